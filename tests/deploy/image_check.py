"""Looks into the container image: its size, its labels, what may be written, and a list of the software in it.

usage: image_check.py IMAGE COMMIT SBOM.json

The list (SBOM) is made from the image's own database of packages, in the format CycloneDX 1.4.
"""
import json
import os
import pathlib
import stat
import subprocess
import sys

IMAGE, COMMIT, SBOM = sys.argv[1:4]
MOST_BYTES = 170_000_000


def podman(*arguments):
    return subprocess.run(["podman", *arguments], check=True, text=True, stdout=subprocess.PIPE, timeout=300).stdout


def check(condition, message):
    if not condition:
        raise SystemExit(f"{IMAGE}: {message}")


def packages_of(root):
    """The installed packages as dictionaries of the fields of dpkg."""
    for entry in (root / "var/lib/dpkg/status").read_text().split("\n\n"):
        fields = dict(line.split(": ", 1) for line in entry.split("\n") if ": " in line and not line.startswith(" "))
        if fields.get("Status") == "install ok installed":
            yield fields


def component(fields):
    name, version, architecture = (fields[key] for key in ("Package", "Version", "Architecture"))
    return {"type": "library", "name": name, "version": version,
            "purl": f"pkg:deb/debian/{name}@{version.replace('+', '%2B')}?arch={architecture}&distro=debian-12"}


def write_sbom(root, labels):
    components = sorted((component(fields) for fields in packages_of(root)), key=lambda one: one["name"])
    own = {"type": "application", "name": "ricochet", "version": labels["org.opencontainers.image.version"]}
    pathlib.Path(SBOM).write_text(json.dumps({
        "bomFormat": "CycloneDX", "specVersion": "1.4", "version": 1, "metadata": {"component": own},
        "components": components}, indent=1) + "\n")
    names = {one["name"] for one in components}
    check({"libc6", "libgrpc++1.51"} <= names, "the database of packages lacks libraries that the server needs")
    return len(components)


def faults_in(root):
    """Files with rights that nothing in the image needs."""
    for folder, directories, files in os.walk(root):
        for path in (pathlib.Path(folder) / name for name in directories + files):
            info = path.lstat()
            where = f"/{path.relative_to(root)}"
            # Devices of the image are hidden by those that a container gets.
            if stat.S_ISLNK(info.st_mode) or stat.S_ISCHR(info.st_mode):
                continue
            if info.st_mode & (stat.S_ISUID | stat.S_ISGID) and not stat.S_ISDIR(info.st_mode):
                yield f"{where} gives the rights of its owner"
            if info.st_mode & stat.S_IWOTH:
                yield f"{where} can be written by everyone"
            if info.st_uid == 10001:
                yield f"{where} belongs to the user of the server"


def main():
    (image,) = json.loads(podman("image", "inspect", IMAGE))
    check(image["Size"] <= MOST_BYTES, f"it has {image['Size']} bytes, more than {MOST_BYTES}")
    labels = image["Config"]["Labels"] or {}
    check(labels.get("org.opencontainers.image.revision") == COMMIT, f"the label of the commit is not {COMMIT}: {labels}")
    check(image["Config"]["User"] == "10001:10001", "its user is not 10001")
    root = pathlib.Path(podman("image", "mount", IMAGE).strip())
    try:
        faults = list(faults_in(root))
        check(not faults, "\n".join(faults[:20]))
        count = write_sbom(root, labels)
    finally:
        podman("image", "unmount", IMAGE)
    print(f"{image['Size'] / 1e6:.1f} MB, {count} packages in {SBOM}, nothing that can be written, no setuid; labels:")
    for name, value in sorted(labels.items()):
        if name.startswith("org.opencontainers"):
            print(f"  {name}={value}")


main()

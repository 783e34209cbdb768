"""Holds deploy/Dockerfile to what the build needs and to what the programs load, without building an image.

usage: image_context_test.py SOURCE_DIRECTORY RICOCHETD RICOCHET
"""
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

RICOCHET, RICOCHETD, SOURCE = [pathlib.Path(sys.argv.pop()).resolve() for _ in range(3)]
DOCKERFILE = (SOURCE / "deploy/Dockerfile").read_text().replace("\\\n", " ")
BUILD_STAGE, RUN_STAGE = re.split(r"^FROM ", DOCKERFILE, flags=re.MULTILINE)[1:]


def output(*command, **options):
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE, timeout=100, **options).stdout


def copy_context(target):
    """Copies what the build stage copies, of what .dockerignore lets through."""
    kept = [line[1:] for line in (SOURCE / ".dockerignore").read_text().splitlines() if line.startswith("!")]
    for line in re.findall(r"^COPY (.*)$", BUILD_STAGE, re.MULTILINE):
        *sources, place = shlex.split(line)
        for source in sources:
            if not any(source == keep or source.startswith(f"{keep}/") for keep in kept):
                raise AssertionError(f".dockerignore hides {source}")
            end = target / place / (pathlib.Path(source).name if place.endswith("/") else "")
            copy = shutil.copytree if (SOURCE / source).is_dir() else shutil.copy
            end.parent.mkdir(parents=True, exist_ok=True)
            copy(SOURCE / source, end)


class ImageContextTest(unittest.TestCase):
    def test_the_build_and_the_installation_find_every_file(self):
        configure = re.search(r"cmake (--preset release [^&]*)", BUILD_STAGE).group(1)
        with tempfile.TemporaryDirectory() as directory:
            context = pathlib.Path(directory)
            copy_context(context)
            output("cmake", *shlex.split(configure), cwd=context, stderr=subprocess.STDOUT)
            build = context / "build/release"
            needed = output("ninja", "-t", "inputs", "all", cwd=build).splitlines()
            for script in build.rglob("cmake_install.cmake"):
                needed += re.findall(r'^ *file\(INSTALL .*? FILES "([^"]*)"', script.read_text(), re.MULTILINE)
            for name in needed:
                path = (build / name).resolve()
                self.assertTrue(path.is_relative_to(build) or path.exists(), path)

    def test_the_image_has_every_library_that_the_programs_load(self):
        installed = set(re.search(r"apt-get install -y --no-install-recommends(.*?)&&", RUN_STAGE).group(1).split())
        todo = list(installed)
        while todo:
            depends = output("dpkg-query", "--show", "--showformat=${Depends},${Pre-Depends}", todo.pop())
            names = {re.match(r"\s*([^\s(:|]+)", one).group(1) for one in depends.split(",") if one.strip()}
            todo += names - installed
            installed |= names
        for program in (RICOCHET, RICOCHETD):
            for library in re.findall(r"\[(lib[^]]*\.so[^]]*)\]", output("readelf", "--dynamic", program)):
                owners = {line.split(":")[0] for line in output("dpkg-query", "--search", f"*/{library}").splitlines()}
                # The image is built without NetCDF.
                if not any(owner.startswith("libnetcdf") for owner in owners):
                    self.assertTrue(owners & installed, f"{program.name} loads {library} of {owners}")


if __name__ == "__main__":
    unittest.main()

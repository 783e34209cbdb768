"""The tests that run containers share this: podman without systemd, and waiting for a server."""
import os
import shutil
import subprocess
import time

# The ulimits spare podman a capability it may lack. The two limits of each are equal, because podman 4.3 exchanges them
# for the container that holds a pod's network.
CONFIGURATION = """[containers]
default_ulimits = ["nofile=4096:4096", "nproc=4096:4096"]
[engine]
runtime = "runc"
cgroup_manager = "cgroupfs"
events_logger = "file"
"""


def environment(work):
    """Empties the work directory, puts podman's configuration there, and returns the environment that names it."""
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    (work / "containers.conf").write_text(CONFIGURATION)
    return {**os.environ, "CONTAINERS_CONF": str(work / "containers.conf")}


def is_serving(ricochet, server):
    return subprocess.run([ricochet, "health", "--server", server], check=False, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, timeout=60).returncode == 0


def wait_for(what, ask, seconds=90):
    """Returns the first answer of `ask` that is true; a server that cannot be asked yet is asked again."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            answer = ask()
        except (OSError, subprocess.CalledProcessError):
            answer = None
        if answer:
            return answer
        time.sleep(0.5)
    raise SystemExit(f"no {what} within {seconds} s")

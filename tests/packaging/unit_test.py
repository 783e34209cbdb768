"""Runs ricochetd under the filter of system calls that its systemd unit states: a call that is not allowed ends it.

usage: unit_test.py UNIT RICOCHETD RICOCHET
"""
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

import seccomp

UNIT, RICOCHETD, RICOCHET = map(pathlib.Path, sys.argv[1:])


def members(name):
    """The system calls of a set such as @resources, those of the sets in it included."""
    if not name.startswith("@"):
        return {name}
    listed = subprocess.run(["systemd-analyze", "syscall-filter", "--no-pager", name], check=True, text=True,
                            stdout=subprocess.PIPE).stdout.splitlines()
    words = [line.strip() for line in listed if line.startswith("    ")]
    return set().union(*(members(word) for word in words if not word.startswith("#")))


def allowed():
    """Returns what systemd makes of the lines of the unit, one after the other; it always adds @default."""
    calls = set()
    for line in re.findall(r"^SystemCallFilter=(.*)$", UNIT.read_text(), re.MULTILINE):
        named = set().union(*(members(word) for word in line.lstrip("~").split()))
        calls = calls - named if line.startswith("~") else calls | named
    return calls | members("@default")


def filtered(calls):
    """Makes what a child calls before it becomes the server."""
    rules = seccomp.SyscallFilter(seccomp.KILL_PROCESS)
    for call in calls:
        try:
            rules.add_rule(seccomp.ALLOW, call)
        except (RuntimeError, ValueError):  # Another processor has this call.
            pass
    return rules.load


with tempfile.TemporaryDirectory() as directory:
    log, port = pathlib.Path(directory, "log"), pathlib.Path(directory, "port")
    server = subprocess.Popen(
        [RICOCHETD, "--listen", "127.0.0.1:0", "--port-file", port, "--log-file", log, "--drain-grace", "0"],
        preexec_fn=filtered(allowed()))
    try:
        while not port.exists() and server.poll() is None:
            time.sleep(0.01)
        assert server.poll() is None, f"ricochetd ended with {server.returncode} at its start"
        server_flag = ["--server", f"127.0.0.1:{port.read_text().strip()}"]
        scene = ["--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1", *server_flag]
        for command in (["solve", *scene], ["solve", *scene, "--certified", "30"],
                        ["sweep", *scene, "--axis", "mu=lin:0:1:100000", "--column", "newton"]):
            subprocess.run([RICOCHET, *command], check=True, stdout=subprocess.DEVNULL)
        server.send_signal(signal.SIGHUP)
        server.terminate()
        assert server.wait(60) == 0, f"ricochetd ended with {server.returncode}"
    finally:
        server.kill()

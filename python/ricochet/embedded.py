"""EmbeddedServer: a ricochetd of this process alone, behind a Unix socket that nobody else can open."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import tempfile
import time

from ricochet.errors import Unavailable

_START_S = 20.0
_STOP_S = 10.0
_LONGEST_SOCKET = 100  # Bytes of a path; the system takes 107.

# Runs a program until it ends or the standard input does, which it does however this process ends, then removes the
# directory.
_KEEPER = """
directory=$1; shift
exec 3<&0
"$@" </dev/null 3<&- &
server=$!
{ read -r _ <&3; kill "$server"; } 2>/dev/null &
exec 3<&-
wait "$server"
code=$?
[ "$code" -ne 0 ] || rm -rf "$directory"
exit "$code"
"""


def _private_directory() -> str:
    directory = tempfile.mkdtemp(prefix="ricochet-")
    if len(os.fsencode(directory)) < _LONGEST_SOCKET - len("/socket"):
        return directory
    os.rmdir(directory)
    return tempfile.mkdtemp(prefix="ricochet-", dir="/tmp")


class EmbeddedServer:
    """Starts the program ``ricochetd``, found in ``RICOCHETD`` or on the ``PATH``, and stops it with this process.

    The server ends whatever ends the process: a call of ``stop``, a normal exit, an exception or a kill.
    """

    def __init__(self) -> None:
        program = shutil.which(os.environ.get("RICOCHETD", "ricochetd"))
        if program is None:
            raise Unavailable(
                "the program ricochetd was not found: install it, set RICOCHETD to its path, or name a server",
                code="UNAVAILABLE",
            )
        self._directory = _private_directory()
        self._socket = os.path.join(self._directory, "socket")
        self.target = f"unix:{self._socket}"
        log = os.path.join(self._directory, "log")
        command = [program, "--listen", self.target, "--log-file", log, "--log-calls", "errors", "--drain-grace", "0"]
        # Options of a server on the same machine are not meant for this one.
        environment = {name: value for name, value in os.environ.items() if not name.startswith("RICOCHETD")}
        # A session of its own: Ctrl-C is for the program that asks, not for its server.
        self._keeper = subprocess.Popen(
            ["/bin/sh", "-c", _KEEPER, "sh", self._directory, *command],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
        self._wait_until_it_serves(log)

    def _takes_connections(self) -> bool:
        with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as end:
            return end.connect_ex(self._socket) == 0

    def _wait_until_it_serves(self, log: str) -> None:
        end = time.monotonic() + _START_S
        while not self._takes_connections():
            if self._keeper.poll() is not None or time.monotonic() > end:
                reason = self._reason(log)
                self.stop()
                shutil.rmtree(self._directory, ignore_errors=True)
                raise Unavailable(f"ricochetd did not start: {reason}", code="UNAVAILABLE")
            time.sleep(0.005)

    def _reason(self, log: str) -> str:
        if self._keeper.poll() is None:
            return f"it did not serve within {_START_S:g} s"
        assert self._keeper.stderr is not None
        text = self._keeper.stderr.read().decode(errors="replace").strip()
        if not text and os.path.exists(log):
            with open(log, encoding="utf-8") as file:
                text = file.read().strip()
        return text.splitlines()[-1] if text else f"it ended with {self._keeper.returncode}"

    def stop(self) -> None:
        """Stops the server and waits for its end."""
        assert self._keeper.stdin is not None and self._keeper.stderr is not None
        self._keeper.stdin.close()
        try:
            self._keeper.wait(_STOP_S)
        except subprocess.TimeoutExpired:
            os.killpg(self._keeper.pid, 9)
            self._keeper.wait()
        self._keeper.stderr.close()

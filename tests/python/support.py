"""The tests of the Python package share this module.

Each test program runs in two ways: as it is, with the engine in its own process, and with --server, where the functions
of the package ask a ricochetd.
"""

import csv
import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
WAIT_S = 20

# The elastic pendulum of Lubarda (2009), sec. 4.
PENDULUM = {
    "pendulum": {"inertia_kg_m2": 1, "a_m": 0.3, "b_m": 1, "omega_minus_rad_s": -1},
    "friction": {"kinetic_coefficient": 0.1},
    "restitution": {"energetic": 1},
}


def vectors(name):
    """The rows of a file of reference impacts, as dictionaries of texts."""
    with open(SOURCE / "tests/data" / name, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def eventually(condition):
    end = time.monotonic() + WAIT_S
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


class Ricochetd:
    """A server on 127.0.0.1, by default on a free port."""

    def __init__(self, *arguments, address="127.0.0.1:0"):
        self._directory = tempfile.TemporaryDirectory()
        port = Path(self._directory.name) / "port"
        self._process = subprocess.Popen(
            [os.environ["RICOCHETD"], "--listen", address, "--port-file", port, "--drain-grace", "0", *arguments],
            stderr=subprocess.DEVNULL,
        )
        if not eventually(port.exists):
            raise RuntimeError("ricochetd did not start")
        self.address = f"127.0.0.1:{port.read_text().strip()}"

    def stop(self):
        self._process.terminate()
        self._process.wait()
        self._directory.cleanup()


def main():
    """Runs the tests of the program."""
    if "--server" not in sys.argv:
        unittest.main()
    sys.argv.remove("--server")
    server = Ricochetd()
    os.environ["RICOCHET_SERVER"] = server.address
    try:
        unittest.main()
    finally:
        server.stop()

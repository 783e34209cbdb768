"""The measurements in Python share this: the programs, a server, stubs, times, and medians."""

import contextlib
import os
import statistics
import subprocess
import sys
import tempfile
import time

BUILD = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "build", "release")
PROTOS = os.path.join(BUILD, "..", "..", "proto")
RICOCHET = os.path.join(BUILD, "client", "ricochet")
RICOCHETD = os.path.join(BUILD, "server", "ricochetd")
ECHO = os.path.join(BUILD, "tests", "benchmark", "ricochet_echo_server")
CLIENTS = os.path.join(BUILD, "tests", "benchmark", "ricochet_load_clients")


@contextlib.contextmanager
def stubs():
    """Makes the Python stubs of the service in a temporary directory, from which they can be imported meanwhile."""
    with tempfile.TemporaryDirectory() as directory:
        files = [os.path.join(folder, name) for folder in ("ricochet/v1", "google/rpc")
                 for name in sorted(os.listdir(os.path.join(PROTOS, folder))) if name.endswith(".proto")]
        plugin = subprocess.run(["which", "grpc_python_plugin"], capture_output=True, text=True, check=True).stdout.strip()
        subprocess.run(["protoc", f"-I{PROTOS}", f"--python_out={directory}", f"--grpc_out={directory}",
                        f"--plugin=protoc-gen-grpc={plugin}", *files], check=True)
        sys.path.insert(0, directory)
        yield


@contextlib.contextmanager
def server(*options, program=RICOCHETD):
    """Starts a ricochetd with these options on a free port of 127.0.0.1; gives its address."""
    with tempfile.TemporaryDirectory() as directory:
        port_file = os.path.join(directory, "port")
        with open(os.path.join(directory, "log"), "wb") as log:
            command = [program, "--listen", "127.0.0.1:0", "--port-file", port_file, *options]
            child = subprocess.Popen(command, stdout=log, stderr=log)
        try:
            until = time.monotonic() + 20
            while not os.path.exists(port_file) and time.monotonic() < until:
                time.sleep(0.02)
            with open(port_file, encoding="ascii") as file:
                yield "127.0.0.1:" + file.read().strip()
        finally:
            child.terminate()
            child.wait()


@contextlib.contextmanager
def echo_server():
    """Starts the server that sends messages of equal sizes and computes nothing; gives its address."""
    with subprocess.Popen([ECHO], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as child:
        try:
            yield "127.0.0.1:" + child.stdout.readline().strip()
        finally:
            child.stdin.close()


def seconds(run):
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def medians(rounds, *runs):
    """Seconds of each, which take turns, after a round that is not counted."""
    for run in runs:
        run()
    times = [[seconds(run) for run in runs] for _ in range(rounds)]
    return times, [statistics.median(column) for column in zip(*times)]


def ratio(times, above, below):
    """The median of the ratios of two runs in each round."""
    return statistics.median(row[above] / row[below] for row in times)


def run_program(*command):
    """Runs a program; returns its output, its seconds, and the most memory that it had, in MiB."""
    start = time.perf_counter()
    with subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as child:
        output = child.stdout.read()
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    took = time.perf_counter() - start
    if child.returncode != 0:
        sys.exit(f"{' '.join(str(part) for part in command)} failed:\n{output}")
    return output, took, usage.ru_maxrss / 1024

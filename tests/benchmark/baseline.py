#!/usr/bin/python3
"""The calls of 64 clients at once: this build against another one, which takes turns with it.

usage: RICOCHET_BASELINE=BUILD baseline.py; BUILD is the other one's build directory, with its benchmarks. Each is asked by its
own clients. Without BUILD nothing is measured.
"""

import os
import statistics
import subprocess

import processes

ROUNDS = 5
CLIENTS = 64


def calls_a_second(build):
    with processes.server(program=os.path.join(build, "server", "ricochetd")) as address:
        clients = os.path.join(build, "tests", "benchmark", "ricochet_load_clients")
        output = subprocess.run([clients, address], capture_output=True, text=True, check=True).stdout
    rows = [line.split("\t") for line in output.splitlines()[1:]]
    return next(float(calls) for count, sweeps, calls, *_ in rows if (int(count), int(sweeps)) == (CLIENTS, 0))


def main():
    baseline = os.environ.get("RICOCHET_BASELINE")
    if not baseline:
        print(f"{CLIENTS} clients: not measured, because RICOCHET_BASELINE names no other build; goal 1.3 x 570cd80")
        return
    ratios = [calls_a_second(processes.BUILD) / calls_a_second(baseline) for _ in range(ROUNDS)]
    print(f"{CLIENTS} clients: {statistics.median(ratios):.2f} x the calls of {baseline}, median of {ROUNDS} rounds; goal 1.3")


if __name__ == "__main__":
    main()

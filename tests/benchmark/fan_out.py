#!/usr/bin/python3
"""How the rate of one sweep grows with the servers that share it, against the embedded engine in the same run.

usage: fan_out.py [--quick] [RICOCHET RICOCHETD]; prints the table of deploy/README.md. Each server, and the embedded engine,
computes with one thread. Without programs those of build/release are measured.
"""

import contextlib
import statistics
import sys

import processes

ROUNDS = 5
SERVERS = (1, 2, 3)
PENDULUM = ["--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "0.8"]
CERTIFIED = [*PENDULUM, "--tolerance", "1e-40"]
SWEEPS = [("a pendulum in double precision", PENDULUM, 20_000_000), ("a pendulum to 40 certified digits", CERTIFIED, 20_000)]


def seconds(scene, points, *more):
    return processes.run_program(processes.RICOCHET, "sweep", "--summary-only", *scene, "--axis",
                                 f"friction.kinetic_coefficient=lin:0:0.25:{points}", "--column", "coefficients.newton", *more)[1]


def round_of(scene, points, addresses):
    """The rate of each number of servers, against that of the embedded engine."""
    alone = seconds(scene, points, "--threads", 1)
    rates = []
    for count in SERVERS:
        shared = ["--server", ",".join(addresses[:count]), *(["--fan-out"] if count > 1 else [])]
        rates.append(alone / seconds(scene, points, *shared))
    return rates


def main():
    arguments = sys.argv[1:]
    quick = arguments[:1] == ["--quick"]
    if quick:
        arguments = arguments[1:]
    if arguments:
        if len(arguments) != 2:
            sys.exit(__doc__)
        processes.RICOCHET, processes.RICOCHETD = arguments
    print("| sweep | " + " | ".join(f"{count} server{'s' if count > 1 else ''}" for count in SERVERS) + " |")
    print("| --- |" + " ---: |" * len(SERVERS))
    with contextlib.ExitStack() as stack:
        addresses = [stack.enter_context(processes.server("--compute-threads", "1")) for _ in SERVERS]
        for name, scene, points in SWEEPS:
            rounds = [round_of(scene, points // (20 if quick else 1), addresses) for _ in range(1 if quick else ROUNDS)]
            print(f"| {name} | " + " | ".join(f"{statistics.median(column):.2f}" for column in zip(*rounds)) + " |", flush=True)


if __name__ == "__main__":
    main()

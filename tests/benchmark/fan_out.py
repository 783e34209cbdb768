#!/usr/bin/python3
"""How the rate of one sweep grows with the servers that share it, against the embedded engine in the same run.

usage: fan_out.py [--quick] [RICOCHET RICOCHETD]; prints the table of deploy/README.md: rates, and the CPU time of the client in
parentheses, both against the embedded engine. Each server, and the embedded engine, computes with one thread. Without
programs those of build/release are measured.
"""

import contextlib
import os
import resource
import statistics
import sys

import processes

HERE = os.path.dirname(os.path.abspath(__file__))
ROUNDS = 5
SERVERS = (1, 2, 3)
PENDULUM = ["--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "0.8"]
SPACE = ["--scene", os.path.join(HERE, "..", "data", "scenes", "turning_contact.textproto")]
SWEEPS = [("a pendulum", PENDULUM, 4_000_000), ("a contact in space", SPACE, 300_000)]


def cpu_s():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def seconds(scene, points, *more):
    """Seconds of a sweep, and the CPU seconds of the process that asks for it."""
    before = cpu_s()
    took = processes.run_program(processes.RICOCHET, "sweep", "--summary-only", *scene, "--axis",
                                 f"friction.kinetic_coefficient=lin:0.01:0.25:{points}", "--column", "energy_change_j", *more)[1]
    return took, cpu_s() - before


def round_of(scene, points, addresses):
    """The rate of each number of servers, and the client's CPU time with it, against those of the embedded engine."""
    alone_s, alone_cpu_s = seconds(scene, points, "--threads", 1)
    ratios = []
    for count in SERVERS:
        shared = ["--server", ",".join(addresses[:count]), *(["--fan-out"] if count > 1 else [])]
        took, client_cpu_s = seconds(scene, points, *shared)
        ratios += [alone_s / took, client_cpu_s / alone_cpu_s]
    return ratios


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
            medians = [statistics.median(column) for column in zip(*rounds)]
            cells = [f"{rate:.2f} ({client:.2f})" for rate, client in zip(medians[::2], medians[1::2])]
            print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Fails if a piece of work executes over 5 % more instructions than are on record.

usage: instruction_counts.py PROGRAM RECORD

Instructions do not depend on the speed of the machine, nor on what else it does. RICOCHET_UPDATE_COUNTS=1 writes the
record anew. Ends with 77 where nothing can be counted, or on a processor without AVX2, where the record says nothing.
"""

import os
import re
import sys

import callgrind

MOST_GROWTH = 0.05


def count(program):
    """Returns the instructions of each piece of work by name, with all that it calls."""
    names, inclusive = callgrind.run("*Counted<*", program)
    counts = {}
    for number, name in enumerate(names.split()):
        wanted = re.compile(rf"::Counted<{number}ul>\(")
        counts[name] = sum(cost for function, cost in inclusive.items() if wanted.search(function))
    return counts


def read(path):
    with open(path, encoding="utf-8") as lines:
        rows = [line.split() for line in lines if line.strip() and not line.startswith("#")]
    return {name: int(instructions) for name, instructions in rows}


def write(path, counts):
    with open(path, "w", encoding="utf-8") as file:
        file.write("# Instructions of each piece of work in tests/benchmark/instruction_counts.cc, by the preset dev.\n"
                   "# RICOCHET_UPDATE_COUNTS=1 tests/benchmark/instruction_counts.py writes this file anew.\n")
        file.writelines(f"{name} {instructions}\n" for name, instructions in counts.items())


def main():
    program, record = sys.argv[1:]
    if obstacle := callgrind.obstacle():
        print(f"Instructions are not counted: {obstacle}.")
        sys.exit(callgrind.CANNOT_RUN)
    counts = count(program)
    if empty := [name for name, instructions in counts.items() if instructions == 0]:
        sys.exit(f"nothing was counted of {', '.join(empty)}")
    if os.environ.get("RICOCHET_UPDATE_COUNTS") == "1":
        write(record, counts)
        return
    recorded = read(record)
    if counts.keys() != recorded.keys():
        sys.exit(f"{record} has {', '.join(recorded)}; the program has {', '.join(counts)}")
    grown = []
    print(f"{'work':<24} {'record':>12} {'now':>12} {'change':>8}")
    for name, instructions in counts.items():
        change = instructions / recorded[name] - 1
        print(f"{name:<24} {recorded[name]:12} {instructions:12} {change:+8.1%}")
        if change > MOST_GROWTH:
            grown.append(name)
    if grown:
        sys.exit(f"{', '.join(grown)}: more than {MOST_GROWTH:.0%} above the record. If that is meant, write it anew:\n"
                 f"  RICOCHET_UPDATE_COUNTS=1 {sys.argv[0]} {program} {record}\nand say in the commit why.")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""The time from starting `ricochet solve` until it has answered, against that of starting a program that does nothing."""

import subprocess

import processes

ROUNDS = 101
GOAL_MS = 15
SOLVE = ["solve", "--a", "0.6", "--b", "0.8", "--mu", "0.2", "--energetic", "0.8"]


def run(*command):
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)


def main():
    times, (solve, nothing) = processes.medians(ROUNDS, lambda: run(processes.RICOCHET, *SOLVE), lambda: run("/bin/true"))
    print(f"From exec to answer, medians of {ROUNDS} rounds")
    print(f"  ricochet solve  {solve * 1e3:6.1f} ms   goal {GOAL_MS} ms; {processes.ratio(times, 0, 1):.1f} x /bin/true")
    print(f"  /bin/true       {nothing * 1e3:6.1f} ms")


if __name__ == "__main__":
    main()

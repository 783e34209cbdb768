#!/usr/bin/python3
"""What each effect costs, in instructions under callgrind: python3 plan_cost.py RICOCHET_PLAN_COST."""

import re
import subprocess
import sys

WHAT = ("validate", "plan", "solve", "direct", "with")


def instructions(program, case, what, count):
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, case, what, str(count)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or found is None:
        sys.exit(f"{' '.join(command)} failed:\n{done.stderr}")
    return int(found.group(1))


def per_call(program, case, what):
    few, many = (10, 20) if case.startswith("finite") else (50, 250)
    return (instructions(program, case, what, many) - instructions(program, case, what, few)) / (many - few)


def main():
    program = sys.argv[1]
    cases = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    print("Instructions a call (callgrind); the effect is off but in the last column.")
    print(f"{'effect':<22} {'validate':>9} {'plan':>7} {'model in scene':>15} {'model directly':>15} {'ratio':>6}"
          f" {'scene with it':>14}")
    worst = 0.0
    for case in cases:
        cost = {what: per_call(program, case, what) for what in WHAT}
        model = cost["solve"] - cost["plan"]
        ratio = model / cost["direct"]
        worst = max(worst, abs(ratio - 1.0))
        print(f"{case:<22} {cost['validate']:9.0f} {cost['plan']:7.0f} {model:15.0f} {cost['direct']:15.0f} {ratio:6.3f}"
              f" {cost['with']:14.0f}")
    print(f"\nThe model in the scene costs within {100 * worst:.1f} % of calling it directly.")


if __name__ == "__main__":
    main()

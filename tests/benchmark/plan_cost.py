#!/usr/bin/python3
"""What each effect costs, in instructions under callgrind: python3 plan_cost.py RICOCHET_PLAN_COST."""

import re
import subprocess
import sys

# The function that is the model of a case without the effect, as callgrind names it.
MODELS = {
    "friction": "*sliding::SolveFrictionless<1ul>*",
    "slip_stop": "*sliding::Solve<1ul>*",
    "slip_turn": "*sliding::Solve<2ul>*",
    "static_friction": "ricochet::planar::Solve(*",
    "tangential_compliance": "ricochet::planar::Solve(*",
    "finite_duration": "ricochet::planar::Solve(*",
    "finite_forces": "ricochet::finite_duration::Solve(*",
    "higher_order": "ricochet::first_order::Solve(*",
}


def instructions(program, case, what, count, inside=None):
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    if inside is not None:
        command += ["--collect-atstart=no", f"--toggle-collect={inside}"]
    command += [program, case, what, str(count)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or found is None:
        sys.exit(f"{' '.join(command)} failed:\n{done.stderr}")
    return int(found.group(1))


def per_call(program, case, what, inside=None):
    few, many = (10, 20) if case.startswith("finite") else (50, 250)
    counts = [instructions(program, case, what, count, inside) for count in (few, many)]
    return (counts[1] - counts[0]) / (many - few)


def main():
    program = sys.argv[1]
    cases = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    print("Instructions a call, counted by callgrind. The effect named is off but in the last column; 'solve' is validated")
    print("scene to outcome: plan, model, and what puts the answer together.")
    print(f"{'effect':<22} {'validate':>9} {'plan':>7} {'solve':>9} {'model in it':>12} {'model directly':>15} {'ratio':>6}"
          f" {'solve with it':>14}")
    worst = 0.0
    for case in cases:
        validate, plan, solve, on = (per_call(program, case, what) for what in ("validate", "plan", "solve", "with"))
        model, direct = (per_call(program, case, what, MODELS[case]) for what in ("solve", "direct"))
        if not direct > 0.0:
            sys.exit(f"{case}: no function {MODELS[case]} was called")
        worst = max(worst, abs(model / direct - 1.0))
        print(f"{case:<22} {validate:9.0f} {plan:7.0f} {solve:9.0f} {model:12.0f} {direct:15.0f} {model / direct:6.3f}"
              f" {on:14.0f}")
    print(f"\nA model costs within {100 * worst:.1f} % in a scene of what it costs directly.")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Instructions and heap allocations of a solve, counted by callgrind: python3 plan_cost.py RICOCHET_PLAN_COST."""

import re
import subprocess
import sys

import callgrind

COUNT = 20
# A solve should execute at most so many instructions, by its system, and how often it should ask for memory.
GOALS = {"planar_contact": 4200, "pendulum": 3500, "planar_body": 4200}
MOST_ALLOCATIONS = 2
SOLVE = "ricochet::bench::(anonymous namespace)::SolveOnce("
VALIDATE = "ricochet::Validate("
PLAN = "ricochet::PlanScene("
# The function that is the model of an effect's case without the effect.
MODELS = {
    "friction": "ricochet::sliding::SolveFrictionless<1",
    "slip_stop": "ricochet::sliding::Solve<1",
    "slip_turn": "ricochet::sliding::Solve<2",
    "static_friction": "ricochet::planar::SolvePlain(",
    "tangential_compliance": "ricochet::planar::SolvePlain(",
    "finite_duration": "ricochet::planar::SolvePlain(",
    "finite_forces": "ricochet::finite_duration::Solve(",
    "higher_order": "ricochet::first_order::Solve(",
}


class Profile:
    """Counts what a solve executes, each function with all that it calls, and how often it asks for memory."""

    def __init__(self, program, case):
        allocations, self.inclusive = callgrind.run("*SolveRepeatedly*", program, case, str(COUNT))
        self.allocations = int(allocations) / COUNT

    def instructions(self, name):
        """A solve's, in the functions whose qualified names begin so; they must not call each other."""
        wanted = re.compile(r"(^|[ *&])" + re.escape(name))
        return sum(cost for function, cost in self.inclusive.items() if wanted.search(function)) / COUNT


def print_solves(program, cases):
    print("One solve in this process, with the defaults of a request, from the request until its answer is freed:")
    print(f"{'system':<22} {'instructions':>12} {'goal':>6} {'allocations':>12} {'goal':>6}")
    for case in cases:
        measured = Profile(program, case)
        goal = GOALS.get(case, "")
        print(f"{case:<22} {measured.instructions(SOLVE):12.0f} {goal:>6} {measured.allocations:12.0f} "
              f"{MOST_ALLOCATIONS if goal else '':>6}")


def print_effects(program, effects):
    print("\nInstructions of a solve without each effect, and of one with it. 'rest' is what puts the answer together.")
    print(f"{'effect':<22} {'validate':>9} {'plan':>7} {'model':>9} {'rest':>7} {'solve':>9} {'solve with it':>14}")
    for effect in effects:
        off, on = (Profile(program, f"{effect}.{state}") for state in ("off", "on"))
        validate, plan, model = (off.instructions(name) for name in (VALIDATE, PLAN, MODELS[effect]))
        if not (validate and plan and model):
            sys.exit(f"{effect}: one of {VALIDATE}, {PLAN}, {MODELS[effect]} was not called")
        solve, solve_with_it = off.instructions(SOLVE), on.instructions(SOLVE)
        rest = solve - validate - plan - model
        print(f"{effect:<22} {validate:9.0f} {plan:7.0f} {model:9.0f} {rest:7.0f} {solve:9.0f} {solve_with_it:14.0f}")


def main():
    program = sys.argv[1]
    if obstacle := callgrind.obstacle():
        print(f"Instructions are not counted: {obstacle}.")
        return
    names = subprocess.run([program], capture_output=True, text=True, check=True).stdout.split()
    print("Counted by callgrind, each function with all that it calls.\n")
    print_solves(program, [name for name in names if "." not in name])
    print_effects(program, [name.split(".")[0] for name in names if name.endswith(".off")])


if __name__ == "__main__":
    main()

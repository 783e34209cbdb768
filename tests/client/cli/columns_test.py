"""Holds every number that the command line writes into a table to the JSON of `solve` for the same scene: the same number,
and none where the answer has none. The scenes are random, of every system, with springs, damping, tangential compliance,
finite forces and impact laws. RICOCHET_SCENES=N takes N scenes of each kind instead of five, for long runs.

usage: columns_test.py RICOCHET WORK_DIRECTORY
"""
import csv
import json
import os
import random
import unittest

from ricochet_case import RicochetCase, WORK, ricochet

SCENES = int(os.environ.get("RICOCHET_SCENES", "5"))  # Each kind has so many.
RANDOM = random.Random(2026)


def towards():
    return RANDOM.uniform(0, 1) if RANDOM.random() < 0.2 else -RANDOM.uniform(0.1, 5)


def body():
    return {"mass_kg": RANDOM.uniform(0.3, 3), "inertia_com_kg_m2": RANDOM.uniform(0.01, 1),
            "offset_t_m": RANDOM.uniform(-0.3, 0.3), "offset_n_m": RANDOM.uniform(-0.5, -0.1),
            "velocity_t_m_s": RANDOM.uniform(-2, 2), "velocity_n_m_s": towards(), "rate_rad_s": RANDOM.uniform(-1, 1)}


def body_in_space():
    inertia = RANDOM.uniform(0.01, 1)
    return {"mass_kg": RANDOM.uniform(0.3, 3), "inertia_com_kg_m2": [inertia, 0, 0, 1.2 * inertia, 0.1 * inertia, inertia],
            "offset_m": [RANDOM.uniform(-0.3, 0.3) for _ in range(3)],
            "linear_m_s": [RANDOM.uniform(-2, 2), RANDOM.uniform(-2, 2), towards()],
            "angular_rad_s": [RANDOM.uniform(-1, 1) for _ in range(3)]}


def link():
    return {"length_m": RANDOM.uniform(0.5, 1.5), "mass_kg": RANDOM.uniform(0.3, 3), "com_m": RANDOM.uniform(0.1, 0.5),
            "inertia_com_kg_m2": RANDOM.uniform(0.01, 1), "theta_rad": RANDOM.uniform(-3, 3),
            "rate_rad_s": RANDOM.uniform(-3, 3)}


PLANAR = {
    "pendulum": (lambda: {"inertia_kg_m2": RANDOM.uniform(0.1, 10), "a_m": RANDOM.uniform(0.05, 1),
                          "b_m": RANDOM.uniform(-1, 1), "omega_minus_rad_s": towards()}, "pin_moment", "moment_n_m"),
    "planar_body": (body, "gravity", "normal_m_s2"),
    "body_pair": (lambda: {"planar": {"body_1": body(), "body_2": body()}}, "gravity", "normal_m_s2"),
    "linkage": (lambda: {"links": [link(), link()]}, "gravity", "normal_m_s2"),
    "planar_contact": (lambda: {"w_tt_per_kg": RANDOM.uniform(1, 3), "w_tn_per_kg": RANDOM.uniform(-0.9, 0.9),
                                "w_nn_per_kg": RANDOM.uniform(1, 3), "tangential_m_s": RANDOM.uniform(-2, 2),
                                "normal_m_s": towards()}, "contact_acceleration", "normal_m_s2"),
}
SPATIAL = {
    "mechanism": lambda: {"mass_matrix": [2, 0.6, 0.1, 0.6, 1.2, 0.3, 0.1, 0.3, 0.5],
                          "jacobian": [RANDOM.uniform(-1, 1) for _ in range(9)],
                          "rates": [RANDOM.uniform(-2, 2) for _ in range(3)]},
    "spatial_body": body_in_space,
    "body_pair": lambda: {"spatial": {"body_1": body_in_space(), "body_2": body_in_space()}},
    "spatial_contact": lambda: {"w_per_kg": [1.96, RANDOM.uniform(-0.3, 0.3), 0.6, 2.96, -0.8, 1.85],
                                "tangential_m_s": [RANDOM.uniform(-2, 2), RANDOM.uniform(-2, 2)], "normal_m_s": towards()},
}


def kinds():
    """The kinds of scene of every system: a name, whether it has a spring, and what makes a scene of the kind."""
    def rigid(system, make, law="energetic"):
        return {system: make(), "friction": {"kinetic_coefficient": RANDOM.uniform(0, 1)},
                "restitution": {law: RANDOM.uniform(0.05, 1)}}

    def on_spring(system, make, compliance, **more):
        return {**rigid(system, make), "compliance": compliance(), **more}

    for system, make in SPATIAL.items():
        for law in ("energetic", "newton"):
            yield f"{system} in space, {law}", False, lambda s=system, m=make, l=law: rigid(s, m, l)
    for system, (make, force, name) in PLANAR.items():
        def linear():
            return {"linear": {"stiffness_n_m": 10 ** RANDOM.uniform(4, 8)}}

        def both():
            return {**linear(), "tangential_ratio_squared": RANDOM.uniform(0.5, 3)}

        def hertz():
            return {"hertz": {"stiffness_n_m1_5": 10 ** RANDOM.uniform(5, 9)}}

        def damped(s=system, m=make):
            scene = on_spring(s, m, lambda: {"hunt_crossley": {"stiffness_n_m_p": 1e6, "exponent": 1.5,
                                                               "damping_s_m": RANDOM.uniform(0, 1)}})
            del scene["restitution"]
            return scene

        def by_law(s=system, m=make):
            scene = {**rigid(s, m), "whittaker": {"e": RANDOM.uniform(0, 1)}}
            del scene["restitution"]
            return scene

        yield f"{system}, poisson", False, lambda s=system, m=make: rigid(s, m, "poisson")
        yield f"{system}, impact law", False, by_law
        yield (f"{system}, tangential spring", False,
               lambda s=system, m=make: on_spring(s, m, lambda: {"tangential_ratio_squared": RANDOM.uniform(0.5, 3)}))
        for spring in (linear, hertz, both):
            yield f"{system}, {spring.__name__} spring", True, lambda s=system, m=make, c=spring: on_spring(s, m, c)
        yield f"{system}, damped spring", True, damped
        yield (f"{system}, forces", True, lambda s=system, m=make, c=linear, f=force, n=name:
               on_spring(s, m, c, **{f: {n: RANDOM.uniform(-10, 0)}}))


def flat(value, path=""):
    """The numbers and names of a JSON value by their paths, without those that are unset."""
    if isinstance(value, dict):
        for name, member in value.items():
            yield from flat(member, f"{path}.{name}" if path else name)
    elif isinstance(value, list):
        for i, entry in enumerate(value):
            yield from flat(entry, f"{path}[{i}]")
    elif value is not None:
        yield path, value


def number(text):
    return float(text.replace("Infinity", "inf")) if isinstance(text, str) else float(text)


class ColumnsTest(RicochetCase):
    def outcome(self, *arguments):
        """The numbers of the answer by path, from JSON; None if the scene is refused."""
        code, out, error = ricochet("solve", *arguments, "--format", "json")
        if code != 0:
            self.assertEqual(code, 2, error)
            return None
        return dict(flat(json.loads(out)["outcome"]))

    def table(self, *arguments):
        lines = list(csv.reader(self.made(*arguments, "--format", "csv").splitlines()))
        return [dict(zip(lines[0], line)) for line in lines[1:]]

    def check_row(self, row, columns, outcome, what):
        """A row of a table of many impacts against the answer for its scene alone."""
        if outcome is None:
            self.assertEqual(row["status"].split(":")[0], "INVALID", what)
            self.assertEqual({row[column] for column in columns}, {"nan"}, what)
            return
        unset = [column for column in columns if column not in outcome]
        if not outcome["admissible"]:
            wanted = "INADMISSIBLE"
        elif outcome["termination"] != "TERMINATION_CONVERGED":
            wanted = "NOT_CONVERGED"
        else:
            wanted = "INCOMPLETE" if unset else "OK"
        self.assertEqual((row["status"], "REGIME_" + row["regime"]), (wanted, outcome["regime"]), what)
        for column in columns:
            if column in unset:
                self.assertEqual(row[column], "nan", f"{column} of {what}")
            else:
                self.assertEqual(number(row[column]), number(outcome[column]), f"{column} of {what}")
            self.compared += 1

    def check_one(self, scene, outcome, what, *demand):
        """`solve --format csv`: a cell for every number of the answer, which is empty where the answer has none."""
        if outcome is None:
            return
        (row,) = self.table("solve", "--scene", scene, *demand)
        for path, cell in row.items():
            if path not in outcome:
                self.assertEqual(cell, "", f"{path} of {what}")
            elif isinstance(outcome[path], bool):
                self.assertEqual(cell, str(outcome[path]).lower(), f"{path} of {what}")
            elif isinstance(outcome[path], str) and not outcome[path].lstrip("-")[:1].isdigit() and "inf" not in cell:
                self.assertTrue(outcome[path].endswith(cell) and cell, f"{path} of {what}")
            else:
                self.assertEqual(number(cell), number(outcome[path]), f"{path} of {what}")
                self.compared += 1

    def check_rows(self, scenes, columns, outcomes, what):
        """`solve --data` and `sweep` of all scenes of a kind, which differ in their numbers."""
        base = json.dumps(scenes[0])
        (WORK / "base.json").write_text(base)
        fields = [dict(flat(scene)) for scene in scenes]
        listed = self.made("scene", "fields", "--scene", "base.json").split()
        names = [name for name in fields[0] if name in listed]
        with open(WORK / "rows.csv", "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(names)
            writer.writerows([repr(float(row[name])) for name in names] for row in fields)
        axes = [part for name in names for part in ("--axis", f"{name}=" + ",".join(repr(float(r[name])) for r in fields))]
        asked = ["--scene", "base.json", "--column", ",".join(columns)]
        for rows in (self.table("solve", *asked, "--data", "rows.csv"),
                     self.table("sweep", *asked, *axes, "--zip", "--regime")):
            self.assertEqual(len(rows), len(scenes))
            for i, row in enumerate(rows):
                self.check_row(row, columns, outcomes[i], f"{what}, scene {i}: {json.dumps(scenes[i])}")

    def check_kind(self, what, has_spring, make):
        scenes = [make() for _ in range(SCENES)]
        outcomes, timed = [], []
        for i, scene in enumerate(scenes):
            (WORK / "scene.json").write_text(json.dumps(scene))
            outcomes.append(self.outcome("--scene", "scene.json"))
            self.check_one("scene.json", outcomes[-1], f"{what}, scene {i}")
            if has_spring:
                duration = ("--require", "finite-duration")
                timed.append(self.outcome("--scene", "scene.json", *duration))
                self.check_one("scene.json", timed[-1], f"{what}, scene {i}", *duration)
        (WORK / "scene.json").write_text(json.dumps(scenes[0]))
        columns = self.made("sweep", "--scene", "scene.json", "--column", "?").split()
        columns = [column for column in columns if "." in column or "[" in column or column == "energy_change_j"]
        of_contact = [column for column in columns if column.startswith("contact.")]
        self.assertEqual(len(of_contact), 4 if has_spring else 0, what)
        self.check_rows(scenes, [column for column in columns if column not in of_contact], outcomes, what)
        if has_spring:
            self.check_rows(scenes, columns, timed, what)
            self.check_rows(scenes, of_contact, timed, what)

    def test_every_column_of_every_table_is_the_number_of_solve_and_unset_where_that_is_unset(self):
        self.compared = 0
        for what, has_spring, make in kinds():
            with self.subTest(what):
                self.check_kind(what, has_spring, make)
        self.assertGreater(self.compared, 10000)

    def test_a_duration_without_a_spring_is_refused(self):
        flags = ["sweep", "--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1", "--axis", "mu=0.1,0.2"]
        self.assertIn('"contact.duration_s": must not be asked of a scene without a normal spring in compliance',
                      self.refused(*flags, "--column", "duration"))

    def test_the_answer_says_that_a_duration_was_left_out_and_that_an_angle_is_large(self):
        scene = {"linkage": {"links": [{**link(), "theta_rad": 0.3, "rate_rad_s": -1}, {**link(), "theta_rad": 20}]},
                 "restitution": {"energetic": 0.5}, "compliance": {"linear": {"stiffness_n_m": 1e6}}}
        (WORK / "scene.json").write_text(json.dumps(scene))
        text = self.made("solve", "--scene", "scene.json")
        self.assertIn("write 20deg or 0.349 if it is meant in degrees", text)
        answer = json.loads(self.made("solve", "--scene", "scene.json", "--format", "json"))["outcome"]
        self.assertIn(("KIND_LARGE_ANGLE", "linkage.links[1].theta_rad"),
                      [(note["kind"], note["path"]) for note in answer["notes"]])
        (WORK / "scene.json").write_text(json.dumps({
            "planar_body": {**body(), "velocity_n_m_s": -40, "rate_rad_s": 0}, "restitution": {"energetic": 0.8},
            "compliance": {"hertz": {"stiffness_n_m1_5": 2e7}}}))
        self.assertIn("Note: The duration and the forces were left out", self.made("solve", "--scene", "scene.json"))
        self.assertNotIn("Note:", self.made("solve", "--scene", "scene.json", "--require", "finite-duration"))


if __name__ == "__main__":
    unittest.main()

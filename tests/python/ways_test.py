"""The engine in this process and a server give the same to every call: each bit of an answer, and each word of an error."""

import json
import unittest
import warnings

import numpy as np
import ricochet
from support import PENDULUM, SOURCE, Ricochetd

MU = [0.0, 0.15, -0.1]
M, J, QDOT = np.diag([1.0, 2.0, 3.0]), np.eye(3) + 0.1, np.array([0.3, -0.2, -1.0])
STATES = np.array([M, M, -M])

SCENES = {
    **{path.name: ricochet.read_scene(path) for ending in ("json", "textproto")
       for path in sorted((SOURCE / "tests/data/scenes").glob(f"*.{ending}"))},
    "no scene": {},
    "no system": {"friction": {"kinetic_coefficient": 0.1}},
    "wrong numbers": {**PENDULUM, "friction": {"kinetic_coefficient": -1}, "restitution": {"energetic": float("nan")}},
    "unknown names": {"pendulum": {"inertia": 1}, "fricton": 2},
    "above the largest double": {**PENDULUM, "pendulum": {"inertia_kg_m2": 1e300, "a_m": 0.3, "omega_minus_rad_s": -1e30}},
    "gains energy": {**PENDULUM, "restitution": {"newton": 0.9}},
    "a matrix": {"spatial_contact": {"w_per_kg": np.eye(3), "tangential_m_s": [1, 0.6], "normal_m_s": -1},
                 "friction": {"kinetic_coefficient": 0.4}, "restitution": {"poisson": 0.5}},
    "an indefinite mechanism": {"mechanism": {"mass_matrix": -M, "jacobian": J, "rates": QDOT}},
}
CALLS = {
    "solve": lambda client, scene: client.solve(scene),
    "solve, prepared": lambda client, scene: client.solve(ricochet.Scene(scene)),
    "solve, coarse": lambda client, scene: client.solve(scene, tolerance=1e-3, exclude="gravity"),
    "solve, a wrong tolerance": lambda client, scene: client.solve(scene, tolerance=0.5),
    "solve, all details": lambda client, scene: client.solve(scene, history=3, force_history=4, both_ends=True),
    "solve, derivatives": lambda client, scene: client.solve(
        scene, derivatives={"of": ["coefficients.newton"], "by": ["friction.kinetic_coefficient"]}),
    "jacobian": lambda client, scene: client.jacobian(
        scene, "newton", ["mu", "mu_static"], side="above").tolist(),
    "solve, certified": lambda client, scene: client.solve(scene, certified=20),
    "solve, strict": lambda client, scene: client.solve(scene, strict=True),
    "plan": lambda client, scene: client.plan(scene, require="tangential_compliance"),
    "bounds": lambda client, scene: client.bounds(scene, ranges={"mu": (0.1, 0.2)}),
    "bounds, derivatives": lambda client, scene: client.bounds(
        scene, derivatives={"of": ["sharp.newton.upper"], "by": ["friction.kinetic_coefficient"]}),
    "bounds, wrong ranges": lambda client, scene: client.bounds(scene, ranges={"mu": (0.2, 0.1), "omega": (0, 1)}),
    "audit": lambda client, scene: client.audit(scene, contact_velocity={"tangential_m_s": 0.1, "normal_m_s": 0.2}),
    "audit, rates": lambda client, scene: client.audit(scene, rates_after=[0.1, 0.2]),
    "audit_batch": lambda client, scene: client.audit_batch(scene, {"normal_after_m_s": [0.1, -3, np.nan]}),
    "solve_batch": lambda client, scene: client.solve_batch(scene, {"mu": MU}, ["newton", "energy_change_j"]),
    "solve_batch, wrong names": lambda client, scene: client.solve_batch(scene, {"nu": MU}, ["newtn"]),
    "sweep": lambda client, scene: client.sweep(scene, {"mu": MU}, "newton", form="table"),
    "sweep, wrong names": lambda client, scene: client.sweep(scene, {"nu": MU}, "newtn", form="table"),
}
AT_CONTACT = {
    "one state": (M, J, QDOT, [0.1, 0.2, 1]),
    "states, one of which is wrong": (STATES, J, QDOT, [0.1, 0.2, 1]),
    "a wrong state": (-M, J, QDOT, [0.1, 0.2, 1]),
    "no normal": (M, J, QDOT, [0, 0, 0]),
    "wrong shapes": (M, J[:2], QDOT, [0, 1]),
}


def bits(answer):
    """An answer as what can be compared: NaN is itself, and 0 is not -0."""
    if isinstance(answer, ricochet.Table):
        return [[(name, array.tobytes()) for name, array in answer.columns.items()],
                [(name, codes.numbers.tobytes()) for name, codes in answer.codes.items()],
                [(name, array.tobytes()) for name, array in answer.axes.items()],
                json.dumps(answer.summary), answer.attrs]
    if isinstance(answer, ricochet.AtContact):
        return answer.rates_after.tobytes(), answer.impulse_n_s.tobytes(), bits(answer.answer)
    return json.dumps(answer)


def outcome(call, *arguments):
    """Returns what a call gives: its answer and its warnings, or its error."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            answer = bits(call(*arguments))
        except ricochet.RicochetError as error:
            return type(error), str(error), error.code, error.reason, error.violations
    return answer, [str(warning.message) for warning in caught]


class Ways(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        server = Ricochetd()
        cls.addClassCleanup(server.stop)
        cls.here, cls.there = ricochet.Client(None), ricochet.Client(server.address)
        cls.addClassCleanup(cls.there.close)

    def test_one_asks_a_server(self):
        self.assertIsNone(self.here.info().server_limits)
        self.assertIsNotNone(self.there.info().server_limits)
        self.assertEqual(self.here.info().engine, self.there.info().engine)

    def test_every_scene_has_the_same_outcome_of_every_call(self):
        for name, scene in SCENES.items():
            for what, call in CALLS.items():
                with self.subTest(what, scene=name):
                    self.assertEqual(outcome(call, self.here, scene), outcome(call, self.there, scene))

    def test_states_of_a_mechanism_have_the_same_outcome(self):
        for name, arguments in AT_CONTACT.items():
            with self.subTest(name):
                here, there = (outcome(lambda: client.at_contact(*arguments, friction=0.3, newton=0.5))
                               for client in (self.here, self.there))
                self.assertEqual(here, there)

    def test_the_rows_of_a_study_stand_where_its_summary_says(self):
        for client in (self.here, self.there):
            study = client.cost(PENDULUM, time_limit_s=60, samples=1)
            names = {pick.model: study.rows[pick.row].name for pick in study.summary.picks}
            self.assertEqual(set(names), {"PENDULUM"})
            self.assertTrue(all(name.startswith("closed form") for name in names.values()), names)
            self.assertEqual(study.rows[0].name, "frictionless")
            times = [study.rows[row].solve.median_s for row in study.summary.front]
            self.assertEqual(times, sorted(times))
            self.assertEqual((study.first_row, study.rows_done), (0, len(study.rows)))

    def test_studies_of_cost_have_the_same_methods_and_errors(self):
        here, there = (client.cost(PENDULUM, time_limit_s=60, samples=1).rows for client in (self.here, self.there))
        self.assertEqual([(row.name, row.method) for row in here], [(row.name, row.method) for row in there])
        # Methods for which no time is left, as on a busy machine, have no numbers.
        pairs = [pair for pair in zip(here, there) if all(row.status != "OUT_OF_TIME" for row in pair)]
        self.assertGreater(len(pairs), len(here) // 2)
        for pair in pairs:
            answers = [json.dumps([row.status, row.claimed, row.achieved, row.velocity_after]) for row in pair]
            self.assertEqual(*answers)


if __name__ == "__main__":
    unittest.main()

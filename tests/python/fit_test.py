"""Fits in Python: recovered numbers, names, errors, and the same bits from a server."""

import math
import unittest

import numpy as np

import ricochet
from support import Ricochetd, main

SCENE = {
    "planar_contact": {"w_tt_per_kg": 3, "w_tn_per_kg": 0.5, "w_nn_per_kg": 1, "tangential_m_s": 1, "normal_m_s": -1},
    "friction": {"kinetic_coefficient": 0.25},
    "restitution": {"poisson": 0.6},
}
SLIP = np.array([0.2, 0.6, 1.0, 2.0, 3.0, 4.0])
AFTER = ["contact_velocity_after.tangential_m_s[0]", "contact_velocity_after.normal_m_s"]


def table():
    solved = ricochet.solve_batch(SCENE, {"planar_contact.tangential_m_s": SLIP}, AFTER)
    return {"planar_contact.tangential_m_s": SLIP, **{name: solved[name] for name in AFTER}}


SIGMA = {AFTER[0]: 0.01, AFTER[1]: np.full(6, 0.01)}


class Fit(unittest.TestCase):
    def test_the_truth_comes_back(self):
        answer = ricochet.fit(SCENE, table(), {"mu": 0.1, "restitution.poisson": 0.8}, sigma=SIGMA)
        mu, poisson = answer.unknowns
        self.assertEqual(mu.path, "friction.kinetic_coefficient")
        self.assertAlmostEqual(mu.value, 0.25, delta=1e-9)
        self.assertAlmostEqual(poisson.value, 0.6, delta=1e-9)
        self.assertEqual((mu.low.kind, mu.high.kind), ("FOUND", "FOUND"))
        self.assertLess(mu.low.value, 0.25)
        self.assertTrue(answer.exact_derivatives)
        self.assertEqual(answer.degrees_of_freedom, 10)

    def test_columns_of_sigma_bounds_and_a_region(self):
        data = table()
        for name in AFTER:
            data[f"{name}.sigma"] = np.full(6, 0.01)
        data[AFTER[0]] = np.ma.array(data[AFTER[0]], mask=SLIP == SLIP[2])
        answer = ricochet.fit(SCENE, data, ["mu", "poisson"], bounds={"mu": (0.24999, None)}, loss="cauchy",
                              starts=2, region=["mu", "poisson"])
        self.assertEqual(answer.unknowns[0].low.kind, "CUT_BY_BOUND")
        self.assertEqual(answer.degrees_of_freedom, 9)
        self.assertEqual(len(answer.starts), 2)
        self.assertGreater(len(answer.region), 40)
        self.assertTrue(math.isnan(answer.rows[2].residuals[0]))

    def test_an_input_with_errors_widens_the_interval(self):
        name = "planar_contact.tangential_m_s"
        exact, by_table, by_argument = (
            ricochet.fit(SCENE, data, ["mu"], sigma=sigma)
            for data, sigma in (
                (table(), SIGMA),
                ({**table(), f"{name}.sigma": np.full(6, 0.03)}, SIGMA),
                (table(), {**SIGMA, name: 0.03}),
            )
        )
        self.assertEqual(repr(by_table), repr(by_argument))
        # Rows that slide keep the error of the velocity before, which joins that after.
        self.assertAlmostEqual(by_table.unknowns[0].sigma / exact.unknowns[0].sigma, math.sqrt(10), delta=0.2)

    def test_errors_name_what_is_wrong(self):
        for change, text in (
            ({"unknown": ["mu", "friction.kinetic"]}, "unknowns[1].path"),
            ({"sigma": {AFTER[0]: 0.01}}, f"{AFTER[1]}.sigma has 0 numbers"),
            ({"sigma": {**SIGMA, "contact.duration_s": 1}}, "must be a column of the table"),
            ({"bounds": {"restitution.poisson": (0, 1)}}, "must be an unknown"),
            ({"bounds": {"poisson": (0, 1)}}, "bounds = 'poisson': must be an unknown"),
            ({"bounds": {"mu": (0, 1), "friction.kinetic_coefficient": (0, 0.5)}}, "a second time"),
            ({"bounds": {"mu": 0.3}}, "friction.kinetic_coefficient = 0.3: must be two numbers or None"),
            ({"bounds": {"mu": (0, 1, 2)}}, "must be two numbers or None"),
            ({"bounds": 0.3}, "bounds must be a dictionary"),
            ({"sigma": {**SIGMA, "contact_velocity_after.normal": 0.1}}, "sigma = .* a second time"),
            ({"sigma": {**SIGMA, "coefficients.newton": 0.1}},
             "sigma = 'coefficients.newton': must be a column of the table"),
            ({"sigma": {**SIGMA, "planar_contact.tangential_m_s": -1}}, "planar_contact.tangential_m_s.sigma[0] = -1"),
            ({"sigma": 0.01}, "sigma must be a dictionary"),
            ({"unknown": {3: 0.1}}, "unknown must have texts"),
            ({"loss": 3}, "loss = 3"),
            ({"table": 3}, "table must be a dictionary"),
            ({"table": {**table(), "contact_velocity_after.normal": SLIP}}, "table = .* a second time"),
            ({"table": {**table(), f"{AFTER[1]}.sigma": SLIP}}, "sigma = .* a second time"),
            ({"loss": "tukey"}, "loss"),
            ({"starts": 0}, "starts"),
        ):
            arguments = {"table": table(), "unknown": ["mu"], "sigma": SIGMA, **change}
            with self.subTest(change), self.assertRaisesRegex(ricochet.InvalidRequest, text.replace("[", r"\[")):
                ricochet.fit(SCENE, **arguments)

    def test_a_server_gives_the_same_bits(self):
        server = Ricochetd()
        self.addCleanup(server.stop)
        data = table()
        data[AFTER[0]] = data[AFTER[0]] + 0.01 * np.cos(np.arange(6))
        with ricochet.Client(server.address) as there:
            for scene in (SCENE, {**SCENE, "restitution": {"energetic": 0.6},
                                  "compliance": {"tangential_ratio_squared": 1.2}}):
                here = ricochet.fit(scene, data, ["mu"], sigma=SIGMA, region=[])
                self.assertEqual(repr(here), repr(there.fit(scene, data, ["mu"], sigma=SIGMA)))


if __name__ == "__main__":
    main()

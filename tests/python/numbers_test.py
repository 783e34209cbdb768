"""The numbers that arrive in Python, against references of 25 digits and closed forms."""

import itertools
import math
import pickle
import re
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np
import ricochet
import xarray
from support import PENDULUM, main, vectors

ULPS = 4  # Tolerance 0 promises this for a pendulum.
LAWS = ("newton", "poisson", "energetic")


def columns(rows, names):
    return {path: np.array([float(row[name]) for row in rows]) for path, name in names.items()}


class Vectors(unittest.TestCase):
    def solve(self, rows, scene, inputs, outputs, tolerance):
        """Yields for each law the rows, the table and the references of the outputs."""
        for law in LAWS:
            chosen = [row for row in rows if row["law"] == law]
            self.assertGreater(len(chosen), 10)
            fields = columns(chosen, {**inputs, f"restitution.{law}": "coefficient"})
            table = ricochet.solve_batch(scene, fields, list(outputs), tolerance=tolerance)
            yield chosen, table, columns(chosen, outputs)

    def test_pendulums_of_a_batch_lie_within_4_ulp(self):
        inputs = {
            "pendulum.a_m": "a",
            "pendulum.b_m": "b",
            "pendulum.inertia_kg_m2": "j0",
            "pendulum.omega_minus_rad_s": "omega_minus",
            "friction.kinetic_coefficient": "mu",
        }
        outputs = {
            "coefficients.newton": "newton",
            "coefficients.poisson": "poisson",
            "rates_after_rad_s[0]": "omega_plus",
            "impulse.normal_total_n_s": "tau1",
            "impulse.tangential_n_s[0]": "friction_impulse",
        }
        for rows, table, expected in self.solve(vectors("pendulum.csv"), {"pendulum": {}}, inputs, outputs, 0):
            self.assertEqual(table.codes["status"].counts().get("INVALID", 0), 0)
            for name, values in expected.items():
                with self.subTest(rows[0]["law"], column=name):
                    np.testing.assert_array_max_ulp(table[name], values, ULPS)

    def test_planar_contacts_of_a_batch_lie_within_the_tolerance(self):
        inputs = {
            "planar_contact.w_tt_per_kg": "wtt",
            "planar_contact.w_tn_per_kg": "wtn",
            "planar_contact.w_nn_per_kg": "wnn",
            "planar_contact.tangential_m_s": "u0",
            "planar_contact.normal_m_s": "v0",
            "friction.kinetic_coefficient": "mu",
        }
        outputs = {"contact_velocity_after.tangential_m_s[0]": "u1", "contact_velocity_after.normal_m_s": "v1"}
        rows = [row for row in vectors("planar.csv") if float(row["v0"]) < 0]
        for chosen, table, expected in self.solve(rows, {"planar_contact": {}}, inputs, outputs, None):
            scale = np.maximum(*(np.abs(values) for values in columns(chosen, {"u": "u0", "v": "v0"}).values()))
            for name, values in expected.items():
                with self.subTest(chosen[0]["law"], column=name):
                    self.assertLessEqual(np.max(np.abs(table[name] - values) / scale), 1e-12)

    def test_contacts_in_space_lie_within_their_tolerance(self):
        tolerance = 1e-9
        for row in vectors("spatial.csv")[:12]:
            number = {name: float(value) for name, value in row.items() if name not in ("law", "phases")}
            speeds = [number["u0_1"], number["u0_2"], number["v0"]]
            scene = {
                "spatial_contact": {
                    "w_per_kg": [number[name] for name in ("w11", "w12", "w13", "w22", "w23", "w33")],
                    "tangential_m_s": np.array(speeds[:2]),
                    "normal_m_s": speeds[2],
                },
                "friction": {"kinetic_coefficient": number["mu"]},
                "restitution": {row["law"]: number["coefficient"]},
            }
            after = ricochet.solve(scene, tolerance=tolerance).contact_velocity_after
            for found, name in zip([*after.tangential_m_s, after.normal_m_s], ("u1_1", "u1_2", "v1")):
                self.assertLessEqual(abs(found - number[name]), tolerance * max(map(abs, speeds)))


class Sweeps(unittest.TestCase):
    def test_a_dataset_has_the_closed_form_at_each_coordinate(self):
        # Lubarda (2009), eq. 38: Newton's coefficient is sqrt((1 - x)/(1 + x)), x = mu b/a, if the energetic one is 1.
        data = ricochet.sweep(
            PENDULUM,
            {"friction.kinetic_coefficient": [0.0, 0.05, 0.2], "pendulum.a_m": ricochet.Linspace(0.3, 2, 5)},
            ["coefficients.newton", "rates_after_rad_s[0]"],
        )
        self.assertEqual(data["coefficients.newton"].dims, ("friction.kinetic_coefficient", "pendulum.a_m"))
        self.assertEqual(data["coefficients.newton"].shape, (3, 5))
        for mu in (0.0, 0.05, 0.2):
            for a in (0.3, 0.725, 1.15, 1.575, 2.0):
                point = data.sel({"friction.kinetic_coefficient": mu}).sel({"pendulum.a_m": a}, method="nearest")
                self.assertAlmostEqual(float(point["coefficients.newton"]), math.sqrt((1 - mu / a) / (1 + mu / a)), 14)
        self.assertEqual(data["pendulum.a_m"].attrs["units"], "m")
        self.assertEqual(data["rates_after_rad_s[0]"].attrs["units"], "rad/s")

    def test_an_audit_acquits_what_solve_answers(self):
        # Without friction no impulse acts along t, and where the approach is what is left of larger velocities, so is
        # that after the impact: rounding is all that an audit finds there. A rate that no impulse made is found.
        random = np.random.default_rng(7)

        def some(count):  # A third of the velocities is 0.
            return [float(x) for x in random.uniform(-2, 2, count) * (random.uniform(size=count) > 1 / 3)]

        def flat():
            (velocity_t_m_s, rate_rad_s), offset_t_m = some(2), random.uniform(-0.5, 0.5)
            return {
                "mass_kg": random.uniform(0.3, 3), "inertia_com_kg_m2": random.uniform(0.01, 1),
                "offset_t_m": offset_t_m, "offset_n_m": random.uniform(-1, -0.1), "velocity_t_m_s": velocity_t_m_s,
                "velocity_n_m_s": -rate_rad_s * offset_t_m - 10 ** random.uniform(-8, 0), "rate_rad_s": rate_rad_s,
            }  # fmt: skip

        def in_space():
            inertia = random.uniform(0.01, 1) * np.array([1.0, 0.1, 0.05, 1.2, -0.1, 0.9])
            return {
                "mass_kg": random.uniform(0.3, 3), "inertia_com_kg_m2": inertia, "offset_m": random.uniform(-0.5, 0.5, 3),
                "linear_m_s": [*some(2), random.uniform(-2, 0)], "angular_rad_s": some(3),
            }  # fmt: skip

        def arm(directions):
            root = random.normal(size=(4, 4))
            mass = root @ root.T + 0.3 * np.eye(4)
            return {"mass_matrix": (mass + mass.T) / 2, "jacobian": random.normal(size=(directions, 4)), "rates": some(4)}

        systems = {
            "flat": lambda: {"planar_body": flat()},
            "two flat": lambda: {"body_pair": {"planar": {"body_1": flat(), "body_2": flat()}}},
            "in space": lambda: {"spatial_body": in_space()},
            "two in space": lambda: {"body_pair": {"spatial": {"body_1": in_space(), "body_2": in_space()}}},
            "arm": lambda: {"mechanism": arm(2)},
            "arm in space": lambda: {"mechanism": arm(3)},
        }
        for (name, system), friction, restitution, _ in itertools.product(
            systems.items(), (0, 0.3), (0, 0.8), range(40)
        ):
            scene = {
                **system(),
                "friction": {"kinetic_coefficient": friction},
                "restitution": {"energetic": restitution},
            }
            outcome = ricochet.solve(scene)
            if "mechanism" in scene:
                rates = list(outcome.rates_after)
            else:
                rates = [rate for body in outcome.bodies_after for rate in [*body.linear_m_s, *body.angular_rad_s]]
            with self.subTest(name, friction=friction, restitution=restitution):
                self.assertTrue(ricochet.audit(scene, rates_after=rates).report.admissible, scene)
                rates[random.integers(len(rates))] += 1e-4
                self.assertFalse(ricochet.audit(scene, rates_after=rates).report.admissible, scene)

    def test_only_the_caller_knows_the_units_of_coordinates(self):
        mechanism = {"mass_matrix": [2.0, 0.5, 0.5, 1.0], "jacobian": [1.0, 0.0, 0.0, 1.0], "rates": [1.0, -1.0]}
        scene = {
            "mechanism": mechanism,
            "friction": {"kinetic_coefficient": 0.2},
            "restitution": {"energetic": 0.5, "by_speed": {"power_law": {"alpha": 0.1, "exponent": 0.2}}},
        }
        alpha = "restitution.by_speed.power_law.alpha"
        columns = ["rates_after[0]", "momentum_change[1]", "impulse.normal_total_n_s", "coefficients.newton"]
        columns += [f"d({column})/d({alpha})" for column in columns]
        data = ricochet.sweep(scene, {"mechanism.rates[0]": [0.5, 1.0], alpha: [0.1, 0.2]}, columns)
        units = {"impulse.normal_total_n_s": "N s", "coefficients.newton": "1", alpha: "1/(m/s)^exponent"}
        units[columns[6].replace("/", "|")] = "(N s)/(1/(m/s)^exponent)"
        units[columns[7].replace("/", "|")] = "1/(1/(m/s)^exponent)"
        for name in [*data.coords, *data.data_vars]:
            if name not in ("regime", "status"):
                self.assertEqual(data[name].attrs.get("units"), units.get(name), name)

    def test_flags_name_the_regimes(self):
        # At mu = a/b the pendulum is locked; without friction it rebounds frictionless.
        data = ricochet.sweep(PENDULUM, {"friction.kinetic_coefficient": [0, 0.1, 0.3]}, ["coefficients.newton"])
        names = data["regime"].attrs["flag_meanings"].split()
        self.assertEqual([names[number] for number in data["regime"].values], ["FRICTIONLESS", "REBOUND", "LOCKED"])

    def test_a_frame_has_a_row_for_each_point(self):
        frame = ricochet.sweep(
            PENDULUM,
            {"friction.kinetic_coefficient": [0, 0.3], "restitution.energetic": [0.5, 1]},
            ["coefficients.newton"],
            form="pandas",
        )
        self.assertEqual(list(frame["friction.kinetic_coefficient"]), [0, 0, 0.3, 0.3])
        self.assertEqual(list(frame["restitution.energetic"]), [0.5, 1, 0.5, 1])
        self.assertEqual(list(frame["coefficients.newton"]), [0.5, 1, 0, 0])
        self.assertEqual(list(frame["regime"]), ["FRICTIONLESS", "FRICTIONLESS", "LOCKED", "LOCKED"])

    def test_axes_may_advance_together(self):
        table = ricochet.sweep(
            PENDULUM,
            {"pendulum.a_m": [0.3, 1], "friction.kinetic_coefficient": [0, 0]},
            ["coefficients.newton"],
            form="table",
            zip_axes=True,
        )
        self.assertEqual(list(table["coefficients.newton"]), [1, 1])
        self.assertEqual(table.to_xarray()["pendulum.a_m"].dims, ("row",))

    def test_a_wrong_point_is_nan_and_invalid(self):
        table = ricochet.sweep(
            PENDULUM, {"friction.kinetic_coefficient": [-1, 0]}, ["coefficients.newton"], form="table"
        )
        self.assertTrue(math.isnan(table["coefficients.newton"][0]))
        self.assertEqual(table.codes["regime"].counts(), {"FRICTIONLESS": 1, "INVALID": 1})

    def test_coordinates_are_the_doubles_that_the_server_used(self):
        # Without friction and with e = 1, the rate after the impact is minus the rate before it.
        for axis in (ricochet.Linspace(-3, 0.7, 1001), ricochet.Linspace(-0.1, -7, 1001), ricochet.Linspace(-2, -2, 1)):
            table = ricochet.sweep(
                {**PENDULUM, "friction": {}},
                {"pendulum.omega_minus_rad_s": axis},
                ["rates_after_rad_s[0]"],
                form="table",
            )
            rates = table.inputs()["pendulum.omega_minus_rad_s"]
            np.testing.assert_array_equal(np.abs(table["rates_after_rad_s[0]"]), np.abs(rates))

    def test_an_axis_of_one_value_has_its_start(self):
        axes = {"pendulum.omega_minus_rad_s": ricochet.Linspace(-2, -3, 1)}
        table = ricochet.sweep({**PENDULUM, "friction": {}}, axes, ["rates_after_rad_s[0]"], form="table")
        np.testing.assert_array_equal(table.axes["pendulum.omega_minus_rad_s"], [-2])

    def test_points_of_many_chunks_are_in_order(self):
        done = []
        table = ricochet.sweep(
            {**PENDULUM, "friction": {}},
            {"restitution.energetic": ricochet.Linspace(0, 1, 300_001)},
            ["coefficients.newton", "coefficients.poisson"],
            form="table",
            progress=lambda *numbers: done.append(numbers),
        )
        np.testing.assert_array_max_ulp(table["coefficients.newton"], np.linspace(0, 1, 300_001), ULPS)
        np.testing.assert_array_max_ulp(table["coefficients.poisson"], np.linspace(0, 1, 300_001), ULPS)
        self.assertGreater(len(done), 3)
        self.assertEqual(done[-1], (300_001, 300_001))


class Batches(unittest.TestCase):
    def test_a_batch_above_the_limit_is_asked_in_parts(self):
        rows = 1_100_000
        rates = -np.linspace(1, 2, rows)
        table = ricochet.solve_batch(
            {**PENDULUM, "friction": {}},
            {"pendulum.omega_minus_rad_s": rates, "pendulum.a_m": 0.3},
            ["rates_after_rad_s[0]"],
        )
        np.testing.assert_array_equal(table["rates_after_rad_s[0]"], -rates)

    def test_tables_are_equal_if_their_numbers_are(self):
        def table(a):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", ricochet.InvalidRows)
                return ricochet.solve_batch(PENDULUM, {"pendulum.a_m": [0.3, a]}, ["coefficients.newton"])
        self.assertEqual(table(-1), table(-1))  # A bad row has NaN.
        self.assertEqual(table(0.4), pickle.loads(pickle.dumps(table(0.4))))
        self.assertNotEqual(table(0.4), table(0.5))

    def test_a_bad_row_has_its_number_and_its_reason(self):
        table = ricochet.solve_batch(PENDULUM, {"pendulum.a_m": [0.3, -1, 0.3]}, ["coefficients.newton"])
        self.assertEqual(list(table.codes["status"].numbers), [1, 3, 1])
        self.assertEqual(table.codes["status"][1], "INVALID")
        [bad] = table.summary.bad_rows
        self.assertEqual((bad.row, bad.field, bad.description), (1, "pendulum.a_m", "= -1: must be > 0"))


class BoundsAndAudits(unittest.TestCase):
    def test_the_friction_that_locks_falls_with_the_height_of_the_pin(self):
        answer = ricochet.bounds(PENDULUM, derivatives={"of": ["critical.stick"], "by": ["pendulum.b_m"]})
        [derivative] = answer.derivatives
        a, b = PENDULUM["pendulum"]["a_m"], PENDULUM["pendulum"]["b_m"]
        self.assertAlmostEqual(derivative.value, -a / b**2, 9)

    def test_newtons_sharp_bound_is_that_of_the_elastic_impact(self):
        answer = ricochet.bounds(PENDULUM, ranges={"friction.kinetic_coefficient": (0.0, 0.1)})
        self.assertAlmostEqual(answer.bounds.sharp.newton.upper, math.sqrt(0.5), 15)
        outer = answer.enclosure.outer.newton
        self.assertLessEqual(outer.lower, 0)
        self.assertGreaterEqual(outer.upper, 1)
        self.assertLess(outer.upper, 1.006)

    def test_a_limit_of_no_row_is_refused(self):
        client = ricochet.Client()
        for limit in (0, -1):
            client._info = ricochet.Record({"limits": {"max_audit_rows": limit}, "server_limits": None})  # It is wrong.
            with self.assertRaisesRegex(ricochet.RicochetError, f"max_audit_rows = {limit}: must be >= 1"):
                client.audit_batch(PENDULUM, {"rates_after": [0.1, 0.2]})

    def test_an_observation_that_doubles_the_rate_breaks_the_limits(self):
        answer = ricochet.audit(PENDULUM, rates_after=2.0)
        self.assertFalse(answer.report.admissible)
        self.assertAlmostEqual(answer.report.coefficients.newton, 2, 14)
        # E+ - E- = (2^2 - 1^2)/2 J at 1 kg m^2.
        self.assertAlmostEqual(answer.report.energy_change_j, 1.5, 13)
        self.assertEqual(answer.report.limits.energy.verdict, "BROKEN")

    def test_rows_of_an_audit_are_columns(self):
        # v+ = a w+ = 0.3 w+ and u+ = b w+ = w+.
        rates = np.array([0.5, 2.0, np.nan])
        table = ricochet.audit_batch(PENDULUM, {"tangential_after_m_s": rates, "normal_after_m_s": 0.3 * rates})
        np.testing.assert_allclose(table["coefficients.newton"], rates, rtol=1e-14)
        self.assertEqual([table.codes["limits.energy.verdict"][row] for row in range(2)], ["KEPT", "BROKEN"])
        self.assertEqual([table.codes["regime"][row] for row in (1, 2)], ["REBOUND", "INVALID"])
        self.assertEqual((table.summary.rows, table.summary.invalid), (3, 1))

    def test_rows_of_an_audit_may_differ_in_numbers_of_the_scene(self):
        # Newton's coefficient is the ratio of the velocities of the contact, -v+/v-; here v is proportional to omega.
        omega = np.array([-1.0, -2.0, -4.0])
        for name in ("omega", "pendulum.omega_minus_rad_s"):
            table = ricochet.audit_batch(PENDULUM, {name: omega, "rates_after": [[0.5]]})
            np.testing.assert_allclose(table["coefficients.newton"], -0.5 / omega, rtol=1e-14)
            self.assertEqual(list(table.to_pandas()["pendulum.omega_minus_rad_s"]), list(omega))
        contact = {"planar_contact": {"w_tt_per_kg": 1, "w_nn_per_kg": 1, "normal_m_s": -1}}
        body = {"planar_body": {"mass_kg": 1, "inertia_com_kg_m2": 1, "velocity_n_m_s": -1}}
        table = ricochet.audit_batch(body, {"rates_after": [0.0, [0.5, 0.25], 0.0]})
        np.testing.assert_allclose(table["coefficients.newton"], [0.5, 0.25], rtol=1e-14)
        names = [f"bodies_after[0].{name}" for name in ("linear_m_s[0]", "linear_m_s[1]", "angular_rad_s[0]")]
        named = dict(zip(names, (0.0, [0.5, 0.25], 0.0)))
        self.assertEqual(ricochet.audit_batch(body, named), table)
        with self.assertRaisesRegex(ricochet.InvalidRequest, r"must have bodies_after\[0\].angular_rad_s\[0\], too"):
            ricochet.audit_batch(body, {name: named[name] for name in names[:2]})
        table = ricochet.audit_batch(contact, {"mu": [0.5, 0.5], "normal_m_s": -2.0, "normal_after_m_s": 0.5,
                                               "tangential_after_m_s": 0.0})
        np.testing.assert_allclose(table["coefficients.newton"], 0.25, rtol=1e-14)
        with self.assertRaisesRegex(ricochet.InvalidRequest, "inputs.0..path = .pendulum.omgea"):
            ricochet.audit_batch(PENDULUM, {"pendulum.omgea": omega, "rates_after": [[0.5]]})

    def test_rows_in_which_nothing_strikes_are_counted(self):
        batch = ricochet.solve_batch(PENDULUM, {"omega": [-1.0, 1.0, 2.0]}, ["newton"])
        self.assertEqual((batch.summary.rows, batch.summary.separating), (3, 2))
        sweep = ricochet.sweep(PENDULUM, {"omega": [-1.0, 1.0]}, ["rates_after[0]"], form="table")
        self.assertEqual(sweep.summary.separating, 1)

    def test_an_audit_of_many_rows_is_asked_in_parts(self):
        rates = np.linspace(0.1, 0.7, 10_000)
        table = ricochet.audit_batch(PENDULUM, {"rates_after": [rates]})
        np.testing.assert_allclose(table["coefficients.newton"], rates, rtol=1e-14)


class Jacobians(unittest.TestCase):
    # Newton's coefficient of a pendulum is eta sqrt(r) with r = (1 - x)/(1 + x), x = mu b/a, and Poisson's eta/sqrt(r).
    SCENE = {"pendulum": {"inertia_kg_m2": 1, "a_m": 0.5, "b_m": 1, "omega_minus_rad_s": -1},
             "friction": {"kinetic_coefficient": 0.25}, "restitution": {"energetic": 0.8}}

    def test_a_pendulum_has_the_derivatives_of_its_formula(self):
        root, slope = math.sqrt(1 / 3), -2 / 0.75  # d ln sqrt(r)/dx is -1/(1 - x^2), and x grows by b/a = 2 of mu.
        got = ricochet.jacobian(self.SCENE, ["newton", "poisson"], ["mu", "energetic", "pendulum.inertia_kg_m2"])
        expected = [[0.8 * root * slope, root, 0], [-0.8 / root * slope, 1 / root, 0]]
        np.testing.assert_allclose(got, expected, rtol=1e-14, atol=1e-15)

    def test_both_entries_across_the_diagonal_of_a_mass_matrix_are_numbers_of_the_scene(self):
        def after(entry):
            mass = [[2, entry], [entry, 1]]
            arm = {"mechanism": {"mass_matrix": mass, "jacobian": np.eye(2), "rates": [1, -1]},
                   "friction": {"kinetic_coefficient": 0.25}, "restitution": {"newton": 0.5}}
            return arm, ricochet.solve(arm).rates_after

        entries = ["mass_matrix[1]", "mass_matrix[2]"]
        found = ricochet.jacobian(after(0.125)[0], ["rates_after[0]", "rates_after[1]"], entries)
        quotient = (np.array(after(0.125 + 1e-4)[1]) - after(0.125 - 1e-4)[1]) / 2e-4
        np.testing.assert_allclose(found, np.transpose([quotient, quotient]), rtol=1e-6, atol=1e-8)

    def test_sides_of_a_threshold_are_asked_for_by_name(self):
        scene = {**self.SCENE, "pendulum": {**self.SCENE["pendulum"], "b_m": 0}}
        sides = {side: ricochet.jacobian(scene, "newton", "b", side=side)[0, 0] for side in ("both", "below", "above")}
        self.assertTrue(math.isnan(sides["both"]))
        self.assertAlmostEqual(sides["below"], 0.4, 14)
        self.assertAlmostEqual(sides["above"], -0.4, 14)
        paths = {"of": "coefficients.newton", "by": "pendulum.b_m"}
        self.assertEqual(ricochet.solve(scene, derivatives=paths).derivatives[0].threshold, "SLIP_START")

    def test_other_impacts_have_differences_with_an_error(self):
        sphere = {"spatial_contact": {"w_per_kg": [3.5, 0, 0, 3.5, 0, 1], "tangential_m_s": [0, 4], "normal_m_s": -1},
                  "friction": {"kinetic_coefficient": 0.2}, "restitution": {"energetic": 0.8}}
        after = "contact_velocity_after.tangential_m_s[1]"
        derivative = ricochet.solve(
            sphere, derivatives={"of": after, "by": "friction.kinetic_coefficient"}).derivatives[0]
        self.assertAlmostEqual(derivative.value, -3.5 * 1.8, 11)
        self.assertLess(derivative.error, 1e-9)

    def test_a_derivative_says_how_far_it_holds(self):
        sphere = {"spatial_contact": {"w_per_kg": [3.5, 0, 0, 3.5, 0, 1], "tangential_m_s": [0, 4], "normal_m_s": -1},
                  "friction": {"kinetic_coefficient": 0.2}, "restitution": {"energetic": 0.8}}
        paths = {"of": "impulse.normal_total_n_s", "by": "friction.kinetic_coefficient", "find_thresholds": True}
        [derivative] = ricochet.solve(sphere, derivatives=paths).derivatives
        self.assertEqual((derivative.below.threshold, derivative.above.threshold), ("DOMAIN", "IMPACT_END"))
        self.assertAlmostEqual(derivative.above.distance, 4 / (3.5 * 1.8) - 0.2, 9)

    def test_a_batch_has_derivatives_as_columns(self):
        column = "d(coefficients.newton)/d(friction.kinetic_coefficient)"
        mu = [0.05, 0.1, 0.15]
        batch = ricochet.solve_batch(self.SCENE, {"friction.kinetic_coefficient": mu}, [column])
        for row, friction in enumerate(mu):
            scene = {**self.SCENE, "friction": {"kinetic_coefficient": friction}}
            self.assertEqual(batch[column][row], ricochet.jacobian(scene, "newton", "mu").item())

    def test_a_dataset_with_derivatives_has_their_units_and_can_be_saved(self):
        scene = {"planar_contact": {"w_tt_per_kg": 3, "w_nn_per_kg": 1, "tangential_m_s": 3, "normal_m_s": -1},
                 "friction": {"kinetic_coefficient": 0.2}, "restitution": {"poisson": 0.5}}
        column = "d(impulse.normal_total_n_s)/d(planar_contact.normal_m_s)"
        data = ricochet.sweep(scene, {"mu": [0.1, 0.2]}, [column])[column.replace("/", "|")]
        self.assertEqual(data.attrs["units"], "(N s)/(m/s)")
        with tempfile.TemporaryDirectory() as directory:
            data.to_netcdf(Path(directory) / "x.nc")
            with xarray.open_dataarray(Path(directory) / "x.nc") as file:
                np.testing.assert_array_equal(file.values, [-1.5, -1.5])

    def test_an_outcome_gives_the_derivatives_it_was_asked_for_as_an_array(self):
        outcome = ricochet.solve(self.SCENE, derivatives={"of": ["newton", "poisson"], "by": ["mu", "energetic"]})
        whole = ricochet.jacobian(self.SCENE, ["newton", "poisson"], ["mu", "energetic"])
        np.testing.assert_array_equal(outcome.jacobian(["coefficients.poisson", "newton"], "mu"), whole[::-1, :1])
        np.testing.assert_array_equal(outcome.jacobian("poisson", ["energetic", "mu"]), whole[1:, ::-1])
        for record, of, text in (
                (outcome, "regime", "of = 'regime': must name one of coefficients.newton, coefficients.poisson"),
                (ricochet.solve(self.SCENE), "newton", "derivatives must be asked for")):
            with self.subTest(text), self.assertRaises(ricochet.InvalidRequest) as caught:
                record.jacobian(of, "mu")
            self.assertIn(text, str(caught.exception))

    def test_what_has_no_derivatives_is_refused(self):
        for scene, of, side, text in (
                (self.SCENE, "effective.kinetic", "both", "derivatives.of[0]"),
                (self.SCENE, "newton", "left", "must be one of both, below, above")):
            with self.subTest(text), self.assertRaises(ricochet.InvalidRequest) as caught:
                ricochet.jacobian(scene, of, "mu", side=side)
            self.assertIn(text, str(caught.exception))


class RoundingOfW(unittest.TestCase):
    """A W that rounding has changed is told, by a bound on what it does to the answer, against certified digits."""

    @staticmethod
    def random_body(random, decades):
        def size():
            return 10 ** random.uniform(-decades, decades)

        def number():
            return size() * random.choice([-1, 1])
        return {"planar_body": {"mass_kg": size(), "inertia_com_kg_m2": size(), "offset_t_m": number(),
                                "offset_n_m": number(), "velocity_t_m_s": number(), "velocity_n_m_s": number(),
                                "rate_rad_s": number()},
                "friction": {"kinetic_coefficient": size()}, "restitution": {"energetic": random.uniform(0, 1)}}

    def test_a_note_bounds_what_it_changes_and_without_one_it_changes_nothing_that_shows(self):
        random, notes, largest = np.random.default_rng(1), 0, 0
        for _ in range(600):
            outcome = ricochet.solve(self.random_body(random, random.choice([2, 4, 5])), certified=15)
            if outcome.regime == "SEPARATING":
                continue
            digits = {number.path: number.decimal for number in outcome.certificate.numbers}
            exact = float(digits["impulse.normal_total_n_s"])
            error = abs(outcome.impulse.normal_total_n_s / exact - 1)
            effects = [float(found[1]) for note in outcome.notes
                       if (found := re.search("nearly singular .* by (.*) of themselves", note.text))]
            self.assertLessEqual(error, effects[0] if effects else 1e-9)
            notes, largest = notes + len(effects), max(largest, error)
        self.assertGreater(notes, 10)
        self.assertGreater(largest, 1e-9)

    def test_a_stated_w_is_exact(self):
        nearly = {"w_tt_per_kg": 1, "w_tn_per_kg": 1 - 1e-13, "w_nn_per_kg": 1, "normal_m_s": -1}
        self.assertEqual(len(ricochet.solve({"planar_contact": nearly, "restitution": {"energetic": 0.5}}).notes), 0)


if __name__ == "__main__":
    main()

"""at_contact: mechanisms as a library of multibody dynamics gives them, against other systems and against mechanics."""

import itertools
import unittest
import warnings

import numpy as np
import ricochet
from support import PENDULUM, main

RANDOM = np.random.default_rng(12)


def rotation():
    q, r = np.linalg.qr(RANDOM.normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def random_states(count, n):
    """Mass matrices, Jacobians, rates and normals; every contact approaches."""
    root = RANDOM.normal(size=(count, n, n))
    mass = root @ root.transpose(0, 2, 1) + 0.3 * np.eye(n)
    mass = np.triu(mass) + np.triu(mass, 1).transpose(0, 2, 1)
    jacobian, rates, normal = (RANDOM.normal(size=shape) for shape in ((count, 3, n), (count, n), (count, 3)))
    approach = np.einsum("bi,bij,bj->b", normal, jacobian, rates)
    return mass, jacobian, np.where(approach[:, None] > 0, -rates, rates), normal


def cross(r):
    return np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])


class Case(unittest.TestCase):
    def refused(self, call, *fields):
        with self.assertRaises(ricochet.InvalidRequest) as raised:
            call()
        self.assertEqual([violation.field for violation in raised.exception.violations], list(fields))


class TwoCoordinatesInSpace(Case):
    """Two coordinates move the contact in a plane of its three directions, wherever that plane lies."""

    SCENES = {
        "a dip of the distance that is narrower than a step": (
            [[2.4489780144233757, 1.7353750551064884], [1.7353750551064884, 2.2692992461915367]],
            [[-0.3344885803229857, -1.38856495139233], [1.607398087533681, -0.952734890580308],
             [0.5582260433028559, 1.730054458715901]],
            [1.291781906440944, -1.333636217821058], 1.3399650560324852, {"poisson": 0.27288813518391364}),
        "a range that rounding turns": (
            [[1.6729073512136552, -2.1367201345846327], [-2.1367201345846327, 2.8860292496972306]],
            [[0.2057165176789978, 0.8870580070430005], [-0.10639959608685703, -0.9494908518002053],
             [0.3242014124060831, 1.618915491436607]],
            [0.3991358441971388, -1.0655647560808246], 0.6191107549012698, {"energetic": 0.7649108036224355}),
    }

    def test_the_audit_of_an_outcome_gives_its_coefficients(self):
        for what, (mass, jacobian, rates, friction, restitution) in self.SCENES.items():
            with self.subTest(what):
                scene = {"mechanism": {"mass_matrix": mass, "jacobian": jacobian, "rates": rates},
                         "friction": {"kinetic_coefficient": friction}, "restitution": restitution}
                outcome = ricochet.solve(scene)
                self.assertEqual(outcome.w_rank, 2)
                after = outcome.contact_velocity_after
                report = ricochet.audit(scene, contact_velocity={
                    "tangential_m_s": list(after.tangential_m_s), "normal_m_s": after.normal_m_s}).report
                self.assertTrue(report.admissible and not report.unexplained)
                for name in ("newton", "poisson", "energetic"):
                    self.assertAlmostEqual(
                        getattr(report.coefficients, name), getattr(outcome.coefficients, name), delta=1e-6)


class SingleStates(Case):
    def test_a_sliding_mass_loses_what_friction_takes(self):
        # p_n = (1 + e) m v and p_t = mu p_n, as long as the slip does not stop.
        after = ricochet.at_contact(2 * np.eye(3), np.eye(3), [3, 4, -1], [0, 0, 2], friction=0.5, newton=0.5)
        np.testing.assert_allclose(after.impulse_n_s, [-0.9, -1.2, 3], rtol=1e-14)
        np.testing.assert_allclose(after.rates_after, [2.55, 3.4, 0.5], rtol=1e-14)
        self.assertEqual(after.answer.regime, "SLIDING")

    def test_derivatives_are_those_of_a_mass_that_slides_in_any_axes(self):
        # v_n' = -e v_n, and the slip loses mu (1 + e) |v_n| of its length s, so that it turns by as much over s.
        mu, e, rates = 0.5, 0.25, np.array([3.0, 4.0, -1.0])
        unit, s = np.array([0.6, 0.8, 0]), 5.0
        loss = mu * (1 + e)
        expected = np.diag([1, 1, -e]) - loss / s * (np.diag([1.0, 1.0, 0]) - np.outer(unit, unit))
        expected[:, 2] += loss * unit
        turn = rotation()
        of, by = ([f"{name}[{i}]" for i in range(3)] for name in ("rates_after", "rates"))
        ask = lambda **more: ricochet.at_contact(
            2 * np.eye(3), turn, rates, turn @ [0, 0, 3], friction=mu, newton=e, **more)
        found = ask(derivatives={"of": of, "by": [*by, "mu"]}).answer.jacobian(of, [*by, "mu"])
        np.testing.assert_allclose(found[:, :3], expected, atol=1e-9)
        np.testing.assert_allclose(found[:, 3], -(1 + e) * unit, atol=1e-9)
        with self.assertRaisesRegex(ricochet.InvalidRequest, "^derivatives is set: must not be for several states"):
            ricochet.at_contact([2 * np.eye(3)], turn, rates, turn @ [0, 0, 3], newton=e, derivatives={"of": of, "by": by})

    def test_a_pendulum_is_the_mechanism_of_one_coordinate(self):
        expected = ricochet.solve(PENDULUM)
        after = ricochet.at_contact([[1]], [[1], [0], [0.3]], [-1], [0, 0, 1], friction=0.1, energetic=1)
        np.testing.assert_allclose(after.rates_after, expected.rates_after_rad_s, rtol=1e-12)
        np.testing.assert_allclose(after.impulse_n_s[2], expected.impulse.normal_total_n_s, rtol=1e-12)

    def test_a_free_body_in_any_axes_is_a_spatial_body(self):
        inertia, arm = np.diag([0.02, 0.05, 0.04]), np.array([0.1, -0.05, -0.2])
        linear, angular = np.array([0.7, 0.2, -1.5]), np.array([1.0, -2.0, 0.5])
        body = {"mass_kg": 1.5, "inertia_com_kg_m2": [0.02, 0, 0, 0.05, 0, 0.04], "offset_m": arm,
                "linear_m_s": linear, "angular_rad_s": angular}
        [expected] = ricochet.solve({"spatial_body": body, "friction": {"kinetic_coefficient": 0.2},
                                     "restitution": {"poisson": 0.6}}).bodies_after
        for _ in range(5):
            turn = rotation()
            mass = np.block([[1.5 * np.eye(3), np.zeros((3, 3))], [np.zeros((3, 3)), turn @ inertia @ turn.T]])
            mass = np.triu(mass) + np.triu(mass, 1).T
            jacobian = np.hstack([np.eye(3), -cross(turn @ arm)])
            after = ricochet.at_contact(mass, jacobian, [*turn @ linear, *turn @ angular], turn @ [0, 0, 1],
                                        friction=0.2, poisson=0.6)
            np.testing.assert_allclose(turn.T @ after.rates_after[:3], expected.linear_m_s, atol=1e-11)
            np.testing.assert_allclose(turn.T @ after.rates_after[3:], expected.angular_rad_s, atol=1e-11)

    def test_a_contact_that_separates_changes_nothing(self):
        after = ricochet.at_contact(np.eye(3), np.eye(3), [1, 2, 3], [0, 0, 1], friction=0.5, newton=0.5)
        np.testing.assert_array_equal(after.rates_after, [1, 2, 3])
        np.testing.assert_array_equal(after.impulse_n_s, [0, 0, 0])

    def test_without_slip_any_direction_will_do(self):
        after = ricochet.at_contact(np.eye(3), np.eye(3), [0, 0, -1], [0, 0, 1], friction=0.5, newton=0.5)
        np.testing.assert_array_equal(after.rates_after, [0, 0, 0.5])

    def test_a_head_on_impact_is_right_in_any_direction(self):
        for normal in itertools.product(range(-2, 3), repeat=3):
            if any(normal):
                unit = np.array(normal) / np.linalg.norm(normal)
                after = ricochet.at_contact(np.eye(3), np.eye(3), -unit, normal, friction=0.7, energetic=1)
                np.testing.assert_allclose(after.rates_after, unit, atol=1e-15)
                self.assertEqual(after.answer.w_rank, 3)
        slider = ricochet.at_contact([[2.0]], [[1], [1], [0]], [-1], [1, 1, 0], friction=0.5, energetic=1)
        np.testing.assert_allclose(slider.rates_after, [1], atol=1e-15)

    def test_a_normal_may_have_any_length(self):
        direction = np.array([0.2, -0.3, 0.9])
        call = lambda normal, rates: ricochet.at_contact(
            np.diag([1, 2, 3]), np.eye(3), rates, normal, friction=0.3, newton=0.5).rates_after
        rates = np.array([1, 2, -3])
        expected = call(direction, rates)
        for length in (1e-200, 1e-160, 1e-158, 1e160, 1e300):
            np.testing.assert_allclose(call(length * direction, rates), expected, rtol=1e-14)
        for speed in (1e-200, 1e-160, 1e150):
            np.testing.assert_allclose(call(direction, speed * rates), speed * expected, rtol=1e-14)

    def test_a_contact_that_cannot_part_has_no_velocities_after(self):
        """Friction and the held joint wedge the contact, whose velocity nothing reverses."""
        wedge = {"M": np.eye(2), "J": [[1, 0], [0, 0], [0.3, 1]], "qdot": [0, -1], "normal": [0, 0, 1],
                 "friction": 1, "energetic": 0.5, "held": [1]}
        for lead in ((), (2,)):
            with self.subTest(lead), self.assertWarnsRegex(ricochet.NoEnd, "1 of 1|2 of 2"):
                after = ricochet.at_contact(**{**wedge, "qdot": np.broadcast_to([0.0, -1.0], (*lead, 2))})
            self.assertTrue(np.isnan(after.rates_after).all() and np.isnan(after.impulse_n_s).all())
            self.assertEqual(after.rates_after.shape, (*lead, 2))
        with self.assertRaises(ricochet.Inadmissible):
            ricochet.solve({"mechanism": {"mass_matrix": np.eye(2), "jacobian": wedge["J"], "rates": [0, -1],
                                          "kept_coordinates": [1]},
                            "friction": {"kinetic_coefficient": 1}, "restitution": {"energetic": 0.5}}, strict=True)

    def test_a_contact_that_locks_in_space_has_the_error_of_rounding(self):
        for law in ("newton", "poisson", "energetic"):
            for coefficient in (0, 0.5, 1):
                with self.subTest(law=law, coefficient=coefficient):
                    after = ricochet.at_contact([[1.0]], [[1.0], [0], [0.3]], [-1.0], [0, 0, 1], friction=1,
                                                **{law: coefficient})
                    self.assertEqual(after.answer.regime, "LOCKED")
                    np.testing.assert_allclose(after.rates_after, 0, atol=1e-15)
                    self.assertLess(after.answer.accuracy.relative_error, 1e-7)

    def test_what_is_wrong_is_named(self):
        good = {"M": np.eye(3), "J": np.eye(3), "qdot": [0, 0, -1], "normal": [0, 0, 1]}
        call = lambda **wrong: ricochet.at_contact(**{**good, **wrong}, newton=0.5)
        self.refused(lambda: call(M=np.eye(2)), "M")
        self.refused(lambda: call(J=np.eye(3)[:2], normal=[0, 1]), "J", "normal")
        self.refused(lambda: call(normal=[0, 0, 0]), "normal")
        self.refused(lambda: call(qdot=3), "qdot")
        self.refused(lambda: call(qdot=[[0], [0], [-1]]), "qdot")
        self.refused(lambda: call(held=[True, False, False]), "held")
        self.refused(lambda: call(qdot=[0, 0, "x"]), "qdot[2]")
        self.refused(lambda: call(M=np.ones((4, 3, 3)), J=np.ones((5, 3, 3))), "M")
        with self.assertRaisesRegex(ricochet.InvalidRequest, r"shapes M \(4, 3, 3\), J \(5, 3, 3\), qdot \(3,\)"):
            call(M=np.ones((4, 3, 3)), J=np.ones((5, 3, 3)))
        self.refused(lambda: call(held=[3]), "held[0]")
        self.refused(lambda: call(held=[1, 0, 1]), "held[2]")
        self.refused(lambda: call(held=None), "held[0]")
        self.refused(lambda: call(friction=np.ma.masked), "friction.kinetic_coefficient")
        self.refused(lambda: call(M=np.diag([1, 1, -1.0])), "mechanism.mass_matrix[8]")
        self.refused(lambda: call(M=np.eye(3) + np.triu(np.ones((3, 3)), 2)), "mechanism.mass_matrix[6]")
        self.refused(lambda: ricochet.at_contact(**good), "restitution.coefficient")
        self.refused(lambda: ricochet.at_contact(**good, newton=1, poisson=1), "restitution.poisson")


class Batches(Case):
    def test_they_keep_the_laws_of_mechanics(self):
        mass, jacobian, rates, normal = random_states(500, 7)
        mu, e = RANDOM.uniform(0, 1, 500), RANDOM.uniform(0, 1, 500)
        after, impulse, table = ricochet.at_contact(mass, jacobian, rates, normal, friction=mu, newton=e)
        self.assertEqual(table.codes["status"].counts().get("INVALID", 0), 0)
        # M (q'+ - q') = J^T p.
        gained = np.einsum("bij,bj->bi", mass, after - rates)
        given = np.einsum("bij,bi->bj", jacobian, impulse)
        np.testing.assert_allclose(gained, given, atol=1e-9 * np.abs(given).max())
        unit = normal / np.linalg.norm(normal, axis=1)[:, None]
        speeds = [np.einsum("bi,bij,bj->b", unit, jacobian, velocities) for velocities in (rates, after)]
        np.testing.assert_allclose(speeds[1], -e * speeds[0], atol=1e-9)
        along = np.einsum("bi,bi->b", unit, impulse)
        across = np.linalg.norm(impulse - along[:, None] * unit, axis=1)
        self.assertTrue(np.all(across <= mu * along * (1 + 1e-9)))

    def test_each_state_has_the_answer_of_a_single_one(self):
        mass, jacobian, rates, normal = random_states(20, 5)
        after, impulse, table = ricochet.at_contact(mass, jacobian, rates, normal, friction=0.3, energetic=0.7, held=[1])
        for b in range(20):
            one = ricochet.at_contact(mass[b], jacobian[b], rates[b], normal[b], friction=0.3, energetic=0.7, held=[1])
            np.testing.assert_allclose(after[b], one.rates_after, rtol=1e-10, atol=1e-12)
            np.testing.assert_allclose(impulse[b], one.impulse_n_s, rtol=1e-10, atol=1e-12)
            self.assertEqual(table.codes["regime"][b], one.answer.regime)

    def test_held_coordinates_may_come_from_any_iterable(self):
        mass, jacobian, rates, normal = random_states(3, 5)
        call = lambda held: ricochet.at_contact(  # noqa: E731
            mass[0], jacobian[0], rates[0], normal[0], friction=0.3, energetic=0.7, held=held).rates_after
        listed = call([1, 3])
        for held in (iter([1, 3]), (i for i in (1, 3)), map(int, "13"), {1, 3}, np.array([1, 3])):
            np.testing.assert_array_equal(call(held), listed)

    def test_a_product_in_float32_is_symmetric_but_for_its_rounding(self):
        mass, jacobian, rates, normal = random_states(20, 5)
        turn = np.linalg.qr(np.random.default_rng(5).normal(size=(5, 5)))[0].astype(np.float32)
        product = turn.T @ mass.astype(np.float32) @ turn
        self.assertFalse(np.array_equal(product, np.swapaxes(product, 1, 2)))
        after = ricochet.at_contact(product, jacobian, rates, normal, friction=0.3, energetic=0.7)
        self.assertTrue(np.isfinite(after.rates_after).all())
        listed = ricochet.at_contact(list(product), jacobian, rates, normal, friction=0.3, energetic=0.7)
        np.testing.assert_array_equal(listed.rates_after, after.rates_after)
        with self.assertRaises(ricochet.InvalidRequest):
            ricochet.at_contact(
                product[0].astype(float), jacobian[0], rates[0], normal[0], friction=0.3, energetic=0.7)

    def test_held_coordinates_leave_the_mechanism(self):
        mass, jacobian, rates, normal = random_states(50, 6)
        free, held = [0, 2, 3, 5], [1, 4]
        after, impulse, _ = ricochet.at_contact(mass, jacobian, rates, normal, friction=0.4, poisson=0.5, held=held)
        np.testing.assert_array_equal(after[:, held], rates[:, held])
        # The velocity of the contact that the held ones give is that of a moving surface: take it from the free ones.
        w = np.einsum("bij,bjk,blk->bil", jacobian[:, :, free], np.linalg.inv(mass[:, free][:, :, free]),
                      jacobian[:, :, free])
        change = np.einsum("bij,bj->bi", jacobian, after - rates)
        np.testing.assert_allclose(change, np.einsum("bij,bj->bi", w, impulse), atol=1e-9 * np.abs(change).max())

    def test_what_has_no_axis_of_states_holds_for_all(self):
        mass, jacobian, rates, normal = random_states(10, 4)
        after, _, _ = ricochet.at_contact(mass[0], jacobian[0], rates, normal[0], friction=0.1, newton=0.5)
        for b in range(10):
            one = ricochet.at_contact(mass[0], jacobian[0], rates[b], normal[0], friction=0.1, newton=0.5)
            np.testing.assert_allclose(after[b], one.rates_after, rtol=1e-10, atol=1e-12)

    def test_a_state_that_breaks_a_rule_is_nan_and_says_why(self):
        mass, jacobian, rates, normal = random_states(4, 3)
        mass[1] = -mass[1]
        jacobian[2, 0, 0] = np.nan
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            after, impulse, table = ricochet.at_contact(mass, jacobian, rates, normal, newton=0.5)
        self.assertEqual([str(warning.message).partition(": mech")[0] for warning in caught],
                         ["rows that break a rule and have NaN: 2 of 4; the first is row 1"])
        self.assertEqual(caught[0].filename, __file__)
        for rows in (after, impulse):
            np.testing.assert_array_equal(np.isnan(rows).any(axis=1), [False, True, True, False])
        self.assertEqual([bad.field for bad in table.summary.bad_rows],
                         ["mechanism.mass_matrix[0]", "mechanism.jacobian[0]"])

    def test_one_state_may_be_struck_in_several_ways(self):
        for count in (1, 2):
            mass = np.array([np.eye(3)] * count)
            with self.assertWarnsRegex(ricochet.InvalidRows, r"1 of 2; .* row 1: friction\.kinetic_coefficient = -0"):
                after, _, _ = ricochet.at_contact(
                    mass, np.eye(3), [[1, 0, -1]], [0, 0, 1], friction=[0.1, -0.1], newton=0.5)
            np.testing.assert_allclose(after[0], [0.85, 0, 0.5], rtol=1e-14)
            self.assertTrue(np.isnan(after[1]).all())

        after, impulse, _ = ricochet.at_contact(
            np.eye(3), np.eye(3), [1, 0, -1], [0, 0, 1], friction=[0.1, 0.2], newton=[0.5, 0.25])
        np.testing.assert_allclose(after, [[0.85, 0, 0.5], [0.75, 0, 0.25]], rtol=1e-14)
        np.testing.assert_allclose(impulse, [[-0.15, 0, 1.5], [-0.25, 0, 1.25]], rtol=1e-14)
        self.refused(lambda: ricochet.at_contact([np.eye(3)] * 2, np.eye(3), [1, 0, -1], [0, 0, 1],
                                                 friction=[0.1, 0.2, 0.3], newton=0.5), "friction")

    def test_a_state_without_a_normal_is_nan_as_well(self):
        with self.assertWarnsRegex(ricochet.InvalidRows, "1 of 2; .* row 1: normal has no direction"):
            after, _, _ = ricochet.at_contact(
                np.eye(3), np.eye(3), [1, 0, -1], [[0, 0, 1], [0, 0, 0]], friction=0.1, newton=0.5)
        np.testing.assert_array_equal(np.isnan(after).any(axis=1), [False, True])

    def test_a_mass_matrix_is_symmetric_but_for_rounding(self):
        turn = np.linalg.qr(np.random.default_rng(3).normal(size=(50, 4, 4)))[0]
        mass = turn.transpose(0, 2, 1) @ np.diag([1.0, 2.0, 3.0, 4.0]) @ turn
        self.assertFalse(np.array_equal(mass, mass.transpose(0, 2, 1)))
        jacobian = np.eye(3, 4)
        given = {"friction": 0.1, "newton": 0.5}
        after, _, _ = ricochet.at_contact(mass, jacobian, [1, 0, -1, 0], [0, 0, 1], **given)
        mean = 0.5 * (mass + mass.transpose(0, 2, 1))
        np.testing.assert_array_equal(after, ricochet.at_contact(mean, jacobian, [1, 0, -1, 0], [0, 0, 1], **given)[0])
        mean[0, 1, 0] += 1e-9
        self.refused(lambda: ricochet.at_contact(mean[0], jacobian, [1, 0, -1, 0], [0, 0, 1], **given),
                     "mechanism.mass_matrix[4]")

    def test_a_planar_mechanism_that_rolls_is_the_same_in_any_frame(self):
        """Its slip is 0 but for rounding, and Wtt has rank one."""
        random = np.random.default_rng(4)
        planar = np.array([[1.0, 0.0, 0.2], [0.0, 1.0, -0.4]])
        mass, rates = np.diag([1.0, 1.0, 0.08]), np.array([0.3, -1.1, -1.5])
        turns = random.uniform(0, 2 * np.pi, 500)
        along = np.stack([np.cos(turns), np.sin(turns), np.zeros(500)], axis=-1)
        jacobian = along[:, :, None] * planar[0] + np.array([0, 0, 1.0])[:, None] * planar[1]
        after, _, answer = ricochet.at_contact(mass, jacobian, rates, [0, 0, 1], friction=0.2, energetic=0.5)
        right = ricochet.solve({
            "mechanism": {"mass_matrix": mass, "jacobian": planar, "rates": rates},
            "friction": {"kinetic_coefficient": 0.2}, "restitution": {"energetic": 0.5}}).rates_after
        np.testing.assert_allclose(after, np.tile(right, (500, 1)), atol=1e-14)
        self.assertEqual(answer.codes["status"].counts(), {"OK": 500})

    def test_a_state_that_overflows_is_nan_as_well(self):
        jacobian = np.array([np.eye(3), 1e160 * np.eye(3)])
        with self.assertWarnsRegex(ricochet.InvalidRows, "1 of 2; .* row 1: mechanism is out of range: "):
            after, _, _ = ricochet.at_contact(np.eye(3), jacobian, [1, 0, -1], [0, 0, 1], friction=0.1, newton=0.5)
        np.testing.assert_array_equal(np.isnan(after).any(axis=1), [False, True])

    def test_matrices_are_taken_in_scenes_as_well(self):
        mass, jacobian, rates, _ = random_states(1, 4)
        listed = {"mass_matrix": mass[0].ravel(), "jacobian": jacobian[0].ravel(), "rates": rates[0]}
        scene = {"mechanism": {"mass_matrix": mass[0], "jacobian": jacobian[0].tolist(), "rates": rates[0]}}
        self.assertEqual(ricochet.Scene(scene), ricochet.Scene({"mechanism": listed}))
        self.refused(lambda: ricochet.Scene({"mechanism": {"mass_matrix": mass[0][:2]}}), "mechanism.mass_matrix")
        self.refused(lambda: ricochet.Scene({"mechanism": {"jacobian": jacobian[0].T}}), "mechanism.jacobian")

    def test_a_jacobian_is_told_from_its_transpose(self):
        for rows, n in ((2, 3), (3, 2), (2, 2), (3, 3), (2, 4)):
            scene = {"jacobian": np.ones((rows, n)), "mass_matrix": np.eye(n), "rates": -np.ones(n)}
            ricochet.Scene({"mechanism": scene})
            for wrong in {(n, rows), (rows, 6), (6, rows), (3, 2), (2, 3)} - {(2, n), (3, n)}:
                for jacobian in (np.ones(wrong), np.ones(wrong).tolist()):
                    with self.subTest(wrong, n=n), self.assertRaises(ricochet.InvalidRequest) as raised:
                        ricochet.solve({"mechanism": {**scene, "jacobian": jacobian}, "restitution": {"newton": 0.5}})
                    self.assertEqual(str(raised.exception), f"mechanism.jacobian has shape {wrong}: must be (2, {n}) "
                                     f"with rows t, n or (3, {n}) with rows t1, t2, n")


if __name__ == "__main__":
    main()

"""Several contacts at once in Python, against numbers that follow by hand: a block of 1 m by 2 m that falls flat at 1 m/s
on its two feet, with friction 1."""

import math
import unittest

import numpy as np

import ricochet
from support import main

LEFT = [[3.4, -1.2], [-1.2, 1.6]]
RIGHT = [[3.4, 1.2], [1.2, 1.6]]
ACROSS = [[3.4, 1.2], [-1.2, 0.4]]
W = np.block([[np.array(LEFT), np.array(ACROSS)], [np.array(ACROSS).T, np.array(RIGHT)]])
TURN = [0, -1, 0, 1]  # The feet are 1 m apart: the block turns by the difference of their normal velocities.


def block(energetic=0.5, **right):
    foot = {"friction": 1, "energetic": energetic}
    return {"contact_matrix": {"w_per_kg": W, "velocity_m_s": [0, -1, 0, -1]}, "contacts": [foot, {**foot, **right}]}


def turn(outcome):
    return float(np.dot(TURN, outcome.contact_velocity_m_s))


class MultiContact(unittest.TestCase):
    def test_a_symmetric_fall_stays_straight_over_a_range_of_stiffness(self):
        feet = [{"body": 1, "point_m": [x, 0], "normal": [0, 1], "friction": 0.3, "energetic": 0.5} for x in (-0.5, 0, 0.5)]
        body = {"mass_kg": 1, "inertia_com_kg_m2": [0.2], "position_m": [0, 0.5], "linear_m_s": [0, -1]}
        curve = ricochet.multicontact({"free_bodies": {"bodies": [body]}, "contacts": feet}, methods="springs",
                                      stiffness_range=(2, 0.1, 10))
        self.assertGreater(len(curve.stiffness_samples), 10)
        for sample in curve.stiffness_samples:
            np.testing.assert_allclose(sample.outcome.velocity, [0, 0.5, 0], atol=1e-12)
        self.assertEqual(len(curve.stiffness_jumps), 0)

    def test_a_range_of_stiffness_needs_springs(self):
        with self.assertRaisesRegex(ricochet.InvalidRequest, "stiffness_range is set: must be absent without the method"):
            ricochet.multicontact(block(), methods="orders", stiffness_range=(2, 0.1, 10))

    def test_the_block_turns_by_the_order_of_its_feet(self):
        answer = ricochet.multicontact(block())
        self.assertEqual(answer.verdict, "ORDER_MATTERS")
        turns = {order: turn(outcome) for outcome in answer.orders for order in outcome.orders}
        self.assertAlmostEqual(turns["1"], -0.45, delta=1e-14)
        self.assertAlmostEqual(turns["2"], 0.45, delta=1e-14)
        self.assertEqual(turn(answer.springs), 0.0)

    def test_springs_turn_it_by_the_ratio_of_their_stiffness(self):
        answer = ricochet.multicontact(block(relative_stiffness=2), methods="springs")
        self.assertAlmostEqual(turn(answer.springs), 0.1344929607039685, delta=1e-12)
        self.assertEqual(len(answer.orders), 0)
        curve = ricochet.multicontact(block(), methods="springs", stiffness_range=(2, 0.01, 100))
        turns = [turn(sample.outcome) for sample in curve.stiffness_samples]
        self.assertAlmostEqual(turns[-1], 0.4333883701506805, delta=1e-12)
        self.assertAlmostEqual(turns[0], -0.4333883701506805, delta=1e-12)

    def test_no_outcome_turns_it_faster_than_energy_allows(self):
        answer = ricochet.multicontact(block(), outputs={"turn": TURN})
        bounds = {bound.output: bound for bound in answer.possible}
        self.assertAlmostEqual(bounds["turn"].upper, math.sqrt(1.5), delta=1e-9)
        self.assertGreaterEqual(bounds["turn"].upper, math.sqrt(1.5))
        self.assertLessEqual(bounds["turn"].lower, -math.sqrt(1.5))

    def test_states_are_answered_one_by_one(self):
        states = np.array([[0, -1, 0, -1], [0, -2, 0, -2]])
        slow, fast = ricochet.multicontact(block(), states=states)
        self.assertEqual(slow, ricochet.multicontact(block()))
        self.assertAlmostEqual(turn(fast.orders[0]), 2 * turn(slow.orders[0]), delta=1e-14)

    def test_no_states_have_no_answers(self):
        for states in ([], np.empty((0, 4))):
            self.assertEqual(ricochet.multicontact(block(), states=states), [])

    def test_a_jacobian_is_told_from_its_transpose(self):
        jacobian = np.arange(20.0).reshape(4, 5) ** 2
        scene = {"mechanism": {"mass_matrix": np.eye(5), "jacobian": jacobian, "rates": -np.ones(5)},
                 "contacts": [{"friction": 0.3, "energetic": 0.5}] * 2}
        ricochet.multicontact(scene, methods="orders")
        for wrong in (jacobian.T, jacobian.reshape(2, 10), jacobian.reshape(10, 2).tolist()):
            mechanism = {**scene["mechanism"], "jacobian": wrong}
            with self.assertRaisesRegex(ricochet.InvalidRequest, r"mechanism\.jacobian has shape .*: must be \(d, 5\)"):
                ricochet.multicontact({**scene, "mechanism": mechanism}, methods="orders")

    def test_cost_knows_the_methods(self):
        study = ricochet.cost(block(), time_limit_s=10, samples=1)
        self.assertEqual([row.name for row in study.rows], ["orders", "springs", "possible"])
        self.assertEqual(study.rows[1].method.multi_contact, "SPRINGS")
        answer = ricochet.multicontact(block(), methods="possible")
        widest = max(bound.upper - bound.lower for bound in answer.possible[:4])
        self.assertEqual(study.rows[2].claimed.total, widest)

    def test_what_is_wrong_is_named(self):
        for change, arguments, field in (
            ({"contacts": [{"friction": -1, "energetic": 0.5}, {"energetic": 2}]}, {}, "contacts[0].friction"),
            ({"contact_matrix": {"w_per_kg": W[:3], "velocity_m_s": [0, -1, 0, -1]}}, {}, "contact_matrix.w_per_kg"),
            ({"contact_matrices": {}}, {}, "contact_matrices"),
            ({}, {"methods": "order"}, "methods"),
            ({}, {"stiffness_range": (1, 2)}, "stiffness_range"),
            ({}, {"stiffness_range": 5}, "stiffness_range"),
            ({}, {"outputs": ["turn"]}, "outputs"),
            ({}, {"states": [[0, -1, 0]]}, "states[0].velocity"),
            ({}, {"outputs": {"turn": TURN[:3]}}, "outputs[0].coefficients"),
        ):
            with self.subTest(field), self.assertRaises(ricochet.InvalidRequest) as raised:
                ricochet.multicontact({**block(), **change}, **arguments)
            fields = [violation.field for violation in raised.exception.violations]
            self.assertIn(field, [one.removeprefix("scene.") for one in fields])


if __name__ == "__main__":
    main()

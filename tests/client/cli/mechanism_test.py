"""Mechanisms that NumPy has saved, and matrices in JSON: ricochet solve --mechanism FILE.npz.

usage: mechanism_test.py RICOCHET WORK_DIRECTORY
"""
import json
import unittest

import numpy

from ricochet_case import RicochetCase, WORK

M = numpy.array([[2.0, 0.6, 0.1], [0.6, 1.2, 0.3], [0.1, 0.3, 0.5]])
J = numpy.array([[0.9, 0.3, -0.2], [0.1, -0.5, 0.6], [0.7, 0.6, 0.4]])
QDOT = numpy.array([-1.0, 0.4, -0.5])
LAW = ["--mu", "0.3", "--energetic", "0.5"]


class MechanismTest(RicochetCase):
    def saved(self, name, save=numpy.savez, **arrays):
        save(WORK / name, **{"M": M, "J": J, "qdot": QDOT, **arrays})
        return ["solve", "--mechanism", name, *LAW]

    def outcome(self, *arguments):
        return json.loads(self.made(*arguments, "--format", "json"))["outcome"]

    def scene(self, name, **mechanism):
        matrices = {"mass_matrix": M.tolist(), "jacobian": J.tolist(), "rates": QDOT.tolist(), **mechanism}
        (WORK / name).write_text(json.dumps({"mechanism": matrices, "friction": {"kinetic_coefficient": 0.3},
                                             "restitution": {"energetic": 0.5}}, indent=2))
        return ["solve", "--scene", name]

    def test_an_archive_is_the_scene_with_its_numbers(self):
        expected = self.outcome(*self.scene("nested.json"))
        self.assertEqual(len(expected["rates_after"]), 3)
        flat = self.scene("flat.json", mass_matrix=M.ravel().tolist(), jacobian=J.ravel().tolist())
        self.assertEqual(self.outcome(*flat), expected)
        self.assertEqual(self.outcome(*self.saved("plain.npz")), expected)
        self.assertEqual(self.outcome(*self.saved("packed.npz", save=numpy.savez_compressed)), expected)
        fortran = {"M": numpy.asfortranarray(M), "J": numpy.asfortranarray(J)}
        self.assertEqual(self.outcome(*self.saved("fortran.npz", **fortran)), expected)

    def test_any_real_type_is_read(self):
        whole = {"M": numpy.diag([2, 1, 3]), "J": numpy.array([[1, 0, 0], [0, 0, 1]]), "qdot": [-1, 0, -1]}
        expected = self.outcome(*self.saved("whole.npz", **whole))
        for kind in (numpy.float32, numpy.int32, numpy.float64):
            arrays = {name: numpy.asarray(array, dtype=kind) for name, array in whole.items()}
            self.assertEqual(self.outcome(*self.saved("kind.npz", **arrays)), expected)

    def test_what_is_held_and_both_ends(self):
        held = self.outcome(*self.saved("held.npz"), "--keep", "1,2", "--both-ends")
        self.assertEqual(held["rates_after"][1:], QDOT[1:].tolist())
        self.assertEqual(self.outcome(*self.saved("held.npz"), "--keep", "0")["rates_after"][0], QDOT[0])
        self.assertIn("must be in [0, 3)", self.refused(*self.saved("held.npz"), "--keep=-1"))
        self.assertEqual(held["free_end"]["rates_after"], self.outcome(*self.saved("free.npz"))["rates_after"])
        text = self.made(*self.saved("held.npz"), "--keep", "1,2", "--both-ends")
        for part in ("Mechanism after", "momentum taken", "rate, none held", "Both ends", "With nothing held:"):
            self.assertIn(part, text)
        self.assertIn("both_ends", self.refused(*self.saved("free.npz"), "--both-ends"))

    def test_several_contacts_are_the_scene_with_their_numbers(self):
        both = numpy.vstack([J[:2], J[1:]])
        numpy.savez(WORK / "feet.npz", M=M, J=both, qdot=QDOT)
        (WORK / "feet.json").write_text(json.dumps({
            "mechanism": {"mass_matrix": M.tolist(), "jacobian": both.tolist(), "rates": QDOT.tolist()},
            "contacts": [{"friction": 0.3, "energetic": 0.5}, {"friction": 0.4, "energetic": 0.25}]}))
        feet = ["multicontact", "--mechanism", "feet.npz"]
        law = ["--mu", "0.3,0.4", "--energetic", "0.5,0.25"]
        self.assertEqual(self.made(*feet, *law, "--format", "json"),
                         self.made("multicontact", "--scene", "feet.json", "--format", "json"))
        numpy.savez(WORK / "feet_held.npz", M=M, J=both, qdot=QDOT * [1, 1, 0])
        scene = json.loads((WORK / "feet.json").read_text())
        scene["mechanism"].update(rates=(QDOT * [1, 1, 0]).tolist(), kept_coordinates=[2])
        (WORK / "feet_held.json").write_text(json.dumps(scene))
        held = ["multicontact", "--mechanism", "feet_held.npz", "--keep", "2"]
        self.assertEqual(self.made(*held, *law, "--format", "json"),
                         self.made("multicontact", "--scene", "feet_held.json", "--format", "json"))
        for arguments, words in [
                ([*feet, "--mu", "0.3,0.4"], "--mechanism needs --mu and --energetic"),
                ([*feet, "--mu", "0.3,0.4", "--energetic", "0.5"], "--energetic = 0.5: must be as many as --mu, 2"),
                ([*feet, "--mu", "1,1,1", "--energetic", "0,0,0"], "must be (6, 3) with rows t, n for each of the 3"),
                (["multicontact", "--scene", "feet.json", "--mu", "1"], "--mu, --energetic, --keep and --composite need --mechanism"),
                (["multicontact"], "needs --scene FILE or --mechanism FILE.npz, and not both"),
                ([*feet, *law, "--scene", "feet.json"], "needs --scene FILE or --mechanism FILE.npz, and not both")]:
            with self.subTest(words):
                self.assertIn(words, self.refused(*arguments))

    def test_only_a_scene_in_which_nothing_strikes_is_said_to_be_one(self):
        feet = [{"friction": 0, "energetic": 0.5}] * 2
        w = numpy.eye(4).tolist()  # The contacts do not feel each other: there is one outcome.
        for normal, words in ((-1, "only one outcome is possible"), (1, "no contact strikes")):
            (WORK / "apart.json").write_text(json.dumps(
                {"contact_matrix": {"w_per_kg": w, "velocity_m_s": [0, normal, 0, normal]}, "contacts": feet}))
            self.assertIn(words, self.made("multicontact", "--scene", "apart.json"))
        striking = ["--method", "springs", "--method", "possible"]
        (WORK / "apart.json").write_text(json.dumps(
            {"contact_matrix": {"w_per_kg": w, "velocity_m_s": [0, -1, 0, -1]}, "contacts": feet}))
        self.assertIn("only one outcome is possible", self.made("multicontact", "--scene", "apart.json", *striking))

    def test_archives_that_lack_something_are_refused_in_words(self):
        rates = {"M": M, "J": J}
        numpy.savez(WORK / "lacks.npz", **rates)
        for arguments, words in [
                (["solve", "--mechanism", "lacks.npz"], "has no array qdot but M.npy, J.npy: must have M, J and qdot"),
                (self.saved("shape.npz", M=M[:2]), "M has the shape (2, 3): must be (3, 3) for the 3 of qdot"),
                (self.saved("rows.npz", J=J[:1]), "J has the shape (1, 3): must be (2, 3) with rows t, n or (3, 3)"),
                (self.saved("feet.npz", J=numpy.vstack([J, J])), "; for several contacts `ricochet multicontact` takes a"),
                (self.saved("column.npz", qdot=QDOT[:, None]), "qdot has the shape (3, 1): must be (n,)"),
                (self.saved("complex.npz", M=M + 0j), "M has the type <c16: must be float64"),
                (self.saved("big.npz", M=M.astype(">f8")), "M has the type >f8: must be float64"),
                (self.saved("skew.npz", M=M + numpy.triu(numpy.ones((3, 3)), 1)), "mechanism.mass_matrix[3]"),
                (self.saved("nan.npz", qdot=QDOT * numpy.nan), "mechanism.rates[0] = nan"),
                (["solve", "--mechanism", "none.npz"], "none.npz: No such file"),
                ([*self.saved("both.npz"), "--a", "1"], "cannot be combined with --scene or the flags of a pendulum"),
                (["solve", "--a", "1", "--keep", "1"], "--keep and --composite need --mechanism")]:
            with self.subTest(words=words):
                self.assertIn(words, self.refused(*arguments))
        self.saved("damaged.npz")
        archive = bytearray((WORK / "damaged.npz").read_bytes())
        archive[archive.index(QDOT.tobytes()) + 6] ^= 1
        (WORK / "damaged.npz").write_bytes(archive)
        self.assertIn("qdot is damaged: its checksum is wrong", self.refused("solve", "--mechanism", "damaged.npz", *LAW))
        (WORK / "text.npz").write_text("M J qdot")
        self.assertIn("must be a file that numpy.savez has written", self.refused("solve", "--mechanism", "text.npz"))

    def contact(self, name, system, w):
        velocity = {"tangential_m_s": -1 if system == "planar_contact" else [1, 0.6], "normal_m_s": -1}
        (WORK / name).write_text(json.dumps({system: {"w_per_kg": w, **velocity}, "restitution": {"newton": 0.5}}))
        return ["solve", "--scene", name]

    def test_w_is_a_matrix_too(self):
        packed = {"planar_contact": {"w_tt_per_kg": 2.5, "w_tn_per_kg": 1.5, "w_nn_per_kg": 2.5, "tangential_m_s": -1,
                                     "normal_m_s": -1}, "restitution": {"newton": 0.5}}
        (WORK / "packed.json").write_text(json.dumps(packed))
        matrix = self.contact("plane.json", "planar_contact", [[2.5, 1.5], [1.5, 2.5]])
        self.assertEqual(self.outcome(*matrix), self.outcome("solve", "--scene", "packed.json"))
        space = [[1.96, 0.24, 0.6], [0.24, 2.96, -0.8], [0.6, -0.8, 1.85]]
        six = self.contact("six.json", "spatial_contact", [1.96, 0.24, 0.6, 2.96, -0.8, 1.85])
        self.assertEqual(self.outcome(*self.contact("space.json", "spatial_contact", space)), self.outcome(*six))

    def test_the_w_of_several_contacts_is_a_matrix_too(self):
        rows = [[3.4, -1.2, 3.4, 1.2], [-1.2, 1.6, -1.2, 0.4], [3.4, -1.2, 3.4, 1.2], [1.2, 0.4, 1.2, 1.6]]
        feet = [{"friction": 1, "energetic": 0.5}] * 2
        answers = []
        for w in (rows, sum(rows, [])):
            (WORK / "feet.json").write_text(json.dumps(
                {"contact_matrix": {"w_per_kg": w, "velocity_m_s": [0, -1, 0, -1]}, "contacts": feet}))
            answers.append(self.made("multicontact", "--scene", "feet.json", "--format", "json"))
        self.assertEqual(*answers)
        self.assertIn("VERDICT_ORDER_MATTERS", answers[0])

    def test_a_w_that_is_wrong_is_named_with_its_frame(self):
        skew = [[2.5, 1.5], [1.4, 2.5]]
        for system, w, words in [
                ("planar_contact", skew, "w_per_kg[1][0] = 1.4: must be equal to [0][1] = 1.5, as W is symmetric in the "
                                         "frame (t, n)"),
                ("spatial_contact", skew, "w_per_kg has 4 entries: must be 3 x 3 in a spatial_contact"),
                ("planar_contact", [[1, 2], [3]], "rows of 2 and of 1 entries"),
                ("planar_contact", [[1, 0, 0, 1]], "w_per_kg has 4 entries: must be 2 x 2 in a planar_contact"),
                ("planar_contact", [1, 0, 0, 1], "planar_contact.w_per_kg: must be a 2 x 2 matrix, a list of its rows"),
                ("spatial_contact", [[[1, 0, 0, 1, 0, 1]]], "spatial_contact.w_per_kg[0]: must not be a list")]:
            with self.subTest(words=words):
                self.assertIn(words, self.refused(*self.contact("wrong.json", system, w)))

    def test_a_matrix_of_another_shape_is_not_read_row_by_row(self):
        right = {"mass_matrix": [[2, 0.3, 0], [0.3, 1, 0.1], [0, 0.1, 1]], "jacobian": [[1, 0, 0.5], [0, 1, 0.2]],
                 "rates": [0.3, -1, 0]}
        law = {"friction": {"kinetic_coefficient": 0.3}, "restitution": {"energetic": 0.5}}
        for change, words in [
                ({"jacobian": [[1, 0], [0, 1], [0.5, 0.2]]}, "mechanism.jacobian has rows of 2 entries: must have rows of 3"),
                ({"jacobian": [[1, 0, 0.5, 0, 1, 0.2]]}, "mechanism.jacobian has rows of 6 entries: must have rows of 3"),
                ({"mass_matrix": [[2, 0.3, 0, 0.3, 1, 0.1, 0, 0.1, 1]]}, "mechanism.mass_matrix has rows of 9 entries"),
                ({"jacobian": [[[1, 0, 0.5]], [[0, 1, 0.2]]]}, "mechanism.jacobian[0]: must not be a list"),
                ({"rates": [[0.3], [-1], [0]]}, "mechanism.rates[0]: must not be a list"),
                ({"rates": [[[]]]}, "must not be a list")]:
            with self.subTest(words=words):
                (WORK / "shape.json").write_text(json.dumps({"mechanism": {**right, **change}, **law}))
                self.assertIn(words, self.refused("solve", "--scene", "shape.json"))
        (WORK / "shape.json").write_text(json.dumps({"mechanism": right, **law}))
        (WORK / "flat.json").write_text(json.dumps({"mechanism": {**right, "jacobian": sum(right["jacobian"], [])}, **law}))
        self.assertEqual(self.outcome("solve", "--scene", "shape.json"), self.outcome("solve", "--scene", "flat.json"))
        (WORK / "deep.json").write_text('{"mechanism":{"mass_matrix":' + "[" * 200000 + "]" * 200000 + "}}")
        self.assertIn("must not be a list", self.refused("solve", "--scene", "deep.json"))
        (WORK / "skew.json").write_text(json.dumps(
            {"contact_matrix": {"w_per_kg": [[1, 0, 0, 1]], "velocity_m_s": [0, -1]}, "contacts": [{"energetic": 0.5}]}))
        self.assertIn("w_per_kg is 1 x 4: must be square", self.refused("multicontact", "--scene", "skew.json"))


if __name__ == "__main__":
    unittest.main()

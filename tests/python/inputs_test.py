"""Tests what Python takes for numbers, names and matrices, and what it says of everything else."""

import decimal
import fractions
import inspect
import json
import os
import pydoc
import re
import subprocess
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np
import pandas
import ricochet
import xarray
from ricochet import names
from ricochet.units import without_unit
from support import PENDULUM, SOURCE, main

NEWTON = "coefficients.newton"
MU = "friction.kinetic_coefficient"


def command_line(*arguments):
    return subprocess.run([os.environ["RICOCHET"], *map(str, arguments)], capture_output=True, text=True, check=False)


class Case(unittest.TestCase):
    def refused(self, call, field, words=""):
        """The call raises the package's own error, which names the field."""
        with self.assertRaises(ricochet.InvalidRequest) as raised:
            call()
        found = {violation.field: violation.description for violation in raised.exception.violations}
        self.assertIn(field, found, raised.exception)
        self.assertIn(words, found[field])


class Numbers(Case):
    WRONG = {
        "complex": (1j, "must be a real number"),
        "complex of numpy": (np.complex128(1), "must be a real number"),
        "too large": (10**400, "must be a number of at most 1.798e+308"),
        "larger than Python prints": (10**5000, "an integer of 16610 bits"),
        "text": ("0.1", "= '0.1': must be a number"),
        "truth": (True, "= True: must be a number"),
        "truth of numpy": (np.bool_(True), "must be a number"),
        "missing": (pandas.NA, "must be a number"),
        "two": (np.array([1.0, 2.0]), "must be a number"),
        "dictionary": ({"a": 1}, "must be a number"),
        "masked": (np.ma.masked, "= masked: must be a number"),
        "array of what is masked": (np.ma.array([1.0], mask=[True]), "must be a number"),
        "time": (np.timedelta64(1, "ns"), "must be a number"),
        "date": (np.datetime64(1, "ns"), "must be a number"),
    }
    RIGHT = (0.25, fractions.Fraction(1, 4), np.float32(0.25), np.float64(0.25), np.longdouble(0.25), np.array(0.25),
             np.array([0.25]))

    def test_each_wrong_one_is_named_wherever_a_number_is_meant(self):
        for what, (value, words) in self.WRONG.items():
            places = {
                "pendulum.b_m": lambda v: ricochet.solve({**PENDULUM, "pendulum": {**PENDULUM["pendulum"], "b_m": v}}),
                "tolerance": lambda v: ricochet.solve(PENDULUM, tolerance=v),
                "velocity_uncertainty_m_s": lambda v: ricochet.audit(
                    PENDULUM, rates_after=1, velocity_uncertainty_m_s=v),
                f"{MU}.start": lambda v: ricochet.sweep(PENDULUM, {MU: ricochet.Linspace(v, 1, 2)}, NEWTON),
                "history": lambda v: ricochet.solve(PENDULUM, history=v),
            }
            for field, call in places.items():
                with self.subTest(what, field=field):
                    self.refused(lambda: call(value), field, words if field != "history" else "must be a whole number")

    def test_each_wrong_entry_of_an_array_is_named(self):
        for what, (value, words) in self.WRONG.items():
            if what in ("two", "missing", "masked", "array of what is masked"):
                continue
            places = {
                f"{MU}[1]": [
                    lambda v: ricochet.sweep(PENDULUM, {MU: [0.1, v]}, NEWTON),
                    lambda v: ricochet.solve_batch(PENDULUM, {MU: [0.1, v]}, NEWTON),
                    lambda v: ricochet.solve_batch(PENDULUM, {MU: pandas.Series([0.1, v], dtype=object)}, NEWTON),
                    lambda v: ricochet.bounds(PENDULUM, ranges={MU: (0.1, v)}),
                ],
                "normal_after_m_s[1]": [lambda v: ricochet.audit_batch(PENDULUM, {"normal_after_m_s": [0.1, v]})],
                "rates_after[1]": [lambda v: ricochet.audit(PENDULUM, rates_after=[0.1, v])],
                "pendulum.a_m[1]": [lambda v: ricochet.solve_batch(PENDULUM, {"a": (0.1, v)}, NEWTON)],
            }
            for field, calls in places.items():
                for call in calls:
                    with self.subTest(what, field=field):
                        self.refused(lambda: call(value), field, words)

    def test_what_can_be_counted_once_is_a_column_and_bytes_are_none(self):
        expected = ricochet.solve_batch(PENDULUM, {MU: [0.1, 0.2]}, NEWTON)
        for given in (iter([0.1, 0.2]), (mu for mu in (0.1, 0.2)), {"a": 0.1, "b": 0.2}.values()):
            self.assertEqual(ricochet.solve_batch(PENDULUM, {MU: given}, NEWTON), expected)
        for given in (b"12", bytearray(b"12")):
            self.refused(lambda: ricochet.solve_batch(PENDULUM, {MU: given}, NEWTON), MU, "must be a number")

    def test_arrays_of_times_are_no_numbers(self):
        for times in (pandas.to_timedelta([1, 2], unit="s"), pandas.to_datetime([1, 2], unit="s"),
                      np.array([1, 2], "m8[s]")):
            for given in (times, times.to_series() if hasattr(times, "to_series") else times, np.asarray(times)):
                with self.subTest(str(times.dtype), holder=type(given).__name__):
                    self.refused(lambda: ricochet.solve_batch(PENDULUM, {MU: given}, NEWTON), f"{MU}[0]", "must be a number")

    def test_every_holder_of_one_number_is_taken_for_it(self):
        expected = ricochet.solve({**PENDULUM, "friction": {"kinetic_coefficient": 0.25}})
        for value in self.RIGHT:
            with self.subTest(type(value).__name__):
                self.assertEqual(ricochet.solve({**PENDULUM, "friction": {"kinetic_coefficient": value}}), expected)
                self.assertEqual(ricochet.sweep(PENDULUM, {"mu": value}, "newton", form="table")[NEWTON][0],
                                 expected.coefficients.newton)
        self.assertEqual(len(ricochet.solve(PENDULUM, history=np.int64(3)).history), 4)
        scene = {**PENDULUM, "friction": {"kinetic_coefficient": decimal.Decimal("nan")}}
        self.refused(lambda: ricochet.solve(scene), MU)

    def test_none_leaves_out_only_what_may_be_unset(self):
        for value in (None, {"kinetic_coefficient": 0.1, "static_coefficient": None}):
            scene = {**PENDULUM, "restitution": {"energetic": 0.5, "newton": None}, "friction": value}
            given = {key: entry for key, entry in (value or {}).items() if entry is not None}
            self.assertEqual(ricochet.solve(scene),
                             ricochet.solve({**PENDULUM, "restitution": {"energetic": 0.5}, "friction": given}))
        scene = {**PENDULUM, "friction": {"kinetic_coefficient": None}}
        self.refused(lambda: ricochet.solve(scene), MU, "= None: must be a number")
        scene = {"planar_contact": {"w_tt_per_kg": 1, "w_nn_per_kg": 1, "normal_m_s": None}}
        self.refused(lambda: ricochet.solve(scene), "planar_contact.normal_m_s", "= None: must be a number")

    def test_what_is_missing_is_nan_and_makes_the_row_invalid(self):
        for column in ([0.1, None], pandas.Series([0.1, pandas.NA]), pandas.array([0.1, None], dtype="Float64"),
                       np.ma.masked_array([0.1, 0.2], [False, True]), [0.1, np.ma.masked],
                       pandas.Series([0.1, np.nan])):
            with self.subTest(type(column).__name__), warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                table = ricochet.solve_batch(PENDULUM, {MU: column}, [NEWTON])
                self.assertEqual([table.codes["status"][row] for row in (0, 1)], ["OK", "INVALID"])
                self.assertTrue(np.isnan(table[NEWTON][1]))
                self.assertEqual([warning.category for warning in caught], [ricochet.InvalidRows])

    def test_a_vector_has_an_order_and_no_masked_entries(self):
        sphere = {"spatial_contact": {"w_per_kg": [3, 0, 0, 3, 0, 1], "tangential_m_s": [9, 2], "normal_m_s": -1}}
        arm = {"mechanism": {"mass_matrix": np.eye(2), "jacobian": np.eye(2), "rates": [1, -1]}}
        masked = np.ma.array([9.0, 2.0], mask=[False, True])
        for scene, field, value, words in (
                (sphere, "tangential_m_s", masked, "[1] = masked"), (sphere, "tangential_m_s", {9.0, 2.0}, "[0] = {"),
                (sphere, "w_per_kg", np.ma.array(np.ones(6), mask=[0, 0, 0, 0, 0, 1]), "[5] = masked"),
                (arm, "rates", masked, "[1] = masked"), (arm, "rates", frozenset({1.0}), "[0] = frozenset"),
                (arm, "mass_matrix", np.ma.array(np.eye(2), mask=np.eye(2)), "[0] = nan")):
            [(system, values)] = scene.items()
            with self.subTest(field, value=value), self.assertRaises(ricochet.InvalidRequest) as raised:
                ricochet.solve({system: {**values, field: value}, "restitution": {"newton": 0.5}})
            self.assertIn(f"{system}.{field}{words}", str(raised.exception))
        self.refused(lambda: ricochet.audit(PENDULUM, contact_velocity={"normal_m_s": np.ma.masked}),
                     "contact_velocity.normal_m_s", "= masked")
        self.refused(lambda: ricochet.audit(PENDULUM, rates_after={0.1, 0.2}), "rates_after", "must be a number")

    def test_an_axis_without_values_is_refused_by_its_rule(self):
        lin, log = ricochet.Linspace, ricochet.Logspace
        for axis, field, words in (
                (lin(0, 1, 0), "count", "= 0: must be in [1, 2^53]"), (lin(0, 1, -1), "count", "= -1"),
                (lin(0, 1, 2.5), "count", "must be a whole number"), (lin(0, np.nan, 2), "stop", "must be finite"),
                (log(0, 1, 2), "start", "= 0: must be finite and > 0"), (log(1, -1, 2), "stop", "= -1")):
            with self.subTest(axis):
                self.refused(axis.values, field, words)
        self.assertEqual(list(lin(0, 1, 3).values()), [0, 0.5, 1])
        self.assertEqual(list(log(1, 4, 1).values()), [1])

    def test_a_scene_that_is_no_dictionary_is_called_by_its_name(self):
        for call in (ricochet.solve, ricochet.bounds, lambda scene: ricochet.sweep(scene, {"mu": 0}, "newton")):
            self.refused(lambda: call("hello"), "scene", "= 'hello': must be a dictionary")

    def test_what_is_asked_of_derivatives_is_a_dictionary(self):
        for call in (ricochet.solve, ricochet.bounds):
            self.refused(lambda: call(PENDULUM, derivatives=["newton"]), "derivatives",
                         "must be a dictionary, with by, find_thresholds, of")


class Matrices(Case):
    W = np.array([[1.96, 0.24, 0.6], [0.24, 2.96, -0.8], [0.6, -0.8, 1.85]])

    def contact(self, w):
        return {
            "spatial_contact": {"w_per_kg": w, "tangential_m_s": [1, 0.6], "normal_m_s": -1},
            "friction": {"kinetic_coefficient": 0.3},
            "restitution": {"energetic": 0.8},
        }

    def test_a_matrix_means_its_upper_triangle_row_by_row(self):
        entries = [1.96, 0.24, 0.6, 2.96, -0.8, 1.85]
        for w in (self.W, self.W.tolist(), np.asfortranarray(self.W), self.W.astype(object)):
            self.assertEqual(ricochet.Scene(self.contact(w)).to_dict()["spatial_contact"]["w_per_kg"], entries)
        self.assertEqual(ricochet.solve(self.contact(self.W)), ricochet.solve(self.contact(entries)))

    def test_a_matrix_of_the_plane_means_its_three_entries(self):
        scene = ricochet.Scene({"planar_contact": {"w_per_kg": [[2.5, 1.5], [1.5, 3.0]]}})
        self.assertEqual(scene, ricochet.Scene(
            {"planar_contact": {"w_tt_per_kg": 2.5, "w_tn_per_kg": 1.5, "w_nn_per_kg": 3.0}}))

    def test_an_entry_that_differs_from_its_mirror_image_is_named(self):
        for i, j in ((0, 1), (0, 2), (1, 2)):
            w = self.W.copy()
            w[i, j] += 1e-6
            self.refused(lambda: ricochet.Scene(self.contact(w)), f"spatial_contact.w_per_kg[{j}][{i}]",
                         f"= {self.W[j, i]!r}: must be equal to [{i}][{j}]")
            w[i, j] = self.W[i, j] * (1 + 1e-14)
            ricochet.Scene(self.contact(w))
        self.refused(lambda: ricochet.Scene({"planar_contact": {"w_per_kg": [[2, 1], [0, 2]]}}),
                     "planar_contact.w_per_kg[1][0]")

    def test_another_shape_is_told_the_order(self):
        for w in ([1, 2, 3, 4, 5], np.eye(2), np.eye(4), np.ones((3, 2)), 3, np.zeros(0)):
            self.refused(lambda: ricochet.Scene(self.contact(w)), "spatial_contact.w_per_kg", "11, 12, 13, 22, 23, 33")
        for w in (np.eye(3), [2.0, 1.0, 3.0], [1.0] * 6):
            self.refused(lambda: ricochet.Scene({"planar_contact": {"w_per_kg": w}}), "planar_contact.w_per_kg",
                         "2 x 2")
        self.refused(lambda: ricochet.Scene({"planar_contact": {"w_per_kg": np.eye(2), "w_tn_per_kg": 0}}),
                     "planar_contact.w_tn_per_kg", "set together")
        self.refused(lambda: ricochet.Scene(self.contact([[1, 0, "x"], [0, 1, 0], [0, 0, 1]])),
                     "spatial_contact.w_per_kg[0][2]", "= 'x': must be a number")


class Frames(Case):
    def test_no_rows_are_a_table_without_rows(self):
        tables = {
            "batch": ricochet.solve_batch(PENDULUM, {MU: []}, NEWTON),
            "batch beside a number": ricochet.solve_batch(PENDULUM, {MU: [], "a": 0.3}, NEWTON),
            "batch of a frame": ricochet.solve_batch(PENDULUM, pandas.DataFrame({MU: []}), NEWTON),
            "audit": ricochet.audit_batch(PENDULUM, {"normal_after_m_s": []}),
            "audit beside a number": ricochet.audit_batch(
                PENDULUM, {"normal_after_m_s": [], "tangential_after_m_s": 0.1}),
            "states": ricochet.at_contact(np.eye(3), np.eye(3), np.empty((0, 3)), [0, 0, 1], energetic=0).answer,
        }
        for what, table in tables.items():
            with self.subTest(what):
                self.assertEqual((len(table), len(table.to_pandas()), table.summary.rows), (0, 0, 0))
                self.assertIsInstance(str(table), str)
        self.refused(lambda: ricochet.solve_batch(PENDULUM, {MU: [], "a": [0.3, 0.4]}, NEWTON), MU,
                     "must be one number, or 2 as the longest array")
        arm = {"mechanism": {"mass_matrix": np.eye(2), "jacobian": np.eye(2), "rates": [1, -1]},
               "restitution": {"newton": 0.5}}
        rates = "mechanism.rates"
        self.refused(lambda: ricochet.solve_batch(arm, {rates: np.ones((4, 2))}, NEWTON), rates,
                     f"the columns of a matrix are stated as {rates}[0], {rates}[1]")
        with self.assertRaises(ricochet.InvalidRequest) as caught:
            ricochet.solve_batch(PENDULUM, {MU: np.ones((4, 2))}, NEWTON)
        self.assertNotIn("[0]", str(caught.exception))
        self.refused(lambda: ricochet.sweep(PENDULUM, {MU: []}, NEWTON), f"{MU}.list.values", "is empty")
        wrong = {"pendulum": {**PENDULUM["pendulum"], "a_m": -1}}
        for columns in ({}, {"normal_after_m_s": []}, {"rates_after": [[]]}):
            self.refused(lambda: ricochet.audit_batch(wrong, columns), "pendulum.a_m", "= -1: must be > 0")

    def test_errors_name_what_the_caller_gave(self):
        velocity = "contact_velocity_after.normal_m_s"
        calls = {
            "tolerance": lambda: ricochet.solve(PENDULUM, tolerance=5),
            "history": lambda: ricochet.solve(PENDULUM, history=-5),
            "force_history": lambda: ricochet.solve(PENDULUM, force_history=10),
            "require[0]": lambda: ricochet.solve(PENDULUM, require=["friction"], exclude=["friction"]),
            f"{velocity}.sigma": lambda: ricochet.fit(PENDULUM, {velocity: [0.3, 0.2]}, [MU]),
            f"{MU}.start": lambda: ricochet.fit(PENDULUM, {velocity: [0.3, 0.2]}, {MU: -1}, sigma={velocity: 1}),
        }
        for field, call in calls.items():
            with self.subTest(field):
                self.refused(call, field)

    def test_a_table_keeps_its_inputs(self):
        mu = np.array([0.0, 0.1])
        table = ricochet.solve_batch(PENDULUM, {MU: mu}, NEWTON)
        mu[:] = 9
        self.assertEqual(list(table.axes[MU]), [0, 0.1])

    def test_an_index_is_kept(self):
        frame = pandas.DataFrame({MU: [0.0, 0.1]}, index=[7, 9])
        table = ricochet.solve_batch(PENDULUM, frame, NEWTON)
        self.assertEqual(list(table.to_pandas().index), [7, 9])
        self.assertEqual(list(table.to_xarray()["row"].values), [7, 9])
        self.assertEqual(frame.join(table.to_pandas()[[NEWTON]]).loc[7, NEWTON], 1)
        audited = ricochet.audit_batch(PENDULUM, pandas.DataFrame({"rates_after": [0.1, 0.2]}, index=list("xy")))
        self.assertEqual(list(audited.to_pandas().index), ["x", "y"])
        series = ricochet.solve_batch(PENDULUM, {MU: frame[MU], "pendulum.a_m": 0.3}, NEWTON)
        self.assertEqual(list(series.to_pandas().index), [7, 9])

    def test_series_of_different_indices_are_refused(self):
        columns = {MU: pandas.Series([0.0, 0.1], [1, 2]), "pendulum.a_m": pandas.Series([0.3, 0.4], [2, 1])}
        self.refused(lambda: ricochet.solve_batch(PENDULUM, columns, NEWTON), "inputs", "different indices")
        observed = dict(zip(["normal_after_m_s", "tangential_after_m_s"], columns.values()))
        self.refused(lambda: ricochet.audit_batch(PENDULUM, observed), "columns", "different indices")
        turned = xarray.DataArray(-np.ones((2, 3)), {"state": [2, 1]}, ["state", "k"])
        friction = xarray.DataArray([0.1, 0.2], {"state": [1, 2]})
        self.refused(lambda: ricochet.at_contact(np.eye(3), np.eye(3), turned, [0, 0, 1], friction=friction, newton=0.5),
                     "qdot", "different indices")
        rates = {"rates_after": [pandas.Series([0.1, 0.2], [1, 2])], "mu": columns["pendulum.a_m"]}
        self.refused(lambda: ricochet.audit_batch(PENDULUM, rates), "columns", "different indices")
        velocity = pandas.Series([0.3, 0.4], [1, 2])
        for table, sigma in (({"rates_after_rad_s[0]": velocity, "a_m": columns["pendulum.a_m"]}, 1),
                             ({"rates_after_rad_s[0]": velocity}, columns["pendulum.a_m"])):
            self.refused(lambda: ricochet.fit(PENDULUM, table, [MU], sigma={"rates_after_rad_s[0]": sigma}), "table",
                         "different indices")
        self.refused(lambda: ricochet.sweep(PENDULUM, columns, NEWTON, zip_axes=True), "axes", "different indices")
        self.assertEqual(len(ricochet.sweep(PENDULUM, columns, NEWTON, form="table")), 4)  # A grid has no rows yet.
        states = dict(friction=columns[MU], newton=columns["pendulum.a_m"])
        self.refused(lambda: ricochet.at_contact(np.eye(3), np.eye(3), [0, 0, -1], [0, 0, 1], **states), "qdot",
                     "different indices")

    def test_all_that_a_dataset_says_of_its_rows_counts(self):
        numbers = {MU: ("row", [0.0, 0.1]), "pendulum.a_m": ("row", [0.3, 0.4])}
        expected = ricochet.solve_batch(PENDULUM, {name: list(column) for name, (_, column) in numbers.items()}, NEWTON)
        for moved in ([], [MU], list(numbers)):
            dataset = xarray.Dataset({"pendulum.b_m": ("row", [1.0, 1.0]), **numbers}).set_coords(moved)
            found = ricochet.solve_batch({**PENDULUM, "pendulum": {**PENDULUM["pendulum"], "b_m": 1.0}}, dataset, NEWTON)
            np.testing.assert_array_equal(found.axes[MU], [0, 0.1])
        again = ricochet.solve_batch(PENDULUM, expected.to_xarray().drop_vars([NEWTON, "regime", "status"]), NEWTON)
        self.assertEqual(again.axes.keys(), expected.axes.keys())
        np.testing.assert_array_equal(again[NEWTON], expected[NEWTON])
        swept = ricochet.sweep(PENDULUM, {"mu": [0.0, 0.1]}, NEWTON)
        numbered = ricochet.solve_batch(PENDULUM, swept.drop_vars([NEWTON, "regime", "status"]), NEWTON)
        self.assertEqual(list(numbered.to_xarray()["row"].values), [0.0, 0.1])
        alone = xarray.Dataset(numbers, {"hue": 3.0})  # Such as a selection leaves.
        np.testing.assert_array_equal(ricochet.solve_batch(PENDULUM, alone, NEWTON)[NEWTON], expected[NEWTON])
        self.refused(lambda: ricochet.solve_batch(PENDULUM, pandas.DataFrame({"mu": [0.0], "coords": [1]}), NEWTON),
                     "inputs", "= 'coords'")
        labelled = xarray.Dataset(numbers, {"row": list("xy")})
        self.assertEqual(list(ricochet.solve_batch(PENDULUM, labelled, NEWTON).to_pandas().index), ["x", "y"])
        other = xarray.DataArray([0.3, 0.4], dims="drop")
        self.refused(lambda: ricochet.solve_batch(PENDULUM, {MU: labelled[MU], "a_m": other}, NEWTON), "inputs",
                     "along different dimensions, drop, row")
        self.refused(lambda: ricochet.solve_batch(PENDULUM, labelled.assign_coords(hue=("row", [1, 2])), NEWTON),
                     "inputs", "= 'hue'")
        turned = labelled[MU].assign_coords(row=list("yx"))
        self.refused(lambda: ricochet.solve_batch(PENDULUM, {MU: turned, "a_m": labelled["pendulum.a_m"]}, NEWTON),
                     "inputs", "different indices")

    def test_codes_are_compared_with_names(self):
        with self.assertWarns(ricochet.InvalidRows):
            codes = ricochet.solve_batch(PENDULUM, {MU: [0.0, -0.1, 0.1]}, NEWTON).codes["status"]
        np.testing.assert_array_equal(codes == "OK", [True, False, True])
        np.testing.assert_array_equal(codes != "OK", [False, True, False])
        self.assertEqual(codes[np.array([False, True, False])], ["INVALID"])
        self.assertEqual(codes[[0, 1]], ["OK", "INVALID"])
        self.refused(lambda: codes == "OKAY", "name", "'OKAY' is unknown; did you mean 'OK'")

    def test_a_message_has_the_names_of_the_arguments(self):
        self.refused(lambda: ricochet.bounds(PENDULUM, ranges={"mu": (0.3, 0.1)}), f"{MU}.high")
        self.refused(lambda: ricochet.audit(PENDULUM, rates_after=[1, 2]), "rates_after", "must have 1")
        self.refused(lambda: ricochet.audit(PENDULUM, rates_after=[np.nan]), "rates_after[0]")

    def test_a_column_of_texts_is_named(self):
        frame = pandas.DataFrame({MU: [0.0, 0.1], "pendulum.a_m": ["a", "b"]})
        self.refused(lambda: ricochet.solve_batch(PENDULUM, frame, NEWTON), "pendulum.a_m[0]", "= 'a': must be")


class ShortNames(Case):
    def test_a_text_is_one_name(self):
        for columns in ("newton", ["newton"], NEWTON, ("newton",), pandas.Index([NEWTON])):
            self.assertEqual(list(ricochet.sweep(PENDULUM, {"mu": [0, 0.1]}, columns, form="table").columns), [NEWTON])
            self.assertEqual(list(ricochet.solve_batch(PENDULUM, {"mu": [0, 0.1]}, columns).columns), [NEWTON])
        self.assertEqual(ricochet.solve(PENDULUM, exclude="friction").regime, "FRICTIONLESS")
        for columns in (3, [3], None, b"newton"):
            self.refused(lambda: ricochet.sweep(PENDULUM, {"mu": 0}, columns), "columns", "must be a name or a list")

    def test_they_mean_the_same_wherever_a_path_is_taken(self):
        short, full = (ricochet.bounds(PENDULUM, ranges={name: (0.1, 0.2)}) for name in ("mu", MU))
        self.assertEqual(short, full)
        table = ricochet.solve_batch(PENDULUM, {"mu": [0.0], "omega": -1, "a": 0.3}, ["newton", "rates_after[0]"])
        self.assertEqual(list(table.axes), [MU, "pendulum.omega_minus_rad_s", "pendulum.a_m"])
        self.assertEqual(list(table.columns), [NEWTON, "rates_after_rad_s[0]"])
        self.assertEqual(table["newton"][0], 1)
        with self.assertRaises(KeyError):
            _ = table["poisson"]
        slope = f"d({NEWTON})/d({MU})"
        for call in (ricochet.solve_batch, lambda *given: ricochet.sweep(*given, form="table")):
            table = call(PENDULUM, {"mu": [0.05]}, ["d(newton)/d(mu)", slope.replace(NEWTON, "coefficients.poisson")])
            self.assertEqual(list(table.columns), [slope, f"d(coefficients.poisson)/d({MU})"])
            self.assertEqual(table["d(newton)/d(mu)"][0], table[slope][0])

    def test_what_they_do_not_mean_is_said(self):
        self.refused(lambda: ricochet.sweep(PENDULUM, {"mu": 0}, "newtn"), "columns", f"did you mean {NEWTON}?")
        self.refused(lambda: ricochet.sweep(PENDULUM, {"kinetic_coeficient": 0}, NEWTON), "axes", f"did you mean {MU}?")
        self.refused(lambda: ricochet.sweep(PENDULUM, {"mu": 0, MU: 1}, "newton"), "axes", "a second time")
        self.refused(lambda: ricochet.sweep(PENDULUM, {"mu": 0}, "d(newtn)/d(mu)"), "columns", f"mean {NEWTON}?")
        arm = {"mechanism": {"mass_matrix": np.eye(3), "jacobian": np.eye(3), "rates": [0, 0, -1]}}
        self.refused(lambda: ricochet.sweep(arm, {"mass_matrix[9]": 0}, "newton"), "axes",
                     "did you mean mechanism.mass_matrix[8]?")
        links = [{"length_m": 1, "mass_kg": 1, "com_m": 0.5, "inertia_com_kg_m2": 0.1, "theta_rad": 0.1}] * 2
        self.refused(lambda: ricochet.sweep({"linkage": {"links": links}}, {"theta": 0}, "newton"), "axes",
                     "must name one of linkage.links[0].theta_rad, linkage.links[1].theta_rad")
        for axes in ([("mu", 1)], "mu", {3: 1}):
            self.refused(lambda: ricochet.sweep(PENDULUM, axes, "newton"), "axes")

    def test_they_are_those_of_the_command_line(self):
        for path in sorted((SOURCE / "tests/data/scenes").iterdir()):
            if path.suffix not in (".json", ".textproto"):
                continue
            known = ricochet.Scene(ricochet.read_scene(path))
            text = command_line("sweep", "--scene", path, "--axis", "?").stdout
            listed = re.findall(r"^ *([a-z]\S*\.\S+)", text, re.M)
            self.assertGreater(len(listed), 3, path)
            self.check_names(path, known._fields(), listed, "axis")
            text = command_line("sweep", "--scene", path, "--column", "?").stdout
            listed = re.findall(r"^ *([a-z]\S*(?:\.\S+|\]))", text, re.M)
            self.check_names(path, known._columns(), listed, "column")

    def test_a_file_is_read_as_the_command_line_reads_it(self):
        spatial = '{"spatial_contact": {"w_per_kg": %s, "tangential_m_s": [1, 0], "normal_m_s": -1}}'
        pendulum = '{"pendulum": {"inertia_kg_m2": 1, "a_m": %s, "omega_minus_rad_s": -1}}'
        files = {
            "matrix.json": spatial % "[[2, 0, 0.5], [0, 2, 0], [0.5, 0, 1]]",
            "list.json": spatial % "[2, 0, 0.5, 2, 0, 1]",
            "uneven.json": spatial % "[[2, 0], [0, 2, 0]]",
            "mark.json": "\ufeff" + pendulum % 1,
            "camel.json": pendulum.replace('"a_m"', '"aM"') % 1,
            "brace": pendulum % 1,
            "null.json": pendulum % "null",
            "twice.json": pendulum % '1, "a_m": 2',
            "unknown.json": pendulum.replace('"a_m"', '"am"') % 1,
            "text.textproto": "pendulum { inertia_kg_m2: 1 a_m: 1 omega_minus_rad_s: -1 }",
            "unknown.textproto": "pendulum { am: 1 }",
            "two.textproto": "pendulum {} planar_body {}",
            "several.textproto": "contacts { mu: 1 }",
            "empty.json": "",
        }
        right = ("matrix.json", "list.json", "mark.json", "camel.json", "brace", "text.textproto")
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                path = Path(folder, name)
                path.write_text(text, encoding="utf-8")
                printed = command_line("scene", "print", "--scene", path, "--json")
                with self.subTest(name):
                    self.assertEqual(printed.returncode == 0, name in right, printed.stderr)
                    if name in right:
                        again = Path(folder, "printed.json")
                        again.write_text(printed.stdout, encoding="utf-8")
                        self.assertEqual(ricochet.Scene(ricochet.read_scene(path)),
                                         ricochet.Scene(ricochet.read_scene(again)))
                        continue
                    with self.assertRaises(ricochet.InvalidRequest) as raised:
                        ricochet.read_scene(path)
                    self.assertEqual(printed.stderr.strip(), f"ricochet: INVALID_ARGUMENT: {raised.exception}")

    def test_any_bytes_may_stand_in_comments_and_names_of_files(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(os.fsencode(folder), b"\xff.textproto")
            Path(os.fsdecode(path)).write_bytes(b"# \xe9\npendulum { inertia_kg_m2: 1 a_m: 1 omega_minus_rad_s: -1 }")
            self.assertEqual(ricochet.read_scene(path), ricochet.read_scene(os.fsdecode(path)))
            self.assertEqual(command_line("scene", "print", "--scene", os.fsdecode(path)).returncode, 0)
            for wrong in (b"pendulum { a_m: \xe9 }", b'pendulum { a_m: "\xe9" }', b'{"\xe9": 1}'):
                Path(os.fsdecode(path)).write_bytes(wrong)
                with self.assertRaisesRegex(ricochet.InvalidRequest, f"is not UTF-8 at byte {wrong.index(0xe9)}"):
                    ricochet.read_scene(path)

    def check_names(self, path, known, listed, what):
        """Every end of a listed path means that path here exactly if the command line takes it for that path."""
        for full in listed:
            parts = without_unit(full).split(".")
            for short in {".".join(parts[i:]) for i in range(len(parts))} | {full}:
                ends = [one for one in listed if short in (one, without_unit(one)) or not one.startswith(("errors.", "free_end."))
                        and (one.endswith("." + short) or without_unit(one).endswith("." + short))]
                ends = [short] if short in listed else ends
                meant = names.meanings(short, known)
                with self.subTest(path.name, what=what, short=short):
                    self.assertEqual(meant == [full], ends == [full], f"{meant} here, {ends} there")

    def test_letters_are_those_of_the_command_line(self):
        source = (SOURCE / "client/cli/input/short_name.cc").read_text()
        known = ricochet.Scene(PENDULUM)._fields()
        # A letter of the tables of audits names no field of a scene.
        letters = {letter: path for letter, path in re.findall(r'\{"(\w+)",\s+"(\S+?)"\}', source) if path in known}
        self.assertGreater(len(letters), 3)
        for letter, path in letters.items():
            self.assertEqual(names.meanings(letter, known), [path])


class Answers(Case):
    def test_a_record_is_one_line_and_a_table_in_a_notebook(self):
        outcome = ricochet.solve(PENDULUM, history=1000)
        text = repr(outcome)
        self.assertRegex(text, r"^Record\(regime='REBOUND', admissible=True, .*coefficients\.newton=0\.707107, .* more\)$"
        )
        self.assertLess(len(text), 130)
        page = outcome._repr_html_()
        self.assertIn("<td style='text-align: left'>work.residual_j</td>", page)
        self.assertIn("<td style='text-align: left'>J</td>", page)
        self.assertLess(len(page), 100_000)
        self.assertNotIn("None", page)
        self.assertEqual(json.loads(json.dumps(outcome))["coefficients"]["newton"], outcome.coefficients.newton)
        table = repr(ricochet.sweep(PENDULUM, {"mu": np.linspace(0, 0.1, 500)}, "newton", form="table"))
        self.assertRegex(table, rf"^Table\(500 rows: {MU}, {NEWTON}, regime, status; .*OK 500\)$")

    def test_the_version_is_that_of_the_engine(self):
        self.assertEqual(ricochet.__version__, ricochet.info().engine.version)

    def test_a_sweep_carries_its_request_and_its_engine(self):
        axes = {MU: [0.0, 0.1]}
        data = ricochet.sweep(PENDULUM, axes, NEWTON)
        with tempfile.TemporaryDirectory() as directory:
            scene = Path(directory) / "scene.json"
            scene.write_text(json.dumps(PENDULUM))
            made = command_line("sweep", "--scene", scene, "--axis", f"{MU}=0,0.1", "--column", NEWTON, "--regime",
                                "-o", Path(directory) / "x.nc")
            self.assertEqual(made.returncode, 0, made.stderr)
            with xarray.open_dataset(Path(directory) / "x.nc") as file:
                self.assertEqual(set(data.attrs), set(file.attrs))
                for name, value in file.attrs.items():
                    if name == "ricochet_request":
                        self.assertEqual(json.loads(data.attrs[name]), json.loads(value))
                    else:
                        self.assertEqual(data.attrs[name], value)
        frame = ricochet.sweep(PENDULUM, axes, NEWTON, form="pandas")
        self.assertEqual(frame.attrs, {**data.attrs, "units": frame.attrs["units"]})

    def test_invalid_points_are_a_warning_where_they_were_asked_for(self):
        calls = [lambda: ricochet.sweep(PENDULUM, {"mu": [0, -1, -2]}, NEWTON),
                 lambda: ricochet.solve_batch(PENDULUM, {"mu": [0, -1, -2]}, NEWTON)]
        for call in calls:
            with self.assertWarnsRegex(ricochet.InvalidRows, rf"2 of 3; the first is row 1: {MU} = -1") as caught:
                call()
            self.assertEqual(caught.filename, __file__)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            ricochet.sweep(PENDULUM, {"mu": [0, 0.1]}, NEWTON)

    def test_impacts_without_an_end_are_a_warning_where_they_were_asked_for(self):
        wedge = {"planar_contact": {"w_tt_per_kg": 1, "w_tn_per_kg": 1, "w_nn_per_kg": 1, "tangential_m_s": 1,
                                    "normal_m_s": -1}, "restitution": {"energetic": 0.5}}
        law = {"planar_contact": {"w_tt_per_kg": 2.5, "w_tn_per_kg": -1.5, "w_nn_per_kg": 1, "tangential_m_s": 1,
                                  "normal_m_s": -1}, "brach": {"e": 0.5, "mu_hat": 0}}
        for scene, path in ((wedge, MU), (law, "brach.mu_hat")):
            for call in (ricochet.sweep, ricochet.solve_batch):
                with self.subTest(path, call=call), self.assertWarnsRegex(
                        ricochet.NoEnd, rf"2 of 3; the first is row 1: {path} = 2") as caught:
                    call(scene, {path: [0, 2, 2]}, "normal_m_s")
                self.assertEqual(caught.filename, __file__)


class Help(unittest.TestCase):
    def test_every_function_says_its_parameters(self):
        for name in ricochet.__all__:
            function = getattr(ricochet, name)
            if not inspect.isroutine(function):
                continue
            with self.subTest(name):
                parameters = inspect.signature(function).parameters.values()
                self.assertFalse([one for one in parameters if one.kind in (one.VAR_KEYWORD, one.VAR_POSITIONAL)])
                text = pydoc.plain(pydoc.render_doc(function))
                for one in parameters:
                    self.assertRegex(text, rf"(?m)^ +(\w+, )*{one.name}(, \w+)*: \S|^unit_of|^read_scene")

    def test_every_option_of_a_client_is_in_its_help(self):
        for name in list(inspect.signature(ricochet.Client).parameters):
            self.assertRegex(ricochet.Client.__doc__, rf"(?m)^ +{name}: ")


if __name__ == "__main__":
    main()

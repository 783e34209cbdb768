"""Draws files of sweeps by `ricochet plot` and holds each picture to that of the sweep itself, byte by byte.

usage: plot_file_test.py RICOCHET WORK_DIRECTORY
"""
import csv
import pathlib
import re
import unittest

import netCDF4
import numpy

from ricochet_case import RicochetCase, WORK, ricochet

MU, PHI, NEWTON, RATE = "friction.kinetic_coefficient", "pendulum.phi_rad", "coefficients.newton", "rates_after_rad_s[0]"
SWEEP = ["sweep", "--a", "0.6", "--b", "0.8", "--energetic", "1", "--regime"]
LINE = [*SWEEP, "--axis", f"{MU}=lin:0:0.5:101", "--column", f"{NEWTON},coefficients.poisson"]
MAP = [*SWEEP, "--axis", f"{MU}=lin:-0.02:0.5:20", "--axis", f"{PHI}=log:0.1:1.5:30", "--column", f"{NEWTON},{RATE}"]
SWEEPS = {
    "line": LINE,
    "family": [*SWEEP, "--axis", f"{MU}=0.1,1/3,0.5", "--axis", f"{PHI}=lin:0.01:1.57:50", "--column", NEWTON],
    "map": MAP,
    "zip": [*SWEEP, "--zip", "--axis", f"{MU}=lin:0.1:0.5:20", "--axis", f"{PHI}=lin:0.1:1.5:20", "--column", NEWTON],
    "part": [*SWEEP, "--range", "3:77", "--axis", f"{MU}=lin:0.1:0.5:3", "--axis", f"{PHI}=log:0.1:1.5:40",
             "--column", NEWTON],
    "three": [*SWEEP, "--axis", f"{MU}=0.1,0.2", "--axis", "restitution.energetic=1,0.5", "--axis",
              f"{PHI}=lin:0.1:1.5:9", "--column", f"{RATE},{NEWTON}"],
    "derivative": [*SWEEP, "--axis", f"{MU}=lin:0.05:0.5:21", "--column", f"{NEWTON},d({NEWTON})/d({MU})"],
    "limit": [*SWEEP, "--axis", "restitution.newton=0.3,0.9", "--axis", f"{MU}=lin:-0.1:0.5:31", "--column",
              "coefficients.energetic,coefficients.poisson"],
}
FORMATS = ["csv", "json", "jsonl", "npy", "netcdf"]
LOOKS = {"line": ["--title", "It's mine", "--size", "700x500", "--logy"], "map": ["--logx", "--size", "1200x500"]}


class PlotFileTest(RicochetCase):
    def test_the_picture_of_a_file_is_that_of_its_sweep(self):
        for name, sweep in SWEEPS.items():
            for look in ([], LOOKS[name]) if name in LOOKS else ([],):
                self.made(*sweep, "--summary-only", "--plot", "sweep.svg", *look)
                expected = (WORK / "sweep.svg").read_bytes()
                for kind in FORMATS:
                    with self.subTest(sweep=name, format=kind, look=look):
                        self.made(*sweep, "--format", kind, "-o", "points")
                        self.assertEqual(self.made("plot", "points", "-o", "file.svg", *look), "file.svg\n")
                        self.assertEqual((WORK / "file.svg").read_bytes(), expected)

    def test_the_picture_takes_the_name_and_the_columns_that_are_asked_for(self):
        self.made(*MAP, "-o", "two.nc")
        self.assertEqual(self.made("plot", "two.nc", "--column", RATE), "two.svg\n")
        one = [*MAP[:-1], RATE]
        self.made(*one, "--summary-only", "--plot", "one.svg")
        self.assertEqual((WORK / "two.svg").read_bytes(), (WORK / "one.svg").read_bytes())
        for ending, start in {"png": b"\x89PNG", "pdf": b"%PDF"}.items():
            self.made("plot", "two.nc", "-o", f"two.{ending}")
            self.assertTrue((WORK / f"two.{ending}").read_bytes().startswith(start))

    def test_numbers_that_no_axis_can_show_are_refused(self):
        self.made(*SWEEPS["line"], "-o", "line.csv")
        lines = (WORK / "line.csv").read_text().splitlines()
        for sign, line in (("", 3), ("-", 4)):
            cells = lines[line].split(",")
            cells[lines[0].split(",").index(NEWTON)] = sign + "1.5e308"
            lines[line] = ",".join(cells)
        (WORK / "far.csv").write_text("\n".join(lines) + "\n")
        self.assertIn("numbers beyond 1e300", self.refused("plot", "far.csv", "-o", "far.svg"))

    def test_a_derivative_has_a_short_name(self):
        self.made(*SWEEPS["derivative"], "-o", "slope.csv")
        for name in (f"d({NEWTON})/d({MU})", "d(newton)/d(mu)", "newton"):
            self.made("plot", "slope.csv", "--column", name, "-o", "slope.svg")
        self.assertIn("must be a column of the file", self.refused("plot", "slope.csv", "--column", "d(newton)/d(phi)"))

    def test_two_long_axes_are_a_map_of_cells(self):
        table = list(csv.DictReader(self.made(*MAP, "--format", "csv").splitlines()))
        self.made(*MAP, "--summary-only", "--plot", "map.svg")
        text = (WORK / "map.svg").read_text(encoding="utf-8")
        cells = 2 * len(table)
        for regime, colour, name in [("INVALID", r"200, 200, 200", "no value or invalid"),
                                     ("LOCKED", r"166,  97,  26", "jammed (locked)")]:
            count = sum(row["regime"] == regime for row in table)
            self.assertGreater(count, 10)
            # Each panel has one more in its legend.
            self.assertEqual(len(re.findall(rf"fill = 'rgb\({colour}\)'", text)), 2 * count + 2)
            self.assertIn(name, text)
            cells += 2
        # Each point is a cell in both panels; the scales of the colours are polygons, too.
        self.assertEqual(text.count("<polygon") - self.scale_polygons(), cells)
        self.assertIn("kinetic friction μ", text)
        self.made(*MAP[:-1], NEWTON, "--summary-only", "--plot", "curves.svg", "--kind", "curves")
        self.assertNotIn("<polygon", (WORK / "curves.svg").read_text(encoding="utf-8"))

    def scale_polygons(self):
        """The polygons that two scales of colours take, from a map of 2 x 2 cells in each of two panels."""
        small = [*SWEEP, "--axis", f"{MU}=0.1,0.2", "--axis", f"{PHI}=1,1.2", "--column", f"{NEWTON},{RATE}"]
        self.made(*small, "--summary-only", "--plot", "small.svg", "--kind", "map")
        return (WORK / "small.svg").read_text(encoding="utf-8").count("<polygon") - 8

    def test_inadmissible_points_have_rings(self):
        self.made(*SWEEPS["limit"], "--format", "csv", "-o", "limit.csv", "--plot", "limit.svg", "--size", "1600x900")
        with open(WORK / "limit.csv", encoding="utf-8") as table:
            statuses = [row["status"] for row in csv.DictReader(table)]
        self.assertEqual(len(statuses), 62)
        picture = (WORK / "limit.svg").read_text(encoding="utf-8")
        rings = re.findall("xlink:href='#gpPt5' transform", picture)
        # One in each column, and one in the legend.
        self.assertEqual(len(rings), 2 * statuses.count("INADMISSIBLE") + 1)
        self.assertIn(">inadmissible<", picture)
        self.assertGreater(statuses.count("OK"), 10)

    def test_inadmissible_cells_of_a_map_have_dots(self):
        limits = [*SWEEP, "--axis", "restitution.newton=lin:0.1:0.9:20", "--axis", f"{MU}=lin:-0.1:0.5:25",
                  "--column", NEWTON]
        self.made(*limits, "--format", "csv", "-o", "cells.csv", "--plot", "cells.svg")
        with open(WORK / "cells.csv", encoding="utf-8") as table:
            statuses = [row["status"] for row in csv.DictReader(table)]
        self.assertGreater(statuses.count("INADMISSIBLE"), 10)
        self.assertGreater(statuses.count("OK"), 10)
        picture = (WORK / "cells.svg").read_text(encoding="utf-8")
        self.assertEqual(len(re.findall("xlink:href='#gpPt6' transform", picture)), statuses.count("INADMISSIBLE") + 1)
        self.assertIn(">inadmissible<", picture)

    def test_lines_over_unknown_regimes_are_said_to_go_on(self):
        self.made(*[word for word in LINE if word != "--regime"], "--format", "csv", "-o", "plain.csv")
        code, _, error = ricochet("plot", "plain.csv")
        self.assertEqual(code, 0)
        self.assertIn("plain.csv has no regimes, so that lines go on", error)

    def test_jammed_points_without_regimes_are_said_to_look_like_others(self):
        self.made(*[word for word in MAP if word != "--regime"], "--format", "csv", "-o", "cells.csv")
        code, _, error = ricochet("plot", "cells.csv")
        self.assertEqual(code, 0)
        self.assertIn("cells.csv has no regimes, so that jammed points look like others", error)
        self.assertNotIn("jammed", (WORK / "cells.svg").read_text(encoding="utf-8"))

    def test_units_of_unknown_variables_come_from_the_file(self):
        self.made(*LINE, "-o", "units.nc")
        with netCDF4.Dataset(WORK / "units.nc", "a") as data:
            data.renameVariable(NEWTON, "my_torque")
            data["my_torque"].units = "N m"
        self.made("plot", "units.nc")
        self.assertIn("my_torque [N m]", (WORK / "units.svg").read_text(encoding="utf-8"))

    def test_wrong_files_are_refused_by_name_and_reason(self):
        self.made(*LINE, "--format", "csv", "-o", "whole.csv")
        whole = (WORK / "whole.csv").read_text().splitlines(keepends=True)
        self.made(*LINE, "-o", "whole.npy")
        self.made(*LINE, "-o", "whole.nc")
        self.made("sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--column", NEWTON, "-o", "point.npy")
        self.made(*LINE, "-o", "table.txt")
        self.made(*LINE, "--summary-only", "--format", "csv", "-o", "summary.csv")
        self.made(*LINE, "-o", "part", "--shard-index", "0", "--shard-count", "2")
        numpy.save(WORK / "plain.npy", numpy.zeros(3))
        with netCDF4.Dataset(WORK / "other.nc", "w") as data:
            data.createDimension("x", 2)
            data.createVariable("x", "f8", ("x",))
        self.made(*LINE, "--format", "json", "-o", "whole.json")
        self.made(*LINE, "--format", "jsonl", "-o", "whole.jsonl")
        document, lines = (WORK / "whole.json").read_text(), (WORK / "whole.jsonl").read_text()
        files = {
            "torn.json": document[:-200], "torn.jsonl": lines[:-20], "scene.json": '{"pendulum": {"a_m": 0.3}}',
            "word.json": document.replace("\n[3,0.015,", '\n[3,"x",', 1), "short.json": document.replace("\n[3,", "\n[", 1),
            "mixed.jsonl": lines.replace('{"index":3,"friction', '{"index":3,"fricton', 1),
            "torn.csv": "".join(whole)[:-12], "word.csv": "".join(whole).replace("\n3,", "\n3,x", 1),
            "wide.csv": "".join(whole[:4]) + whole[4].rstrip("\n") + ",7\n", "other.csv": "time,force\n0,1\n",
            "foreign.csv": "index,my.axis,coefficients.newton\n0,1,1\n", "empty.csv": "", "head.csv": whole[0],
            "regime.csv": "".join(whole).replace("REBOUND", "BOUND"),
            "nan.csv": "".join(whole).replace("\n3,0.015,", "\n3,nan,", 1)}
        for name, text in files.items():
            (WORK / name).write_text(text)
        for name in ("whole.npy", "whole.nc"):
            (WORK / f"torn{pathlib.Path(name).suffix}").write_bytes((WORK / name).read_bytes()[:-500])
        (WORK / "picture.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(20))
        (WORK / "folder").mkdir()
        for name, reason in {
                "absent.csv": "No such file or directory", "folder": "is a directory", "empty.csv": "is empty",
                "head.csv": "has no points", "torn.csv": "line 102: has 4 cells: must have 6",
                "word.csv": f'line 5: {MU} = "x0.015": must be a number', "wide.csv": "line 5: has 7 cells",
                "other.csv": "the first column must be index", "foreign.csv": "the column my.axis must be a field",
                "regime.csv": "regime = BOUND: must be the name of a regime", "table.txt": "is a table for people",
                "summary.csv": "is a summary", "part.shard-0-of-2": "ricochet merge makes one file",
                "plain.npy": "its numbers have no names", "torn.npy": "of its 101 records",
                "torn.nc": "cannot be read as NetCDF", "other.nc": "has no attribute ricochet_request",
                "torn.json": "is not a whole JSON document", "torn.jsonl": "line 101: must be a JSON object",
                "scene.json": "has no columns", "word.json": f'point 3: {MU} = "x": must be a number or null',
                "short.json": "point 3: has 5 cells: must have 6", "mixed.jsonl": "line 4: has the name fricton",
                "nan.csv": f"{MU} = nan at point 3: must be finite to be drawn",
                "picture.png": "is neither CSV nor JSON nor NPY nor NetCDF-4"}.items():
            with self.subTest(name=name):
                code, out, error = ricochet("plot", name, "-o", "refused.svg")
                self.assertEqual(out, "")
                self.assertIn(code, (2, 42))
                self.assertIn(name, error)
                self.assertIn(reason, error)
        self.assertIn("without an axis", self.refused("plot", "point.npy", code=42))
        self.assertIn("-o refused.gif: must end in .svg, .png or .pdf",
                      self.refused("plot", "whole.csv", "-o", "refused.gif"))
        self.assertIn("did you mean coefficients.newton", self.refused("plot", "whole.csv", "--column", "coefficients.nevton"))
        self.assertEqual(self.made("plot", "whole.csv", "--column", "newton", "-o", "short.svg"), "short.svg\n")
        self.assertIn("named once", self.refused("plot", "whole.csv", "--column", f"newton,{NEWTON}"))
        self.assertIn("named once", self.refused("plot", "whole.csv", "--column", f"{NEWTON},{NEWTON}"))
        self.assertIn("needs a grid of two axes", self.refused("plot", "whole.csv", "--kind", "map", code=2))
        self.assertFalse(list(WORK.glob("refused*")))


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Runs `ricochet ... --plot` and compares the pictures with the numbers of the same runs.

Usage: picture_test.py RICOCHET SCENES

A picture is read as a reader does it: the labels of an axis and the places of their ticks give its scale, and the scale
gives the number at each point of a curve.
"""

import csv
import io
import math
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

RICOCHET, SCENES = sys.argv[1:3]
SVG = "{http://www.w3.org/2000/svg}"
PENDULUM = ["--a", "0.3", "--b", "1", "--energetic", "1"]
SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


def scene(name):
    return ["--scene", os.path.join(SCENES, name)]


def run(*arguments, code=0, environment=None):
    result = subprocess.run([RICOCHET, *arguments], capture_output=True, text=True, env=environment, check=False)
    assert result.returncode == code, (arguments, result.returncode, result.stderr)
    return result


def number(label):
    """The number that the label of a tick stands for, "2×10⁻⁵" or "0.5"."""
    mantissa, power, exponent = label.partition("10") if re.match(r"^10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+$", label) else ("", "", "")
    if power:
        return 10.0 ** int(exponent.translate(SUPERSCRIPTS))
    mantissa, _, exponent = label.partition("×10")
    return float(mantissa) * 10.0 ** int(exponent.translate(SUPERSCRIPTS) or 0) if exponent else float(label)


def segments(path):
    """The connected lines of an SVG path, as lists of points."""
    lines = []
    for step, x, y in re.findall(r"([ML]?)\s*(-?[\d.]+),(-?[\d.]+)", path):
        if step == "M":
            lines.append([])
        lines[-1].append((float(x), float(y)))
    return lines


class Axis:
    """Ticks along one axis: places in pixels and labels."""

    def __init__(self):
        self.ticks = []

    def value(self, pixel, log=False):
        (p0, l0), (p1, l1) = self.ticks[0], self.ticks[-1]
        a, b = number(l0), number(l1)
        if log:
            a, b = math.log10(a), math.log10(b)
        found = a + (pixel - p0) / (p1 - p0) * (b - a)
        return 10.0**found if log else found


class Panel:
    """One panel of a picture: its axes, its curves as (stroke, dashes, lines) and its marks as (colour, x, y)."""

    def __init__(self):
        self.x, self.y, self.curves, self.marks = Axis(), Axis(), [], []


class Picture:
    def __init__(self, text):
        self.root = ElementTree.fromstring(text)
        self.texts = ["".join(element.itertext()) for element in self.root.iter(SVG + "text")]
        self.panels, panel = [], Panel()
        canvas = self.root.find(f"{SVG}g[@id='gnuplot_canvas']")
        for group in list(canvas):
            name = group.get("id") or ""
            if re.match(r"gnuplot_plot_1[a-z]*$", name):
                self.panels.append(panel)
                last, panel = panel, Panel()
            if name.startswith("gnuplot_plot_"):
                self.read_curve(group, last)
            else:
                self.read_tick(group, panel)

    @staticmethod
    def read_tick(group, panel):
        path, label = group.find(SVG + "path"), group.find(f"{SVG}g/{SVG}text")
        if path is None or label is None:
            return
        ends = segments(path.get("d"))[0]
        if ends[0][0] == ends[1][0]:
            panel.x.ticks.append((ends[0][0], "".join(label.itertext())))
        else:
            panel.y.ticks.append((ends[0][1], "".join(label.itertext())))

    @staticmethod
    def read_curve(group, panel):
        has_title = group.find(f".//{SVG}text") is not None
        for path in group.iter(SVG + "path"):
            lines = segments(path.get("d"))
            panel.curves.append((path.get("stroke"), path.get("stroke-dasharray"), lines[1:] if has_title else lines))
        marks = [(use.get("color"), *map(float, re.findall(r"-?[\d.]+", use.get("transform"))[:2]))
                 for use in group.iter(SVG + "use")]
        panel.marks += marks[:-1] if has_title else marks


class PictureTest(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.addCleanup(self.directory.cleanup)

    def path(self, name):
        return os.path.join(self.directory.name, name)

    def draw(self, *arguments):
        """Returns the picture, and the table that the run prints as csv."""
        result = run(*arguments, "--format", "csv", "--plot", self.path("picture.svg"))
        with open(self.path("picture.svg"), encoding="utf-8") as file:
            picture = Picture(file.read())
        return picture, list(csv.DictReader(io.StringIO(result.stdout)))

    def expect_points(self, panel, curve, xs, ys, log_x=False):
        """The curve goes through the points, to a pixel."""
        drawn = [point for line in panel.curves[curve][2] for point in line]
        for x, y in zip(xs, ys):
            reach_x = abs(panel.x.value(drawn[0][0] + 1, log_x) - panel.x.value(drawn[0][0], log_x))
            reach_y = abs(panel.y.value(1) - panel.y.value(0))
            if log_x:
                reach_x *= x / panel.x.value(drawn[0][0], log_x)
            near = [p for p in drawn if abs(panel.x.value(p[0], log_x) - x) <= reach_x
                    and abs(panel.y.value(p[1]) - y) <= reach_y]
            self.assertTrue(near, (curve, x, y))


class Labels(PictureTest):
    def test_units_come_from_the_field_table(self):
        picture, _ = self.draw("sweep", *scene("dropped_rod.textproto"), "--axis",
                               "compliance.linear.stiffness_n_m=log:1e4:1e8:9", "--column", "contact.peak_normal_n")
        self.assertIn("compliance linear stiffness [N/m]", picture.texts)
        self.assertIn("contact peak normal [N]", picture.texts)

    def test_indices_are_shown(self):
        picture, _ = self.draw("sweep", *scene("double_pendulum.textproto"), "--axis",
                               "linkage.links[1].theta_rad=lin:0:1:5", "--column", "rates_after_rad_s[1]")
        self.assertIn("linkage links[1] theta [rad]", picture.texts)
        self.assertIn("angular velocity after, ω+[1] [rad/s]", picture.texts)
        picture, _ = self.draw("sweep", *scene("spatial_body.json"), "--axis",
                               "friction.kinetic_coefficient=lin:0.1:0.3:3", "--column",
                               "bodies_after[0].linear_m_s[0],bodies_after[0].linear_m_s[1]")
        # Columns of one panel share the words that their names begin with.
        self.assertIn("bodies after[0] [m/s]", picture.texts)
        self.assertIn("linear[1]", picture.texts)

    def test_each_unit_has_a_panel(self):
        picture, table = self.draw("sweep", *scene("dropped_rod.textproto"), "--axis",
                                   "compliance.linear.stiffness_n_m=log:1e4:1e8:9", "--column",
                                   "contact.peak_normal_n,contact.duration_s")
        self.assertEqual(len(picture.panels), 2)
        xs = [float(row["compliance.linear.stiffness_n_m"]) for row in table]
        for panel, column in zip(picture.panels, ["contact.peak_normal_n", "contact.duration_s"]):
            self.expect_points(panel, 0, xs, [float(row[column]) for row in table], log_x=True)

    def test_labels_of_ticks_do_not_touch(self):
        for size in ["960x620", "640x400", "420x500", "1900x500"]:
            picture, _ = self.draw("solve", *scene("sphere_20.textproto"), "--size", size)
            height = float(picture.root.get("height"))
            for panel in picture.panels:
                self.assertGreater(len(panel.x.ticks), 1)
                self.assertGreater(len(panel.y.ticks), 1)
                for (a, left), (b, right) in zip(panel.x.ticks, panel.x.ticks[1:]):
                    # A letter is at least 5 pixels wide; the smallest letters are 9 pixels high.
                    self.assertGreater(b - a, 5 * (len(left) + len(right)) / 2 + 5, (size, left, right))
                for (a, _), (b, _) in zip(panel.y.ticks, panel.y.ticks[1:]):
                    self.assertGreater(abs(b - a), 12, (size, height))

    def test_the_title_is_that_of_the_user(self):
        title = "It's `date` $(date) \"now\""
        picture, _ = self.draw("solve", *PENDULUM, "--mu", "0.1", "--title", title)
        self.assertIn(title, picture.texts)


class Curves(PictureTest):
    def test_every_curve_looks_different(self):
        picture, _ = self.draw("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=lin:0.01:0.2:16", "--axis",
                               "pendulum.phi_rad=lin:0.3:1.5:5", "--column", "coefficients.newton")
        looks = [curve[:2] for curve in picture.panels[0].curves]
        self.assertEqual(len(looks), 16)
        self.assertEqual(len(set(looks)), 16)

    def test_the_points_are_those_of_the_table(self):
        picture, table = self.draw("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=0.05,0.1", "--axis",
                                   "pendulum.phi_rad=lin:0.3:1.5:20", "--column",
                                   "coefficients.newton,coefficients.poisson")
        for friction, curves in [("0.05", (0, 1)), ("0.1", (2, 3))]:
            rows = [row for row in table if row["friction.kinetic_coefficient"] == friction]
            for curve, column in zip(curves, ["coefficients.newton", "coefficients.poisson"]):
                self.expect_points(picture.panels[0], curve, [float(row["pendulum.phi_rad"]) for row in rows],
                                   [float(row[column]) for row in rows])

    def test_no_line_crosses_a_change_of_regime(self):
        picture, table = self.draw("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=lin:0.1:0.5:41",
                                   "--column", "coefficients.poisson", "--regime")
        panel = picture.panels[0]
        lines = panel.curves[0][2]
        self.assertEqual({row["regime"] for row in table}, {"REBOUND", "LOCKED"})
        self.assertEqual(len(lines), 2)
        before = max(float(row["friction.kinetic_coefficient"]) for row in table if row["regime"] == "REBOUND")
        after = min(float(row["friction.kinetic_coefficient"]) for row in table if row["regime"] == "LOCKED")
        self.assertAlmostEqual(panel.x.value(lines[0][-1][0]), before, delta=1e-3)
        self.assertAlmostEqual(panel.x.value(lines[1][0][0]), after, delta=1e-3)

    def test_invalid_points_are_crossed(self):
        picture, table = self.draw("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=lin:-0.1:0.1:11",
                                   "--column", "coefficients.newton")
        missing = [float(row["friction.kinetic_coefficient"]) for row in table
                   if row["coefficients.newton"] in ("nan", "")]
        panel = picture.panels[0]
        crosses = sorted(x for colour, x, _ in panel.marks if "127, 127, 127" in colour)
        self.assertGreater(len(missing), 3)
        self.assertEqual(len(crosses), len(missing))
        for cross, x in zip(crosses, missing):
            self.assertAlmostEqual(panel.x.value(cross), x, delta=1e-3)

    def test_rounding_is_not_a_step(self):
        # The rod slides throughout, so that F/N is -mu but for rounding.
        with open(os.path.join(SCENES, "dropped_rod.textproto"), encoding="utf-8") as file:
            rod = "".join(line for line in file if not line.startswith(("compliance", "gravity")))
        with open(self.path("rod.textproto"), "w", encoding="utf-8") as file:
            file.write(rod)
        picture, _ = self.draw("solve", "--scene", self.path("rod.textproto"))
        ratio = picture.panels[1]
        heights = [y for _, _, lines in ratio.curves for line in lines for _, y in line]
        self.assertLess(max(heights) - min(heights), 1.0)
        self.assertAlmostEqual(abs(ratio.y.value(heights[0])), 0.3, delta=0.002)
        labels = [label for _, label in ratio.y.ticks]
        self.assertEqual(len(labels), len(set(labels)))

    def test_logarithmic_axes_say_what_they_leave_out(self):
        picture, table = self.draw("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=lin:0.1:0.5:41",
                                   "--column", "coefficients.newton", "--logx", "--logy")
        zeros = sum(float(row["coefficients.newton"]) == 0.0 for row in table)
        self.assertGreater(zeros, 1)
        self.assertIn(f"{zeros} points at or below 0 not shown", picture.texts)

    def test_an_axis_of_hundreds_of_decades_ends(self):
        inertia = ["sweep", *PENDULUM, "--axis", "pendulum.inertia_kg_m2=1e-160,1,1e160", "--column", "coefficients.newton"]
        picture, _ = self.draw(*inertia)
        labels = [label for _, label in picture.panels[0].x.ticks]
        self.assertIn("1", labels)
        self.assertIn("10¹⁵⁰", labels)
        least = ["sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=5e-324", "--column", "coefficients.newton"]
        picture, _ = self.draw(*least)
        self.assertEqual(len(picture.panels[0].marks), 1)
        result = run(*least, "--logx", "--plot", self.path("p.svg"), code=2)
        self.assertIn("below 1e-300 on a logarithmic axis", result.stderr)

    def test_a_line_follows_its_axis_whatever_the_order_of_the_values(self):
        values = [0.2, 0.01, 0.25, 0.05, 0.1]
        picture, table = self.draw("sweep", *PENDULUM, "--axis",
                                   f"friction.kinetic_coefficient={','.join(map(str, values))}", "--column",
                                   "coefficients.newton")
        self.assertEqual([float(row["friction.kinetic_coefficient"]) for row in table], values)
        for line in picture.panels[0].curves[0][2]:
            self.assertEqual([x for x, _ in line], sorted(x for x, _ in line))

    def test_a_line_of_many_points_has_its_extremes_and_no_more_than_can_be_seen(self):
        picture, table = self.draw("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=lin:0:0.4:100001",
                                   "--column", "coefficients.newton")
        panel, values = picture.panels[0], [float(row["coefficients.newton"]) for row in table]
        drawn = [panel.y.value(y) for line in panel.curves[0][2] for _, y in line]
        self.assertLess(len(drawn), 40_000)
        reach = 2 * abs(panel.y.value(1) - panel.y.value(0))
        self.assertAlmostEqual(max(drawn), max(values), delta=reach)
        self.assertAlmostEqual(min(drawn), min(values), delta=reach)

    def test_no_line_crosses_rows_that_a_file_lacks(self):
        for ending in ("csv", "jsonl"):
            rows = run("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=lin:0.01:0.1:10", "--column",
                       "coefficients.newton", "--format", ending).stdout.splitlines(keepends=True)
            lines = []
            for name, kept in (("whole", rows), ("part", rows[:4] + rows[6:])):
                file = self.path(f"{name}.{ending}")
                with open(file, "w", encoding="utf-8") as written:
                    written.writelines(kept)
                run("plot", file, "-o", self.path("picture.svg"))
                with open(self.path("picture.svg"), encoding="utf-8") as drawn:
                    lines.append(len(Picture(drawn.read()).panels[0].curves[0][2]))
            self.assertEqual(lines, [1, 2], ending)

    def test_the_title_names_the_axes_that_advance_together(self):
        picture, _ = self.draw("sweep", *PENDULUM, "--zip", "--axis", "friction.kinetic_coefficient=0.1,0.2", "--axis",
                               "pendulum.b_m=0.9,1", "--column", "coefficients.newton")
        self.assertIn("Newton's coefficient of restitution over depth b, with kinetic friction μ", picture.texts)


class Scales(PictureTest):
    """Near jamming Poisson's coefficient diverges: some values own any scale that shows them all."""
    POLE = ["sweep", "--a", "0.6", "--b", "0.8", "--energetic", "1", "--regime", "--column", "coefficients.poisson"]
    MAP = [*POLE, "--axis", "friction.kinetic_coefficient=lin:0:1:41", "--axis", "pendulum.phi_rad=lin:0.05:1.5:41"]
    BROWN = "rgb(166,97,26)"

    def expect_outside(self, picture, values):
        """The line that says what is outside agrees with the values; returns the end of the scale."""
        outside = re.compile(r"(\d+) of (\d+) points lie above ([\d.]+), up to ([\d.]+)")
        said = [match for match in map(outside.fullmatch, picture.texts) if match]
        self.assertEqual(len(said), 1, picture.texts)
        above, count, end, highest = map(float, said[0].groups())
        self.assertEqual(count, len(values))
        self.assertEqual(above, sum(value > end for value in values))
        self.assertLessEqual(above, len(values) / 20)
        self.assertAlmostEqual(highest, max(values), delta=1e-5 * highest)
        # The median is not on the ground.
        self.assertGreater(sorted(values)[len(values) // 2], end / 5)
        self.assertIn(f"≥ {said[0].group(3)}", picture.texts)
        return end

    @staticmethod
    def fills(picture):
        return [polygon.get("fill").replace(" ", "") for polygon in picture.root.iter(SVG + "polygon")]

    def test_one_pole_does_not_own_the_colours(self):
        picture, table = self.draw(*self.MAP)
        locked = [row for row in table if row["regime"] == "LOCKED"]
        values = [float(row["coefficients.poisson"]) for row in table if row["regime"] != "LOCKED"]
        self.assertGreater(max(values), 100)
        self.assertGreater(len(locked), 100)
        self.expect_outside(picture, values)
        self.assertGreater(len(set(self.fills(picture))), 60)
        # One cell for each point, and the sample of the legend.
        self.assertEqual(self.fills(picture).count(self.BROWN), len(locked) + 1)
        self.assertIn("jammed (locked)", picture.texts)

    def test_one_pole_does_not_own_the_axis(self):
        picture, table = self.draw(*self.POLE, "--axis", "friction.kinetic_coefficient=lin:0:0.7499999999:201")
        values = [float(row["coefficients.poisson"]) for row in table]
        end = self.expect_outside(picture, values)
        panel = picture.panels[0]
        colour = panel.curves[0][0]
        panel.y.ticks = [(place, label.removeprefix("≥ ")) for place, label in panel.y.ticks]
        self.assertAlmostEqual(panel.y.value(min(place for place, _ in panel.y.ticks)), end)
        above = [mark for mark in panel.marks if mark[0] == colour and abs(panel.y.value(mark[2]) - end) < 0.01 * end]
        self.assertEqual(len(above), sum(value > end for value in values))

    def test_jammed_points_of_a_line_are_marked(self):
        picture, table = self.draw(*self.POLE, "--axis", "friction.kinetic_coefficient=lin:0:1:201")
        panel = picture.panels[0]
        locked = [row for row in table if row["regime"] == "LOCKED"]
        self.assertGreater(len(locked), 10)
        self.assertEqual(sum(mark[0].replace(" ", "") == self.BROWN for mark in panel.marks), len(locked))

    def test_values_of_jammed_points_are_seen(self):
        picture, table = self.draw(*self.MAP[:-6], "--column", "impulse.normal_total_n_s", *self.MAP[-4:])
        locked = [row for row in table if row["regime"] == "LOCKED"]
        self.assertGreater(len({row["impulse.normal_total_n_s"] for row in locked}), 100)
        self.assertNotIn(self.BROWN, self.fills(picture))
        marks = [mark for mark in picture.panels[0].marks if mark[0].replace(" ", "") == self.BROWN]
        self.assertEqual(len(marks), len(locked))

    def test_values_over_decades_have_a_logarithmic_scale(self):
        rod = [*scene("dropped_rod.textproto"), "--column", "contact.peak_normal_n"]
        stiffness = "compliance.linear.stiffness_n_m=log:1e-1:1e9:31"
        picture, table = self.draw("sweep", *rod, "--axis", stiffness)
        panel = picture.panels[0]
        self.assertIn("10²", [label for _, label in panel.y.ticks])
        for (x, y), row in zip((point for line in panel.curves[0][2] for point in line), table):
            self.assertAlmostEqual(math.log10(panel.y.value(y, log=True)),
                                   math.log10(float(row["contact.peak_normal_n"])), delta=0.02)

    def test_without_a_value_there_are_no_numbers(self):
        picture, table = self.draw("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=lin:-0.5:-0.1:5",
                                   "--column", "coefficients.newton")
        self.assertEqual({row["coefficients.newton"] for row in table}, {"nan"})
        self.assertEqual(picture.panels[0].y.ticks, [])
        picture, _ = self.draw("sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=-0.2,-0.1", "--axis",
                               "pendulum.phi_rad=0.1,0.2", "--column", "coefficients.newton", "--kind", "map")
        self.assertEqual(set(self.fills(picture)), {"rgb(200,200,200)"})

    def test_equal_curves_are_all_seen(self):
        columns = ["coefficients.newton", "coefficients.poisson", "coefficients.energetic"]
        picture, table = self.draw("sweep", *scene("spatial_body.json"), "--axis",
                                   "spatial_body.linear_m_s[0]=lin:1:3:31", "--column", ",".join(columns))
        for row in table:
            self.assertAlmostEqual(float(row[columns[0]]), float(row[columns[2]]), delta=1e-9)
        widths = {}
        for group in picture.root.iter(SVG + "g"):
            for path in group.findall(SVG + "path"):
                widths.setdefault(path.get("stroke"), []).append(float(group.get("stroke-width") or 0.0))
        newton, poisson, energetic = (max(widths[colour]) for colour in
                                      ["rgb(  0, 114, 178)", "rgb(213,  94,   0)", "rgb(  0, 158, 115)"])
        self.assertGreater(newton, poisson + 2)
        self.assertGreater(poisson, energetic + 2)


class Places(PictureTest):
    def places(self, picture):
        """The places of all texts, as (text, x, y, height of the letters, is it upright)."""
        found = []
        for group in picture.root.iter(SVG + "g"):
            text = group.find(SVG + "text")
            if text is not None and group.get("transform"):
                x, y = map(float, re.findall(r"-?[\d.]+", group.get("transform"))[:2])
                found.append(("".join(text.itertext()), x, y, float(group.get("font-size")),
                              "rotate" in group.get("transform")))
        return found

    def test_titles_of_panels_stand_at_one_height(self):
        picture, _ = self.draw("solve", *scene("dropped_rod.textproto"), "--tolerance", "1e-6", "--force-history", "20")
        heights = {text: y for text, _, y, _, _ in self.places(picture)}
        self.assertIn("F tangential", heights)
        self.assertEqual(heights["Forces"], heights["Indentation"])
        self.assertEqual(heights["Velocity of the contact"], heights["Normal force over indentation"])

    def test_the_label_of_the_colours_touches_no_number(self):
        columns = {"coefficients.poisson": "Poisson's", "accuracy.relative_error": "accuracy"}
        for size in ["960x620", "1280x520", "480x360"]:
            picture, _ = self.draw(*Scales.MAP, *[word for column in columns for word in ("--column", column)][2:],
                                   "--size", size)
            width = float(picture.root.get("width"))
            places = self.places(picture)
            for first, edge in zip(columns.values(), [width if size == "480x360" else width / 2, width]):
                labels = [place for place in places if place[4] and place[0].startswith(first) and place[1] > edge / 2]
                self.assertEqual(len(labels), 1, (size, places))
                label = labels[0]
                numbers = [place for place in places if not place[4] and label[1] - 10 * place[3] < place[1] < label[1]
                           and re.match(r"^(≥ )?[\d.]+(×10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?$", place[0])]
                self.assertGreater(len(numbers), 1)
                for text, x, _, height, _ in numbers:
                    # Digits of DejaVu Sans are 0.64 of the height wide, and letters reach 0.76 above their line.
                    letters = len(re.sub("[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]", "", text)) + 0.65 * len(re.findall("[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]", text))
                    self.assertGreater(label[1] - 0.76 * height, x + 0.64 * height * letters + 1, (size, text))
                self.assertLess(label[1] + 0.24 * label[3], edge, size)


class Impacts(PictureTest):
    def test_an_impact_that_takes_time_has_forces_indentation_and_loop(self):
        picture, table = self.draw("solve", *scene("dropped_rod.textproto"), "--tolerance", "1e-6",
                                   "--force-history", "40")
        self.assertEqual(len(picture.panels), 4)
        column = {name: [float(row[name]) for row in table] for name in table[0]}
        forces, depth, velocity, loop = picture.panels
        self.expect_points(forces, 0, column["time_s"], column["normal_n"])
        self.expect_points(forces, 1, column["time_s"], column["tangential_n"])
        self.expect_points(depth, 0, column["time_s"], column["indentation_m"])
        self.expect_points(velocity, 1, column["time_s"], column["normal_m_s"])
        deepest = column["indentation_m"].index(max(column["indentation_m"]))
        self.expect_points(loop, 0, column["indentation_m"][:deepest], column["normal_n"][:deepest])
        self.expect_points(loop, 1, column["indentation_m"][deepest:], column["normal_n"][deepest:])
        for unit in ["force [N]", "d [m]", "velocity [m/s]", "time t [s]"]:
            self.assertIn(unit, picture.texts)

    def test_a_picture_does_not_change_the_numbers(self):
        arguments = ["solve", *scene("dropped_rod.textproto"), "--format", "json"]
        self.assertEqual(run(*arguments, "--plot", self.path("p.svg")).stdout, run(*arguments).stdout)
        arguments = ["sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=0,0.1", "--format", "json"]
        strip = re.compile(r'"elapsed(_s|S)":[^,}]*')
        self.assertEqual(strip.sub("", run(*arguments, "--plot", self.path("p.svg")).stdout),
                         strip.sub("", run(*arguments).stdout))

    def test_the_slip_of_an_impact_in_space_is_drawn(self):
        picture, _ = self.draw("solve", *scene("turning_contact.textproto"))
        hodograph = picture.panels[0]
        # Impacts with less restitution end on the way of the one that is drawn, after its compression.
        columns = [f"contact_velocity_after.tangential_m_s[{i}]" for i in range(2)]
        with open(os.path.join(SCENES, "turning_contact.textproto"), encoding="utf-8") as file:
            text = re.sub(r"restitution \{[^}]*\}", "restitution { poisson: 0.1 }", file.read())
        with open(self.path("poisson.textproto"), "w", encoding="utf-8") as file:
            file.write(text)
        ends = list(csv.DictReader(io.StringIO(
            run("sweep", "--scene", self.path("poisson.textproto"), "--axis", "restitution.poisson=lin:0:0.7:15",
                "--column", ",".join(columns), "--format", "csv").stdout)))
        way = [(hodograph.x.value(x), hodograph.y.value(y)) for line in hodograph.curves[0][2] for x, y in line]
        for end in ends:
            u = [float(end[column]) for column in columns]
            self.assertLess(min(math.hypot(x - u[0], y - u[1]) for x, y in way), 0.004)

    def test_every_format_has_the_size(self):
        for name, head in [("p.png", b"\x89PNG"), ("p.pdf", b"%PDF"), ("p.svg", b"<?xml")]:
            run("solve", *PENDULUM, "--mu", "0.1", "--size", "700x400", "--plot", self.path(name))
            with open(self.path(name), "rb") as file:
                data = file.read()
            self.assertTrue(data.startswith(head), name)
            if name.endswith("png"):
                self.assertEqual(struct.unpack(">II", data[16:24]), (700, 400))
            if name.endswith("svg"):
                self.assertIn(b'width="700" height="400"', data)
            if name.endswith("pdf"):
                # 700 and 400 pixels of a 96th of an inch are 525 and 300 points.
                self.assertTrue(re.search(rb"/MediaBox\s*\[\s*0 0 525(\.0*)? 300(\.0*)?\s*\]", data))


class BoundsAndAudits(PictureTest):
    def test_bounds_are_bars(self):
        picture, table = self.draw("bounds", *PENDULUM, "--mu", "0.1")
        rows = {row["quantity"]: row for row in table}
        coefficients, impulse = picture.panels
        self.assertEqual([label for _, label in reversed(sorted(coefficients.y.ticks))],
                         ["tangential", "energetic", "Poisson", "Newton"])
        # One bar for each quantity, from the lower to the upper end.
        for bar, name in zip(coefficients.curves[0][2], ["newton", "poisson", "energetic", "tangential"]):
            for end, (x, _) in zip(["lower", "upper"], bar):
                self.assertAlmostEqual(coefficients.x.value(x), float(rows[name]["sharp." + end]), delta=0.005)
        (left, _), (right, _) = impulse.curves[1][2][0]
        self.assertAlmostEqual(impulse.x.value(left), float(rows["normal_total_n_s"]["energy_only.lower"]), delta=0.02)
        self.assertAlmostEqual(impulse.x.value(right), float(rows["normal_total_n_s"]["energy_only.upper"]), delta=0.02)

    def test_a_fit_shows_data_over_model_residuals_profiles_and_the_region(self):
        data = os.path.join(SCENES, "..", "falling_rod.csv")
        names = ["linear_m_s[0]=0.01", "linear_m_s[1]=0.01", "bodies_after[0].angular_rad_s[0]=0.1"]
        picture, table = self.draw("fit", *scene("falling_rod.textproto"), "--data", data, "--unknown", "mu",
                                   "--unknown", "newton", *[word for name in names for word in ("--sigma", name)],
                                   "--region", "mu,newton", "--rows")
        self.assertEqual(len(picture.panels), 7)
        with open(data, encoding="utf-8") as file:
            measured = list(csv.DictReader(line for line in file if line[0] != "#"))
        # Both marks of each row, at the first input that differs by row.
        for panel, name in zip(picture.panels, ["bodies_after[0].linear_m_s[0]", "bodies_after[0].linear_m_s[1]"]):
            self.assertEqual(len(panel.marks), 2 * len(measured))
            for row, fitted in zip(measured, table):
                for y in (float(row[name]), float(fitted[f"{name}.predicted"])):
                    x = float(row["offset_t_m"])
                    self.assertLess(min(math.hypot((panel.x.value(a) - x) * 10, panel.y.value(b) - y)
                                        for _, a, b in panel.marks), 0.02)
        self.assertEqual(len(picture.panels[3].marks), 3 * len(measured))

    def test_audited_rows_stand_at_their_impulses(self):
        data = os.path.join(SCENES, "..", "observed.csv")
        picture, table = self.draw("audit", *scene("double_pendulum.textproto"), "--data", data)
        impulse, sharp, energy = picture.panels
        valid = [row for row in table if row["regime"] != "INVALID"]
        self.assertEqual(len(impulse.marks), len(valid))
        for row in valid:
            x, y = float(row["normal_impulse_n_s"]), float(row["tangential_impulse_n_s[0]"])
            self.assertLess(min(math.hypot(impulse.x.value(a) - x, impulse.y.value(b) - y)
                                for _, a, b in impulse.marks), 0.01)
            x, y = float(row["index"]), float(row["energy_change_j"])
            self.assertLess(min(math.hypot(energy.x.value(a) - x, energy.y.value(b) - y)
                                for _, a, b in energy.marks), 0.02)
        # The invalid rows are crossed at the lower edge.
        self.assertEqual(len(sharp.marks), len(table))


class Failures(PictureTest):
    def test_without_gnuplot_the_numbers_come(self):
        arguments = ["sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=0.1,0.2", "--format", "csv"]
        result = run(*arguments, "--plot", self.path("p.svg"), code=42, environment={"PATH": "/nonexistent"})
        self.assertEqual(result.stdout, run(*arguments).stdout)
        self.assertIn("the numbers are complete, but", result.stderr)
        self.assertIn("gnuplot, which is not installed", result.stderr)
        self.assertEqual(os.listdir(self.directory.name), [])

    def test_with_too_many_curves_the_numbers_come(self):
        arguments = ["sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=lin:0.1:0.2:50", "--axis",
                     "pendulum.b_m=0.9,1", "--column", "coefficients.newton", "--format", "csv"]
        result = run(*arguments, "--plot", self.path("p.svg"), code=42)
        self.assertEqual(result.stdout, run(*arguments).stdout)
        self.assertIn("more than 49 curves", result.stderr)

    def test_options_of_a_picture_need_one(self):
        sweep = ["sweep", *PENDULUM, "--axis", "friction.kinetic_coefficient=0.1,0.2", "--column", "coefficients.newton"]
        for option in [["--size", "640x400"], ["--title", "x"], ["--logy"], ["--kind", "map"]]:
            result = run(*sweep, *option, code=2)
            self.assertIn(f": {option[0]} needs --plot FILE", result.stderr)
        result = run(*sweep, "--logx", "--title", "x", code=2)
        self.assertIn(": --title and --logx need --plot FILE", result.stderr)
        for size in ["640", "640x", "10x400", "640x400x2", "99999x400"]:
            result = run("solve", *PENDULUM, "--plot", self.path("p.svg"), "--size", size, code=2)
            self.assertIn("WIDTHxHEIGHT in pixels", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])

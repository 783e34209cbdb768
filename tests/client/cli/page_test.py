"""Checks the page that `ricochet cost --html` writes: it is well-formed, stands alone, and shows every method.

usage: page_test.py RICOCHET WORK_DIRECTORY
"""

import json
import re
import shutil
import subprocess
import sys
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

WORK, RICOCHET = [Path(sys.argv.pop()).resolve() for _ in range(2)]
SCENE = ["--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "1"]


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        done = subprocess.run(
            [RICOCHET, "cost", *SCENE, "--time-limit", "1s", "--html", "page.html", "--format", "json"], cwd=WORK,
            check=True, capture_output=True, text=True)
        cls.study = json.loads(done.stdout)
        cls.text = (WORK / "page.html").read_text(encoding="utf-8")
        cls.page = ElementTree.fromstring(cls.text)

    def test_leaves_nothing_beside_the_page(self):
        self.assertEqual([path.name for path in WORK.iterdir()], ["page.html"])

    def test_needs_nothing_from_elsewhere(self):
        self.assertNotIn("http", self.text)
        for element in self.page.iter():
            self.assertNotIn(element.tag, ("script", "link", "img", "iframe", "image"))
            for name in ("src", "data", "srcset"):
                self.assertNotIn(name, element.attrib)
        self.assertNotIn("@import", self.text)

    def test_ids_are_unique_and_every_reference_has_one(self):
        ids = [element.attrib["id"] for element in self.page.iter() if "id" in element.attrib]
        self.assertGreater(len(ids), 20)
        self.assertEqual(len(ids), len(set(ids)))
        used = [element.attrib["href"] for element in self.page.iter() if "href" in element.attrib]
        used += ["#" + name for name in re.findall(r"url\(#([^)]+)\)", self.text)]
        self.assertGreater(len(used), 20)
        for reference in used:
            self.assertTrue(reference.startswith("#"), reference)
            self.assertIn(reference[1:], ids)

    def test_has_both_pictures_in_two_widths(self):
        pictures = list(self.page.iter("svg"))
        self.assertEqual(len(pictures), 4)
        for picture in pictures:
            self.assertTrue(picture.find("title").text)
            self.assertGreater(len(list(picture.iter("use"))), 5)

    def test_shows_every_method(self):
        table = next(self.page.iter("table"))
        shown = [row.find("td").text for row in table.find("tbody")]
        self.assertEqual(shown, [row["name"] for row in self.study["rows"]])
        heads = len(list(table.iter("th")))
        for row in table.find("tbody"):
            self.assertEqual(len(row.findall("td")), heads)

    def test_names_machine_compiler_version_date_and_scene(self):
        text = " ".join(self.page.itertext())
        machine = self.study["summary"]["machine"]
        for part in (machine["cpu"], machine["compiler"], self.study["engine"]["version"], "inertia_kg_m2: 1"):
            self.assertIn(part, text)
        self.assertRegex(text, r"\d{4}-\d\d-\d\d \d\d:\d\d UTC")

    def test_no_answer_errs_by_more_than_it_claims(self):
        self.assertEqual(self.study["summary"]["deceived"], 0)
        self.assertRegex(self.text, "Errors claimed and made: 0 of [0-9]+ claim too little")


if __name__ == "__main__":
    unittest.main()

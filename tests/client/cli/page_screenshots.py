"""Opens a page in headless Chromium, 1280 and 400 pixels wide, by day and by night, takes screenshots, and checks that it
can be read: nothing is written to the console, nothing is cut off at the right, and no text is too small.

usage: page_screenshots.py PAGE.html DIRECTORY

It needs chromium and chromium-driver of Debian.
"""

import sys
import unittest
from pathlib import Path

from browser import Browser, CUT_OFF, CUT_OFF_IN_PICTURES, SMALLEST_TEXT

DIRECTORY, PAGE = [Path(sys.argv.pop()).resolve() for _ in range(2)]
LEAST_TEXT_PX = 10


class ScreenshotsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        DIRECTORY.mkdir(parents=True, exist_ok=True)
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)

    def open(self, width, scheme):
        self.browser.look_like(width, scheme)
        self.browser.open(PAGE.as_uri())

    def test_can_be_read_on_wide_and_narrow_screens(self):
        for width in (1280, 400):
            for scheme in ("light", "dark"):
                with self.subTest(width=width, scheme=scheme):
                    self.open(width, scheme)
                    self.assertEqual(self.browser.script("return window.innerWidth"), width)
                    self.assertEqual(self.browser.script(CUT_OFF), [])
                    self.assertEqual(self.browser.script(CUT_OFF_IN_PICTURES), [])
                    self.assertGreaterEqual(self.browser.script(SMALLEST_TEXT), LEAST_TEXT_PX)
                    self.browser.screenshot(DIRECTORY / f"{PAGE.stem}-{width}-{scheme}.png")

    def test_each_width_shows_its_own_pictures(self):
        visible = "return [...document.querySelectorAll('svg')].filter(p => p.getClientRects().length > 0).length"
        for width in (1280, 400):
            self.open(width, "light")
            self.assertEqual(self.browser.script(visible), 2)

    def test_writes_nothing_to_the_console(self):
        self.open(1280, "light")
        self.assertEqual(self.browser.console(), [])
        self.browser.script("console.error('seen')")
        self.assertEqual(len(self.browser.console()), 1)


if __name__ == "__main__":
    unittest.main()

"""Opens a page in headless Chromium, 1280 and 400 pixels wide, by day and by night, takes screenshots, and checks that it
can be read: nothing is written to the console, nothing is cut off at the right, and no text is too small.

usage: page_screenshots.py PAGE.html DIRECTORY

It speaks WebDriver to chromedriver, of Debian's package chromium-driver.
"""

import base64
import json
import re
import subprocess
import sys
import tempfile
import unittest
import urllib.request
from pathlib import Path

DIRECTORY, PAGE = [Path(sys.argv.pop()).resolve() for _ in range(2)]
LEAST_TEXT_PX = 10
BROWSER_ARGUMENTS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--hide-scrollbars"
]

# The height in pixels of a capital letter's line of every visible text, in the page and in its pictures.
SMALLEST_TEXT = """
  let least = 1e9;
  for (const element of document.querySelectorAll('h1, h2, p, td, th, dt, dd, pre, figcaption, li, svg text')) {
    if (element.getClientRects().length === 0) continue;
    const matrix = element.getScreenCTM ? element.getScreenCTM() : null;
    const part = matrix ? element.querySelector('tspan') || element : element;
    const size = parseFloat(getComputedStyle(part).fontSize) * (matrix ? Math.hypot(matrix.a, matrix.b) : 1);
    least = Math.min(least, size);
  }
  return least;"""

# Visible elements that reach beyond the right edge of the window, except in boxes that scroll.
CUT_OFF = """
  return [...document.querySelectorAll('body *')].filter(element =>
    element.closest('pre, svg') === null && element.getBoundingClientRect().right > window.innerWidth + 0.5)
    .map(element => element.outerHTML.slice(0, 80));"""

# Texts of pictures that reach beyond the picture.
CUT_OFF_IN_PICTURES = """
  const cut = [];
  for (const picture of document.querySelectorAll('svg')) {
    if (picture.getClientRects().length === 0) continue;
    const frame = picture.getBoundingClientRect();
    for (const text of picture.querySelectorAll('text')) {
      const box = text.getBoundingClientRect();
      if (box.width > 0 && (box.left < frame.left - 1 || box.right > frame.right + 1 || box.bottom > frame.bottom + 1)) {
        cut.push(text.textContent);
      }
    }
  }
  return cut;"""


class Browser:
    """One session of WebDriver, with Chromium's own commands."""

    def __init__(self, profile):
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
        for line in self.driver.stdout:
            started = re.search(r"started successfully on port (\d+)", line)
            if started:
                self.address = f"http://127.0.0.1:{started.group(1)}/session"
                break
        options = {"args": [*BROWSER_ARGUMENTS, f"--user-data-dir={profile}"]}
        wanted = {"browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        session = self.post("", {"capabilities": {"alwaysMatch": wanted}})
        self.address += "/" + session["sessionId"]

    def post(self, path, body):
        request = urllib.request.Request(
            self.address + path, json.dumps(body).encode(), {"Content-Type": "application/json"})
        with urllib.request.urlopen(request, timeout=60) as response:
            return json.load(response)["value"]

    def command(self, name, **parameters):
        return self.post("/goog/cdp/execute", {"cmd": name, "params": parameters})

    def script(self, text):
        return self.post("/execute/sync", {"script": text, "args": []})

    def close(self):
        urllib.request.urlopen(urllib.request.Request(self.address, method="DELETE"), timeout=60).close()
        self.driver.terminate()
        self.driver.wait()
        self.driver.stdout.close()


class ScreenshotsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        DIRECTORY.mkdir(parents=True, exist_ok=True)
        profile = tempfile.TemporaryDirectory()
        cls.addClassCleanup(profile.cleanup)
        cls.browser = Browser(profile.name)
        cls.addClassCleanup(cls.browser.close)

    def open(self, width, scheme):
        self.browser.command(
            "Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=width < 700)
        self.browser.command("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.browser.post("/url", {"url": PAGE.as_uri()})

    def test_can_be_read_on_wide_and_narrow_screens(self):
        for width in (1280, 400):
            for scheme in ("light", "dark"):
                with self.subTest(width=width, scheme=scheme):
                    self.open(width, scheme)
                    self.assertEqual(self.browser.script("return window.innerWidth"), width)
                    self.assertEqual(self.browser.script(CUT_OFF), [])
                    self.assertEqual(self.browser.script(CUT_OFF_IN_PICTURES), [])
                    self.assertGreaterEqual(self.browser.script(SMALLEST_TEXT), LEAST_TEXT_PX)
                    picture = self.browser.command("Page.captureScreenshot", captureBeyondViewport=True)
                    (DIRECTORY / f"{PAGE.stem}-{width}-{scheme}.png").write_bytes(base64.b64decode(picture["data"]))

    def test_each_width_shows_its_own_pictures(self):
        visible = "return [...document.querySelectorAll('svg')].filter(p => p.getClientRects().length > 0).length"
        for width in (1280, 400):
            self.open(width, "light")
            self.assertEqual(self.browser.script(visible), 2)

    def test_writes_nothing_to_the_console(self):
        self.open(1280, "light")
        self.assertEqual(self.browser.post("/se/log", {"type": "browser"}), [])
        self.browser.script("console.error('seen')")
        self.assertEqual(len(self.browser.post("/se/log", {"type": "browser"})), 1)


if __name__ == "__main__":
    unittest.main()

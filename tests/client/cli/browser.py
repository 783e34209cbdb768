"""Browser: headless Chromium by WebDriver, and scripts that say whether a page can be read.

It needs chromium and chromium-driver of Debian.
"""

import base64
import json
import re
import subprocess
import tempfile
import urllib.request

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

    def __init__(self):
        self.profile = tempfile.TemporaryDirectory()
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True)
        for line in self.driver.stdout:
            started = re.search(r"started successfully on port (\d+)", line)
            if started:
                self.address = f"http://127.0.0.1:{started.group(1)}/session"
                break
        options = {"args": [*BROWSER_ARGUMENTS, f"--user-data-dir={self.profile.name}"]}
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

    def console(self):
        """Returns what the pages have written there since the last look."""
        return self.post("/se/log", {"type": "browser"})

    def look_like(self, width, scheme):
        self.command("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1,
                     mobile=width < 700)
        self.command("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])

    def open(self, address):
        self.post("/url", {"url": address})

    def screenshot(self, path):
        picture = self.command("Page.captureScreenshot", captureBeyondViewport=True)
        path.write_bytes(base64.b64decode(picture["data"]))

    def close(self):
        urllib.request.urlopen(urllib.request.Request(self.address, method="DELETE"), timeout=60).close()
        self.driver.terminate()
        self.driver.wait()
        self.driver.stdout.close()
        self.profile.cleanup()

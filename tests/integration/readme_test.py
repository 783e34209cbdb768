"""Runs the examples of README.md, CONTRIBUTING.md and docs/, and checks that these pages name only what exists.

usage: readme_test.py SOURCE_DIRECTORY RICOCHET RICOCHETD WORK_DIRECTORY
"""

import os
import re
import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path

from page import commands_and_outputs, files, without_times

WORK, RICOCHETD, RICOCHET, SOURCE = [Path(sys.argv.pop()).resolve() for _ in range(4)]
ADDRESS = "127.0.0.1:50051"  # The pages write this address; the server of this test has a port of its own.
README = SOURCE / "README.md"
PAGES = {
    path: path.read_text()
    for path in [
        README, *sorted(SOURCE.glob("C*.md")), SOURCE / "deploy/README.md", SOURCE / "tests/data/README.md",
        *sorted((SOURCE / "docs").rglob("*.md"))]
}
EQUATIONS = 60
MOST_README_LINES = 130
WAIT_S = 10


def blocks(language, page):
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGES[page], re.MULTILINE | re.DOTALL)


def picture(path):
    """All of an SVG but the version of gnuplot."""
    return re.sub(r"<desc>.*?</desc>", "", path.read_text(), flags=re.DOTALL)


def shell(command):
    path = os.pathsep.join([str(RICOCHET.parent), "/usr/bin", "/bin"])
    done = subprocess.run(
        ["/bin/bash", "-c", command], cwd=WORK, env={**os.environ, "PATH": path}, text=True,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return done.returncode, done.stdout


class ExamplesTest(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        (WORK / "proto").symlink_to(SOURCE / "proto")
        (WORK / "tests").symlink_to(SOURCE / "tests")
        port_file = WORK / "port"
        with open(WORK / "server.log", "w", encoding="utf-8") as log:
            server = subprocess.Popen(
                [RICOCHETD, "--listen", "127.0.0.1:0", "--port-file", port_file, "--drain-grace", "0"], stderr=log)
        cls.addClassCleanup(server.wait)
        cls.addClassCleanup(server.terminate)
        deadline = time.monotonic() + WAIT_S
        while not (port_file.exists() and port_file.read_text()):
            if server.poll() is not None or time.monotonic() > deadline:
                raise RuntimeError((WORK / "server.log").read_text())
            time.sleep(0.05)
        cls.address = f"127.0.0.1:{port_file.read_text().strip()}"
        cls.write_files()

    @classmethod
    def write_files(cls):
        """Writes every block that follows "A file `NAME`:"."""
        for text in PAGES.values():
            for name, content in files(text):
                (WORK / name).write_text(content.replace(ADDRESS, cls.address))

    def test_commands_print_what_the_pages_show(self):
        count = 0
        for page in PAGES:
            for command, output in commands_and_outputs(PAGES[page]):
                with self.subTest(page=page.name, command=command):
                    _, printed = shell(command.replace(ADDRESS, self.address))
                    self.assertEqual(without_times(printed), without_times(output))
                count += 1
        self.assertGreaterEqual(count, 8)
        for name in ["figure4.svg", "dropped_rod.svg", "fit_rod.svg", "spheres.svg"]:
            self.assertEqual(picture(WORK / name), picture(SOURCE / "docs/images" / name), name)

    def test_cpp_is_compiled_by_the_consumer_project(self):
        compiled = [path.read_text() for path in sorted([*(SOURCE / "tests/consumer").glob("*.cc"),
                                                              *(SOURCE / "tests/robots").glob("*.cc")])]
        count = 0
        for page in PAGES:
            for block in blocks("cpp", page):
                self.assertTrue(any(block in source for source in compiled), block)
                count += 1
        self.assertGreater(count, 0)


class PagesTest(unittest.TestCase):
    def test_examples_print_the_message_of_a_status_and_not_its_data(self):
        for page in PAGES:
            for block in blocks("cpp", page):
                self.assertNotRegex(block, r"<<\s*[\w.>-]*status\(\)\s*(<<|;)")

    def test_readme_is_short(self):
        self.assertLessEqual(PAGES[README].count("\n"), MOST_README_LINES)

    def test_every_command_of_the_dev_script_is_listed(self):
        dev = (SOURCE / "dev").read_text()
        defined = re.findall(r"^cmd_([a-z]+)\(\)|^  \[([a-z]+)\]=", dev, re.MULTILINE)
        listed = re.findall(r"^\| `\./dev ([a-z]+)` \|", "\n".join(PAGES.values()), re.MULTILINE)
        self.assertEqual(sorted(listed), sorted(name or script for name, script in defined))

    def test_links_lead_somewhere(self):
        for page, text in PAGES.items():
            for target in re.findall(r"\]\((?!https?:|#)([^)#]+)", text):
                self.assertTrue((page.parent / target).exists(), f"{page}: {target}")

    def test_links_to_headings_lead_to_headings(self):
        for page, text in PAGES.items():
            for target, heading in re.findall(r"\]\((?!https?:)([^)#]*)#([^)]+)\)", text):
                linked = (page.parent / target).resolve() if target else page
                headings = re.findall(r"^#+ (.*)$", PAGES[linked], re.MULTILINE)
                anchors = [re.sub(r"[^\w -]", "", line.lower()).replace(" ", "-") for line in headings]
                self.assertIn(heading, anchors, f"{page}: {linked}")

    def test_every_page_on_the_theory_is_listed(self):
        listed = re.findall(r"^\| \[([\w.]+)\]\(\1\) \|", PAGES[SOURCE / "docs/theory/README.md"], re.MULTILINE)
        pages = [page.name for page in (SOURCE / "docs/theory").glob("*.md") if page.name != "README.md"]
        self.assertEqual(sorted(listed), sorted(pages))

    def test_every_equation_of_the_paper_is_mapped(self):
        mapped = set()
        for first, last in re.findall(
                r"^\| \[(\d+)\](?:-\[(\d+)\])? \|", PAGES[SOURCE / "docs/theory/pendulum.md"], re.MULTILINE):
            mapped.update(range(int(first), int(last or first) + 1))
        self.assertEqual(mapped, set(range(1, EQUATIONS + 1)))

    def test_every_test_they_name_exists(self):
        defined = set()
        for path in (SOURCE / "tests").rglob("*.cc"):
            defined.update(re.findall(r"^TEST(?:_[FP])?\((\w+),\s+(\w+)\)", path.read_text(), re.MULTILINE))
        named = re.findall(r"\b(\w+Test|Cli|SolverContract|SameBits)\.([A-Z]\w+)", "\n".join(PAGES.values()))
        self.assertGreater(len(named), 30)
        self.assertEqual(sorted(set(named) - defined), [])

    def test_every_file_and_folder_they_name_exists(self):
        paths = re.findall(
            r"`((?:core|tests|client|server|proto|deploy|docs)/[a-z0-9_./-]*)`", "\n".join(PAGES.values()))
        self.assertEqual([path for path in sorted(set(paths)) if not (SOURCE / path).exists()], [])

    def test_every_source_that_the_scripts_name_exists(self):
        scripts = [SOURCE / "dev", *(SOURCE / "tools").glob("*.sh"), *(SOURCE / "tests").rglob("*.sh")]
        paths = re.findall(
            r"(?<![\w./$}*-])((?:core|tests|client|server|proto|deploy|docs|packaging|tools)/[a-z0-9_./-]*[a-z0-9_])"
            r"(?![\w*$/{])",
            "\n".join(path.read_text() for path in scripts))
        self.assertGreater(len(paths), 50)
        self.assertEqual([path for path in sorted(set(paths)) if not (SOURCE / path).exists()], [])

    def test_every_output_of_the_pendulum_they_name_exists(self):
        header = (SOURCE / "core/models/pendulum/pendulum.h").read_text()
        for output in re.findall(r"`(k[A-Z]\w+)`", PAGES[SOURCE / "docs/theory/pendulum.md"]):
            self.assertRegex(header, rf"\b{output}\b")


if __name__ == "__main__":
    unittest.main()

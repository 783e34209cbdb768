"""Does what README.md says and demands what it shows; checks that core/README.md names what exists.

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

WORK, RICOCHETD, RICOCHET, SOURCE = [Path(sys.argv.pop()).resolve() for _ in range(4)]
ADDRESS = "127.0.0.1:50051"  # As the README writes it; the server of this test has a port of its own.
README = (SOURCE / "README.md").read_text()
CORE_README = (SOURCE / "core/README.md").read_text()
EQUATIONS = 60
WAIT_S = 10


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


def commands_and_outputs():
    for block in blocks("console"):
        for command, output in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", block, re.MULTILINE):
            yield command, output


def without_times(text):
    return re.sub(r" in [0-9.e-]+ s\n", " in ELAPSED s\n", text)


def picture(path):
    """All of an SVG but the version of gnuplot."""
    return re.sub(r"<desc>.*?</desc>", "", path.read_text(), flags=re.DOTALL)


def shell(command):
    path = os.pathsep.join([str(RICOCHET.parent), "/usr/bin", "/bin"])
    done = subprocess.run(
        ["/bin/bash", "-c", command], cwd=WORK, env={**os.environ, "PATH": path}, text=True,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return done.returncode, done.stdout


class ReadmeTest(unittest.TestCase):
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

    def prepare_python(self):
        stubs = [block for block in blocks("sh") if "protoc" in block]
        self.assertEqual(len(stubs), 1)
        self.assertEqual(shell(stubs[0]), (0, ""))
        programs = blocks("python")
        self.assertEqual(len(programs), 1)
        self.assertIn(ADDRESS, programs[0])
        (WORK / "ask.py").write_text(programs[0].replace(ADDRESS, self.address))

    def test_commands_print_what_the_readme_shows(self):
        self.prepare_python()
        count = 0
        for command, output in commands_and_outputs():
            with self.subTest(command):
                _, printed = shell(command.replace(ADDRESS, self.address))
                self.assertEqual(without_times(printed), without_times(output))
            count += 1
        self.assertGreaterEqual(count, 8)
        self.assertEqual(picture(WORK / "figure4.svg"), picture(SOURCE / "client/cli/figure4.svg"))

    def test_cpp_is_compiled_by_the_consumer_project(self):
        compiled = (SOURCE / "tests/consumer/main.cc").read_text()
        self.assertTrue(blocks("cpp"))
        for block in blocks("cpp"):
            self.assertIn(block, compiled)

    def test_every_command_of_the_dev_script_is_listed(self):
        defined = re.findall(r"^cmd_([a-z]+)\(\)", (SOURCE / "dev").read_text(), re.MULTILINE)
        listed = re.findall(r"^\| `\./dev ([a-z]+)` \|", README, re.MULTILINE)
        self.assertEqual(sorted(listed), sorted(defined))

    def test_links_lead_somewhere(self):
        for folder, text in ((SOURCE, README), (SOURCE / "core", CORE_README)):
            for target in re.findall(r"\]\((?!https?:|#)([^)#]+)\)", text):
                self.assertTrue((folder / target).exists(), target)


class EquationMapTest(unittest.TestCase):
    def test_every_equation_of_the_paper_is_mapped(self):
        mapped = set()
        for first, last in re.findall(r"^\| \[(\d+)\](?:-\[(\d+)\])? \|", CORE_README, re.MULTILINE):
            mapped.update(range(int(first), int(last or first) + 1))
        self.assertEqual(mapped, set(range(1, EQUATIONS + 1)))

    def test_every_test_it_names_exists(self):
        defined = set()
        for path in (SOURCE / "tests").rglob("*.cc"):
            defined.update(re.findall(r"^TEST(?:_[FP])?\((\w+), (\w+)\)", path.read_text(), re.MULTILINE))
        named = re.findall(r"\b(\w+Test|Cli|SolverContract|SameBits)\.(\w+)", CORE_README)
        self.assertGreater(len(named), 30)
        for test in named:
            self.assertIn(test, defined)

    def test_every_file_and_output_it_names_exists(self):
        for path in re.findall(r"`((?:core|tests|models|laws|numerics|scene|sweep)/[\w./-]+\.(?:h|cc|csv))`", CORE_README):
            self.assertTrue((SOURCE / path).exists() or (SOURCE / "core" / path).exists(), path)
        header = (SOURCE / "core/models/pendulum/pendulum.h").read_text()
        for output in re.findall(r"`(k[A-Z]\w+)`", CORE_README):
            self.assertRegex(header, rf"\b{output}\b")


if __name__ == "__main__":
    unittest.main()

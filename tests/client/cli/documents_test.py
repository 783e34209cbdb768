"""Every command of the documents that the machine and the day do not change prints what it has always printed.

A page shows a part of what its commands print; here all of standard output, standard error and the exit code is held, the
bytes of the tables that they write, and those of the same answers as csv, json and jsonl. RICOCHET_UPDATE_GOLDEN=1 rewrites
the record.

usage: documents_test.py RICOCHET SOURCE_DIRECTORY WORK_DIRECTORY
"""
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

WORK, SOURCE, RICOCHET = [pathlib.Path(sys.argv.pop()).resolve() for _ in range(3)]
sys.path.append(str(SOURCE / "tests/integration"))
from page import commands_and_outputs, files, without_times  # noqa: E402

PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs").rglob("*.md"))]
GOLDEN = SOURCE / "tests/data/golden/documents.txt"
# Times differ from run to run, and a server has a test of its own.
VARYING = ("ricochet cost", "--server", "python3")

# Stands before the program in the path, so that pipes and loops run as they stand in the page.
SHIM = """#!/bin/bash
call=$(mktemp -d -p {calls})
printf '%s' "$*" > $call/words
{program} "$@" > $call/out 2> $call/err
code=$?
printf '%s' $code > $call/code
cat $call/err >&2
cat $call/out
exit $code
"""


def normalised(text):
    """The text without times and without what differs from release to release."""
    text = re.sub(r'"version":"[0-9.]+","fingerprint":"[0-9a-f]{16}"', '"version":"V","fingerprint":"F"', text)
    text = re.sub(r'"elapsed_s":[0-9.e+-]+', '"elapsed_s":ELAPSED', text)
    return without_times(text)


def record(call):
    """Holds what one call printed."""
    words, out, err, code = ((call / name).read_text() for name in ("words", "out", "err", "code"))
    text = f"$ ricochet {words}\n{normalised(out)}"
    return text + (f"Standard error:\n{normalised(err)}" if err else "") + f"Exit code: {code}\n"


def sha256(content):
    return hashlib.sha256(content).hexdigest()


def in_other_formats(call):
    """The sums of what a call prints in the formats for programs; none for one that is no answer or names its format."""
    words = (call / "words").read_text().split()
    if words[0] not in ("solve", "bounds", "sweep", "audit", "merge") or {"-o", "--format"} & set(words):
        return ""
    text = ""
    for name in ("csv", "json", "jsonl"):
        done = subprocess.run([RICOCHET, *words, "--format", name], cwd=WORK / "run", stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False, timeout=120)
        text += f"as {name}: {sha256((normalised(done.stdout) + normalised(done.stderr)).encode())}\n"
    return text


class DocumentsTest(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        for name in ("bin", "calls", "run"):
            (WORK / name).mkdir(parents=True)
        shim = WORK / "bin/ricochet"
        shim.write_text(SHIM.format(calls=WORK / "calls", program=RICOCHET))
        shim.chmod(0o755)
        (WORK / "run/tests").symlink_to(SOURCE / "tests")
        for page in PAGES:
            cls.run_commands(page.read_text())
        cls.printed = cls.all_printed()

    @classmethod
    def run_commands(cls, text):
        for name, content in files(text):
            (WORK / "run" / name).write_text(content)
        environment = {**os.environ, "PATH": f"{WORK / 'bin'}:/usr/bin:/bin"}
        for command, _ in commands_and_outputs(text):
            if any(word in command for word in VARYING):
                continue
            subprocess.run(["/bin/bash", "-c", command], cwd=WORK / "run", env=environment, stdin=subprocess.DEVNULL,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False, timeout=120)

    @staticmethod
    def all_printed():
        """The record: the calls in the order of their words, and the tables that they wrote."""
        calls = sorted({record(call) + in_other_formats(call) for call in (WORK / "calls").iterdir()})
        tables = [f"{path.name} {sha256(path.read_bytes())}\n"
                  for path in sorted((WORK / "run").iterdir()) if path.suffix in (".csv", ".npy")]
        return "\n".join(calls) + "\nSHA-256 of tables\n" + "".join(tables)

    def test_every_command_prints_what_it_always_printed(self):
        if os.environ.get("RICOCHET_UPDATE_GOLDEN"):
            GOLDEN.write_text(self.printed)
        self.assertEqual(self.printed, GOLDEN.read_text())

    def test_many_commands_were_run(self):
        self.assertGreater(self.printed.count("\n$ ricochet "), 30)


if __name__ == "__main__":
    unittest.main()

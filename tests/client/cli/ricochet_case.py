"""RicochetCase: a test that runs the command line in a work directory of its own.

usage: TEST.py RICOCHET WORK_DIRECTORY
"""
import pathlib
import shutil
import subprocess
import sys
import unittest

WORK, RICOCHET = [pathlib.Path(sys.argv.pop()).resolve() for _ in range(2)]


def ricochet(*arguments):
    done = subprocess.run([RICOCHET, *arguments], cwd=WORK, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          check=False, timeout=120)
    return done.returncode, done.stdout, done.stderr


class RicochetCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)

    def made(self, *arguments):
        """Returns what the command prints, which must succeed."""
        code, out, error = ricochet(*arguments)
        self.assertEqual(code, 0, error)
        return out

    def refused(self, *arguments, code=2):
        """Returns what the command says when it fails, which must print nothing else."""
        found, out, error = ricochet(*arguments)
        self.assertEqual((found, out), (code, ""), error)
        return error

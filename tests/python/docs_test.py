"""Runs the Python examples of docs/python.md and of the package, and compares what they print."""

import doctest
import re
import unittest

import ricochet
from ricochet import units
from support import SOURCE, main

PAGE = SOURCE / "docs/python.md"
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


class Examples(unittest.TestCase):
    def run_examples(self, test):
        report = []
        runner = doctest.DocTestRunner(optionflags=FLAGS)
        failed, attempted = runner.run(test, out=report.append)
        self.assertGreater(attempted, 0)
        self.assertEqual(failed, 0, "".join(report))

    def test_page(self):
        # One program: a block goes on where the last one ended.
        blocks = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
        text = "\n".join(blocks)
        self.run_examples(doctest.DocTestParser().get_doctest(text, {}, PAGE.name, str(PAGE), 0))

    def test_docstrings(self):
        for module in (ricochet, units):
            for test in doctest.DocTestFinder().find(module):
                if test.examples:
                    with self.subTest(test.name):
                        self.run_examples(test)


if __name__ == "__main__":
    main()

"""docs/cli.md lists the options that the program has. RICOCHET_UPDATE_GOLDEN=1 writes the list anew.

usage: options_page_test.py DESCRIBE PAGE
"""
import json
import os
import pathlib
import subprocess
import sys
import textwrap
import unittest

PAGE, DESCRIBE = [pathlib.Path(sys.argv.pop()).resolve() for _ in range(2)]
FIRST = "<!-- The lists below are made from the program: tests/client/cli/options_page_test.py writes them. -->\n"
LAST = "<!-- The lists above are made from the program. -->\n"
WIDTH, INDENT = 100, 30


def commands_of(command, words=()):
    """Yields the words of each subcommand that does something, and its options."""
    for sub in command.get("commands", []):
        yield from commands_of(sub, (*words, sub["name"]))
    if words and not command.get("commands"):
        yield " ".join(words), command["options"]


def entry(option):
    """An option as the help shows it."""
    names = option["positional"] or ",".join(option["names"])
    head = names if option["positional"] else f"{names} {option['value']}".rstrip()
    text = textwrap.wrap(option["description"], WIDTH - INDENT, break_on_hyphens=False, break_long_words=False)
    first = [head.ljust(INDENT) + text[0]] if len(head) < INDENT else [head, " " * INDENT + text[0]]
    return "\n".join(line.rstrip() for line in [*first, *(" " * INDENT + line for line in text[1:])])


def lists(program):
    """A list for each set of subcommands that have the same options, in the order of the help."""
    commands = {}
    for name, options in commands_of(program):
        for option in options:
            commands.setdefault(entry(option), []).append(name)
    entries = {}
    for text, names in commands.items():
        entries.setdefault(tuple(names), []).append(text)
    every = len(list(commands_of(program)))
    for names, texts in entries.items():
        # A name of two words stays on one line.
        title = ", ".join(f"`{name}`".replace(" ", "\u00a0") for name in names)
        title = textwrap.fill("Every subcommand:" if len(names) == every else f"{title}:", 120)
        yield title.replace("\u00a0", " ") + "\n\n```text\n" + "\n".join(texts) + "\n```\n"


class OptionsPageTest(unittest.TestCase):
    maxDiff = None

    def test_the_page_lists_the_options_of_the_program(self):
        described = json.loads(subprocess.run([DESCRIBE], capture_output=True, check=True, timeout=120).stdout)
        program = next(one for one in described["programs"] if one["name"] == "ricochet")
        for name, options in commands_of(program):
            for option in options:
                self.assertNotRegex(option["description"], r"\bdefault\b", f"{name}: a default stands in brackets")
        page = PAGE.read_text()
        before, rest = page.split(FIRST)
        listed, after = rest.split(LAST)
        made = "\n" + "\n".join(lists(program)) + "\n"
        if os.environ.get("RICOCHET_UPDATE_GOLDEN"):
            PAGE.write_text(before + FIRST + made + LAST + after)
            listed = made
        self.assertEqual(listed, made)


if __name__ == "__main__":
    unittest.main()

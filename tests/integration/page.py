"""The examples of a page: what its console blocks run and print, and the files that it shows.

As a program it runs the examples of one page in the current directory: page.py PAGE
"""

import re
import subprocess
import sys
from pathlib import Path

# A new user waits no longer for one command of the first hour.
LONGEST_S = 60


def commands_and_outputs(text):
    for block in re.findall(r"^```console\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        yield from re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", block, re.MULTILINE)


def files(text):
    """The name and the content of every block that follows "A file `NAME`:"."""
    return re.findall(r"`([\w.]+)`:\n\n```(?:json|python)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def without_times(text):
    return re.sub(r" in [0-9.e-]+ s\n", " in ELAPSED s\n", text)


def run(page):
    text = Path(page).read_text(encoding="utf-8")
    for name, content in files(text):
        Path(name).write_text(content, encoding="utf-8")
    count = 0
    for command, output in commands_and_outputs(text):
        print(f"$ {command}")
        done = subprocess.run(
            ["/bin/bash", "-c", command], text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, check=False, timeout=LONGEST_S)
        print(done.stdout, end="")
        if without_times(done.stdout) != without_times(output):
            sys.exit(f"the page shows:\n{output}")
        count += 1
    if not count:
        sys.exit(f"{page} has no examples")
    print(f"{count} commands print what {page} shows")


if __name__ == "__main__":
    run(sys.argv[1])

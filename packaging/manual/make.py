"""Writes manual pages and completions from the options that the programs declare.

usage: make.py PROGRAMS_JSON VERSION DIRECTORY
"""

import json
import sys
from pathlib import Path

import completion
import man_page

SECTIONS = {"ricochet": 1, "ricochetd": 8}
SUMMARIES = {"ricochet": "compute impacts with friction", "ricochetd": "answer questions about impacts, as a daemon"}


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def main():
    source, version, directory = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    described = json.loads(Path(source).read_text(encoding="utf-8"))
    for program in described["programs"]:
        name = program["name"]
        section = SECTIONS[name]
        folder = directory / f"man{section}"
        for title, text in man_page.pages(program, section, SUMMARIES[name], version):
            write(folder / f"{title}.{section}", text)
        write(directory / "bash" / name, completion.bash(program, described["values"]))
        write(directory / "zsh" / f"_{name}", completion.zsh(program, described["values"]))


if __name__ == "__main__":
    main()

"""Counts instructions by callgrind, for plan_cost.py and instruction_counts.py."""

import collections
import os
import re
import shutil
import subprocess
import sys
import tempfile

CANNOT_RUN = 77


def obstacle():
    """Says why nothing can be counted on this machine; None where it can."""
    if shutil.which("valgrind") is None:
        return "valgrind is not installed"
    with open("/proc/cpuinfo", encoding="utf-8") as processor:
        if not re.search(r"^flags\s*:.*\brdtscp\b", processor.read(), re.MULTILINE):
            return "the processor has no RDTSCP, which Highway executes when it is loaded and valgrind then refuses"
    return None


def run(function, *command):
    """Runs a command and counts inside a function whose name may hold *.

    Returns what the command printed and the instructions of each function with all that it calls. Ends with 77 where
    the command does.
    """
    with tempfile.TemporaryDirectory() as directory:
        out = os.path.join(directory, "out")
        counted = ["valgrind", "--tool=callgrind", "--collect-atstart=no", f"--toggle-collect={function}",
                   f"--callgrind-out-file={out}", *command]
        done = subprocess.run(counted, capture_output=True, text=True, check=False)
        if done.returncode == CANNOT_RUN:
            print(done.stderr)
            sys.exit(CANNOT_RUN)
        if done.returncode != 0:
            sys.exit(f"{' '.join(counted)} failed:\n{done.stderr}")
        with open(out, encoding="utf-8") as lines:
            return done.stdout, inclusive(lines)


def inclusive(lines):
    """Adds up what callgrind wrote: the instructions of each function with all that it calls."""
    counts, names, function, callee, is_call = collections.Counter(), {}, None, None, False
    for line in lines:
        named = re.match(r"(c?fn)=\((\d+)\)(?: (.*))?", line)
        if named:
            kind, number, name = named.groups()
            if name is not None:
                names[number] = name
            if kind == "fn":
                function = names[number]
            else:
                callee = names[number]
        elif line.startswith("calls="):
            is_call = True
        elif re.match(r"[+*\d-]", line):
            # Position and cost; after calls= the cost is that of the calls.
            if not (is_call and callee == function):
                counts[function] += int(line.split()[1])
            is_call = False
    return counts

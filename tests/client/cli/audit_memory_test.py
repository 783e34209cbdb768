#!/usr/bin/env python3
"""A long table is audited in the memory of a short one.

Usage: audit_memory_test.py RICOCHET SCENES
"""

import os
import subprocess
import sys
import tempfile

RICOCHET, SCENES = sys.argv[1:3]
SHORT, LONG = 10_000, 60_000


def audit(path, *more):
    """Returns the largest resident size of an audit in kB."""
    with open(os.devnull, "wb") as null:
        process = subprocess.Popen([RICOCHET, "audit", "--scene", os.path.join(SCENES, "rod_contact.textproto"),
                                    "--data", path, *more], stdout=null, stderr=null)
        _, status, usage = os.wait4(process.pid, 0)
    assert status == 0, status
    return usage.ru_maxrss


with tempfile.TemporaryDirectory() as directory:
    sizes = {}
    for rows in (SHORT, LONG):
        path = os.path.join(directory, f"{rows}.csv")
        with open(path, "w", encoding="ascii") as file:
            file.write("tangential_after_m_s,normal_after_m_s\n")
            file.writelines(f"{-0.9 + 1e-6 * (i % 1000)},0.3\n" for i in range(rows))
            # Comments make the file as long as a million rows, at the cost of none.
            file.writelines("#" * 99 + "\n" for _ in range(10 * (rows - SHORT)))
        sizes[rows] = {name: audit(path, "--format", name) for name in ("text", "csv", "json")}
    for name, short in sizes[SHORT].items():
        grown = sizes[LONG][name] - short
        print(f"{name}: {short} kB for {SHORT} rows, {grown} kB more for {LONG}")
        # The text of the file alone would take 50 MB, and the reports of all rows as JSON 100 MB.
        assert grown < 20_000, (name, grown)

"""Writes the tables of measured impacts that docs/fit.md and docs/experiments.md fit.

falling_rod.csv is made: the impacts of scenes/falling_rod.textproto with friction 0.18 and Newton's coefficient 0.62, a
normal error on each velocity, and one row spoiled. alumina_sphere.csv has two of the three series of measured_sphere.csv
as velocities. usage: make_fit_data.py RICOCHET
"""

import csv
import math
import pathlib
import random
import subprocess
import sys

DATA = pathlib.Path(__file__).resolve().parent
ROD = DATA / "scenes/falling_rod.textproto"
MEASURED = ["bodies_after[0].linear_m_s[0]", "bodies_after[0].linear_m_s[1]", "bodies_after[0].angular_rad_s[0]"]
SIGMA = [0.01, 0.01, 0.1]
SPEED = 3.9


def write(name, comment, header, rows):
    lines = [*(f"# {line}" for line in comment), ",".join(header), *(",".join(row) for row in rows)]
    (DATA / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def falling_rod(ricochet):
    truth = DATA / "truth.textproto"
    truth.write_text(ROD.read_text().replace("coefficient: 0.3", "coefficient: 0.18").replace("newton: 0.5", "newton: 0.62"))
    head = ["offset_t_m", "offset_n_m", "velocity_n_m_s"]
    inputs = [[f"{0.2 * math.sin(math.radians(angle)):.4f}", f"{-0.2 * math.cos(math.radians(angle)):.4f}", speed]
              for speed in ("-1.5", "-2.5") for angle in (10, 20, 30, 45, 60, 75)]
    table = "\n".join(",".join(row) for row in [head, *inputs])
    out = subprocess.run([ricochet, "solve", "--scene", truth, "--data", "-", "--column", ",".join(MEASURED), "--format",
                          "csv"], input=table, text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True).stdout
    truth.unlink()
    noise = random.Random(2009)
    rows = []
    for given, solved in zip(inputs, csv.DictReader(out.splitlines())):
        rows.append(given + [f"{float(solved[name]) + noise.gauss(0, sigma):.3f}" for name, sigma in zip(MEASURED, SIGMA)])
    rows[7][4] = f"{float(rows[7][4]) + 0.08:.3f}"
    write("falling_rod.csv", ["Made by make_fit_data.py: friction 0.18, Newton's coefficient 0.62, and normal errors of",
                              "0.01 m/s and 0.1 rad/s; the normal velocity of row 7 is 0.08 m/s too large."],
          head + MEASURED, rows)


def alumina_sphere():
    rows = []
    with open(DATA / "measured_sphere.csv", encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            angle = math.radians(float(row["angle_from_normal_deg"]))
            before = [SPEED * math.sin(angle), -SPEED * math.cos(angle)]
            if row["quantity"] == "tangential_restitution_of_centre":
                rows.append([*before, float(row["value"]) * before[0], None])
            elif row["quantity"] == "rebound_spin_rad_s":
                rows.append([*before, None, float(row["value"])])
    write("alumina_sphere.csv",
          ["Made by make_fit_data.py of measured_sphere.csv, which has the source: tangential velocity and spin after."],
          ["velocity_t_m_s", "velocity_n_m_s", MEASURED[0], MEASURED[2]],
          [["" if number is None else f"{number:.6g}" for number in row] for row in rows])


if __name__ == "__main__":
    falling_rod(sys.argv[1])
    alumina_sphere()

"""Draws docs/images/measured_sphere.svg: the measured sphere of docs/experiments.md and what Ricochet predicts for it, rigid
and with tangential compliance, without a fitted number. Prints the root mean square deviations.

usage: draw_measured_sphere.py RICOCHET
"""

import csv
import math
import pathlib
import subprocess
import sys
import tempfile

DATA = pathlib.Path(__file__).resolve().parent
PICTURE = DATA.parents[1] / "docs/images/measured_sphere.svg"
SCENE = DATA / "scenes/alumina_sphere.textproto"
SPEED = 3.9
COLUMNS = ["bodies_after[0].linear_m_s[0]", "bodies_after[0].angular_rad_s[0]",
           "contact_velocity_after.tangential_m_s[0]", "contact_velocity_after.normal_m_s"]
# The quantity, its title, and how it follows from the angle before and the columns.
QUANTITIES = [
    ("tangential_restitution_of_centre", "tangential restitution of the centre",
     lambda angle, t, w, u, v: t / (SPEED * math.sin(angle))),
    ("rebound_spin_rad_s", "spin after [rad/s]", lambda angle, t, w, u, v: w),
    ("rebound_angle_of_contact_deg", "rebound angle of the contact [deg]",
     lambda angle, t, w, u, v: math.degrees(math.atan2(u, v))),
]


def predicted(ricochet, compliant, quantity, degrees):
    text = SCENE.read_text(encoding="utf-8")
    if not compliant:
        text = text[: text.index("compliance {")]
    angles = [math.radians(angle) for angle in degrees]
    table = ["velocity_t_m_s,velocity_n_m_s", *(f"{SPEED * math.sin(a)},{-SPEED * math.cos(a)}" for a in angles)]
    with tempfile.NamedTemporaryFile("w", suffix=".textproto") as scene:
        scene.write(text)
        scene.flush()
        out = subprocess.run(
            [ricochet, "solve", "--scene", scene.name, "--data", "-", "--column", ",".join(COLUMNS), "--format", "csv"],
            input="\n".join(table), text=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True).stdout
    rows = csv.DictReader(out.splitlines())
    return [quantity(angle, *(float(row[name]) for name in COLUMNS)) for angle, row in zip(angles, rows)]


def block(name, points):
    return f"${name} << EOD\n" + "\n".join(f"{x} {y}" for x, y in points) + "\nEOD\n"


def main(ricochet):
    with open(DATA / "measured_sphere.csv", encoding="utf-8") as file:
        measured = list(csv.DictReader(line for line in file if not line.startswith("#")))
    script = ("set terminal svg size 1350,430 font 'DejaVu Sans,12'\nset multiplot layout 1,3\nset grid\n"
              "set xlabel 'angle of incidence [deg]'\nset xrange [0:90]\nset key bottom right\n")
    for name, title, quantity in QUANTITIES:
        points = [(float(row["angle_from_normal_deg"]), float(row["value"])) for row in measured if row["quantity"] == name]
        data, plots = block("measured", points), ["$measured with points pointtype 7 title 'measured'"]
        for model in ("rigid", "compliant"):
            curve = [0.5 * i for i in range(1, 180)]
            data += block(model, zip(curve, predicted(ricochet, model == "compliant", quantity, curve)))
            plots.append(f"${model} with lines linewidth 2 title '{model}'")
            at = predicted(ricochet, model == "compliant", quantity, [angle for angle, _ in points])
            rms = math.sqrt(sum((p - value) ** 2 for p, (_, value) in zip(at, points)) / len(points))
            print(f"{name} {model} {rms:.4g}")
        script += data + f"set ylabel '{title}'\nplot " + ", ".join(plots) + "\n"
    svg = subprocess.run(["gnuplot"], input=script, text=True, stdout=subprocess.PIPE, check=True).stdout
    PICTURE.write_text(svg, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])

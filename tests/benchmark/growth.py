#!/usr/bin/python3
"""How cost grows with points, columns, axes, links, contacts of a batch, threads and clients.

usage: growth.py [--quick]; writes docs/growth.md and docs/images/growth.svg. A quick run leaves out what takes long, and
writes nothing.
"""

import functools
import json
import os
import statistics
import subprocess
import sys
import tempfile

import grpc
import numpy as np

import processes

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support", "processes"))
import provenance  # pylint: disable=wrong-import-position

ROUNDS = 3
FRICTION = "friction.kinetic_coefficient"
PENDULUM = ["--a", "0.3", "--b", "1", "--mu", "0.1", "--energetic", "0.8"]
COLUMNS = [
    "coefficients.newton", "coefficients.poisson", "coefficients.energetic", "coefficients.tangential", "rates_after_rad_s[0]",
    "contact_velocity_after.tangential_m_s[0]", "contact_velocity_after.normal_m_s", "impulse.normal_compression_n_s",
    "impulse.normal_total_n_s", "impulse.tangential_n_s[0]", "work.normal_compression_j", "work.normal_restitution_j",
    "work.tangential_compression_j", "work.tangential_restitution_j", "work.normal_total_j", "work.tangential_total_j",
    "energy_change_j"]
AXES = [(FRICTION, 0, 0.25), ("restitution.energetic", 0.1, 1), ("pendulum.a_m", 0.3, 0.4), ("pendulum.inertia_kg_m2", 1, 2),
        ("pendulum.omega_minus_rad_s", -2, -1)]


def sweep(*arguments, threads=1):
    """Median seconds and the most MiB of a sweep that is computed here and whose values are not kept."""
    runs = [processes.run_program(processes.RICOCHET, "sweep", "--summary-only", "--threads", threads, *arguments)
            for _ in range(ROUNDS)]
    return statistics.median(run[1] for run in runs), max(run[2] for run in runs)


@functools.cache
def start_s():
    """Median seconds of a sweep of one point, which are those of starting the process."""
    return statistics.median(sweep(*PENDULUM, *line(1), "--column", COLUMNS[0])[0] for _ in range(ROUNDS))


def computing_s(*arguments, threads=1):
    """Median seconds of a sweep without those of starting the process."""
    return max(sweep(*arguments, threads=threads)[0] - start_s(), 1e-9)


def line(points, path=FRICTION, ends=(0, 0.25)):
    return ["--axis", f"{path}=lin:{ends[0]}:{ends[1]}:{points}"]


def by_points(quick):
    rows = []
    for exponent in range(3, 8 if quick else 10):
        took, mib = sweep(*PENDULUM, *line(10**exponent), "--column", COLUMNS[0])
        rows.append((10**exponent, took, mib))
    return rows


def by_columns(points):
    return [(count, computing_s(*PENDULUM, *line(points), "--column", ",".join(COLUMNS[:count])) / points)
            for count in (1, 2, 4, 8, 12, 17)]


def by_axes(points):
    rows = []
    for count in range(1, len(AXES) + 1):
        each = round(points ** (1 / count))
        axes = [part for path, *ends in AXES[:count] for part in line(each, path, ends)]
        rows.append((count, computing_s(*PENDULUM, *axes, "--column", COLUMNS[0]) / each**count))
    return rows


def by_links(points):
    """A chain that hangs at a slant, whose friction varies."""
    rows = []
    for links in (2, 4, 8, 16, 32, 64):
        parts = [{"length_m": 0.5, "mass_kg": 1, "com_m": 0.25, "inertia_com_kg_m2": 0.02, "theta_rad": 0.3 + 0.01 * i,
                  "rate_rad_s": -0.2} for i in range(links)]
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump({"linkage": {"links": parts}, "restitution": {"energetic": 0.7}}, file)
            file.flush()
            took = computing_s("--scene", file.name, *line(points, ends=(0.01, 0.5)), "--column", COLUMNS[0])
        rows.append((links, took / points))
    return rows


def by_threads(share):
    """For each system: its name, and the rate of every number of threads against that of one."""
    scenes = os.path.join(provenance.ROOT, "tests", "data", "scenes")
    rows = []
    for name, points, columns, scene in (
            ("pendulum, one column", 200_000_000, 1, None), ("pendulum, 8 columns", 100_000_000, 8, None),
            ("contact in a plane", 20_000_000, 1, "rod_contact.textproto"), ("body in a plane", 20_000_000, 1, "sphere_20.textproto"),
            ("contact in space", 1_000_000, 1, "turning_contact.textproto"), ("linkage", 20_000_000, 1, "double_pendulum.textproto"),
            ("contact with a normal spring", 20_000, 1, "dropped_rod.textproto")):
        system = PENDULUM if scene is None else ["--scene", os.path.join(scenes, scene)]
        names = COLUMNS[:columns] if scene is None else ["contact_velocity_after.normal_m_s"]
        times = [computing_s(*system, *line(max(2, int(share * points)), ends=(0.01, 0.25)), "--column", ",".join(names),
                             threads=threads) for threads in range(1, (os.cpu_count() or 1) + 1)]
        rows.append((name, *(f"{times[0] / took:.2f}" for took in times)))
    return rows


def batch_request(rows):
    from ricochet.v1 import batch_pb2  # pylint: disable=import-outside-toplevel
    from google.protobuf import text_format  # pylint: disable=import-outside-toplevel
    request = text_format.Parse("""setup { scene { planar_contact {} restitution { energetic: 0.5 } }
      fields: "planar_contact.w_tt_per_kg" fields: "planar_contact.w_tn_per_kg" fields: "planar_contact.w_nn_per_kg"
      fields: "planar_contact.tangential_m_s" fields: "planar_contact.normal_m_s" fields: "friction.kinetic_coefficient"
      columns: "contact_velocity_after.tangential_m_s[0]" columns: "contact_velocity_after.normal_m_s" }""",
                                batch_pb2.SolveBatchRequest())
    at = np.arange(rows)
    for centre, spread, step in ((3, 0.5, 0.7), (0, 1, 1.01), (1.5, 0.3, 1.32), (0, 2, 1.63), (-1, 0.5, 1.94), (0.4, 0.3, 2.25)):
        request.inputs.append((centre + spread * np.sin(step * at + 1)).astype("<f8").tobytes())
    return request


def by_contacts(address):
    from ricochet.v1 import impact_service_pb2_grpc  # pylint: disable=import-outside-toplevel
    stub = impact_service_pb2_grpc.ImpactServiceStub(grpc.insecure_channel(address))
    rows = []
    for count in (1, 10, 100, 1000, 10000, 100000):
        request = batch_request(count)
        times = [processes.seconds(lambda what=request: stub.SolveBatch(what)) for _ in range(21)]
        rows.append((count, statistics.median(times) / count))
    return rows


def by_clients(address):
    output = subprocess.run([processes.CLIENTS, address], capture_output=True, text=True, check=True).stdout
    return [[float(cell) for cell in row.split("\t")] for row in output.splitlines()[1:]]


def measure(quick):
    points = 2_000_000 if quick else 100_000_000
    found = {"points": by_points(quick), "columns": by_columns(points), "axes": by_axes(points),
             "links": by_links(2000 if quick else 200_000), "threads": by_threads(0.01 if quick else 1)}
    with processes.stubs(), processes.server() as address:
        found["contacts"] = by_contacts(address)
        found["clients"] = by_clients(address)
    return found


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + " ---: |" * len(head),
            *("| " + " | ".join(str(cell) for cell in row) + " |" for row in rows), ""]


def relative(rows):
    """Each cost against the first one."""
    return [(f"{count:,}", f"{cost / rows[0][1]:.2f}") for count, cost in rows]


def page(found):
    alone, beside = found["clients"][0], found["clients"][-1]
    start = start_s()
    points = [
        (f"{count:,}", f"{took * 1e3:,.0f}", f"{(took - start) / count * 1e9:.1f}" if took > 2 * start else "–",
         f"{mib:.0f}")
        for count, took, mib in found["points"]]
    threads = [str(count) for count in range(1, len(found["threads"][0]))]
    contacts = [(f"{count:,}", f"{each * 1e6:,.3f}", f"{each * count * 1e6:,.0f}") for count, each in found["contacts"]]
    clients = [(int(row[0]), f"{row[2]:,.0f}", f"{row[3] / alone[3]:.1f}", f"{row[4] / alone[3]:.1f}")
               for row in found["clients"][:-1]]
    return "\n".join([
        "# How cost grows", "",
        "`./dev bench` measures this page and its picture: medians of three runs, one process at a time, with the release build.",
        provenance.sentence(), "",
        "![Cost against points, columns, axes, links, contacts and clients](images/growth.svg)", "",
        "## Points of a sweep", "",
        "One column of a pendulum, one thread, in the process of the command line. The time of a sweep of one point, which is",
        "that of starting the process, is taken off before it is divided by the points; a sweep that takes less than twice as",
        "long (–) says nothing about its points. Memory does not grow with the points.", "",
        *table(["points", "ms", "ns a point", "peak MiB"], points),
        "## Columns, axes and links", "",
        "The time of a point against that of the first row, without that of starting the process. All columns are outputs of",
        "the closed form.", "",
        *table(["columns", "time"], relative(found["columns"])), *table(["axes", "time"], relative(found["axes"])),
        "A chain whose friction varies is reduced to its contact once, so that the number of its links costs nothing a point.", "",
        *table(["links", "time"], relative(found["links"])),
        "## Threads", "",
        "The rate of one sweep against that of one thread, by the number of threads. What is delivered in order is taken",
        "by one thread, here the command line, so that the cheapest points gain least.", "",
        *table(["system", *threads], found["threads"]),
        "## Contacts of a batch", "", "Planar contacts by `SolveBatch` on loopback, asked by Python, the call included.", "",
        *table(["contacts a call", "µs a contact", "µs a call"], contacts),
        "## Clients at once", "",
        "Clients that call Solve again as soon as they have the answer, on the machine of the server. Latencies are given as",
        f"multiples of one client's median. Beside eight sweeps, one client has a median of {beside[3] / alone[3]:.1f} and a 99th",
        f"percentile of {beside[4] / alone[3]:.1f}; alone its 99th percentile is {alone[4] / alone[3]:.1f}.", "",
        *table(["clients", "calls a second", "median", "99th percentile"], clients)])


PANELS = [("points", "points of a sweep", "time of a sweep [s]", lambda row: (row[0], row[1])),
          ("columns", "columns", "time of a point [ns]", lambda row: (row[0], row[1] * 1e9)),
          ("axes", "axes", "time of a point [ns]", lambda row: (row[0], row[1] * 1e9)),
          ("links", "links of a chain", "time of a point [µs]", lambda row: (row[0], row[1] * 1e6)),
          ("contacts", "contacts a call", "time of a contact [µs]", lambda row: (row[0], row[1] * 1e6)),
          ("clients", "clients", "calls a second", lambda row: (row[0], row[2]))]
LOGARITHMIC = {"points": "xy", "links": "x", "contacts": "xy", "clients": "x"}
POWERS = "set format x '10^{%L}'; set xtics 10"
TICS = {"points": POWERS, "contacts": POWERS, "axes": "set format x '%g'; set xtics 1"}


def picture(found):
    lines = ["set terminal svg size 900,560 dynamic background 'white' font 'DejaVu Sans,12'", "unset key", "set grid lc '#dddddd'",
             "set multiplot layout 2,3", "set yrange [0:*]"]
    for name, label, unit, of in PANELS:
        axes = LOGARITHMIC.get(name, "")
        rows = found[name][:-1] if name == "clients" else found[name]
        lines += [f"set xlabel '{label}'", f"set title '{unit}'", "unset logscale"]
        lines += [f"set logscale {axes}"] if axes else []
        lines += ["set yrange [*:*]" if "y" in axes else "set yrange [0:*]",
                  TICS.get(name, "set format x '%g'; set xtics autofreq"),
                  "plot '-' with linespoints lw 2 pt 7 ps 0.6 lc '#0072b2'"]
        lines += [f"{x} {y}" for x, y in map(of, rows)] + ["e"]
    return "\n".join(lines + ["unset multiplot", ""])


def main():
    quick = sys.argv[1:] == ["--quick"]
    if sys.argv[1:] and not quick:
        sys.exit(__doc__)
    found = measure(quick)
    text = page(found)
    print(text)
    if quick:
        return
    with open(os.path.join(provenance.ROOT, "docs", "growth.md"), "w", encoding="utf-8") as file:
        file.write(text)
    with open(os.path.join(provenance.ROOT, "docs", "images", "growth.svg"), "w", encoding="utf-8") as file:
        subprocess.run(["gnuplot"], input=picture(found), stdout=file, text=True, check=True)


if __name__ == "__main__":
    main()

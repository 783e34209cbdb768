#!/usr/bin/python3
"""Computes the outputs of pendulum.csv and planar.csv by multiple precision, from their input columns.

make_vectors.py FILE          prints FILE with all outputs computed anew; rows with inputs alone are completed.
make_vectors.py --check FILE  compares instead, and fails if an output differs by more than the digits of FILE leave open.

It needs mpmath (Debian: python3-mpmath) and shares no code with the core. README.md beside it names the columns.
"""

import csv
import os
import sys

from mpmath import mp, mpf, nstr, sign, sqrt

# Enough for 1 - x with the smallest x in the files, about 1e-308, to keep 25 digits.
mp.dps = 400
DIGITS = 25
# The files were computed at 40 digits and more, so an exact 0 may stand there as less than this times its scale.
ZERO = mpf(10) ** -36


def inputs(row, *names):
    """The doubles that the texts stand for, exactly."""
    return (mpf(float(row[name])) for name in names)


def pendulum(row):
    a, b, mu, j0, omega, given = inputs(row, "a", "b", "mu", "j0", "omega_minus", "coefficient")
    height = abs(b)
    locked = mu * height >= a
    if locked:
        newton = poisson = energetic = mpf(0)
    else:
        root = sqrt((a - mu * height) / (a + mu * height))
        energetic = {"newton": given / root, "poisson": given * root, "energetic": given}[row["law"]]
        newton, poisson = energetic * root, energetic / root
    tau0 = -j0 * omega / (a + mu * height)
    friction = sign(b) * mu * (1 - poisson) * tau0
    work_n, work_t = a * tau0 * omega / 2, mu * height * tau0 * omega / 2
    return {
        "regime": "stick" if locked else "rebound",
        "newton": newton,
        "poisson": poisson,
        "energetic": energetic,
        "omega_plus": -newton * omega,
        "tau0": tau0,
        "tau1": (1 + poisson) * tau0,
        "friction_impulse": friction,
        "mu_hat": friction / ((1 + poisson) * tau0),
        "work_n_compression": work_n,
        "work_n_restitution": -energetic**2 * work_n,
        "work_t_compression": work_t,
        "work_t_restitution": energetic**2 * work_t,
        "energy_dissipated": j0 * omega**2 * (1 - newton**2) / 2,
    }


class PlanarPath:
    """The contact velocity (u, v), the friction impulse and the works, as the normal impulse tau grows."""

    def __init__(self, row):
        self.wtt, self.wtn, self.wnn, self.mu, self.u, self.v = inputs(row, "wtt", "wtn", "wnn", "mu", "u0", "v0")
        self.tau = self.friction = self.work_n = self.work_t = mpf(0)

    def sticks(self):
        return self.u == 0 and abs(self.wtn) <= self.mu * self.wtt

    def slope(self):
        """df/dtau: Coulomb's law."""
        if self.sticks():
            return -self.wtn / self.wtt if self.wtt != 0 else mpf(0)
        return -self.mu * sign(self.u if self.u != 0 else self.wtn)

    def rates(self):
        """du/dtau and dv/dtau; in stick exactly 0 where W is singular."""
        if self.sticks() and self.wtt != 0:
            return mpf(0), (self.wtt * self.wnn - self.wtn**2) / self.wtt
        slope = self.slope()
        return self.wtt * slope + self.wtn, self.wtn * slope + self.wnn

    def until_slip_stops(self):
        rate = self.rates()[0]
        return -self.u / rate if self.u * rate < 0 else mp.inf

    def advance(self, impulse):
        (du, dv), slope = self.rates(), self.slope()
        self.work_n += (self.v + dv * impulse / 2) * impulse
        self.work_t += (self.u + du * impulse / 2) * slope * impulse
        stops = impulse == self.until_slip_stops()
        self.u = mpf(0) if stops else self.u + du * impulse
        self.v += dv * impulse
        self.friction += slope * impulse
        self.tau += impulse

    def go_until(self, end):
        """Goes on piece by piece; end() is the impulse from here to the end, infinite if not on this piece."""
        while end() > self.until_slip_stops():
            self.advance(self.until_slip_stops())
        self.advance(end())

    def until_velocity(self, v):
        rate = self.rates()[1]
        return (v - self.v) / rate if (v - self.v) * rate > 0 else (mpf(0) if v == self.v else mp.inf)

    def until_work(self, work):
        """Where v and dv/dtau are not negative, as in restitution."""
        missing, rate = work - self.work_n, self.rates()[1]
        return 2 * missing / (self.v + sqrt(self.v**2 + 2 * rate * missing)) if missing > 0 else mpf(0)


def planar(row):
    path, law = PlanarPath(row), row["law"]
    given, v0 = inputs(row, "coefficient", "v0")
    path.go_until(lambda: path.until_velocity(mpf(0)))
    path.v = mpf(0)
    tau_compression, compression = path.tau, path.work_n
    locked = path.u == 0 and path.rates()[1] == 0
    if not locked:
        path.go_until({
            "newton": lambda: path.until_velocity(-given * v0),
            "poisson": lambda: (1 + given) * tau_compression - path.tau,
            "energetic": lambda: path.until_work((1 - given**2) * compression),
        }[law])
    restitution = path.work_n - compression
    return {
        "u1": path.u,
        "v1": path.v,
        "tau_compression": tau_compression,
        "tau1": path.tau,
        "friction_impulse": path.friction,
        "work_n_compression": compression,
        "work_n_restitution": restitution,
        "work_t": path.work_t,
        "newton": -path.v / v0,
        "poisson": (path.tau - tau_compression) / tau_compression,
        "energetic": sqrt(-restitution / compression),
    }


MODELS = {"pendulum.csv": pendulum, "planar.csv": planar}
# For each output that may be exactly 0 where the file has a tiny number: the column whose size it is compared with.
SCALES = {"u1": "u0", "friction_impulse": "tau1", "mu_hat": "mu"}


def text(value):
    return value if isinstance(value, str) else nstr(value, DIGITS, strip_zeros=value == 0)


def differs(name, expected, row):
    if isinstance(expected, str):
        return expected != row[name]
    scale = abs(mpf(row.get(SCALES.get(name), 0))) + abs(mpf(row.get("v0", 0)))
    return abs(mpf(row[name]) - expected) > abs(expected) * mpf(10) ** (1 - DIGITS) + scale * ZERO


def check(rows, model):
    wrong = [f"row {number}, {name}: {row[name]}, not {text(value)}"
             for number, row in enumerate(rows, 1) for name, value in model(row).items() if differs(name, value, row)]
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{len(rows)} rows agree")


def main():
    wants_check, path = len(sys.argv) == 3 and sys.argv[1] == "--check", sys.argv[-1]
    model = MODELS[os.path.basename(path)]
    with open(path, encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        rows = list(reader)
    if wants_check:
        check(rows, model)
        return
    writer = csv.DictWriter(sys.stdout, reader.fieldnames, lineterminator="\n")
    writer.writeheader()
    for row in rows:
        writer.writerow(row | {name: text(value) for name, value in model(row).items()})


if __name__ == "__main__":
    main()

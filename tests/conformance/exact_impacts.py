"""Impacts in arbitrary precision: one contact in a plane or in space, and orders of impacts at several contacts.

Nothing here shares code with the core. A planar impact is followed by tests/data/make_vectors.py, whose path is piecewise
linear. An impact in space follows Keller's equations over xi with dtau = |u| dxi, as power series in the slip, its direction
(cos, sin) and all that is integrated; the right-hand sides are polynomials of these. Numbers are doubles taken exactly.
"""

import os
import sys

from mpmath import mp, mpf, sqrt

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'data'))
import make_vectors  # noqa: E402

mp.dps = 400
LAWS = ('newton', 'poisson', 'energetic')
SPACE_DIGITS = 45
NOTHING = mpf(10) ** -200  # Below this a velocity is the rounding of an exact 0.


def solve_linear(matrix, right):
    """Solves a regular system by elimination with pivots."""
    rows = [list(row) + [b] for row, b in zip(matrix, right)]
    n = len(rows)
    for i in range(n):
        pivot = max(range(i, n), key=lambda j: abs(rows[j][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for j in range(i + 1, n):
            factor = rows[j][i] / rows[i][i]
            rows[j] = [a - factor * b for a, b in zip(rows[j], rows[i])]
    for i in reversed(range(n)):
        rows[i][n] = (rows[i][n] - sum(rows[i][k] * rows[k][n] for k in range(i + 1, n))) / rows[i][i]
    return [row[n] for row in rows]


def times(matrix, vector):
    return [sum(a * b for a, b in zip(row, vector)) for row in matrix]


class PlanarImpact(make_vectors.PlanarPath):
    """The path of make_vectors with its events, from a W and a velocity that need not be doubles."""

    def __init__(self, w, velocity, mu):  # pylint: disable=super-init-not-called
        (self.wtt, self.wtn), (_, self.wnn) = w
        self.u, self.v = velocity
        self.mu = mu
        self.tau = self.friction = self.work_n = self.work_t = mpf(0)
        self.events = []
        if self.u == 0 and self.sticks() and self.wtn != 0:
            self.note('sticks')

    def advance(self, impulse):
        before = self.u
        super().advance(impulse)
        self.u = mpf(0) if abs(self.u) < NOTHING else self.u
        self.v = mpf(0) if abs(self.v) < NOTHING else self.v
        if before != 0 and self.u == 0:
            self.note('slip stops')
            if self.sticks():
                self.note('sticks')
            elif self.rates()[0] != 0:
                self.note('slip starts')

    def note(self, kind):
        self.events.append((kind, self.tau))

    def locked(self):
        return self.sticks() and abs(self.rates()[1]) < NOTHING

    def tangential_impulse(self):
        return [self.friction]

    def velocity(self):
        return [self.u, self.v]


class SpatialImpact:
    """The impact of a contact in space; W is 3 x 3 and its tangential block is regular."""

    def __init__(self, w, velocity, mu):
        self.w, self.mu = w, mu
        self.slip = list(velocity[:2])
        self.v = velocity[2]
        self.tau = self.work_n = self.work_t = mpf(0)
        self.impulse = [mpf(0), mpf(0)]
        self.events = []
        self.straight = None  # Once slip has stopped: the constant df/dtau.

    def note(self, kind):
        self.events.append((kind, self.tau))

    # --- After slip has stopped every rate is constant. ---

    def after_stop(self):
        (a, b, wtn1), (_, d, wtn2), _ = self.w
        stick = solve_linear([[a, b], [b, d]], [-wtn1, -wtn2])
        if sqrt(stick[0]**2 + stick[1]**2) <= self.mu:
            self.note('sticks')
            return stick
        self.note('slip starts')
        return [-self.mu * x for x in self.restart()]

    def restart(self):
        """The one direction along which slip grows without turning."""
        def across(angle):
            return self.rates_of(mp.cos(angle), mp.sin(angle))[1]
        steps = 720
        for i in range(steps):
            low, high = (2 * mp.pi * (i + mpf(1) / 3 + k) / steps for k in range(2))
            if across(low) * across(high) < 0:
                angle = mp.findroot(across, (low, high), solver='anderson', tol=mpf(10)**(-2 * SPACE_DIGITS + 20))
                if self.rates_of(mp.cos(angle), mp.sin(angle))[0] > 0:
                    return mp.cos(angle), mp.sin(angle)
        raise ArithmeticError('slip starts along no direction')

    def rates_of(self, c, s):
        """The slip's growth and turning per normal impulse: h and g."""
        f = [-self.mu * c, -self.mu * s]
        rate = [self.w[i][0] * f[0] + self.w[i][1] * f[1] + self.w[i][2] for i in range(2)]
        return c * rate[0] + s * rate[1], -s * rate[0] + c * rate[1]

    def straight_rates(self):
        f = self.straight
        return [self.w[i][0] * f[0] + self.w[i][1] * f[1] + self.w[i][2] for i in range(3)]

    def advance_straight(self, impulse):
        rates = self.straight_rates()
        self.work_n += (self.v + rates[2] * impulse / 2) * impulse
        for i in range(2):
            self.work_t += (self.slip[i] + rates[i] * impulse / 2) * self.straight[i] * impulse
            self.impulse[i] += self.straight[i] * impulse
            self.slip[i] += rates[i] * impulse
        self.v += rates[2] * impulse
        self.tau += impulse

    # --- While it slips: power series. ---

    def series(self, order):
        """Taylor coefficients of (slip, cos, sin, tau, v, work_n, work_t, f1, f2) over xi."""
        speed = sqrt(self.slip[0]**2 + self.slip[1]**2)
        rows = [[x] for x in (speed, self.slip[0] / speed, self.slip[1] / speed, self.tau, self.v, self.work_n,
                              self.work_t, *self.impulse)]
        slip, c, s, v = rows[0], rows[1], rows[2], rows[4]
        (a, b, t1), (_, d, t2), (_, _, n) = self.w
        mu = self.mu
        cc, cs, ss, sh, gs, gc = [], [], [], [], [], []
        h, g = [], []

        def product(x, y, k):
            return mp.fdot(x[:k + 1], y[k::-1])

        for k in range(order):
            cc.append(product(c, c, k))
            cs.append(product(c, s, k))
            ss.append(product(s, s, k))
            h.append(-mu * (a * cc[k] + 2 * b * cs[k] + d * ss[k]) + t1 * c[k] + t2 * s[k])
            g.append(-mu * ((d - a) * cs[k] + b * (cc[k] - ss[k])) - t1 * s[k] + t2 * c[k])
            sh.append(product(slip, h, k))
            gs.append(product(s, g, k))
            gc.append(product(c, g, k))
            slip_c, slip_s = product(slip, c, k), product(slip, s, k)
            rates = (sh[k], -gs[k], gc[k], slip[k], n * slip[k] + t1 * (-mu * slip_c) + t2 * (-mu * slip_s),
                     product(v, slip, k), -mu * product(slip, slip, k), -mu * slip_c, -mu * slip_s)
            for row, rate in zip(rows, rates):
                row.append(rate / (k + 1))
        return rows

    def set_state(self, rows, xi):
        values = [mp.polyval(row[::-1], xi) for row in rows]
        norm = sqrt(values[1]**2 + values[2]**2)
        self.slip = [values[0] * values[1] / norm, values[0] * values[2] / norm]
        self.tau, self.v, self.work_n, self.work_t = values[3:7]
        self.impulse = list(values[7:])

    def go_until(self, missing):
        """Goes on until missing(tau, v, work_n), negative before, becomes 0."""
        order = 30
        while self.straight is None:
            if sqrt(self.slip[0]**2 + self.slip[1]**2) < mpf(10) ** -SPACE_DIGITS:
                if self.slip != [0, 0]:
                    self.note('slip stops')
                self.slip = [mpf(0), mpf(0)]
                self.straight = self.after_stop()
                break
            rows = self.series(order)
            largest = max(abs(row[order]) for row in rows)
            step = min(mpf(1), (mpf(10) ** (-SPACE_DIGITS) / largest) ** (mpf(1) / order)) if largest > 0 else mpf(1)
            if self.value(rows, step, missing) >= 0:
                low, high = mpf(0), step
                while high - low > mpf(10) ** (-SPACE_DIGITS + 2) * step:
                    middle = (low + high) / 2
                    low, high = (low, middle) if self.value(rows, middle, missing) >= 0 else (middle, high)
                self.set_state(rows, high)
                return
            self.set_state(rows, step)
        self.finish_straight(missing)

    @staticmethod
    def value(rows, xi, missing):
        tau, v, work_n = (mp.polyval(rows[i][::-1], xi) for i in (3, 4, 5))
        return missing(tau, v, work_n)

    def finish_straight(self, missing):
        rate = self.straight_rates()[2]

        def value(x):
            return missing(self.tau + x, self.v + rate * x, self.work_n + (self.v + rate * x / 2) * x)
        if value(mpf(0)) >= 0:
            return
        high = mpf(1)
        while value(high) < 0:
            high *= 2
        low = mpf(0)
        while high - low > mpf(10) ** (-SPACE_DIGITS) * high:
            middle = (low + high) / 2
            low, high = (low, middle) if value(middle) >= 0 else (middle, high)
        self.advance_straight(high)

    def locked(self):
        return False

    def tangential_impulse(self):
        return self.impulse

    def velocity(self):
        return [*self.slip, self.v]


def finish_planar(path, law, given, v0, tau_compression, compression):
    path.go_until({
        'newton': lambda: path.until_velocity(-given * v0),
        'poisson': lambda: (1 + given) * tau_compression - path.tau,
        'energetic': lambda: path.until_work((1 - given**2) * compression),
    }[law])


def finish_spatial(path, law, given, v0, tau_compression, compression):
    path.go_until({
        'newton': lambda tau, v, work: v + given * v0,
        'poisson': lambda tau, v, work: tau - (1 + given) * tau_compression,
        'energetic': lambda tau, v, work: work - (1 - given**2) * compression,
    }[law])


def follow(w, velocity, mu, law, given):
    """Follows one impact to its end. Returns its numbers by name; None if the contact does not approach."""
    if velocity[-1] >= 0:
        return None
    planar = len(velocity) == 2
    with mp.workdps(400 if planar else SPACE_DIGITS + 25):
        path = (PlanarImpact if planar else SpatialImpact)(w, velocity, mu)
        if planar:
            path.go_until(lambda: path.until_velocity(mpf(0)))
        else:
            path.go_until(lambda tau, v, work: v)
        path.v = mpf(0)
        path.note('compression ends')
        tau_compression, compression, friction = path.tau, path.work_n, path.work_t
        locked = path.locked()
        if not locked and given > 0:
            (finish_planar if planar else finish_spatial)(path, law, given, velocity[-1], tau_compression, compression)
        path.note('restitution ends')
        restitution = path.work_n - compression
        return {
            'regime': regime_of(path.events, locked, path.work_t == 0 and path.tangential_impulse() == [0] * (len(w) - 1)),
            'impulse': [*path.tangential_impulse(), path.tau],
            'normal_compression_n_s': tau_compression,
            'works': [compression, restitution, friction, path.work_t - friction],
            'coefficients': [-path.v / velocity[-1], (path.tau - tau_compression) / tau_compression,
                             sqrt(-restitution / compression)],
            'events': path.events,
        }


def regime_of(events, locked, frictionless):
    if locked or frictionless:
        return 'locked' if locked else 'frictionless'
    turns = [(kind, tau) for kind, tau in events if kind == 'sticks' or kind == 'slip starts' and tau > 0]
    if not turns:
        return 'sliding'
    kind, tau = turns[-1]
    end_of_compression = next(tau for kind, tau in events if kind == 'compression ends')
    phase = 'compression' if tau < end_of_compression - NOTHING else 'restitution'
    return ('stick in ' if kind == 'sticks' else 'reversal in ') + phase


def orders(w, velocity, contacts, most):
    """Yields every order of impacts that ends, as (contacts hit, velocity after, impulses).

    contacts has (friction, coefficient) of each; restitution is energetic. An order longer than `most` is left out.
    """
    d = len(velocity) // len(contacts)

    def search(hit, v, impulse):
        approaching = [i for i in range(len(contacts)) if v[i * d + d - 1] < -NOTHING]
        if not approaching:
            yield hit, v, impulse
            return
        if len(hit) == most:
            return
        for i in approaching:
            block = range(i * d, i * d + d)
            end = follow([[w[a][b] for b in block] for a in block], [v[a] for a in block], contacts[i][0], 'energetic',
                         contacts[i][1])
            total = list(impulse)
            for a, p in zip(block, end['impulse']):
                total[a] += p
            after = [x + sum(w[a][b] * p for b, p in zip(block, end['impulse'])) for a, x in enumerate(v)]
            yield from search([*hit, i + 1], after, total)

    yield from search([], list(velocity), [mpf(0)] * len(velocity))


__all__ = ['LAWS', 'follow', 'mpf', 'orders', 'solve_linear', 'times']

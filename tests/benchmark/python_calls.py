#!/usr/bin/python3
"""Measures what a call from Python costs: in this process, against the same call of a server on loopback; batches against NumPy,
which evaluates a closed form in plain doubles and checks nothing; the import against that of NumPy.

The numbers of both sides are compared before their times.
"""

import os
import statistics
import subprocess
import sys

import numpy as np

import processes

PACKAGE = os.path.join(processes.BUILD, "python", "package")
sys.path.insert(0, PACKAGE)
import ricochet  # noqa: E402  # pylint: disable=wrong-import-position

ROUNDS = 15
CALLS = 200  # In one sample.
ROWS = 1_000
STATES = 10_000
A, B, ETA = 0.3, 1.0, 0.9
SCENE = {
    "pendulum": {"inertia_kg_m2": 1, "a_m": A, "b_m": B, "omega_minus_rad_s": -1},
    "friction": {"kinetic_coefficient": 0.1},
    "restitution": {"energetic": ETA},
}
CONTACT = {
    "planar_contact": {"w_tt_per_kg": 2.5, "w_tn_per_kg": 1.5, "w_nn_per_kg": 2.5, "tangential_m_s": -1},
    "restitution": {"newton": 0.5},
}
FRICTION = np.linspace(0, 0.2, ROWS)
SPEEDS = -np.linspace(1, 2, ROWS)


def newton_by_numpy():
    plus, minus = A + FRICTION * B, A - FRICTION * B
    return ETA * np.sqrt(minus / plus)


def newton_of(client):
    return client.solve_batch(SCENE, {"friction.kinetic_coefficient": FRICTION}, ["coefficients.newton"])


def contacts_of(client):
    inputs = {"planar_contact.normal_m_s": SPEEDS, "friction.kinetic_coefficient": FRICTION}
    return client.solve_batch(CONTACT, inputs, ["contact_velocity_after.normal_m_s"])


def arms():
    """M, J and q' of arms with seven joints, whose contact approaches along z."""
    random = np.random.default_rng(1)
    roots = random.normal(size=(STATES, 7, 7))
    mass = roots @ roots.transpose(0, 2, 1) + 0.5 * np.eye(7)
    jacobian = random.normal(size=(STATES, 3, 7))
    rates = random.normal(size=(STATES, 7))
    rates[np.einsum("bj,bj->b", jacobian[:, 2], rates) > 0] *= -1
    return mass, jacobian, rates


def repeated(call, calls):
    def run():
        for _ in range(calls):
            call()
    return run


def compare(name, here, there, what, calls=CALLS):
    """Prints the time of a call, and what another takes in its place."""
    times, (ours, _) = processes.medians(ROUNDS, repeated(here, calls), repeated(there, calls))
    print(f"  {name:<44} {ours / calls * 1e6:8.2f} us   {processes.ratio(times, 1, 0):7.2f} x as fast as {what}")


def compare_arms():
    mass, jacobian, rates = arms()
    def strike():
        return ricochet.at_contact(mass, jacobian, rates, [0, 0, 1], friction=0.3, energetic=0.5)
    taken = np.einsum("bij,bi->bj", jacobian, strike().impulse_n_s)
    change = np.linalg.solve(mass, taken[..., None])[..., 0]
    if np.max(np.abs(strike().rates_after - rates - change)) > 1e-9:
        sys.exit("the rates of at_contact and of NumPy differ")
    compare(f"at_contact of {STATES} arms of seven joints", strike, lambda: np.linalg.cholesky(mass),
            "NumPy's Cholesky factors alone", calls=1)


def import_time(modules):
    """Seconds of an import in a program of its own, as Python measures it."""
    code = f"import time; {modules[0]}; start = time.perf_counter(); {modules[1]}; print(time.perf_counter() - start)"
    environment = {**os.environ, "PYTHONPATH": PACKAGE}
    return float(subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, check=True).stdout)


def compare_imports():
    pairs = [(import_time(("import numpy", "import ricochet")), import_time(("pass", "import numpy")))
             for _ in range(ROUNDS)]
    ours = statistics.median(pair[0] for pair in pairs)
    print(f"  {'import ricochet after numpy':<44} {ours * 1e3:8.2f} ms   "
          f"{statistics.median(pair[0] / pair[1] for pair in pairs):7.2f} x the time of import numpy")


def main():
    prepared = ricochet.Scene(SCENE)
    with processes.server() as address, ricochet.Client() as client, ricochet.Client(address) as remote:
        if client.solve(SCENE) != remote.solve(SCENE):
            sys.exit("the answers of this process and of the server differ")
        if np.max(np.abs(newton_of(client)["newton"] - newton_by_numpy())) > 4e-12:
            sys.exit("the answers of a batch and of NumPy differ")
        print(f"Calls from Python, medians of {ROUNDS} rounds of {CALLS}")
        server = "the same call of a server"
        compare("solve of a dictionary", lambda: client.solve(SCENE), lambda: remote.solve(SCENE), server)
        compare("solve of a Scene", lambda: client.solve(prepared), lambda: remote.solve(prepared), server)
        compare("solve of a dictionary, one number read", lambda: client.solve(SCENE).coefficients.newton,
                lambda: remote.solve(SCENE).coefficients.newton, server)
        compare("solve of a dictionary, all numbers read", lambda: dict(client.solve(SCENE)),
                lambda: dict(remote.solve(SCENE)), server)
        compare(f"solve_batch of {ROWS} pendulums", lambda: newton_of(client), lambda: newton_of(remote), server)
        compare(f"solve_batch of {ROWS} planar contacts", lambda: contacts_of(client), lambda: contacts_of(remote), server)
        compare(f"solve_batch of {ROWS} pendulums", lambda: newton_of(client), newton_by_numpy, "NumPy's closed form")
        compare_arms()
        compare_imports()


if __name__ == "__main__":
    main()

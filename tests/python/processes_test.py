"""Threads, forks, other processes and Ctrl-C."""

import concurrent.futures
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time
import unittest
from unittest import mock

import numpy as np
import ricochet
from support import PENDULUM, WAIT_S, Ricochetd, main

# The forces of an impact that takes time are integrated, which takes half a millisecond.
SPRING = {
    "planar_contact": {"w_tt_per_kg": 2.5, "w_tn_per_kg": 1.5, "w_nn_per_kg": 2.5, "tangential_m_s": -1, "normal_m_s": -1},
    "friction": {"kinetic_coefficient": 0.2},
    "restitution": {"energetic": 0.8},
    "compliance": {"linear": {"stiffness_n_m": 1e6}},
}
NEWTON = "coefficients.newton"


def long_sweep(client=ricochet, points=10_000_000, progress=None):
    """A sweep that takes hours; one of 2,000 points takes a second."""
    axes = {"mu": ricochet.Linspace(0.1, 0.3, points)}
    return client.sweep(SPRING, axes, "contact.duration_s", form="table", progress=progress)


def helped_batch(client=ricochet):
    """A batch that other threads help with, because it takes some 30 ms."""
    table = client.solve_batch(SPRING, {"mu": np.linspace(0.1, 0.3, 40)}, ["contact.duration_s", NEWTON])
    return table["contact.duration_s"].tobytes() + table[NEWTON].tobytes()


def refusal(client):
    """The error of a call."""
    try:
        return client.solve(PENDULUM).regime.encode()
    except ricochet.Unavailable as error:
        return str(error).encode()


def run(code, **environment):
    """Runs a program and returns what it prints."""
    ended = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], env={**os.environ, **environment}, timeout=WAIT_S,
                           capture_output=True, text=True, check=False)
    return ended.stdout + ended.stderr


class Alone(unittest.TestCase):
    def test_grpc_stays_until_the_process_ends(self):
        # A thread of gRPC that ended it after the last client would crash a process that ends meanwhile.
        code = """
            import ctypes, time
            import ricochet
            with ricochet.Client("127.0.0.1:1", deadline=0.2) as client:
                try:
                    client.info()
                except ricochet.RicochetError:
                    print("nobody answers")
            time.sleep(0.5)
            print(ctypes.CDLL("libgrpc.so.29").grpc_is_initialized())
            """
        self.assertEqual(run(code), "nobody answers\n1\n")

    def test_no_server_and_no_other_package_is_needed(self):
        code = f"""
            import os, sys
            os.environ.pop("RICOCHET_SERVER", None)
            sys.modules.update({{name: None for name in ("grpc", "google", "google.protobuf", "pandas", "xarray")}})
            import ricochet
            scene = {PENDULUM!r}
            print(ricochet.solve(scene).coefficients.newton, ricochet.bounds(scene).bounds.sharp.newton.lower)
            print(ricochet.sweep(scene, {{"mu": [0, 0.1]}}, "newton", form="table")["newton"][0])
        """
        self.assertEqual(run(code, PATH="/nowhere").split(), ["0.7071067811865475", "0.0", "1.0"])

    def test_daemon_threads_that_compute_do_not_disturb_the_end(self):
        for call in ("solve(P)", "sweep(P, {'mu': [.1, .2]}, 'newton')", "solve_batch(P, {'mu': [.1] * 50000}, 'newton')"):
            printed = run(f"""
                import threading, time, ricochet
                P = {PENDULUM}
                def work():
                    while True:
                        ricochet.{call}
                for _ in range(2):
                    threading.Thread(target=work, daemon=True).start()
                time.sleep(0.2)
                """)
            self.assertEqual(printed, "", call)

    def test_functions_and_clients_go_to_other_processes(self):
        for solve in (ricochet.solve, ricochet.Client().solve):
            self.assertEqual(pickle.loads(pickle.dumps(solve))(PENDULUM), solve(PENDULUM))

    def test_none_is_the_engine_of_this_process_whatever_the_environment_says(self):
        with mock.patch.dict(os.environ, RICOCHET_SERVER="127.0.0.1:1"):
            self.assertEqual(ricochet.Client(server=None).solve(PENDULUM), ricochet.solve(PENDULUM))

    def test_processes_end_without_a_word(self):
        code = f"import ricochet; ricochet.solve({PENDULUM!r}); client = ricochet.Client(); client.solve({PENDULUM!r})"
        self.assertEqual(run(code), "")


class Threads(unittest.TestCase):
    def test_calls_of_many_threads_have_the_answers_of_one(self):
        scenes = [{**PENDULUM, "friction": {"kinetic_coefficient": 0.001 * i}} for i in range(200)]
        expected = [ricochet.solve(scene) for scene in scenes]
        with ricochet.Client() as client, concurrent.futures.ThreadPoolExecutor(8) as pool:
            self.assertEqual(list(pool.map(client.solve, scenes)), expected)

    def test_batches_of_many_threads_have_the_answers_of_one(self):
        expected = helped_batch()
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            self.assertEqual(set(pool.map(lambda _: helped_batch(), range(6))), {expected})

    def test_one_record_may_be_read_by_many(self):
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            for _ in range(20):
                outcome = ricochet.solve(PENDULUM)
                whole = list(pool.map(lambda reads: dict(reads), [outcome] * 8))
                self.assertTrue(all(one == whole[0] for one in whole))

    def test_other_threads_go_on_while_a_call_computes(self):
        ended = threading.Event()
        call = threading.Thread(target=lambda: (long_sweep(points=1_000), ended.set()))
        steps = 0
        call.start()
        while not ended.wait(0.001):
            steps += 1
        call.join()
        self.assertGreater(steps, 10)


class Forks(unittest.TestCase):
    def forked(self, work):
        """Returns what `work` gives in a child, as bytes."""
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                os.write(writing, work())
            finally:
                os._exit(0)
        os.close(writing)
        with os.fdopen(reading, "rb") as pipe:
            signal.signal(signal.SIGALRM, lambda *_: os.kill(child, signal.SIGKILL))
            signal.alarm(WAIT_S)
            found = pipe.read()
            signal.alarm(0)
        os.waitpid(child, 0)
        return found

    def test_a_child_and_its_parent_both_go_on(self):
        expected = helped_batch()
        for _ in range(3):
            self.assertEqual(self.forked(helped_batch), expected)
            self.assertEqual(helped_batch(), expected)

    def test_a_child_of_a_child_as_well(self):
        expected = helped_batch()
        self.assertEqual(self.forked(lambda: helped_batch() + self.forked(helped_batch)), 2 * expected)

    def test_a_client_of_its_own_as_well(self):
        with ricochet.Client() as client:
            newton = client.solve(PENDULUM).coefficients.newton
            child = self.forked(lambda: str(client.solve(PENDULUM).coefficients.newton).encode())
            self.assertEqual(float(child), newton)
            self.assertEqual(client.solve(PENDULUM).coefficients.newton, newton)

    def test_forks_one_after_the_other_beside_calls_that_grpc_still_destroys(self):
        # gRPC's own handler of a fork waits for ever if a thread of gRPC destroys a call meanwhile.
        with ricochet.Client() as client:
            for _ in range(50):
                regime = client.solve(PENDULUM).regime
                self.assertEqual(self.forked(regime.encode).decode(), regime)

    def test_what_was_not_read_yet_is_read_in_the_child(self):
        outcome = ricochet.solve(PENDULUM)
        self.assertEqual(self.forked(lambda: repr(outcome).encode()).decode(), repr(outcome))

    def test_a_fork_beside_a_thread_that_computes(self):
        # A server is asked by gRPC, which leaves alone a child that is forked while it is called.
        expected = helped_batch()
        local = ricochet.Client(None)
        started = threading.Event()
        busy = threading.Thread(target=long_sweep, args=(local, 2_000, lambda *_: started.set()))
        busy.start()
        self.assertTrue(started.wait(WAIT_S))
        self.assertEqual([self.forked(lambda: helped_batch(local)) for _ in range(3)], [expected] * 3)
        busy.join()

    def test_a_child_that_was_forked_beside_a_call_of_a_server_says_that_it_cannot_ask_one(self):
        server = Ricochetd()
        self.addCleanup(server.stop)
        with ricochet.Client(server.address) as client:
            started = threading.Event()
            busy = threading.Thread(target=long_sweep, args=(client, 2_000, lambda *_: started.set()))
            busy.start()
            self.assertTrue(started.wait(WAIT_S))
            try:
                child = self.forked(lambda: refusal(client))
            finally:
                busy.join()
            self.assertIn(b"cannot ask one", child)
            self.assertEqual(client.solve(PENDULUM).regime, "REBOUND")


def outcome_of(mu):
    return ricochet.solve({**PENDULUM, "friction": {"kinetic_coefficient": mu}})


class OtherProcesses(unittest.TestCase):
    def test_pools_give_records_tables_and_errors(self):
        expected = [outcome_of(mu) for mu in (0.0, 0.1, 0.2)]
        for method in ("fork", "spawn"):
            with self.subTest(method), multiprocessing.get_context(method).Pool(2) as pool:
                self.assertEqual(pool.map(outcome_of, (0.0, 0.1, 0.2)), expected)
                with self.assertRaises(ricochet.InvalidRequest) as raised:
                    pool.apply(outcome_of, (-1,))
                self.assertEqual(raised.exception.violations[0].field, "friction.kinetic_coefficient")

    def test_what_the_package_gives_can_be_pickled(self):
        table = ricochet.sweep(PENDULUM, {"mu": [0, 0.1]}, "newton", form="table")
        copy = pickle.loads(pickle.dumps(table))
        self.assertEqual((list(copy["newton"]), copy.attrs), (list(table["newton"]), table.attrs))
        scene = ricochet.Scene(PENDULUM)
        self.assertEqual(pickle.loads(pickle.dumps(scene)), scene)


class Interrupts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # A shell starts a program in the background with this signal ignored.
        cls.addClassCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))

    def interrupted(self, call):
        """Returns the time from a Ctrl-C to the KeyboardInterrupt that ends the call, s."""
        sent = []

        def send():
            time.sleep(0.3)
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        sender = threading.Thread(target=send)
        sender.start()
        with self.assertRaises(KeyboardInterrupt):
            call()
        ended = time.monotonic()
        sender.join()
        return ended - sent[0]

    def test_ctrl_c_ends_a_long_call(self):
        ranges = {"mu": (0.0, 0.9), "w_tt": (1.0, 9.0), "w_tn": (0.1, 0.9), "w_nn": (1.0, 9.0), "tangential": (-3, 3),
                  "planar_contact.normal_m_s": (-3, -0.1)}
        rigid = {name: part for name, part in SPRING.items() if name != "compliance"}
        calls = {
            "sweep": long_sweep,
            # The parts of a simple one come one right after the other.
            **{f"simple sweep {i}": lambda: ricochet.sweep(
                PENDULUM, {"mu": ricochet.Linspace(0, 0.3, 30_000_000)}, "newton", form="table") for i in range(4)},
            "batch": lambda: ricochet.solve_batch(SPRING, {"mu": np.linspace(0.1, 0.3, 100_000)}, "contact.duration_s"),
            "cost": lambda: ricochet.cost(PENDULUM, time_limit_s=50),
            "bounds": lambda: ricochet.bounds(rigid, ranges=ranges),
        }
        for name, call in calls.items():
            with self.subTest(name):
                # It takes 50 ms at most on a machine that does nothing else.
                self.assertLess(self.interrupted(call), 1)
        self.assertEqual(ricochet.solve(PENDULUM).regime, "REBOUND")

    def test_a_handler_that_returns_lets_the_call_go_on(self):
        seen = []
        before = signal.signal(signal.SIGALRM, lambda *_: seen.append(time.monotonic()))
        self.addCleanup(signal.signal, signal.SIGALRM, before)
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        table = long_sweep(points=1_000)
        ended = time.monotonic()
        self.assertEqual(len(table), 1_000)
        self.assertEqual(len(seen), 1)
        self.assertLess(seen[0], ended)

    def test_an_exception_of_a_progress_ends_the_sweep(self):
        def stop(done, total):
            raise LookupError(f"{done} of {total}")

        with self.assertRaisesRegex(LookupError, "of 10000000"):
            ricochet.sweep(SPRING, {"mu": ricochet.Linspace(0.1, 0.3, 10_000_000)}, "contact.duration_s", progress=stop)


if __name__ == "__main__":
    main()

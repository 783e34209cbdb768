"""The Python package as a client: its own server, other servers, errors, broken connections."""

import concurrent.futures
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path
from unittest import mock

import grpc
import numpy as np
import ricochet
from support import PENDULUM, SOURCE, Ricochetd, eventually

from ricochet.v1 import impact_service_pb2_grpc, sweep_pb2

ASK = f"import ricochet; scene = {PENDULUM!r}; newton = ricochet.solve(scene).coefficients.newton"


def servers_below(directory):
    """The processes whose command line names a socket in the directory."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if f"unix:{directory}".encode() in path.read_bytes():
                found.append(int(path.parent.name))
        except OSError:
            pass
    return found


class OwnServer(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = directory.name

    def start(self, code):
        # Without its handlers of fork gRPC aborts or hangs in a child.
        environment = {**os.environ, "TMPDIR": self.directory, "GRPC_ENABLE_FORK_SUPPORT": "1"}
        return subprocess.Popen(
            [sys.executable, "-c", textwrap.dedent(code)],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def expect_nothing_left(self):
        self.assertTrue(eventually(lambda: not servers_below(self.directory)), "a server still runs")
        self.assertTrue(eventually(lambda: not os.listdir(self.directory)), "its files remain")

    def test_it_ends_with_the_program(self):
        output, errors = self.start(f"{ASK}\nprint(newton)").communicate()
        self.assertEqual(output.strip(), "0.7071067811865475", errors)
        self.expect_nothing_left()

    def test_nobody_else_can_open_its_socket(self):
        process = self.start(f"import os; os.umask(0)\n{ASK}\nprint(newton, flush=True)\ninput()")
        self.addCleanup(process.communicate)
        self.assertTrue(process.stdout.readline())
        [directory] = Path(self.directory).iterdir()
        self.assertEqual(directory.stat().st_mode & 0o777, 0o700)
        self.assertEqual((directory / "socket").stat().st_mode & 0o777, 0o600)
        process.communicate("\n")

    def test_it_ends_with_an_exception(self):
        process = self.start(f"{ASK}\nraise SystemExit(3)")
        process.communicate()
        self.assertEqual(process.returncode, 3)
        self.expect_nothing_left()

    def test_it_ends_with_a_program_that_is_killed(self):
        process = self.start(f"{ASK}\nprint(newton, flush=True)\ninput()")
        self.addCleanup(process.communicate)
        self.assertTrue(process.stdout.readline())
        self.assertTrue(servers_below(self.directory))
        process.send_signal(signal.SIGKILL)
        self.expect_nothing_left()

    def test_close_stops_it_and_the_next_call_starts_another(self):
        with mock.patch.dict(os.environ, TMPDIR=self.directory), mock.patch.object(tempfile, "tempdir", None):
            with ricochet.Client() as client:
                client.solve(PENDULUM)
                self.assertTrue(servers_below(self.directory))
                client.close()
                self.expect_nothing_left()
                self.assertEqual(client.solve(PENDULUM).regime, "REBOUND")
            self.expect_nothing_left()

    def test_the_functions_of_the_module_work_after_a_fork(self):
        child = "print(ricochet.solve(scene).regime, flush=True); ricochet.close(); os._exit(0)"
        code = f"{ASK}\nimport os\nif os.fork() == 0:\n  {child}\nos.wait()"
        output, errors = self.start(code).communicate()
        self.assertEqual(output.strip(), "REBOUND", errors)
        self.expect_nothing_left()

    def test_a_client_works_after_a_fork_as_well(self):
        child = "print(client.solve(scene).regime, flush=True); client.close(); os._exit(0)"
        code = (f"import os, ricochet; scene = {PENDULUM!r}; client = ricochet.Client(); client.solve(scene)\n"
                f"if os.fork() == 0:\n  {child}\nos.wait(); print(client.solve(scene).regime)")
        output, errors = self.start(code).communicate()
        self.assertEqual(output.split(), ["REBOUND", "REBOUND"], errors)
        self.expect_nothing_left()

    def test_threads_that_ask_first_share_one_server(self):
        code = f"""
            import concurrent.futures, pathlib, ricochet, tempfile
            with concurrent.futures.ThreadPoolExecutor(8) as pool:
                list(pool.map(lambda _: ricochet.solve({PENDULUM!r}), range(8)))
            print(len(list(pathlib.Path(tempfile.gettempdir()).glob("ricochet-*"))))
        """
        output, errors = self.start(code).communicate()
        self.assertEqual(output.strip(), "1", errors)
        self.expect_nothing_left()

    def test_a_missing_program_is_named(self):
        with mock.patch.dict(os.environ, RICOCHETD="/nowhere/ricochetd"):
            with self.assertRaisesRegex(ricochet.Unavailable, "ricochetd was not found"):
                ricochet.Client().solve(PENDULUM)

    def test_a_program_that_fails_says_why(self):
        with mock.patch.dict(os.environ, RICOCHETD="/bin/false"):
            with self.assertRaisesRegex(ricochet.Unavailable, "did not start: it ended with 1"):
                ricochet.Client().solve(PENDULUM)


class Errors(unittest.TestCase):
    def violations(self, scene, **options):
        with self.assertRaises(ricochet.InvalidRequest) as raised:
            ricochet.solve(scene, **options)
        self.assertEqual(raised.exception.reason, "INVALID_REQUEST")
        return {violation.field: violation.description for violation in raised.exception.violations}

    def test_every_wrong_value_is_named_by_the_server(self):
        scene = {**PENDULUM, "friction": {"kinetic_coefficient": -1}, "restitution": {"energetic": 2}}
        self.assertEqual(set(self.violations(scene)), {"friction.kinetic_coefficient", "restitution.energetic"})

    def test_every_unknown_field_has_the_nearest_name(self):
        scene = {"pendulum": {"inertia_kg_m2": 1, "a": 0.3}, "fricton": {}}
        self.assertEqual(self.violations(scene)["fricton"], "is unknown; did you mean 'friction'?")
        self.assertIn("a_m", self.violations(scene)["pendulum.a"])

    def test_values_of_a_wrong_kind_are_named(self):
        scene = {"pendulum": {"inertia_kg_m2": "1", "a_m": True}, "friction": 0.1}
        self.assertEqual(set(self.violations(scene)), {"pendulum.inertia_kg_m2", "pendulum.a_m", "friction"})

    def test_two_systems_are_refused(self):
        found = self.violations({**PENDULUM, "planar_contact": {}})
        self.assertEqual(found, {"planar_contact": "is set together with pendulum: must not be"})

    def test_an_unknown_effect_is_named(self):
        self.assertIn("did you mean 'friction'", self.violations(PENDULUM, exclude=["frictions"])["exclude"])

    def test_an_inadmissible_outcome_is_an_error_if_strict(self):
        scene = {**PENDULUM, "restitution": {"newton": 0.9}}
        self.assertFalse(ricochet.solve(scene).admissible)
        with self.assertRaises(ricochet.Inadmissible) as raised:
            ricochet.solve(scene, strict=True)
        self.assertEqual(raised.exception.reason, "INADMISSIBLE_OUTCOME")

    def test_a_result_above_the_largest_double_is_out_of_range(self):
        scene = {**PENDULUM, "pendulum": {"inertia_kg_m2": 1e300, "a_m": 0.3, "omega_minus_rad_s": -1e30}}
        with self.assertRaises(ricochet.OutOfRange) as raised:
            ricochet.solve(scene)
        self.assertIsInstance(raised.exception, OverflowError)

    def test_a_server_that_is_not_there_is_unavailable(self):
        with ricochet.Client("unix:/nowhere/socket", deadline="5s") as client:
            with self.assertRaises(ricochet.Unavailable):
                client.solve(PENDULUM)

    def test_arrays_of_different_lengths_are_refused(self):
        with self.assertRaises(ricochet.InvalidRequest) as raised:
            ricochet.solve_batch(PENDULUM, {"pendulum.a_m": [1, 2, 3], "pendulum.b_m": [1, 2]}, ["coefficients.newton"])
        self.assertEqual([violation.field for violation in raised.exception.violations], ["pendulum.b_m"])

    def test_a_record_names_the_nearest_attribute(self):
        with self.assertRaisesRegex(AttributeError, "did you mean 'newton'"):
            _ = ricochet.solve(PENDULUM).coefficients.newtn


class Scenes(unittest.TestCase):
    def test_files_of_both_forms_are_read(self):
        for name in ("spatial_body.json", "double_pendulum.textproto"):
            scene = ricochet.read_scene(SOURCE / "tests/data/scenes" / name)
            self.assertEqual(ricochet.solve(scene).termination, "CONVERGED")

    def test_what_is_not_set_is_none(self):
        outcome = ricochet.solve(PENDULUM)
        self.assertIsNone(outcome.contact)
        self.assertIsNone(outcome.certificate)


class Options(unittest.TestCase):
    def refuse(self, field, **options):
        with self.assertRaises(ricochet.InvalidRequest) as raised:
            ricochet.Client(**options)
        self.assertEqual([violation.field for violation in raised.exception.violations], [field])

    def test_numbers_and_truths_are_taken_as_such(self):
        options = ricochet.Client(deadline=2.5, max_receive=1000, tls=True)._options
        self.assertEqual((options.deadline_s(), options.max_receive_bytes(), options.is_tls), (2.5, 1000, True))

    def test_wrong_ones_are_refused(self):
        self.refuse("deadline", deadline="soon")
        self.refuse("deadline", deadline="0s")
        self.refuse("tls", tls="yes")
        self.refuse("tls_key", server="localhost:1", tls_cert="cert.pem")
        self.refuse("token", server="192.0.2.1:1", token="secret")
        self.refuse("token", server="localhost:1", token="secret", token_file="file")

    def test_a_file_and_the_environment_set_them(self):
        server = Ricochetd()
        self.addCleanup(server.stop)
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(f'server = "{server.address}"\ndeadline = "1ms"\n')
            file.flush()
            with mock.patch.dict(os.environ, RICOCHET_CONFIG=file.name, RICOCHET_DEADLINE="20s"):
                with ricochet.Client() as client:
                    self.assertEqual(client.solve(PENDULUM).regime, "REBOUND")
                    self.assertIsNone(client._embedded)

    def test_an_unknown_line_of_the_file_is_refused(self):
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write('sever = "x"\n')
            file.flush()
            self.refuse("config", config=file.name)

    def test_the_next_server_stands_in_for_one_that_is_gone(self):
        server = Ricochetd()
        self.addCleanup(server.stop)
        with ricochet.Client(f"unix:/nowhere/socket,{server.address}") as client:
            self.assertEqual(client.solve(PENDULUM).regime, "REBOUND")
            table = client.sweep(PENDULUM, {"restitution.energetic": [0, 1]}, ["coefficients.newton"])
            self.assertEqual(len(table), 2)


def openssl(*arguments):
    subprocess.run(["openssl", *arguments], check=True, capture_output=True)


class Security(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        directory = tempfile.TemporaryDirectory()
        cls.addClassCleanup(directory.cleanup)
        cls.key, cls.cert, cls.tokens, cls.token = [os.path.join(directory.name, name) for name in "kcts"]
        openssl(
            "req",
            "-x509",
            "-newkey",
            "ec",
            "-pkeyopt",
            "ec_paramgen_curve:prime256v1",
            "-nodes",
            "-keyout",
            cls.key,
            "-out",
            cls.cert,
            "-days",
            "2",
            "-subj",
            "/CN=ricochet.test",
            "-addext",
            "subjectAltName=DNS:ricochet.test",
        )
        Path(cls.token).write_text("secret\n")
        # The SHA-256 of "secret".
        digest = "2bb80d537b1da3e38bd30361aa855686bde0eacd7162fef6a25fe97bf527a25b"
        Path(cls.tokens).write_text(f"tester sha256:{digest} solve\n")
        os.chmod(cls.tokens, 0o600)
        cls.server = Ricochetd("--tls-cert", cls.cert, "--tls-key", cls.key, "--tokens", cls.tokens)
        cls.addClassCleanup(cls.server.stop)

    def solve(self, **options):
        with ricochet.Client(self.server.address, server_name="ricochet.test", deadline="5s", **options) as client:
            return client.solve(PENDULUM)

    def test_a_token_and_the_right_authority_let_in(self):
        self.assertEqual(self.solve(tls_ca=self.cert, token="secret").regime, "REBOUND")
        self.assertEqual(self.solve(tls_ca=self.cert, token_file=self.token).regime, "REBOUND")

    def test_others_are_refused(self):
        for wrong, code in [
            ({"tls_ca": self.cert}, "UNAUTHENTICATED"),
            ({"tls_ca": self.cert, "token": "guess"}, "UNAUTHENTICATED"),
            ({"token": "secret"}, "UNAVAILABLE"),
        ]:
            with self.subTest(wrong), self.assertRaises(ricochet.RicochetError) as raised:
                self.solve(**wrong)
            self.assertEqual(raised.exception.code, code)


class BreakingService(impact_service_pb2_grpc.ImpactServiceServicer):
    """Sweeps of the points 0, 1, 2, ... that break off after two points of each call."""

    def __init__(self, fingerprints):
        self.fingerprints = list(fingerprints)
        self.firsts = []

    def Sweep(self, request, context):
        self.firsts.append(request.first_index)
        fingerprint = self.fingerprints[min(len(self.firsts), len(self.fingerprints)) - 1]
        total = 5
        for index in range(request.first_index, total):
            if index == request.first_index + 2:
                context.abort(grpc.StatusCode.UNAVAILABLE, "the server stops")
            chunk = sweep_pb2.SweepResponse(
                first_index=index,
                count=1,
                values=struct.pack("<d", index),
                regimes=b"\x02",
                statuses=b"\x02",
                points_total=total,
            )
            chunk.engine.fingerprint = fingerprint
            chunk.tallies.points = index + 1 - request.first_index
            chunk.tallies.inadmissible.count = index + 1 - request.first_index
            if index == total - 1:
                chunk.summary.points = total
            yield chunk


class BrokenSweeps(unittest.TestCase):
    def sweep(self, *fingerprints):
        self.service = BreakingService(fingerprints)
        server = grpc.server(concurrent.futures.ThreadPoolExecutor(2))
        impact_service_pb2_grpc.add_ImpactServiceServicer_to_server(self.service, server)
        port = server.add_insecure_port("127.0.0.1:0")
        server.start()
        self.addCleanup(server.stop, None)
        with ricochet.Client(f"127.0.0.1:{port}") as client:
            return client.sweep(PENDULUM, {"restitution.energetic": np.linspace(0, 1, 5)}, ["coefficients.newton"])

    def test_they_go_on_from_the_first_point_that_has_not_arrived(self):
        table = self.sweep("same")
        self.assertEqual(list(table["coefficients.newton"]), [0, 1, 2, 3, 4])
        self.assertEqual(self.service.firsts, [0, 2, 4])
        self.assertEqual(table.summary.inadmissible, 5)

    def test_points_of_two_engines_are_not_joined(self):
        with self.assertRaisesRegex(ricochet.RicochetError, "another engine"):
            self.sweep("one", "two")


class Units(unittest.TestCase):
    def test_units_are_those_of_the_comments_in_the_protos(self):
        # A comment states the unit after the last comma before its first full stop: "a, horizontal distance, m. > 0."
        units = [
            "kg m²",
            "1/kg",
            "rad/s",
            "m/s²",
            "m/s",
            "N s",
            "N m",
            "N/m^1.5",
            "N/m^p",
            "N/m",
            "s/m",
            "rad",
            "kg",
            "m",
            "N",
            "J",
            "s",
        ]
        pattern = r"((?: *//.*\n)+) *(?:optional |repeated )?double (\w+) = \d+;"
        checked = set()
        for name in ("scene", "outcome"):
            text = (SOURCE / f"proto/ricochet/v1/{name}.proto").read_text()
            for comment, field in re.findall(pattern, text):
                words = " ".join(line.strip().removeprefix("//").strip() for line in comment.splitlines())
                stated = re.search(rf", ({'|'.join(map(re.escape, units))})(?:\.|,|:| \d|$)", words)
                if stated:
                    checked.add(field)
                    self.assertEqual(
                        ricochet.unit_of(f"message.{field}").replace("^2", "²"), stated[1], f"{field}: {words}"
                    )
        self.assertGreater(len(checked), 40)

    def test_every_name_with_an_ending_of_a_unit_has_one(self):
        self.assertEqual(ricochet.unit_of("contact.peak_normal_n"), "N")
        self.assertEqual(ricochet.unit_of("contact.duration_s"), "s")
        self.assertEqual(ricochet.unit_of("friction.kinetic_coefficient"), "1")
        self.assertEqual(ricochet.unit_of("compliance.tangential_ratio_squared"), "1")


if __name__ == "__main__":
    unittest.main()

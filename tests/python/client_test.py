"""The Python package as a client: scenes, errors, servers that are named, broken connections."""

import concurrent.futures
import copy
import json
import os
import pickle
import re
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import grpc
import numpy as np
import ricochet
from support import PENDULUM, SOURCE, Ricochetd, main

from ricochet.v1 import impact_service_pb2_grpc

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

    def test_files_with_several_contacts_are_read(self):
        text = subprocess.run([os.environ["RICOCHET"], "scene", "template", "box_on_two_feet"], check=True,
                              capture_output=True).stdout
        with tempfile.TemporaryDirectory() as directory:
            path = Path(directory, "box.textproto")
            path.write_bytes(text)
            scene = ricochet.read_scene(path)
            path.write_bytes(text.replace(b"friction", b"fricton"))
            with self.assertRaisesRegex(ricochet.InvalidRequest, r"box\.textproto is not a ricochet\.v1\.Multi.*fricton"):
                ricochet.read_scene(path)
        self.assertEqual([contact["friction"] for contact in scene["contacts"]], [1, 1])
        self.assertEqual(ricochet.multicontact(scene).verdict, "ORDER_MATTERS")
        with self.assertRaisesRegex(ricochet.InvalidRequest, "contacts is a list of several contacts, which only mul"):
            ricochet.solve(scene)
        self.assertEqual({row.method.multi_contact for row in ricochet.cost(scene, samples=1).rows},
                         {"ORDERS", "SPRINGS", "POSSIBLE"})

    def test_what_is_not_set_is_none(self):
        outcome = ricochet.solve(PENDULUM)
        self.assertIsNone(outcome.contact)
        self.assertIsNone(outcome.certificate)

    def test_one_that_was_read_once_has_the_answers_of_its_dictionary(self):
        scene = ricochet.Scene(PENDULUM)
        self.assertEqual(ricochet.solve(scene), ricochet.solve(PENDULUM))
        self.assertEqual(ricochet.plan(scene), ricochet.plan(PENDULUM))
        self.assertEqual(ricochet.bounds(scene, ranges={"mu": (0, 0.1)}), ricochet.bounds(PENDULUM, ranges={"mu": (0, 0.1)}))
        self.assertEqual(ricochet.audit(scene, rates_after=0.5), ricochet.audit(PENDULUM, rates_after=0.5))
        for call in (ricochet.solve_batch, ricochet.sweep):
            options = {"form": "table"} if call is ricochet.sweep else {}
            tables = [call(one, {"mu": [0, 0.1]}, "newton", **options) for one in (scene, PENDULUM)]
            self.assertEqual(list(tables[0]["newton"]), list(tables[1]["newton"]))
        self.assertEqual(ricochet.Scene(scene.to_dict()), scene)
        self.assertEqual(eval(repr(scene), {"Scene": ricochet.Scene}), scene)


class Records(unittest.TestCase):
    """The entries of an outcome are made when they are asked for, which nobody may notice."""

    def setUp(self):
        self.whole = ricochet.solve(PENDULUM).copy()

    def test_each_way_of_reading_reads_all(self):
        ways = {
            "dict": dict,
            "keys": lambda outcome: dict(zip(outcome.keys(), outcome.values())),
            "items": lambda outcome: dict(outcome.items()),
            "unpacked": lambda outcome: {**outcome},
            "arguments": lambda outcome: (lambda **given: given)(**outcome),
            "update": lambda outcome: (lambda given: given.update(outcome) or given)({}),
            "union": lambda outcome: {} | outcome,
            "union from the left": lambda outcome: outcome | {},
            "copy": lambda outcome: outcome.copy(),
            "shallow copy": copy.copy,
            "deep copy": copy.deepcopy,
            "json": lambda outcome: json.loads(json.dumps(outcome)),
            "pickle": lambda outcome: pickle.loads(pickle.dumps(outcome)),
            "iteration": lambda outcome: {name: outcome[name] for name in outcome},
            "get": lambda outcome: {name: outcome.get(name) for name in self.whole},
            "pop": lambda outcome: {name: outcome.pop(name) for name in self.whole},
            "attributes": lambda outcome: {name: getattr(outcome, name) for name in self.whole},
            "after one entry": lambda outcome: (outcome.work, dict(outcome))[1],
        }
        for name, read in ways.items():
            with self.subTest(name):
                found = read(ricochet.solve(PENDULUM))
                self.assertEqual(found, self.whole)
                self.assertEqual(list(found), list(self.whole))

    def test_each_question_is_about_all(self):
        solve = lambda: ricochet.solve(PENDULUM)
        self.assertEqual(len(solve()), len(self.whole))
        self.assertIn("work", solve())
        self.assertNotIn("wrok", solve())
        self.assertTrue(solve() == solve() and self.whole == solve() and solve() == self.whole)
        self.assertFalse(solve() != solve() or self.whole != solve())
        self.assertEqual(list(reversed(solve())), list(reversed(self.whole)))
        self.assertEqual(repr(solve()), repr(ricochet.Record(self.whole)))
        self.assertLess(set(self.whole), set(dir(solve())))
        self.assertIsInstance(solve(), ricochet.Record)
        for name in ("wrok", 3):
            with self.assertRaises(KeyError):
                _ = solve()[name]

    def test_an_entry_stays_the_same_object(self):
        outcome = ricochet.solve(PENDULUM)
        work = outcome.work
        self.assertIs(outcome["work"], work)
        self.assertIs(dict(outcome)["work"], work)

    def test_it_can_be_changed_as_a_dictionary(self):
        outcome = ricochet.solve(PENDULUM)
        outcome["work"] = 1
        del outcome["impulse"]
        self.assertEqual(outcome, {**{name: value for name, value in self.whole.items() if name != "impulse"}, "work": 1})
        outcome.clear()
        self.assertEqual(outcome, {})


class Options(unittest.TestCase):
    def refuse(self, field, **options):
        with self.assertRaises(ricochet.InvalidRequest) as raised:
            ricochet.Client(**options)
        self.assertEqual([violation.field for violation in raised.exception.violations], [field])

    def test_numbers_and_truths_are_taken_as_such(self):
        options = ricochet.Client(deadline=2.5, max_receive=1000, tls=True)._options
        self.assertEqual((options["deadline"], options["max_receive"], options["tls"]), (2.5, 1000, True))

    def test_wrong_ones_are_refused(self):
        self.refuse("deadline", deadline="soon")
        self.refuse("deadline", deadline="0s")
        for deadline in (1e-5, 5e20, float("nan"), -1):
            with self.assertRaisesRegex(ricochet.InvalidRequest, re.escape(f"= {deadline}: must be a time from 1ms")):
                ricochet.Client(deadline=deadline)
        self.assertEqual(ricochet.Client(deadline=None, server=None)._options["deadline"], None)
        self.refuse("server", server=5)
        self.refuse("tls_ca", tls_ca=b"ca.pem")
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
                    self.assertIsNotNone(client.info().server_limits)

    def test_an_empty_setting_is_refused(self):
        for name in ("CONFIG", "SERVER", "TLS_CA", "TOKEN"):
            with self.subTest(name), mock.patch.dict(os.environ, {f"RICOCHET_{name}": ""}):
                self.refuse(f"RICOCHET_{name}")
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write('tls-ca = ""\n')
            file.flush()
            self.refuse("config", config=file.name)

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
            table = client.sweep(PENDULUM, {"restitution.energetic": [0, 1]}, ["newton"], form="table")
            self.assertEqual(len(table), 2)


    def test_rows_above_the_limits_of_a_server_are_asked_in_parts(self):
        server = Ricochetd("--max-batch-numbers", "10", "--max-audit-rows", "2")
        self.addCleanup(server.stop)
        fields, columns = {"mu": np.linspace(0, 0.2, 25)}, ["newton", "impulse.normal_total_n_s"]
        rates = {"rates_after": [np.linspace(0, 0.4, 5)]}
        with ricochet.Client() as here, ricochet.Client(server.address) as there:
            expected = here.solve_batch(PENDULUM, fields, columns)
            answer = there.solve_batch(PENDULUM, fields, columns)
            for name in columns:
                self.assertEqual(answer[name].tobytes(), expected[name].tobytes())
            self.assertEqual(answer.summary.rows, 25)
            self.assertEqual(len(there.audit_batch(PENDULUM, rates)), 5)

    def test_an_audit_above_the_bytes_of_a_message_is_asked_in_parts(self):
        server = Ricochetd()
        self.addCleanup(server.stop)
        count, rows = 16, 8000  # Columns of 2 MiB; a message has 1.
        arm = {"mechanism": {"mass_matrix": np.eye(count).ravel(), "jacobian": np.eye(2, count).ravel(),
                             "rates": np.zeros(count)}, "friction": {"kinetic_coefficient": 0.5}}
        states = {f"mechanism.rates[{i}]": np.full(rows, -1.0 if i == 1 else 0.25 * i) for i in range(count)}
        states["rates_after"] = [np.full(rows, 0.5 if i == 1 else 0.25 * i) for i in range(count)]
        with ricochet.Client(server.address) as there:
            table = there.audit_batch(arm, states)
        self.assertEqual((table.summary.rows, table.summary.admissible), (rows, rows))
        np.testing.assert_array_equal(table["coefficients.newton"], 0.5)


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
            ({"token": "secret"}, "FAILED_PRECONDITION"),
        ]:
            with self.subTest(wrong), self.assertRaises(ricochet.RicochetError) as raised:
                self.solve(**wrong)
            self.assertEqual(raised.exception.code, code)


class BreakingService(impact_service_pb2_grpc.ImpactServiceServicer):
    """Passes sweeps on to a server, and breaks off after two messages of each call."""

    def __init__(self, address, fingerprints):
        self._channel = grpc.insecure_channel(address)
        self._stub = impact_service_pb2_grpc.ImpactServiceStub(self._channel)
        self.fingerprints = list(fingerprints)
        self.calls = []

    def Sweep(self, request, context):
        self.calls.append(request.first_index)
        answers = self._stub.Sweep(request)
        for count, chunk in enumerate(answers):
            if count == 2:
                answers.cancel()
                context.abort(grpc.StatusCode.UNAVAILABLE, "the server stops")
            chunk.engine.fingerprint = self.fingerprints[min(len(self.calls), len(self.fingerprints)) - 1]
            yield chunk

    def close(self):
        self._channel.close()


class BrokenSweeps(unittest.TestCase):
    COUNT = 300_000

    def sweep(self, *fingerprints):
        behind = Ricochetd()
        self.addCleanup(behind.stop)
        self.service = BreakingService(behind.address, fingerprints)
        self.addCleanup(self.service.close)
        server = grpc.server(concurrent.futures.ThreadPoolExecutor(2))
        impact_service_pb2_grpc.add_ImpactServiceServicer_to_server(self.service, server)
        port = server.add_insecure_port("127.0.0.1:0")
        server.start()
        self.addCleanup(server.stop, None)
        with ricochet.Client(f"127.0.0.1:{port}") as client:
            axis = ricochet.Linspace(0, 1, self.COUNT)
            return client.sweep({**PENDULUM, "friction": {}}, {"restitution.energetic": axis}, "newton", form="table")

    def test_they_go_on_from_the_first_point_that_has_not_arrived(self):
        table = self.sweep("same")
        np.testing.assert_array_max_ulp(table["coefficients.newton"], np.linspace(0, 1, self.COUNT), 4)
        self.assertGreater(len(self.service.calls), 1)
        self.assertEqual(self.service.calls, sorted(self.service.calls))
        self.assertEqual(table.codes["status"].counts(), {"OK": self.COUNT})
        self.assertEqual(table.codes["status"][:2], ["OK", "OK"])
        self.assertEqual(list(table), list(table.keys()))
        self.assertEqual(list(table), list(table.columns))
        self.assertEqual([name in table for name in (list(table)[0], "no such name", 0)], [True, False, False])

    def test_points_of_two_engines_are_not_joined(self):
        with self.assertRaisesRegex(ricochet.RicochetError, "come from the engine .*two.*, those before from .*one"):
            self.sweep("one", "two")


class Restarts(unittest.TestCase):
    def test_a_server_that_is_back_soon_answers(self):
        # Both ::1 and 127.0.0.1 are localhost, so that one of the addresses always refuses.
        for host in ("127.0.0.1", "localhost"):
            with self.subTest(host):
                server = Ricochetd()
                client = ricochet.Client(f"{host}:{server.address.rpartition(':')[2]}")
                server.stop()
                self.assertFalse(any(self.answers(client) for _ in range(8)))
                server = Ricochetd(address=server.address)
                self.addCleanup(server.stop)
                self.assertTrue(any(self.answers(client) for _ in range(10)))

    def answers(self, client):
        try:
            return client.solve(PENDULUM).admissible
        except ricochet.Unavailable:
            return False


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
    main()

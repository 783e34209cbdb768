"""`ricochet explore` as HTTP with JSON, asked by curl and by bare sockets, and what those get who must not ask.

usage: explore_test.py RICOCHET WORK_DIRECTORY
"""

import base64
import concurrent.futures
import http.client
import json
import re
import select
import signal
import socket
import struct
import subprocess
import unittest

from ricochet_case import RICOCHET, RicochetCase, WORK

PENDULUM = {"pendulum": {"inertia_kg_m2": 1.3, "a_m": 0.3, "b_m": 1, "omega_minus_rad_s": -2},
            "friction": {"kinetic_coefficient": 0.1}, "restitution": {"energetic": 0.9}}
SERVICE = "/ricochet.v1.ImpactService/"


class ExploreTest(RicochetCase):

    def setUp(self):
        # One that was started in the background ignores Ctrl-C.
        self.server = subprocess.Popen([RICOCHET, "explore"], cwd=WORK, text=True, stdout=subprocess.PIPE,
                                       preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
        self.addCleanup(self.server.stdout.close)
        self.addCleanup(self.server.kill)
        url = self.server.stdout.readline()
        self.host, self.token = re.fullmatch(r"http://([0-9.]+:[0-9]+)/\?token=([0-9a-f]{32})\n", url).groups()

    def tearDown(self):
        self.assertEqual(self.server.poll(), None)
        self.assertEqual(self.curl(method="Info")[0], 200)
        self.server.send_signal(signal.SIGINT)
        self.assertEqual(self.server.wait(10), 0)

    def curl(self, request=None, method="Solve", headers=(), path=None, body=None, kind="application/json"):
        """Posts a request by curl. Returns the status of HTTP and the answer in JSON."""
        command = ["curl", "--silent", "--max-time", "20", "--path-as-is", "--write-out", "\n%{http_code}"]
        for header in (f"Content-Type: {kind}", f"Authorization: Bearer {self.token}", *headers):
            command += ["--header", header]
        body = json.dumps(request or {}) if body is None else body
        done = subprocess.run([*command, "--data-binary", "@-", f"http://{self.host}{path or SERVICE + method}"],
                              input=body, text=True, stdout=subprocess.PIPE, check=True)
        answer, status = done.stdout.rsplit("\n", 1)
        return int(status), json.loads(answer) if answer.startswith("{") else answer

    def sent(self, text):
        """The first line of the answer to the bytes of a request, and whatever else comes."""
        with socket.create_connection(self.host.split(":"), timeout=20) as connection:
            connection.sendall(text.encode("latin-1"))
            with connection.makefile("rb") as answer:
                return answer.readline().decode().strip(), answer.read().decode()

    def test_solves_with_the_digits_of_the_command_line(self):
        (WORK / "scene.json").write_text(json.dumps(PENDULUM), encoding="utf-8")
        solved = json.loads(self.made("solve", "--scene", "scene.json", "--format", "json"))
        status, answer = self.curl({"scene": PENDULUM})
        self.assertEqual((status, answer["outcome"]), (200, solved["outcome"]))

    def test_answers_the_other_calls(self):
        status, bounds = self.curl({"scene": PENDULUM}, "Bounds")
        self.assertEqual((status, bounds["bounds"]["sharp"]["newton"]["lower"]), (200, 0), bounds)
        fields = base64.b64encode(bytes.fromhex("0000000000000000" "9a9999999999b93f")).decode()  # 0 and 0.1
        status, rows = self.curl({"setup": {"scene": PENDULUM, "fields": ["friction.kinetic_coefficient"],
                                            "columns": ["coefficients.newton"]}, "inputs": [fields]}, "SolveBatch")
        self.assertEqual(status, 200, rows)
        newton = base64.b64decode(rows["outputs"][0])
        self.assertEqual(len(newton), 16)
        status, plan = self.curl({"scene": PENDULUM}, "Plan")
        self.assertEqual((status, plan["plan"]["model"]), (200, "MODEL_PENDULUM"))
        speeds = [1, 2, 3]
        status, fit = self.curl({
            "scene": {**PENDULUM, "friction": {}}, "unknowns": [{"path": "restitution.energetic"}],
            "inputs": [{"path": "pendulum.omega_minus_rad_s", "values": [-speed for speed in speeds]}],
            "measured": [{"path": "rates_after_rad_s[0]", "values": [0.6 * speed for speed in speeds], "sigma": [0.01]}]}, "Fit")
        self.assertEqual(status, 200, fit)
        self.assertAlmostEqual(fit["unknowns"][0]["value"], 0.6, delta=1e-12)  # A smooth surface: w+ = -e w-.

    def test_every_border_over_friction_is_narrow(self):
        # Two borders of this rod lie within 0.02.
        rod = {"planar_body": {"mass_kg": 1, "inertia_com_kg_m2": 0.0950759067978801, "offset_t_m": -0.8652130762749417,
                               "offset_n_m": -3.3229995166448827, "velocity_t_m_s": -0.3526307943415954,
                               "velocity_n_m_s": -1}, "friction": {"kinetic_coefficient": 0.3},
               "restitution": {"energetic": 0.5}}
        status, answers = self.curl({"scene": rod}, path="/answers")
        self.assertEqual(status, 200)
        asked = answers["over"]["request"]
        mu = struct.unpack(f"{len(base64.b64decode(asked['inputs'][0])) // 8}d", base64.b64decode(asked["inputs"][0]))
        regimes = base64.b64decode(self.curl(asked, "SolveBatch")[1]["regimes"])
        borders = [(low, high) for low, high, x, y in zip(mu, mu[1:], regimes, regimes[1:]) if x != y and low > 0]
        self.assertGreaterEqual(len(borders), 2)
        for low, high in borders:
            self.assertLess(high - low, 1e-5)

    def test_computes_what_takes_a_deep_stack(self):
        feet = {"contact_matrix": {"w_per_kg": [3.4, -1.2, 3.4, 1.2, -1.2, 1.6, -1.2, 0.4, 3.4, -1.2, 3.4, 1.2, 1.2, 0.4,
                                                1.2, 1.6], "velocity_m_s": [0, -1, 0, -1]},
                "contacts": [{"friction": 1, "energetic": 0.5}] * 2}
        (WORK / "feet.json").write_text(json.dumps(feet), encoding="utf-8")
        answers = json.loads(self.made("multicontact", "--scene", "feet.json", "--stiffness-ratio", "2=0.01:100",
                                       "--format", "json"))["answers"]
        status, answer = self.curl({"scene": feet, "stiffness_range": {"contact": 2, "low": 0.01, "high": 100}},
                                   "MultiContact")
        self.assertEqual((status, answer["answers"]), (200, answers))
        status, answer = self.curl({"scene": PENDULUM, "certified_digits": 1000})
        self.assertEqual(status, 200, answer)
        lasting = {**PENDULUM, "compliance": {"hertz": {"stiffness_n_m1_5": 1e5}}}
        status, answer = self.curl({"scene": lasting, "required": ["EFFECT_FINITE_DURATION"]})
        self.assertEqual(status, 200, answer)

    def test_takes_the_word_bearer_in_any_case(self):
        for word, expected in (("bearer", "200 OK"), ("BEARER", "200 OK"), ("basic", "401 Unauthorized")):
            self.assertEqual(self.sent(f"GET / HTTP/1.1\r\nHost: {self.host}\r\nAuthorization: {word} {self.token}\r\n"
                                       "Connection: close\r\n\r\n")[0], f"HTTP/1.1 {expected}")

    def test_names_every_field_that_is_wrong(self):
        wrong = {**PENDULUM, "pendulum": {**PENDULUM["pendulum"], "a_m": -1, "inertia_kg_m2": 0}}
        status, error = self.curl({"scene": wrong})
        self.assertEqual((status, error["code"]), (400, "invalid_argument"))
        details = {detail["type"]: detail["debug"] for detail in error["details"]}
        fields = [one["field"] for one in details["google.rpc.BadRequest"]["fieldViolations"]]
        self.assertEqual(sorted(fields), ["pendulum.a_m", "pendulum.inertia_kg_m2"])

    def test_refuses_what_is_no_call(self):
        for path in (SERVICE + "Solved", "/" + "../" * 8 + "etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/favicon.ico"):
            status, error = self.curl({}, path=path)
            self.assertIn(status, (400, 404), (path, error))
            self.assertNotIn("root:", str(error))
        self.assertEqual(self.curl(body="{")[0], 400)
        self.assertEqual(self.curl({"scene": PENDULUM, "unknown": 1})[0], 400)
        self.assertEqual(self.curl({}, kind="text/plain")[0], 415)
        self.assertEqual(self.sent(f"GET {SERVICE}Solve?token={self.token} HTTP/1.1\r\nHost: {self.host}\r\n"
                                   "Connection: close\r\n\r\n")[0], "HTTP/1.1 405 Method Not Allowed")
        for method in ("POST", "DELETE"):
            self.assertEqual(self.sent(f"{method} /?token={self.token} HTTP/1.1\r\nHost: {self.host}\r\n"
                                       "Content-Length: 0\r\nConnection: close\r\n\r\n")[0],
                             "HTTP/1.1 405 Method Not Allowed")

    def test_keeps_the_deadline_of_a_client(self):
        scene = {"spatial_contact": {"w_per_kg": [1.96, 0.24, 0.6, 2.96, -0.8, 1.85], "tangential_m_s": [1, 0.6],
                                     "normal_m_s": -1},
                 "friction": {"kinetic_coefficient": 0.3}, "restitution": {"energetic": 0.5}}
        rows = {"tangential_after_m_s": [0.1] * 8192, "tangential_2_after_m_s": [0.1], "normal_after_m_s": [0.4]}
        status, error = self.curl({"scene": scene, "columns": rows}, "AuditBatch", headers=["Connect-Timeout-Ms: 1"])
        self.assertEqual((status, error["code"]), (504, "deadline_exceeded"))
        self.assertEqual(self.curl({"scene": PENDULUM}, headers=["Connect-Timeout-Ms: soon"])[0], 400)

    def test_answers_nobody_from_elsewhere(self):
        for header in ("Host: evil.example", f"Host: evil.example:{self.host.split(':')[1]}", "Host: 127.0.0.1:1",
                       "Origin: http://evil.example", "Origin: http://", "Origin: null", "Origin: https://" + self.host,
                       "Authorization: Bearer " + "0" * 32, "Authorization:"):
            name = header.split(":")[0]
            headers = [header] if name != "Authorization" else []
            lines = [f"POST {SERVICE}Info HTTP/1.1", *([] if name == "Host" else [f"Host: {self.host}"]),
                     *([header] if name == "Authorization" else [f"Authorization: Bearer {self.token}"]), *headers,
                     "Content-Type: application/json", "Content-Length: 2", "Connection: close"]
            first, rest = self.sent("\r\n".join(lines) + "\r\n\r\n{}")
            self.assertRegex(first, "HTTP/1.1 40[13] ", header)
            self.assertNotIn("version", rest, header)
            self.assertNotRegex(rest.lower(), "access-control-allow", header)
        first, rest = self.sent(f"GET / HTTP/1.1\r\nHost: {self.host}\r\nConnection: close\r\n\r\n")
        self.assertEqual(first, "HTTP/1.1 401 Unauthorized")
        self.assertNotIn("<html", rest)

    def test_lets_its_page_run_nothing_of_others(self):
        first, rest = self.sent(f"GET /?token={self.token} HTTP/1.1\r\nHost: {self.host}\r\nConnection: close\r\n\r\n")
        self.assertEqual(first, "HTTP/1.1 200 OK")
        policy = re.search("Content-Security-Policy: (.*)\r", rest).group(1)
        self.assertIn("default-src 'none'", policy)
        self.assertIn("frame-ancestors 'none'", policy)
        self.assertNotIn("unsafe", policy)

    def test_refuses_a_long_body(self):
        status, error = self.curl(body=" " * (2 << 20))
        self.assertEqual((status, error["code"]), (429, "resource_exhausted"))

    def test_goes_on_beside_requests_that_are_half_sent(self):
        halves = []
        for _ in range(300):
            half = socket.create_connection(self.host.split(":"))
            self.addCleanup(half.close)
            half.sendall(f"POST {SERVICE}Info HTTP/1.1\r\nHost: {self.host}\r\nContent-Le".encode())
            halves.append(half)
        self.assertEqual(self.curl({"scene": PENDULUM})[0], 200)
        self.assertEqual(select.select(halves, [], [], 0)[0], [], "the call waited until the server dropped others")
        for half in halves:
            half.settimeout(30)
            while half.recv(4096):
                pass  # It ends: the server drops who sends too slowly.

    def test_goes_on_under_a_thousand_requests(self):
        def ask(_):
            connection = http.client.HTTPConnection(self.host, timeout=60)
            try:
                codes = set()
                for _ in range(125):
                    connection.request("POST", SERVICE + "Solve", json.dumps({"scene": PENDULUM}),
                                       {"Authorization": "Bearer " + self.token, "Content-Type": "application/json"})
                    reply = connection.getresponse()
                    reply.read()
                    codes.add(reply.status)
                return codes
            finally:
                connection.close()
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            self.assertEqual(set().union(*pool.map(ask, range(8))), {200})


if __name__ == "__main__":
    unittest.main()

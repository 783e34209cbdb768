"""Asks a real ricochetd by reflection alone: no proto file and no stub of this repository is used.

usage: reflection_client_test.py RICOCHETD WORK_DIRECTORY
"""

import math
import re
import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path

import grpc
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

WORK, RICOCHETD = Path(sys.argv.pop()), sys.argv.pop()
DEADLINE_S = 20
SCENE = {
    "pendulum": {"inertia_kg_m2": 1, "a_m": 0.3, "b_m": 1, "omega_minus_rad_s": -1},
    "friction": {"kinetic_coefficient": 0.1},
    "restitution": {"energetic": 1},
}


def reflection_messages(version):
    """The two messages of the public protocol, as far as this test uses them."""
    file = descriptor_pb2.FileDescriptorProto(name=f"{version}.proto", package=f"reflection.{version}")
    field = descriptor_pb2.FieldDescriptorProto
    for name, number, label, kind in [
        ("ServerReflectionRequest", 4, field.LABEL_OPTIONAL, field.TYPE_STRING),
        ("FileDescriptorResponse", 1, field.LABEL_REPEATED, field.TYPE_BYTES),
        ("ServerReflectionResponse", 4, field.LABEL_OPTIONAL, field.TYPE_MESSAGE),
    ]:
        message = file.message_type.add(name=name)
        added = message.field.add(name="value", number=number, label=label, type=kind)
        if kind == field.TYPE_MESSAGE:
            added.type_name = f".reflection.{version}.FileDescriptorResponse"
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file)
    factory = message_factory.MessageFactory(pool)
    return [
        factory.GetPrototype(pool.FindMessageTypeByName(f"reflection.{version}.{name}"))
        for name in ("ServerReflectionRequest", "ServerReflectionResponse")
    ]


class DescribedService:
    """Makes the messages of services, and their calls, from what a server says of itself."""

    def __init__(self, reflection_address, version):
        self._pool = descriptor_pool.DescriptorPool()
        request, response = reflection_messages(version)
        self._factory = message_factory.MessageFactory(self._pool)
        with grpc.insecure_channel(reflection_address) as channel:
            ask = channel.stream_stream(
                f"/grpc.reflection.{version}.ServerReflection/ServerReflectionInfo",
                request_serializer=request.SerializeToString,
                response_deserializer=response.FromString,
            )
            symbols = ["ricochet.v1.ImpactService", "grpc.health.v1.Health"]
            answers = ask(iter([request(value=symbol) for symbol in symbols]), timeout=DEADLINE_S)
            files = {}
            for answer in answers:
                for data in answer.value.value:
                    file = descriptor_pb2.FileDescriptorProto.FromString(data)
                    files[file.name] = file
        self._add(files, list(files))

    def _add(self, files, names):
        """Adds files after the ones that they import."""
        for name in names:
            if name in files:
                file = files.pop(name)
                self._add(files, list(file.dependency))
                self._pool.Add(file)

    def call(self, channel, service, method, fields):
        described = self._pool.FindServiceByName(service).FindMethodByName(method)
        request, response = [self._factory.GetPrototype(kind) for kind in (described.input_type, described.output_type)]
        ask = channel.unary_unary(
            f"/{service}/{method}",
            request_serializer=request.SerializeToString,
            response_deserializer=response.FromString,
        )
        return ask(request(**fields), timeout=DEADLINE_S)


class ReflectionClientTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        log, port = WORK / "log", WORK / "port"
        with log.open("w") as output:
            cls.server = subprocess.Popen(
                [
                    RICOCHETD,
                    "--listen",
                    "127.0.0.1:0",
                    "--reflection",
                    "127.0.0.1:0",
                    "--port-file",
                    port,
                    "--drain-grace",
                    "0",
                ],
                stderr=output,
            )
        cls.addClassCleanup(cls.server.wait)
        cls.addClassCleanup(cls.server.terminate)
        end = time.monotonic() + DEADLINE_S
        while not port.exists() and time.monotonic() < end:
            time.sleep(0.02)
        cls.address = f"127.0.0.1:{port.read_text().strip()}"
        cls.reflection = re.search(r" reflection address=(\S+)", log.read_text())[1]

    def test_both_versions_describe_a_solve_that_gives_the_papers_coefficient(self):
        # Lubarda (2009): Newton's coefficient is sqrt((a - mu b)/(a + mu b)) if the energetic one is 1.
        for version in ("v1", "v1alpha"):
            with self.subTest(version), grpc.insecure_channel(self.address) as channel:
                service = DescribedService(self.reflection, version)
                answer = service.call(channel, "ricochet.v1.ImpactService", "Solve", {"scene": SCENE})
                newton = answer.outcome.coefficients.newton
                self.assertLessEqual(abs(newton - math.sqrt(0.5)), 4 * math.ulp(math.sqrt(0.5)))

    def test_health_is_described(self):
        service = DescribedService(self.reflection, "v1")
        with grpc.insecure_channel(self.address) as channel:
            answer = service.call(channel, "grpc.health.v1.Health", "Check", {"service": "ricochet.v1.ImpactService"})
        status = answer.DESCRIPTOR.fields_by_name["status"].enum_type.values_by_number[answer.status]
        self.assertEqual(status.name, "SERVING")


if __name__ == "__main__":
    unittest.main()

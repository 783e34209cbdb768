"""Asks a running server through generated stubs. usage: python_client_test.py ADDRESS"""

import array
import math
import sys
import unittest

import grpc
from google.rpc import error_details_pb2, status_pb2
from ricochet.v1 import impact_service_pb2, impact_service_pb2_grpc, outcome_pb2, scene_pb2, sweep_pb2

ADDRESS = sys.argv.pop()
DEADLINE_S = 10


def elastic_pendulum(kinetic_coefficient):
    return scene_pb2.Scene(
        pendulum=scene_pb2.Pendulum(inertia_kg_m2=1, a_m=0.3, b_m=1, omega_minus_rad_s=-1),
        friction=scene_pb2.Friction(kinetic_coefficient=kinetic_coefficient),
        restitution=scene_pb2.Restitution(energetic=1),
    )


def violated_fields(error):
    details = dict(error.trailing_metadata())["grpc-status-details-bin"]
    fields = []
    for detail in status_pb2.Status.FromString(details).details:
        bad_request = error_details_pb2.BadRequest()
        if detail.Unpack(bad_request):
            fields += [violation.field for violation in bad_request.field_violations]
    return fields


class PythonClientTest(unittest.TestCase):
    def setUp(self):
        channel = grpc.insecure_channel(ADDRESS)
        self.addCleanup(channel.close)
        self.service = impact_service_pb2_grpc.ImpactServiceStub(channel)

    def solve(self, kinetic_coefficient):
        request = impact_service_pb2.SolveRequest(scene=elastic_pendulum(kinetic_coefficient))
        return self.service.Solve(request, timeout=DEADLINE_S)

    def test_elastic_pendulum_has_the_papers_newton_coefficient(self):
        # kappa^2 = (a - mu b) / (a + mu b) = 0.2 / 0.4 at eta = 1.
        newton = self.solve(0.1).outcome.coefficients.newton
        self.assertLessEqual(abs(newton - math.sqrt(0.5)), 4 * math.ulp(math.sqrt(0.5)))

    def test_columns_of_a_sweep_are_the_bytes_of_their_doubles(self):
        request = sweep_pb2.SweepRequest(
            scene=elastic_pendulum(0.1),
            axes=[sweep_pb2.Axis(path="friction.kinetic_coefficient", list=sweep_pb2.ListValues(values=[0, 0.1, 0.2]))],
            columns=["coefficients.newton", "coefficients.poisson"],
            with_regime=True,
        )
        newton, poisson, regimes = array.array("d"), array.array("d"), []
        for chunk in self.service.Sweep(request, timeout=DEADLINE_S):
            columns = array.array("d", chunk.values)
            newton += columns[: chunk.count]
            poisson += columns[chunk.count :]
            regimes += [outcome_pb2.Regime.Name(number) for number in chunk.regimes]
        for index, mu in enumerate([0, 0.1, 0.2]):
            coefficients = self.solve(mu).outcome.coefficients
            self.assertEqual(newton[index], coefficients.newton)
            self.assertEqual(poisson[index], coefficients.poisson)
            self.assertEqual(regimes[index], outcome_pb2.Regime.Name(self.solve(mu).outcome.regime))

    def test_bad_request_names_the_field(self):
        with self.assertRaises(grpc.RpcError) as raised:
            self.solve(-0.1)
        self.assertEqual(raised.exception.code(), grpc.StatusCode.INVALID_ARGUMENT)
        self.assertIn("friction.kinetic_coefficient", raised.exception.details())
        self.assertEqual(violated_fields(raised.exception), ["friction.kinetic_coefficient"])


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/python3
"""Eight columns of a pendulum: NumPy in this process, against a sweep that is read over gRPC on loopback.

NumPy evaluates the closed form of the paper as a user would write it, in plain doubles and without a check of any input.
The sweeps give the same columns with the service's promises. Their numbers are compared before their times.
"""

import subprocess
import sys

import grpc
import numpy as np

import processes

POINTS = 4_000_000
ROUNDS = 7
A, B, ETA = 0.3, 1.0, 0.9
COLUMNS = ["coefficients.newton", "coefficients.poisson", "coefficients.tangential", "rates_after_rad_s[0]",
           "impulse.normal_total_n_s", "impulse.tangential_n_s[0]", "work.normal_total_j", "energy_change_j"]
ENDS = (0.0, 0.29)


def by_numpy():
    """The columns by equations [8], [10], [11], [15], [16], [25], [37] and [49] of the paper, for J = 1 and omega = -1."""
    mu = np.linspace(*ENDS, POINTS)
    plus, minus = A + mu * B, A - mu * B
    newton = ETA * np.sqrt(minus / plus)
    poisson = newton * plus / minus
    compression = 1.0 / plus
    restitution = poisson * compression
    normal = compression + restitution
    tangential = mu * (compression - restitution)
    work = 0.5 * A * (newton * newton / minus - 1.0 / plus)
    return [newton, poisson, tangential / normal, newton, normal, tangential, work, 0.5 * (newton * newton - 1.0)]


class Remote:
    """Sweeps over gRPC in Python."""

    def __init__(self, address):
        from ricochet.v1 import impact_service_pb2_grpc, sweep_pb2  # pylint: disable=import-outside-toplevel
        from google.protobuf import text_format  # pylint: disable=import-outside-toplevel
        options = [("grpc.max_receive_message_length", -1)]
        self.line = grpc.insecure_channel(address, options=options)
        self.stub = impact_service_pb2_grpc.ImpactServiceStub(self.line)
        columns = " ".join(f'columns: "{name}"' for name in COLUMNS)
        self.request = text_format.Parse(
            f"""scene {{ pendulum {{ inertia_kg_m2: 1 a_m: {A} b_m: {B} omega_minus_rad_s: -1 }}
              restitution {{ energetic: {ETA} }} }} {columns} end_index: {POINTS}
              axes {{ path: "friction.kinetic_coefficient" linspace {{ start: {ENDS[0]} stop: {ENDS[1]} count: {POINTS} }} }}""",
            sweep_pb2.SweepRequest())

    def into_numpy(self):
        values = np.empty((len(COLUMNS), POINTS))
        for chunk in self.stub.Sweep(self.request):
            part = np.frombuffer(chunk.values, dtype="<f8").reshape(len(COLUMNS), chunk.count)
            values[:, chunk.first_index:chunk.first_index + chunk.count] = part
        return values

    def undecoded(self):
        """Reads messages as bytes, whatever they mean."""
        sweep = self.line.unary_stream("/ricochet.v1.ImpactService/Sweep")
        return sum(len(message) for message in sweep(self.request.SerializeToString()))


def by_client(address):
    """The client library in C++, with the start of its process; the values are received and left."""
    columns = ",".join(COLUMNS)
    axis = f"friction.kinetic_coefficient=lin:{ENDS[0]}:{ENDS[1]}:{POINTS}"
    subprocess.run([processes.RICOCHET, "sweep", "--server", address, "--a", str(A), "--b", str(B), "--energetic", str(ETA),
                    "--axis", axis, "--column", columns, "--summary-only"], stdout=subprocess.DEVNULL, check=True)


def main():
    with processes.stubs(), processes.server() as address, processes.echo_server() as echo_address:
        remote, echo = Remote(address), Remote(echo_address)
        for name, ours, theirs in zip(COLUMNS, remote.into_numpy(), by_numpy()):
            # A sweep promises 1e-12 of the velocities and energies before the impact, all of which are of the size of
            # 1.
            if np.max(np.abs(ours - theirs)) > 4e-12:
                sys.exit(f"{name}: NumPy and the service differ by {np.max(np.abs(ours - theirs))}")
        times, (local, python, raw, cpp) = processes.medians(
            ROUNDS, by_numpy, remote.into_numpy, echo.undecoded, lambda: by_client(address))
    print(f"8 columns of a pendulum, {POINTS / 1e6:.0f} M points, medians of {ROUNDS} rounds")
    for name, took, index in (("NumPy in this process", local, 0), ("sweep by gRPC into NumPy", python, 1),
                              ("equal bytes by gRPC, nothing computed or decoded", raw, 2),
                              ("sweep by the C++ client; goal 1.1", cpp, 3)):
        print(f"  {name:<50} {POINTS / took / 1e6:7.1f} M points/s   {processes.ratio(times, 0, index):5.2f} x NumPy's rate")
    print(f"  {'rate of the sweep into NumPy':<50} {processes.ratio(times, 2, 1):7.2f} x that of equal bytes; goal 0.8")


if __name__ == "__main__":
    main()

"""Calls of the service by grpcio, and the scenes that the checks ask about."""

import dataclasses
import time

import grpc
from google.protobuf import text_format

from framework import require

LIMIT_S = 60  # The longest that a check waits for one answer, whatever the machine.

# Clients of several servers have this policy: each call is tried again on another server.
POLICY = """{"loadBalancingConfig": [{"round_robin": {}}], "methodConfig": [{"name": [{}], "waitForReady": true,
  "retryPolicy": {"maxAttempts": 5, "initialBackoff": "0.05s", "maxBackoff": "0.5s", "backoffMultiplier": 2,
                  "retryableStatusCodes": ["UNAVAILABLE"]}}]}"""
RECONNECT = {f"{kind}_reconnect_backoff_ms": ms for kind, ms in {"initial": 100, "min": 100, "max": 500}.items()}


def pb():
    from ricochet.v1 import impact_service_pb2  # pylint: disable=import-outside-toplevel  # Made by prepare().
    return impact_service_pb2


def channel(address, **more):
    """A connection of its own: channels of one process otherwise share them. `more` are arguments of gRPC, without "grpc."."""
    arguments = {"use_local_subchannel_pool": 1, "max_receive_message_length": -1, "enable_retries": 0, **more}
    return grpc.insecure_channel(address, options=[("grpc." + name, value) for name, value in arguments.items()])


def stub(on):
    from ricochet.v1 import impact_service_pb2_grpc  # pylint: disable=import-outside-toplevel
    return impact_service_pb2_grpc.ImpactServiceStub(on)


def request_class(method):
    """The class of a method's requests; the name is taken from the service, because two methods may share a class."""
    from google.protobuf import message_factory  # pylint: disable=import-outside-toplevel
    service = pb().DESCRIPTOR.services_by_name["ImpactService"]
    return message_factory.MessageFactory().GetPrototype(service.methods_by_name[method].input_type)


def request(method, text):
    return text_format.Parse(text, request_class(method)())


PENDULUM = """pendulum { inertia_kg_m2: 1 a_m: 0.3 b_m: 1 omega_minus_rad_s: -1 }
  friction { kinetic_coefficient: 0.1 } restitution { energetic: 0.9 }"""
HERTZ = """planar_body { mass_kg: 1 inertia_com_kg_m2: 0.05 offset_t_m: 0.21 offset_n_m: -0.4 velocity_t_m_s: 1.3
  velocity_n_m_s: -1.1 } friction { kinetic_coefficient: 0.25 } restitution { energetic: 0.75 }
  compliance { hertz { stiffness_n_m1_5: 3e7 } } gravity { normal_m_s2: -9.81 }"""
# A stiff contact under a great weight, which bounces many times before it comes to rest: a second of integration or so.
HARD_DURATION = """planar_body { mass_kg: 1 inertia_com_kg_m2: 0.02 offset_t_m: 0.034 offset_n_m: -0.4
  velocity_t_m_s: 0.83 velocity_n_m_s: -2.1 } friction { kinetic_coefficient: 0.49 } restitution { energetic: 1 }
  compliance { tangential_ratio_squared: 4.4e-5 linear { stiffness_n_m: 4.1e9 } }
  gravity { normal_m_s2: -6950 tangential_m_s2: 3.6 }"""


def linkage(links, wave=0.001):
    """A chain that hangs almost straight; no two links are alike."""
    parts = " ".join(
        f"links {{ length_m: {0.5 + wave * i} mass_kg: {1 + wave * i} com_m: 0.21 inertia_com_kg_m2: 0.03 "
        f"theta_rad: {0.3 + 0.001 * i} rate_rad_s: -0.2 }}" for i in range(links))
    return f"linkage {{ {parts} }} friction {{ kinetic_coefficient: 0.2 }} restitution {{ energetic: 0.7 }}"


def cheap():
    return request("Solve", f"scene {{ {PENDULUM} }}")


def long_sweep(points=10**9):
    return request("Sweep", f"""scene {{ {PENDULUM} }} columns: "coefficients.newton"
      axes {{ path: "pendulum.b_m" linspace {{ start: 0.4 stop: 2.1 count: {points} }} }}""")


def _seconds_of(on, what):
    start = time.monotonic()
    on.Solve(what, timeout=LIMIT_S)
    return time.monotonic() - start


@dataclasses.dataclass
class Expensive:
    """A valid Solve that takes about this long."""

    request: object
    seconds: float


def expensive(server, about_s=0.045):
    """A valid Solve of about this time on this machine: a certificate of a chain, with as many digits as that takes."""
    with channel(server.address) as line:
        on = stub(line)
        best = None
        for links, digits in ((1, 50), (2, 100), (4, 100), (8, 100), (8, 200), (16, 100), (16, 200), (24, 200), (32, 200),
                              (32, 400), (48, 300), (48, 600)):
            what = request("Solve", f"scene {{ {linkage(links)} }} certified_digits: {digits}")
            try:
                seconds = min(_seconds_of(on, what) for _ in range(2))
            except grpc.RpcError as error:
                require(error.code() in (grpc.StatusCode.INVALID_ARGUMENT, grpc.StatusCode.RESOURCE_EXHAUSTED),
                        f"a chain of {links} with {digits} digits: {error.code().name} {error.details()}")
                continue
            if best is None or abs(seconds - about_s) < abs(best.seconds - about_s):
                best = Expensive(what, seconds)
            if seconds > about_s:
                break
    return best


def code_of(call):
    """The status of a call that is made by this function."""
    try:
        call()
        return grpc.StatusCode.OK
    except grpc.RpcError as error:
        return error.code()


def details(error):
    """ErrorInfo.reason and RetryInfo's delay in seconds of a failed call; None for what is missing."""
    from google.rpc import error_details_pb2, status_pb2  # pylint: disable=import-outside-toplevel
    reason, delay = None, None
    for key, value in error.trailing_metadata() or ():
        if key != "grpc-status-details-bin":
            continue
        for detail in status_pb2.Status.FromString(value).details:
            info, retry = error_details_pb2.ErrorInfo(), error_details_pb2.RetryInfo()
            if detail.Unpack(info):
                reason = info.reason
            elif detail.Unpack(retry):
                delay = retry.retry_delay.seconds + retry.retry_delay.nanos * 1e-9
    return reason, delay


def require_served(server, most_s=LIMIT_S, source=None):
    """A new client gets an answer to a cheap Solve; returns the seconds that it took."""
    del source
    start = time.monotonic()
    try:
        with channel(server.address) as line:
            stub(line).Solve(cheap(), timeout=most_s)
    except grpc.RpcError as error:
        require(False, f"a Solve of another client ended with {error.code().name}: {error.details()}")
    return time.monotonic() - start


def wait_served(server, most_s):
    """Seconds until a new client gets an answer; not level if there is none within this time."""
    start = time.monotonic()
    code = None
    while time.monotonic() - start < most_s:
        with channel(server.address) as line:
            code = code_of(lambda: stub(line).Solve(cheap(), timeout=5))  # pylint: disable=cell-var-from-loop
        if code == grpc.StatusCode.OK:
            return time.monotonic() - start
        time.sleep(0.2)
    require(False, f"no Solve was answered in {most_s} s, the last ended with {code.name}")
    return 0.0


def health(server, seconds=5):
    """SERVING, NOT_SERVING or the name of a status."""
    with channel(server.address) as line:
        check = line.unary_unary("/grpc.health.v1.Health/Check")
        try:
            answer = check(b"", timeout=seconds)
        except grpc.RpcError as error:
            return error.code().name
    return {b"\x08\x01": "SERVING", b"\x08\x02": "NOT_SERVING"}.get(answer, answer.hex())


def call_until(stop, target, failed):
    """Calls servers in turn until told to stop; collects the codes of what failed, and returns how often it called."""
    count = 0
    with channel(target, enable_retries=1, service_config=POLICY, **RECONNECT) as line:
        on = stub(line)
        while not stop.is_set():
            code = code_of(lambda: on.Solve(cheap(), timeout=30))
            count += 1
            if code != grpc.StatusCode.OK:
                failed.append(code.name)
    return count

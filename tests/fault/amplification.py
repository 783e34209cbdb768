"""Small requests that ask for much: none may take more than 64 MiB or end the process, and each can be stopped.

Answers that nobody reads have a limit of their own.
"""

import struct
import threading
import time

import grpc

from calls import HARD_DURATION, cheap, channel, linkage, pb, request, require_served
from framework import Server, check, cpu_until_idle, main, require, tools
from http2 import DATA, END_STREAM, SERVICE, RawConnection, frame, message

MOST_MIB = 64  # The most memory that one request may take.
DEADLINE_S = 1.0
STOP_CPU_S = 1.0  # CPU time from a deadline or a disconnection to rest: ten times the promise for one processor.
PROMISED = {"OK", "INVALID_ARGUMENT", "OUT_OF_RANGE", "RESOURCE_EXHAUSTED", "DEADLINE_EXCEEDED", "FAILED_PRECONDITION"}


def solve(text):
    return "Solve", request("Solve", text)


def chain(links, more=""):
    return solve(f"scene {{ {linkage(links)} }} {more}")


def history(links, states):
    method, what = chain(links)
    what.history_intervals = states
    return method, what


def repeated_effect(count):
    method, what = "Solve", cheap()
    what.required.extend([1] * count)
    return method, what


def empty_links(count):
    what = pb().SolveRequest()
    what.scene.friction.kinetic_coefficient = 0.1
    for _ in range(count):
        what.scene.linkage.links.add()
    return "Solve", what


def bounds(scene, ranges):
    what = pb().BoundsRequest()
    what.MergeFrom(request("Bounds", f"scene {{ {scene} }}"))
    for path, low, high in ranges:
        what.ranges.add(path=path, low=low, high=high)
    return "Bounds", what


def unknown_ranges(count, links):
    return bounds(linkage(links), [(f"q{i}", 0, 1) for i in range(count)])


def wide_ranges(links, count):
    names = [("length_m", 0.45, 0.62), ("mass_kg", 0.9, 1.1), ("com_m", 0.18, 0.26), ("inertia_com_kg_m2", 0.02, 0.04),
             ("theta_rad", 0.25, 0.45), ("rate_rad_s", -0.3, -0.1)]
    fields = [(f"linkage.links[{i}].{name}", low, high) for i in range(links) for name, low, high in names]
    return bounds(linkage(links), [("friction.kinetic_coefficient", 0.1, 0.3), *fields][:count])


def audit(links):
    what = pb().AuditRequest()
    what.MergeFrom(request("Audit", f"scene {{ {linkage(links)} }}"))
    what.contact_velocity.tangential_m_s.append(0.1)
    what.contact_velocity.normal_m_s = 0.2
    return "Audit", what


def audit_batch(links, rows):
    what = request("AuditBatch", f"scene {{ {linkage(links)} }}")
    what.columns.tangential_after_m_s.extend([0.1 + 0.001 * i for i in range(rows)])
    what.columns.normal_after_m_s.extend([0.2] * rows)
    return "AuditBatch", what


def audit_batch_in_space(rows):
    what = request("AuditBatch", """scene { spatial_contact { w_per_kg: [1, 0.1, 0.2, 1.2, 0.1, 0.9]
      tangential_m_s: [0.3, 0.2] normal_m_s: -1 } friction { kinetic_coefficient: 0.3 } }""")
    what.columns.tangential_after_m_s.extend([0.1] * rows)
    what.columns.tangential_2_after_m_s.extend([0.05] * rows)
    what.columns.normal_after_m_s.extend([0.4] * rows)
    return "AuditBatch", what


def sweep(scene, columns=("coefficients.newton",), axes=(), count=10**9):
    what = request("Sweep", f"scene {{ {scene} }}")
    what.columns.extend(columns)
    for path, low, high in axes:
        axis = what.axes.add(path=path)
        axis.linspace.start, axis.linspace.stop, axis.linspace.count = low, high, count
    return "Sweep", what


def sweep_of_hard_points():
    return sweep(HARD_DURATION, axes=[("planar_body.velocity_t_m_s", 0.82, 0.84)])


def good_axes(count):
    return sweep(linkage(count), axes=[(f"linkage.links[{i}].mass_kg", 1, 2) for i in range(count)], count=1)


# Each row: what is asked for, and a function that makes the method and the request.
ROWS = {
    "chain of 3500": lambda: chain(3500),
    "chain of 350, 900 digits": lambda: chain(350, "certified_digits: 900"),
    "chain of 60, 1000 digits": lambda: chain(60, "certified_digits: 1000"),
    "hard duration, 65,000 forces": lambda: solve(f"scene {{ {HARD_DURATION} }} force_intervals: 65000"),
    "1100 links, 65,000 states": lambda: history(1100, 65000),
    "4300 links, 65,535 states": lambda: history(4300, 65535),
    "a million required effects": lambda: repeated_effect(1000000),
    "480,000 empty links": lambda: empty_links(480000),
    "4500 unknown ranges": lambda: unknown_ranges(4500, 1),
    "220 unknown ranges of 2100 links": lambda: unknown_ranges(220, 2100),
    "31 wide ranges of 6 links": lambda: wide_ranges(6, 31),
    "55 wide ranges of 52 links": lambda: wide_ranges(52, 55),
    "audit of 2800 links": lambda: audit(2800),
    "audit of 3 rows on 2800 links": lambda: audit_batch(2800, 3),
    "8192 rows in space": lambda: audit_batch_in_space(8192),
    "sweep of hard points": sweep_of_hard_points,
    "sweep of a chain of 280": lambda: sweep(linkage(280), axes=[("friction.kinetic_coefficient", 0.1, 0.4)]),
    "2800 unknown columns of 2800 links": lambda: sweep(linkage(2800), [f"c{i}" for i in range(2800)]),
    "1100 unknown axes of 1100 links": lambda: sweep(
        linkage(1100), axes=[(f"q{i}", 0, 1) for i in range(1100)], count=2),
    "290,000 empty columns": lambda: sweep(linkage(1), [""] * 290000),
    "1800 axes of 1800 links": lambda: good_axes(1800),
}


class Asked:
    """A call in a thread of its own, which ends with a status and never raises."""

    def __init__(self, address, method, data, timeout_s):
        self.line = channel(address)
        self.code = None
        self.text = ""
        self.bytes = 0

        def run():
            path = SERVICE + method
            try:
                if method == "Sweep":
                    for chunk in self.line.unary_stream(path)(data, timeout=timeout_s):
                        self.bytes += len(chunk)
                else:
                    self.bytes = len(self.line.unary_unary(path)(data, timeout=timeout_s))
                self.code = "OK"
            except (grpc.RpcError, ValueError) as error:  # A channel that is closed raises the latter.
                self.code = error.code().name if isinstance(error, grpc.RpcError) else "CANCELLED"
                self.text = str(error.details())[:200] if isinstance(error, grpc.RpcError) else ""

        self.thread = threading.Thread(target=run, daemon=True)
        self.thread.start()

    def wait(self, seconds):
        self.thread.join(seconds)
        return not self.thread.is_alive()

    def hang_up(self):
        self.line.close()
        self.thread.join(10)


def warm(server):
    """The memory of the first calls is not that of the request."""
    for _ in range(5):
        require_served(server)
    server.forget_peak()
    return server.peak_mib()


def deadline_and_memory(server, before, method, what):
    cpu = server.cpu_s()
    asked = Asked(server.address, method, what, DEADLINE_S)
    require(asked.wait(20), "the client's call does not end")
    idle = cpu_until_idle(server, STOP_CPU_S)
    used, took = server.cpu_s() - cpu, server.peak_mib() - before
    require(server.alive(), "the process ended")
    text = f"{len(what)} bytes: {asked.code}, {used:.2f} CPU s, {took:.0f} MiB, {asked.bytes} bytes out"
    require(asked.code in PROMISED, text + f"; {asked.text}")
    require(idle is not None, text + f"; it computes on for {STOP_CPU_S:g} CPU s after its deadline")
    require(took <= MOST_MIB, text + f"; more than {MOST_MIB} MiB")
    require_served(server, 10)
    return {"bytes": len(what), "status": asked.code, "CPU s": used, "MiB": took, "bytes out": asked.bytes}


def disconnection(server, before, method, what):
    asked = Asked(server.address, method, what, None)
    asked.wait(10.0 if tools().soak else 1.5)
    require(server.peak_mib() - before <= MOST_MIB, f"without a deadline it takes {server.peak_mib() - before:.0f} MiB")
    asked.hang_up()
    idle = cpu_until_idle(server, STOP_CPU_S)
    require(idle is not None, f"it computes on for {STOP_CPU_S:g} CPU s after its client left")
    return idle


def sigterm(server, method, what):
    Asked(server.address, method, what, None).wait(0.5)
    return server.drain()


def register(name, make):
    def run():
        method, what = make()
        what = what.SerializeToString()
        with Server(drain_grace=0.2) as server:
            before = warm(server)
            figures = deadline_and_memory(server, before, method, what)
            figures["CPU s after hang-up"] = disconnection(server, before, method, what)
            figures["SIGTERM s"] = sigterm(server, method, what)
            return figures

    check(f"amplification: {name}",
          f"it computes for at most {STOP_CPU_S:g} CPU s after a deadline of {DEADLINE_S:g} s and after its client hangs up, "
          f"takes at most {MOST_MIB} MiB, SIGTERM ends the process with 0 within 10 s, and others are served",
          kind="input")(run)


for row_name, row_make in ROWS.items():
    register(row_name, row_make)


CALL_MEMORY_MIB = 128
COMPUTES_MIB = 96  # For what computes, and for the messages of 1 MiB that gRPC itself holds.


def unread_histories():
    what = cheap()
    what.history_intervals = 65000
    return "Solve", what, 200


def unread_batches():
    what = request("SolveBatch", "")
    what.setup.scene.CopyFrom(cheap().scene)
    what.setup.fields.append("friction.kinetic_coefficient")
    what.setup.columns.append("coefficients.newton")
    what.inputs.append(struct.pack("<d", 0.3) * (1 << 20))
    return "SolveBatches", what, 40


def send_whole(line, path, body):
    """Sends the only message of a call as the server gives credit for it."""
    payload = message(body)
    stream = line.open(path)
    line.send_data(stream, [payload[start:start + 16384] for start in range(0, len(payload), 16384)], seconds=10)
    line.send(frame(DATA, END_STREAM, stream))


def register_unread(name, make):
    def run():
        method, what, calls = make()
        body = what.SerializeToString()
        with Server(drain_grace=0.2, call_memory=CALL_MEMORY_MIB) as server:
            before = warm(server)
            with RawConnection(server.host, server.port, source="127.0.0.2", window=0) as first, \
                 RawConnection(server.host, server.port, source="127.0.0.2", window=0) as second:
                for line in (first, second):
                    for _ in range(calls // 2):
                        send_whole(line, SERVICE + method, body)
                refused, until = 0, time.monotonic() + 60
                while refused == 0 and time.monotonic() < until:
                    for line in (first, second):
                        line.read(8)
                    statuses = [stream.status() for line in (first, second) for stream in line.streams.values()]
                    refused = statuses.count(grpc.StatusCode.RESOURCE_EXHAUSTED.value[0])
                took = server.peak_mib() - before
                require(server.alive(), "the process ended")
                require_served(server, 10)
            require(0 < refused < calls, f"{refused} calls of {calls} were refused")
            require(took <= CALL_MEMORY_MIB + COMPUTES_MIB, f"it takes {took:.0f} MiB")
            return {"calls": calls, "refused": refused, "MiB": took}

    check(f"unread: {name}",
          f"answers that nobody reads take at most {COMPUTES_MIB} MiB beside the {CALL_MEMORY_MIB} MiB of --call-memory, "
          "and others are served", kind="input")(run)


register_unread("200 histories", unread_histories)
register_unread("40 batches of 8 MiB", unread_batches)


if __name__ == "__main__":
    main()

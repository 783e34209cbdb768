"""Requests that mean nothing: random bytes, mutated requests, and messages of odd values in every field."""

import collections
import contextlib
import os
import struct
import threading
import warnings

import grpc
from google.protobuf.descriptor import FieldDescriptor as Field
from google.protobuf.message import DecodeError

from calls import HERTZ, PENDULUM, channel, cheap, linkage, request, request_class, require_served, stub
from framework import Server, check, main, require, tools, wait_until

# Methods whose answer is a stream, and those whose request is one, too.
STREAMS = {"Sweep", "Cost", "SolveBatches"}
STREAMED = {"SolveBatches"}
PROMISED = {"OK", "INVALID_ARGUMENT", "OUT_OF_RANGE", "FAILED_PRECONDITION", "RESOURCE_EXHAUSTED", "DEADLINE_EXCEEDED"}
ODD_DOUBLES = [0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, -1e308, float("nan"),
               float("inf"), float("-inf"), 2.0**53, 2.0**53 + 2, 0.1, 1 / 3, 1e-12, 3.14]
ODD_INTEGERS = [0, 1, -1, 2, 10, 1000, 65535, 65536, 2**31 - 1, -2**31, 2**53, 2**53 + 1, 2**63 - 1, -2**63]
PATHS = ["friction.kinetic_coefficient", "pendulum.b_m", "coefficients.newton", "", "x", "a.b[9]", "rates_after_rad_s[0]",
         "linkage.links[0].mass_kg", "☃", "pendulum.phi_rad", "\x00", "%n%s"]
# How often each method is asked; Sweep and Cost work until the deadline.
WEIGHTS = {"Solve": 50, "Bounds": 30, "Audit": 30, "AuditBatch": 30, "Plan": 30, "SolveBatch": 30, "SolveBatches": 20,
           "MultiContact": 20, "Fit": 10, "Info": 5, "Sweep": 20, "Cost": 1}
IN_FLIGHT = 32
DEADLINE_S = 0.5
KEPT = 20000  # The most requests that are kept to be looked at.


def seeds(method):
    """Valid requests, which mutations start from."""
    if method == "Sweep":
        return [request(method, f"""scene {{ {PENDULUM} }} columns: "coefficients.newton" columns: "work.normal_total_j"
          axes {{ path: "pendulum.b_m" linspace {{ start: 0.4 stop: 2.1 count: 7 }} }}
          axes {{ path: "friction.kinetic_coefficient" list {{ values: [0, 0.1, 0.5] }} }} with_regime: true""")]
    if method == "Info":
        return [request(method, "")]
    if method in ("SolveBatch", "SolveBatches"):
        what = request(method, f"""setup {{ scene {{ {PENDULUM} }} fields: "pendulum.b_m" fields: "friction.kinetic_coefficient"
          columns: "coefficients.newton" columns: "accuracy.relative_error" }}""")
        what.inputs.extend([struct.pack("<3d", 0.4, 1.0, 2.1), struct.pack("<3d", 0.0, 0.1, 0.5)])
        return [what]
    if method == "MultiContact":
        return [request(method, """scene {
          free_bodies { bodies { mass_kg: 1 inertia_com_kg_m2: 0.4 position_m: [0, 1] linear_m_s: [0, -1] angular_rad_s: 0 } }
          contacts { body: 1 point_m: [-0.5, 0] normal: [0, 1] friction: 1 energetic: 0.5 }
          contacts { body: 1 point_m: [0.5, 0] normal: [0, 1] friction: 1 energetic: 0.5 } }""")]
    more = {
        "Fit": """unknowns { path: "friction.kinetic_coefficient" start: 0.2 }
          measured { path: "contact_velocity_after.normal_m_s" values: [0.2, 0.3, 0.1] sigma: 0.1 }""",
        "Solve": "history_intervals: 3 certified_digits: 20",
        "Bounds": "certified_digits: 20",
        "Audit": "contact_velocity { tangential_m_s: 0.1 normal_m_s: 0.2 } velocity_uncertainty_m_s: 0.01",
        "AuditBatch": "columns { tangential_after_m_s: [0.1, 0.2] normal_after_m_s: [0.3, 0.1] friction: 0.2 }",
    }.get(method, "")
    scenes = [PENDULUM, linkage(3)] if method in ("Solve", "Bounds") else [PENDULUM, HERTZ, linkage(3)]
    return [request(method, f"scene {{ {scene} }} {more}") for scene in scenes]


def random_bytes(rng, method):
    del method
    return rng.randbytes(rng.choice([0, 1, 3, 10, 100, 1000, 20000]))


def mutated(rng, method):
    data = bytearray(rng.choice(seeds_of[method]))
    for _ in range(rng.choice([1, 1, 2, 3])):
        at = rng.randrange(len(data) + 1)
        what = rng.randrange(10)
        if what == 0 and at < len(data):
            data[at] ^= 1 << rng.randrange(8)
        elif what == 1:
            data[at:at] = rng.randbytes(rng.randint(1, 9))
        elif what == 2:
            del data[at:at + rng.randint(1, 9)]
        elif what == 3:
            data += data[at:]
        elif what == 4 and at < len(data):
            data[at] = rng.choice([0, 0x7F, 0x80, 0xFF])
        else:
            doubles = [i for i in range(len(data) - 8) if data[i] & 7 == 1] or [0]  # Most of these are tags of doubles.
            at = rng.choice(doubles)
            data[at + 1:at + 9] = rng.randbytes(8)
    return bytes(data)


def odd_value(rng, field):
    if field.type in (Field.TYPE_DOUBLE, Field.TYPE_FLOAT):
        return rng.choice(ODD_DOUBLES)
    if field.type == Field.TYPE_STRING:
        return rng.choice(PATHS)
    if field.type == Field.TYPE_BYTES:
        return rng.randbytes(rng.randint(0, 20))
    if field.type == Field.TYPE_BOOL:
        return rng.random() < 0.5
    if field.type == Field.TYPE_ENUM:
        return rng.choice([0, 1, 2, 3, 7, 99, -1])
    value = rng.choice(ODD_INTEGERS)
    if field.type in (Field.TYPE_INT32, Field.TYPE_SINT32, Field.TYPE_SFIXED32):
        return max(-2**31, min(2**31 - 1, value))
    if field.type in (Field.TYPE_UINT32, Field.TYPE_FIXED32):
        return abs(value) % 2**32
    if field.type in (Field.TYPE_UINT64, Field.TYPE_FIXED64):
        return abs(value)
    return value


def fill(rng, into, depth=0):
    for field in into.DESCRIPTOR.fields:
        if rng.random() < 0.5 or depth > 4:
            continue
        if field.label == Field.LABEL_REPEATED:
            values = getattr(into, field.name)
            for _ in range(rng.choice([0, 1, 2, 3, 6, 30])):
                if field.type == Field.TYPE_MESSAGE:
                    fill(rng, values.add(), depth + 1)
                else:
                    values.append(odd_value(rng, field))
        elif field.type == Field.TYPE_MESSAGE:
            part = getattr(into, field.name)
            part.SetInParent()
            fill(rng, part, depth + 1)
        else:
            setattr(into, field.name, odd_value(rng, field))


def scene_of(what):
    """The scene of a request, or the request if it has none."""
    return what.setup.scene if hasattr(what, "setup") else getattr(what, "scene", what)


def odd(rng, method):
    what = request_class(method)()
    if rng.random() < 0.7:
        what.MergeFromString(rng.choice(seeds_of[method]))
        # A few odd values in a scene that is otherwise right get further than many.
        part = scene_of(what) if rng.random() < 0.5 else what
        other = type(part)()
        fill(rng, other, 2)
        for field, value in other.ListFields():
            if rng.random() < 0.3 and field.type != Field.TYPE_MESSAGE and field.label != Field.LABEL_REPEATED:
                setattr(part, field.name, value)
        oneof = part.WhichOneof("system") if "system" in part.DESCRIPTOR.oneofs_by_name else None
        if oneof:
            for field in getattr(part, oneof).DESCRIPTOR.fields:
                if rng.random() < 0.2 and field.type == Field.TYPE_DOUBLE and field.label != Field.LABEL_REPEATED:
                    setattr(getattr(part, oneof), field.name, rng.choice(ODD_DOUBLES))
    else:
        fill(rng, what)
    return what.SerializeToString()


seeds_of = {}


@contextlib.contextmanager
def silent():
    """Protobuf prints what it cannot read."""
    kept = os.dup(2)
    try:
        with open(os.devnull, "wb") as nowhere, warnings.catch_warnings():
            # Python reads on after a group that ends nowhere, and only warns.
            warnings.simplefilter("error", RuntimeWarning)
            os.dup2(nowhere.fileno(), 2)
            yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


def parses(method, data):
    try:
        request_class(method).FromString(data)
        return True
    except (DecodeError, RuntimeWarning, SystemError):  # The last is what the warning becomes inside protobuf.
        return False


class Sender:
    """Sends bytes as requests, so many at once, and counts how they end."""

    def __init__(self, line):
        prefix = "/ricochet.v1.ImpactService/"
        self.calls = {
            method: (line.stream_stream if method in STREAMED else line.unary_stream if method in STREAMS
                     else line.unary_unary)(prefix + method)
            for method in WEIGHTS}
        self.room = threading.Semaphore(IN_FLIGHT)
        self.lock = threading.Lock()
        self.counts = collections.Counter()
        self.others = []

    def send(self, method, data):
        self.room.acquire()  # pylint: disable=consider-using-with  # Released when the call has ended.
        if method in STREAMS:
            call = self.calls[method](iter([data]) if method in STREAMED else data, timeout=DEADLINE_S)
            threading.Thread(target=self._read, args=(call, method, data), daemon=True).start()
        else:
            self.calls[method].future(data, timeout=DEADLINE_S).add_done_callback(
                lambda ended: self._ended(ended.code().name, method, data))

    def _read(self, call, method, data):
        code = "OK"
        try:
            for _ in call:
                pass
        except grpc.RpcError as error:
            code = error.code().name
        self._ended(code, method, data)

    def _ended(self, code, method, data):
        with self.lock:
            self.counts[code] += 1
            if code not in PROMISED and len(self.others) < KEPT:
                self.others.append((code, method, data))
        self.room.release()

    def finish(self):
        for _ in range(IN_FLIGHT):
            self.room.acquire()  # pylint: disable=consider-using-with

    def lost(self):
        """The requests that did not end as promised."""
        with silent():
            return [one for one in self.others if one[0] != "INTERNAL" or parses(one[1], one[2])]


def bombard(name, make, share):
    """`share` is the part of all bad requests that are of this kind."""
    rng = tools().random(name)
    count = int((1000000 * tools().part if tools().soak else 10000) * share)
    for method in WEIGHTS:
        seeds_of[method] = [what.SerializeToString() for what in seeds(method)]
    with Server(log_level="error") as server, channel(server.address) as line:
        stub(line).Solve(cheap(), timeout=20)
        before, descriptors = server.rss_mib(), server.descriptors()
        sender = Sender(line)
        for method in rng.choices(list(WEIGHTS), WEIGHTS.values(), k=count):
            sender.send(method, make(rng, method))
        sender.finish()
        require(server.alive(), f"the process ended, seed {tools().seed}")
        lost = sender.lost()
        require(not lost, f"{len(lost)} requests ended otherwise, seed {tools().seed}: "
                + "; ".join(f"{code} {method} {data[:200].hex()}" for code, method, data in lost[:3]))
        require_served(server)
        grown = server.rss_mib() - before
        require(grown <= tools().memory_mib(64), f"the memory grew by {grown:.0f} MiB")
        require(server.descriptors() <= descriptors + 3, "descriptors are left")
        return {"sent": count, "seed": tools().seed, **dict(sender.counts), "MiB": grown}


RULE = ("every call ends with a promised status, or INTERNAL if protobuf cannot read it; memory and descriptors stay, and the "
        "next client is served")


@check("random messages", RULE, kind="input")
def random_messages():
    return bombard("bytes", random_bytes, 0.3)


@check("mutated requests", RULE, kind="input")
def mutated_requests():
    return bombard("mutated", mutated, 0.4)


@check("odd values", RULE, kind="input")
def odd_values():
    return bombard("odd", odd, 0.3)


@check("odd envelopes", "unknown methods, nesting of 300, groups of 100,000, unknown fields and a byte too many are refused; what cannot "
       "be read is in the log", kind="input")
def odd_envelopes():
    with Server() as server, channel(server.address) as line:
        def ask(path, data):
            try:
                line.unary_unary(path)(data, timeout=20)
                return "OK"
            except grpc.RpcError as error:
                return error.code().name

        solve = "/ricochet.v1.ImpactService/Solve"
        nested = b""
        for _ in range(300):
            nested = b"\x0a" + bytes([len(nested) % 128 | 128, len(nested) // 128]) + nested
        answers = {
            "unknown method": ask("/ricochet.v1.ImpactService/Nothing", b""),
            "unknown service": ask("/no.Service/Nothing", b""),
            "no path": ask("/", b""),
            "nesting": ask(solve, nested),
            "cut off": ask(solve, b"\x0a\x7f\x00"),
            "groups": ask(solve, b"\x0b" * 100000 + b"\x0c" * 100000),
            "unknown fields": ask(solve, cheap().SerializeToString() + b"\xf8\x7f\x01" * 1000),
            "1 MiB": ask(solve, cheap().SerializeToString() + b"\xfa\x7f" + b"\xc0\xff\x3f" + bytes(1048512)),
            "2 MiB": ask(solve, bytes(2 << 20)),
        }
        require(answers["unknown method"] == answers["unknown service"] == "UNIMPLEMENTED", f"{answers}")
        require(answers["unknown fields"] == "INVALID_ARGUMENT", f"{answers}")
        require(answers["2 MiB"] == "RESOURCE_EXHAUSTED", f"{answers}")
        require(answers["groups"] == answers["cut off"] == "INVALID_ARGUMENT", f"{answers}")
        require(wait_until(lambda: "reason=MALFORMED_REQUEST" in server.log_text(), 5),
                "a message that cannot be read is not in the log")
        require_served(server)
        return answers


if __name__ == "__main__":
    main()

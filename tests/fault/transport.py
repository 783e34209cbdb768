"""Attacks on HTTP/2 itself. What gRPC 1.51 cannot bear directly must not pass the proxy of deploy/, nor mutual TLS."""

import functools
import gzip
import socket
import struct
import time
import zlib

from calls import cheap, expensive, request, require_served, HARD_DURATION
from framework import MIB, Server, check, cpu_until_idle, in_threads, main, require, tools
from http2 import (CONTINUATION, DATA, END_HEADERS, HEADERS, PING, PREFACE, PRIORITY, RST_STREAM, SERVICE, SETTINGS,
                   WINDOW_UPDATE, RawConnection, frame, message)

MOST_MIB = 64
BOUNDARY = ("gRPC 1.51 has no limit on this. Off loopback, serve behind the proxy of this directory or with mutual TLS, "
            "which the same attack does not pass; on loopback, a limit on memory (`MemoryMax=` of the systemd unit, the one of a container) bounds it.")


def server(**more):
    return Server(**more)


def endless_message(connection):
    """A message that says it has 600 MiB, and as much of it as the server takes; who takes no more of it has withstood."""
    stream = connection.open(SERVICE + "Solve", end=False)
    start = struct.pack(">BI", 0, 600 * MIB)
    pieces = (400 if tools().soak else 160) * MIB // 16384
    return connection.send_data(stream, [start, *[bytes(16384)] * pieces], 30 if tools().soak else 8, patience_s=3)


@functools.lru_cache
def gzip_of_zeros(size):
    """The gzip form of so many MiB of zeros, without compressing each MiB again."""
    block = zlib.compressobj(9, zlib.DEFLATED, -15)
    one = block.compress(bytes(MIB)) + block.flush(zlib.Z_FULL_FLUSH)
    crc = 0
    for _ in range(size // MIB):
        crc = zlib.crc32(bytes(MIB), crc)
    empty = zlib.compressobj(9, zlib.DEFLATED, -15).flush()
    body = gzip.compress(b"")[:10] + one * (size // MIB) + empty + struct.pack("<II", crc, size % 2**32)
    return body


def gzip_bomb(connection):
    """Zeros that are small while they are compressed."""
    size = (1000 if tools().soak else 300) * MIB
    body = gzip_of_zeros(size)
    stream = connection.open(SERVICE + "Solve", end=False, extra=[("grpc-encoding", "gzip")])
    payload = message(body, compressed=True)
    connection.send_data(stream, [payload[i:i + 16384] for i in range(0, len(payload), 16384)], 30)
    connection.send(frame(DATA, 1, stream))
    answer = connection.answer(stream, 20)
    require(answer.status() != 0, "it was answered")
    return len(payload)


def continuation_flood(connection):
    """A block of headers that never ends."""
    pieces = (800 if tools().soak else 160) * MIB // 16384
    literal = b"\x00" + b"\x03abc" + b"\x7f\xe1\x7d" + b"x" * 16224  # A header of 16,224 bytes that is not indexed.
    connection.send(frame(HEADERS, 0, 1, connection.block(SERVICE + "Solve")))
    sent = 0
    for _ in range(pieces):
        if not connection.send(frame(CONTINUATION, 0, 1, literal)):
            break
        sent += len(literal)
    return sent


def endless_integer(connection):
    """One integer of HPACK without an end, in CONTINUATION frames."""
    connection.send(frame(HEADERS, 0, 1, connection.block(SERVICE + "Solve") + b"\x7f"))
    sent = 0
    until = time.monotonic() + 3
    while time.monotonic() < until and sent < 4 * MIB and connection.send(frame(CONTINUATION, 0, 1, b"\x80" * 16000)):
        sent += 16000
    return sent


def rapid_reset(connection):
    """Streams that are opened and reset at once."""
    body = message(cheap().SerializeToString())
    sent = 0
    for _ in range(20000 if tools().soak else 8000):
        stream = connection.next_stream
        connection.next_stream += 2
        out = (frame(HEADERS, END_HEADERS, stream, connection.block(SERVICE + "Solve")) + frame(DATA, 1, stream, body) +
               frame(RST_STREAM, 0, stream, struct.pack(">I", 8)))
        if not connection.send(out):
            break
        sent += len(out)
        connection.read(0)
    return sent


def half_open(connection):
    """Streams whose message never comes."""
    sent = 0
    for _ in range(50000 if tools().soak else 12000):
        stream = connection.next_stream
        connection.next_stream += 2
        out = frame(HEADERS, END_HEADERS, stream, connection.block(SERVICE + "Solve"))
        if not connection.send(out):
            break
        sent += len(out)
        connection.read(0)
    return sent


def large_headers(connection):
    """60 KB of metadata on each of 100 streams, before SETTINGS are acknowledged."""
    sent = 0
    length = b"\x7f" + bytes([(60000 - 127) % 128 | 128, (60000 - 127) // 128 % 128 | 128, (60000 - 127) // 16384])
    for _ in range(100):
        stream = connection.next_stream
        connection.next_stream += 2
        block = connection.block(SERVICE + "Solve") + b"\x00\x05large" + length + b"x" * 60000
        out = b"".join(
            frame(HEADERS if start == 0 else CONTINUATION, END_HEADERS if start + 16384 >= len(block) else 0, stream,
                  block[start:start + 16384]) for start in range(0, len(block), 16384))
        if not connection.send(out):
            break
        sent += len(out)
        connection.read(0)
    return sent


# Each attack: its name, the function, the connections at once, and whether gRPC alone must bear it.
ATTACKS = [
    ("message of 600 MiB", endless_message, 1, True),
    ("compressed zeros", gzip_bomb, 1, True),
    ("endless headers", continuation_flood, 1, False),
    ("endless integer", endless_integer, 4, False),
    ("rapid reset", rapid_reset, 1, False),
    ("half-open streams", half_open, 1, False),
    ("headers before SETTINGS", large_headers, 1, True),
]


def attack(running, address, function, count):
    """Attacks from `count` connections while another client asks; returns figures."""
    for _ in range(3):
        require_served(running)
    before, cpu = running.peak_mib(), running.cpu_s()
    # Some limits bind only a client that acknowledges SETTINGS.
    connections = [RawConnection(*address, source="127.0.0.2", acknowledge=False) for _ in range(count)]
    for connection in connections:
        connection.read(0.2, lambda: connection.settings > 0)  # pylint: disable=cell-var-from-loop
    done = []

    def ask():
        times = []
        while len(done) < count:
            times.append(require_served(running, 20))
            time.sleep(0.05)
        return times

    def strike(connection):
        try:
            return function(connection)
        finally:
            done.append(1)

    results = in_threads([ask, *[lambda c=connection: strike(c) for connection in connections]])
    require(running.alive(), "the process ended")
    grown = running.peak_mib() - before
    for connection in connections:
        connection.close()
    used = cpu_until_idle(running, 60)
    total = running.cpu_s() - cpu
    figures = {"bytes in": sum(results[1:]), "MiB": grown, "CPU s": total, "slowest Solve s": max(results[0] or [0.0])}
    text = ", ".join(f"{name} {value:.3g}" for name, value in figures.items())
    require(grown <= MOST_MIB, f"{text}: more than {MOST_MIB} MiB")
    require(used is not None and total <= 5, f"{text}: more than 5 CPU s")
    require_served(running)
    return figures


def register(name, function, count, alone):
    @check(f"{name}, directly", f"it takes at most {MOST_MIB} MiB and 5 CPU s, and others are served meanwhile", kind="input",
           mitigation="" if alone else BOUNDARY)
    def direct():
        with server() as running:
            return attack(running, (running.host, running.port), function, count)

    return direct


for row in ATTACKS:
    register(*row)


@check("rapid reset of expensive calls", "calls that are reset at once are not computed", kind="input")
def reset_of_dear_calls():
    with server() as running:
        call = expensive(running, 0.3)
        hard = request("Solve", f"scene {{ {HARD_DURATION} }} required: EFFECT_FINITE_DURATION").SerializeToString()
        connection = RawConnection(running.host, running.port, source="127.0.0.2")
        before = running.cpu_s()
        for i in range(200):
            stream = connection.open(SERVICE + "Solve", hard if i % 2 else call.request.SerializeToString())
            connection.send(frame(RST_STREAM, 0, stream, struct.pack(">I", 8)))
            connection.read(0)
        took = require_served(running, 20)
        cpu_until_idle(running, 20)
        used = running.cpu_s() - before
        connection.close()
        require(used <= 5, f"{used:.1f} CPU s for 200 calls of {call.seconds:.2f} s and more")
        return {"CPU s": used, "Solve s": took}


FLOODS = {
    "SETTINGS": lambda i: frame(SETTINGS, 0, 0, struct.pack(">HI", 4, 65535 + i % 100)),
    "PING": lambda i: frame(PING, 0, 0, struct.pack(">Q", i)),
    "PRIORITY": lambda i: frame(PRIORITY, 0, 2 * (i % 1000) + 1, struct.pack(">IB", 0, 16)),
    "WINDOW_UPDATE": lambda i: frame(WINDOW_UPDATE, 0, 0, struct.pack(">I", 1)),
    "empty DATA": lambda i: frame(DATA, 0, 1),
    "RST_STREAM": lambda i: frame(RST_STREAM, 0, 2 * (i % 1000) + 1, struct.pack(">I", 8)),
    "empty CONTINUATION": lambda i: frame(CONTINUATION, 0, 1),
}


@check("floods of small frames", "each closes the connection or is cheap: at most 64 MiB and 5 CPU s, and others are served",
       kind="input")
def floods():
    figures = {}
    for name, make in FLOODS.items():
        def flood(connection, name=name, make=make):
            if name == "empty DATA":
                connection.open(SERVICE + "Solve", end=False)
            elif name == "empty CONTINUATION":
                connection.send(frame(HEADERS, 0, 1, connection.block(SERVICE + "Solve")))
            sent = 0
            for i in range(0, 100000 if tools().soak else 20000, 100):
                out = b"".join(make(i + k) for k in range(100))
                if not connection.send(out):
                    break
                sent += len(out)
                connection.read(0)
            return sent

        with server() as running:
            figures[name + ": CPU s"] = attack(running, (running.host, running.port), flood, 1)["CPU s"]
    return figures


@check("random bytes", "connections that send noise, in place of HTTP/2 or after its preface, leave the server as it was",
       kind="input")
def noise():
    rng = tools().random("noise")
    count = 3000 if tools().soak else 300
    with server() as running:
        require_served(running)
        before, descriptors = running.rss_mib(), running.descriptors()
        for i in range(count):
            with socket.create_connection((running.host, running.port), 10, source_address=("127.0.0.2", 0)) as line:
                try:
                    line.sendall((PREFACE + frame(SETTINGS, 0, 0) if i % 2 else b"") + rng.randbytes(rng.randint(1, 4000)))
                    if i % 5 == 0:
                        line.settimeout(0.05)
                        line.recv(100)
                except OSError:
                    pass  # The server has closed or says nothing.
        require_served(running)
        require(running.rss_mib() - before <= MOST_MIB, f"{running.rss_mib() - before:.0f} MiB more")
        return {"connections": count, "seed": tools().seed, "MiB": running.rss_mib() - before,
                "descriptors more": running.descriptors() - descriptors}


@check("malformed metadata", "a bad grpc-timeout, an unknown encoding or 9 KiB of metadata harms no other connection",
       kind="input")
def bad_metadata():
    with server() as running:
        statuses = []
        for extra in ([("grpc-timeout", "-1S")], [("grpc-timeout", "99999999999S")], [("grpc-encoding", "nonsense")],
                      [("x-large", "x" * 9000)], [("grpc-timeout", "")], [("x-bin", "not base64!")]):
            with RawConnection(running.host, running.port) as connection:
                connection.read(0.2, lambda: connection.settings > 0)  # pylint: disable=cell-var-from-loop
                stream = connection.open(SERVICE + "Solve", cheap().SerializeToString(), extra)
                answer = connection.answer(stream, 10)
                statuses.append("closed" if connection.closed and not answer.over() else answer.status())
            require_served(running)
        require(statuses[3] != 0, "9 KiB of metadata were taken")
        return {"statuses": statuses}


if __name__ == "__main__":
    main()

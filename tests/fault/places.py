"""Clients that hold places, threads and connections for nothing: others are served all the same."""

import base64
import contextlib
import time

import grpc

from calls import (HERTZ, channel, cheap, code_of, expensive, health, long_sweep, request, require_served, stub, wait_served)
from framework import Server, check, main, percentile, require, tools, wait_until
from http2 import SERVICE, RawConnection

GREEDY = "127.0.0.2"  # The source address of the clients that want too much.
STALL_S = 3  # The limits of time that the servers of these checks get, where they have such an option.
FREE_WITHIN_S = 20  # By then what was held must be free: the limits and much slack.
LIVE_CALLS = 256


def serve(**more):
    return Server(**{"max_live_calls": LIVE_CALLS, "write_stall_timeout": STALL_S, **more})


@contextlib.contextmanager
def greedy(server, count, **how):
    connections = [RawConnection(server.host, server.port, source=GREEDY, **how) for _ in range(count)]
    try:
        yield connections
    finally:
        for connection in connections:
            connection.close()


def open_sweeps(connections, each):
    body = long_sweep().SerializeToString()
    for connection in connections:
        for _ in range(each):
            connection.open(SERVICE + "Sweep", body)


@check("admission", "a sweep beyond the places is refused with RESOURCE_EXHAUSTED, a reason and a delay, and one within "
       "them is answered", kind="load")
def admission():
    from google.rpc import error_details_pb2, status_pb2  # pylint: disable=import-outside-toplevel
    with serve(max_live_calls=64) as server, greedy(server, 4, credit=False) as connections:
        for connection in connections:
            connection.grant(0, 1 << 30)
        open_sweeps(connections, 30)
        for connection in connections:
            connection.read(20, lambda: all(s.bytes or s.over() for s in connection.streams.values()))  # pylint: disable=cell-var-from-loop
        streams = [stream for connection in connections for stream in connection.streams.values()]
        answered = sum(stream.bytes > 0 for stream in streams)
        refused = [stream for stream in streams if not stream.bytes]
        require(answered > 0 and refused, f"{answered} sweeps of {len(streams)} are answered")
        for stream in refused:
            require(stream.status() == grpc.StatusCode.RESOURCE_EXHAUSTED.value[0],
                    f"a refused sweep has status {stream.status()}, reset {stream.reset}")
            text = stream.headers["grpc-status-details-bin"]
            status = status_pb2.Status.FromString(base64.b64decode(text + "=" * (-len(text) % 4)))
            info, retry = error_details_pb2.ErrorInfo(), error_details_pb2.RetryInfo()
            require(status.details[0].Unpack(info) and info.reason, "a refusal has no reason")
            require(any(detail.Unpack(retry) for detail in status.details), "a refusal has no delay")
        require(wait_until(lambda: server.log_text().count("RESOURCE_EXHAUSTED") > 0, 5), "no refusal is in the log")
        return {"answered": answered, "refused": len(refused), "reason": info.reason}


@check("greedy client", "one client that asks for every place leaves others theirs", kind="load")
def greedy_client():
    with serve() as server, greedy(server, 3, credit=False) as connections:
        open_sweeps(connections, 100)
        for connection in connections:
            connection.pump()
        time.sleep(1)
        answers = [require_served(server, 10) for _ in range(20)]
        return {"p50 s": percentile(answers, 0.5), "health": health(server)}


@check("sweeps that nobody reads", f"300 sweeps whose client reads nothing let others in within {FREE_WITHIN_S} s, and end")
def unread_sweeps():
    with serve() as server, greedy(server, 3, window=0) as connections:
        threads = server.threads()
        open_sweeps(connections, 100)
        for connection in connections:
            connection.pump()
        took = wait_served(server, FREE_WITHIN_S)
        held = server.threads()
        require(wait_until(lambda: server.threads() <= threads + 16, FREE_WITHIN_S),
                f"{server.threads()} threads are held, {threads} before")
        return {"Solve after s": took, "threads": held, "MiB": server.rss_mib()}


@check("answers that nobody reads", f"600 Solves whose client never reads the answers let others in within {FREE_WITHIN_S} s, "
       "and their threads are free again")
def unread_answers():
    with serve() as server, greedy(server, 6, window=0) as connections:
        threads = server.threads()
        body = cheap().SerializeToString()
        for connection in connections:
            for _ in range(100):
                connection.open(SERVICE + "Solve", body)
            connection.pump()
        took = wait_served(server, FREE_WITHIN_S)
        held = server.threads()
        require(wait_until(lambda: server.threads() <= threads + 64, FREE_WITHIN_S),
                f"{server.threads()} threads are held, {threads} before")
        return {"Solve after s": took, "threads held": held, "threads": server.threads()}


@check("no acknowledgement of SETTINGS", f"400 sweeps on a connection that never acknowledges SETTINGS let others in within "
       f"{FREE_WITHIN_S} s")
def no_acknowledgement():
    with serve() as server, greedy(server, 1, window=0, acknowledge=False) as connections:
        open_sweeps(connections, 400)
        connections[0].pump()
        return {"Solve after s": wait_served(server, FREE_WITHIN_S), "threads": server.threads()}


def held_open(path, each=110, body=None):
    with serve() as server, greedy(server, 3) as connections:
        threads = server.threads()
        for connection in connections:
            for _ in range(each):
                connection.open(path, body, end=False)
            connection.pump()
        time.sleep(1)
        answers = [require_served(server, 10) for _ in range(20)]
        return {"p50 s": percentile(answers, 0.5), "threads before": threads, "threads": server.threads()}


@check("idle reflection streams", "330 reflection streams without a message leave others served")
def reflection_streams():
    return held_open("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo")


@check("health watches", "330 watches of the health leave others served")
def watches():
    return held_open("/grpc.health.v1.Health/Watch", body=b"")


@check("half a Solve", "330 calls whose message never comes leave others served")
def half_calls():
    return held_open(SERVICE + "Solve")


@check("silence of expensive sweeps", "a sweep of points of milliseconds sends a chunk at least every 5 s")
def chunks_by_time():
    what = request("Sweep", f"""scene {{ {HERTZ} }} columns: "coefficients.newton"
      axes {{ path: "planar_body.velocity_n_m_s" linspace {{ start: -1 stop: -2 count: 1000000 }} }}""")
    seconds = 60 if tools().soak else 7
    with serve() as server, channel(server.address) as line:
        gaps, sizes = [], []
        last = start = time.monotonic()
        try:
            for chunk in stub(line).Sweep(what, timeout=seconds):
                gaps.append(time.monotonic() - last)
                sizes.append(chunk.count)
                last = time.monotonic()
        except grpc.RpcError as error:
            require(error.code() == grpc.StatusCode.DEADLINE_EXCEEDED, f"it ended with {error.code().name}")
        gaps.append(start + seconds - last)
        require(sizes and max(gaps) <= 5, f"{len(sizes)} chunks, the longest silence is {max(gaps):.1f} s")
        return {"chunks": len(sizes), "points a chunk": percentile(sizes, 0.5), "longest silence s": max(gaps)}


@check("a unary call without a deadline", "the server ends it by its own longest time")
def longest_time():
    with serve() as server:
        slow = expensive(server, 0.3)
    limit = slow.seconds / 10
    with serve(max_unary_time=limit) as server, channel(server.address) as line:
        start = time.monotonic()
        code = code_of(lambda: stub(line).Solve(slow.request, timeout=20))
        took = time.monotonic() - start
        require(code == grpc.StatusCode.DEADLINE_EXCEEDED and took < 15, f"{code.name} after {took:.1f} s")
        return {"status": code.name, "alone s": slow.seconds, "s": took}


@check("slow readers", "100 sweeps whose clients read 1 KB/s take less than 40 MiB, and others are served", kind="load")
def slow_readers():
    with serve(write_stall_timeout=600, max_streams=200, max_streams_per_peer=200) as server, greedy(
            server, 4, credit=False) as connections:
        before = server.rss_mib()
        open_sweeps(connections, 25)
        worst, most = 0.0, before
        until = time.monotonic() + (60 if tools().soak else 5)
        while time.monotonic() < until:
            for connection in connections:
                connection.read(0.05)
                for stream in connection.streams:
                    connection.grant(stream, 200)
            worst = max(worst, require_served(server, 10))
            most = max(most, server.rss_mib())
        require(most - before < 40, f"memory grew by {most - before:.0f} MiB")
        return {"slowest Solve s": worst, "MiB": most - before}


@check("idle connections", "50 connections without a call that answer pings are closed at the time limit, and a call is not")
def idle_connections():
    with serve(idle_timeout=1) as server, greedy(server, 50) as connections, greedy(server, 1) as busy:
        open_sweeps(busy, 1)
        for connection in [*connections, *busy]:
            connection.pump()
        start = time.monotonic()
        require(wait_until(lambda: all(connection.closed for connection in connections), 60),
                f"{sum(not c.closed for c in connections)} of 50 are open after 60 s")
        took = time.monotonic() - start
        require(not busy[0].closed, "a connection with a call is closed, too")
        return {"s": took}


@check("silent connections", "500 connections that send nothing, half a preface or no SETTINGS are closed within 30 s")
def silent_connections():
    with serve(handshake_timeout=2) as server:
        before = server.descriptors()
        connections = []
        for start in (b"", b"PRI * HTTP/2.0\r\n", b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"):
            for i in range(167):
                connection = RawConnection(server.host, server.port, source=f"127.0.1.{i + 1}", preface=False)
                connection.send(start)
                connections.append(connection)
        served = require_served(server, 10)
        held = server.descriptors() - before
        require(wait_until(lambda: server.descriptors() <= before + 5, 30),
                f"{server.descriptors() - before} of {held} connections are open after 30 s")
        for connection in connections:
            connection.close()
        return {"Solve s": served}


@check("a peer that answers no ping", "it is cut off within 60 s, and its sweeps end", soak=True)
def no_pong():
    with serve(write_stall_timeout=300) as server, greedy(server, 1, window=0, pong=False) as connections:
        open_sweeps(connections, 50)
        connections[0].pump()
        start = time.monotonic()
        require(wait_until(lambda: connections[0].closed, 60), "it is connected after 60 s")
        return {"s": time.monotonic() - start}


@check("cancel storm", "3000 Solves and 300 sweeps that are cancelled at once free their places and threads", kind="load")
def cancel_storm():
    with serve() as server:
        before, cpu = server.descriptors(), server.cpu_s()
        with channel(server.address) as line:
            on = stub(line)
            for _ in range(30):
                calls = [on.Solve.future(cheap(), timeout=30) for _ in range(100)] + [on.Sweep(long_sweep()) for _ in range(10)]
                for call in calls:
                    call.cancel()
            used = server.cpu_s() - cpu
        require_served(server, 10)
        require(wait_until(lambda: server.descriptors() <= before + 2, 20), "descriptors are left")
        require(wait_until(lambda: server.threads() < 64, 20), f"{server.threads()} threads are left")
        return {"CPU s": used, "threads": server.threads()}


if __name__ == "__main__":
    main()

"""More work than there are processors: what is answered in time must not fall, and cheap calls must not wait for expensive ones."""

import threading
import time

import grpc

from calls import channel, cheap, expensive, details, stub
from framework import PROCESSORS, Server, check, cpu_until_idle, main, percentile, require, tools
from http2 import SERVICE, RawConnection

LONG_DEADLINES = 7  # Deadline of an expensive call, in times that it takes alone.


def serve(**more):
    return Server(**{"max_live_calls": 2000, "max_live_calls_per_peer": 2000, **more})


def goodput(server, call, clients, seconds):
    """Answers a second that clients in closed loops get before their deadlines; a refused client waits as it is told."""
    stop = threading.Event()
    lock = threading.Lock()
    tally = {}

    def client():
        with channel(server.address) as line:
            on = stub(line)
            while not stop.is_set():
                name, delay = "OK", 0
                try:
                    on.Solve(call.request, timeout=LONG_DEADLINES * call.seconds)
                except grpc.RpcError as error:
                    name = error.code().name
                    delay = details(error)[1] or 0
                with lock:
                    if not stop.is_set():
                        tally[name] = tally.get(name, 0) + 1
                stop.wait(delay)

    threads = [threading.Thread(target=client, daemon=True) for _ in range(clients)]
    for thread in threads:
        thread.start()
    time.sleep(LONG_DEADLINES * call.seconds)  # The first deadlines pass before the counting begins.
    with lock:
        tally.clear()
    start = time.monotonic()
    time.sleep(seconds)
    with lock:
        counted, took = dict(tally), time.monotonic() - start
    stop.set()
    for thread in threads:
        thread.join(30)
    return counted.get("OK", 0) / took, counted


@check("goodput under overload", "8 times as many clients as processors, with deadlines, get at least half of the answers a second "
       "that as many clients as processors get; 80 % in the long run", kind="load", timed=True)
def goodput_under_overload():
    seconds = 20 if tools().soak else 4
    with serve() as server:
        call = expensive(server)
        figures = {"one call s": call.seconds}
        at_capacity, _ = goodput(server, call, PROCESSORS, seconds)
        figures["at capacity /s"] = at_capacity
        tried = (2, 8, 100) if tools().soak else (8,)
        for times in tried:
            rate, counted = goodput(server, call, times * PROCESSORS, seconds)
            figures[f"x{times}"] = rate / at_capacity
            figures[f"x{times} statuses"] = counted
            least = 0.8 if tools().soak and times <= 8 else 0.5
            require(rate >= least * at_capacity,
                    f"{times} times the clients: {rate:.1f} of {at_capacity:.1f} answers a second, {counted}")
        return figures


@check("short deadlines", "200 expensive calls at once, with deadlines of three times their time, use less than a quarter of the CPU time of all",
       kind="load", timed=True)
def dead_calls():
    with serve() as server:
        call = expensive(server)
        before = server.cpu_s()
        connections = [RawConnection(server.host, server.port) for _ in range(2)]
        body = call.request.SerializeToString()
        for connection in connections:
            for _ in range(100):
                connection.open(SERVICE + "Solve", body, extra=[("grpc-timeout", f"{3000 * call.seconds:.0f}m")])
            connection.pump()
        whole = 200 * call.seconds
        time.sleep(0.5)
        cpu_until_idle(server, whole)
        used = server.cpu_s() - before
        for connection in connections:
            connection.close()
        require(used <= whole / 4, f"{used:.1f} CPU s of {whole:.1f} s")
        return {"CPU s": used, "in full s": whole}


def latencies(server, count):
    """Times of cheap Solves, one after the other on a connection of their own, for at most a minute."""
    times = []
    until = time.monotonic() + (60 if tools().soak else 15)
    with channel(server.address) as line:
        on = stub(line)
        on.Solve(cheap(), timeout=60)
        for _ in range(count):
            start = time.monotonic()
            on.Solve(cheap(), timeout=60)
            times.append(time.monotonic() - start)
            if time.monotonic() > until:
                break
            time.sleep(0.005)
    return times


@check("Solves beside expensive calls", "p99 of a cheap Solve beside the most expensive calls of 64 clients is at most 5 times p99 alone "
       "and 20 ms", kind="load", timed=True)
def beside_dear_calls():
    count = 1000 if tools().soak else 150
    with serve() as server:
        call = expensive(server, 1)
        alone = percentile(latencies(server, count), 0.99)
        stop = threading.Event()

        def client():
            with channel(server.address) as line:
                on = stub(line)
                while not stop.is_set():
                    try:
                        on.Solve(call.request, timeout=20)
                    except grpc.RpcError as error:
                        stop.wait(details(error)[1] or 0)

        threads = [threading.Thread(target=client, daemon=True) for _ in range(64)]
        for thread in threads:
            thread.start()
        time.sleep(0.5)
        try:
            beside = percentile(latencies(server, count), 0.99)
        finally:
            stop.set()
        require(beside <= 5 * max(alone, 0.02), f"p99 alone {alone:.4f} s, beside 64 clients {beside:.4f} s")
        return {"expensive call s": call.seconds, "p99 alone s": alone, "p99 beside s": beside, "ratio": beside / alone}


if __name__ == "__main__":
    main()

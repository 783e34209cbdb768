"""The load that the service holds: many clients, bursts, and fair shares beside sweeps."""

import re
import subprocess
import time

import grpc

from calls import PENDULUM, channel, cheap, code_of, require_served, stub
from framework import PROCESSORS, Server, check, in_threads, main, percentile, require, tools
from http2 import SERVICE, message


def serve(**more):
    """A server that lets one address have all connections and places, as all of these clients have the same."""
    return Server(**{"max_connections": 4000, "max_connections_per_peer": 4000, "max_live_calls": 2000,
                     "max_live_calls_per_peer": 2000, "log_level": "warning", **more})


def h2load(server, clients, streams, calls):
    """Cheap Solves by h2load in a closed loop; returns calls per second, latencies in ms, and the calls answered.

    h2load knows no grpc-status, but a call that fails has no DATA: the bytes of DATA count the answers.
    """
    body = tools().work / "solve.bin"
    body.write_bytes(message(cheap().SerializeToString()))
    with channel(server.address) as line:
        size = 5 + stub(line).Solve(cheap(), timeout=20).ByteSize()
    log = tools().work / "h2load.tsv"
    log.unlink(missing_ok=True)
    run = subprocess.run(
        ["h2load", "-n", str(calls), "-c", str(clients), "-m", str(streams), "-t", "1", "-d", str(body),
         "-H", "te: trailers", "-H", "content-type: application/grpc", f"--log-file={log}",
         f"http://{server.address}{SERVICE}Solve"], capture_output=True, text=True, timeout=300, check=True)
    rate = float(re.search(r"finished in .*?, ([\d.]+) req/s", run.stdout).group(1))
    data = int(re.search(r"\((\d+)\) data", run.stdout).group(1))
    micros = [int(line.split("\t")[2]) for line in log.read_text(encoding="ascii").splitlines()]
    require(data % size == 0 or data / size < calls, f"answers of other sizes than {size}: {data} bytes")
    return rate, [value / 1e3 for value in micros], data / size


@check("unary clients", "1 to 1000 clients in a closed loop get every answer; in the long run 1000 get a quarter of the best rate",
       kind="load")
def unary_clients():
    figures, rates = {}, {}
    with serve() as server:
        require_served(server)
        before = server.rss_mib()
        for clients in (1, 8, 64, 256, 1000):
            calls = max(3 * clients, 30000 if tools().soak else 1500)
            rate, latencies, answered = h2load(server, clients, 1, calls)
            require(answered == calls, f"{clients} clients: {answered:.1f} answers to {calls} calls")
            rates[clients] = rate
            figures[f"{clients}: /s"] = round(rate)
            figures[f"{clients}: p99 ms"] = percentile(latencies, 0.99)
        # A short run is for the most part the set-up of its connections.
        require(not tools().soak or rates[1000] >= max(rates.values()) / 4, f"1000 clients: {rates}")
        grown = server.peak_mib() - before
        require(grown < 256, f"the memory grew by {grown:.0f} MiB")
        return {**figures, "MiB": grown, "threads": server.threads()}


@check("burst", "800 cheap Solves at once on 8 connections are all answered", kind="load")
def burst():
    with serve() as server:
        calls = 40000 if tools().soak else 4000
        rate, latencies, answered = h2load(server, 8, 100, calls)
        require(answered == calls, f"{calls - answered:.0f} of {calls} calls were not answered")
        return {"/s": round(rate), "p99 ms": percentile(latencies, 0.99), "threads": server.threads()}


def open_loop(server, rate, seconds):
    """Latencies in s of cheap Solves that are sent at this rate, whether the earlier ones were answered or not."""
    latencies, failed = [], []
    with channel(server.address) as line:
        on = stub(line)
        on.Solve(cheap(), timeout=20)
        calls = []
        start = time.monotonic()
        for i in range(int(rate * seconds)):
            due = start + i / rate
            time.sleep(max(0.0, due - time.monotonic()))
            call = on.Solve.future(cheap(), timeout=20)

            def done(ended, due=due):
                if ended.code() == grpc.StatusCode.OK:
                    latencies.append(time.monotonic() - due)
                else:
                    failed.append(ended.code().name)

            call.add_done_callback(done)
            calls.append(call)
        for call in calls:
            code_of(call.result)
    require(not failed, f"{len(failed)} Solves failed: {set(failed)}")
    return latencies


class Sweeps:
    """Sweeps without an end, each of a process of its own, so that reading them does not hold up who measures."""

    def __init__(self, server, count):
        scene = tools().work / "sweep.textproto"
        scene.write_text(PENDULUM, encoding="ascii")
        command = [tools().ricochet, "sweep", "--scene", scene, "--server", server.address, "--format", "csv",
                   "--axis", "pendulum.b_m=lin:0.4:2.1:10000000000", "--column", "coefficients.newton"]
        self.clients = [subprocess.Popen(command, stdout=subprocess.PIPE) for _ in range(count)]
        self.counters = [subprocess.Popen(["wc", "--lines"], stdin=client.stdout, stdout=subprocess.PIPE, text=True)
                         for client in self.clients]
        for client in self.clients:
            client.stdout.close()  # The counter has it.

    def close(self):
        """Ends them; returns the points of each, and how many had ended before."""
        ended = sum(client.poll() is not None for client in self.clients)
        for client in self.clients:
            client.kill()
            client.wait()
        return [int(counter.communicate()[0]) for counter in self.counters], ended


@check("Solves beside sweeps", "p99 of Solves beside 8 sweeps (p90 in the short run) is at most 25 times that alone and 20 ms, "
       "and no sweep gets more than 4 times another's points", kind="load", timed=True)
def beside_sweeps():
    seconds, part = (20, 0.99) if tools().soak else (3, 0.9)
    with serve() as server:
        alone = percentile(open_loop(server, 100, seconds), part)
        sweeps = Sweeps(server, 8)
        try:
            time.sleep(0.5)
            beside = percentile(open_loop(server, 100, seconds), part)
        finally:
            shares, ended = sweeps.close()
        require(ended == 0, f"{ended} sweeps ended")
        require(min(shares) > 0 and max(shares) <= 4 * min(shares), f"points of the sweeps: {shares}")
        require(beside <= 25 * max(alone, 0.02), f"alone {alone:.4f} s, beside 8 sweeps {beside:.4f} s")
        return {"alone s": alone, "beside s": beside, "points, most over least": max(shares) / min(shares)}


@check("idle clients", "2000 idle connections take at most 40 KiB each, and others are served", kind="load", soak=True)
def idle_clients():
    import socket  # pylint: disable=import-outside-toplevel
    with serve() as server:
        require_served(server)
        before = server.rss_mib()
        connections = [socket.create_connection((server.host, server.port), 10, source_address=(f"127.0.3.{1 + i % 200}", 0))
                       for i in range(2000)]
        took = require_served(server)
        each = (server.rss_mib() - before) * 1024 / len(connections)
        for connection in connections:
            connection.close()
        require(each <= 40, f"{each:.0f} KiB a connection")
        return {"KiB each": each, "Solve s": took}


@check("threads for computing", "as many clients as processors, each with Solves one after the other, get all answers",
       kind="load")
def closed_loop():
    with serve() as server:
        def client():
            with channel(server.address) as line:
                on = stub(line)
                return sum(code_of(lambda: on.Solve(cheap(), timeout=20)) == grpc.StatusCode.OK for _ in range(300))

        answered = in_threads([client] * PROCESSORS)
        require(answered == [300] * PROCESSORS, f"answered: {answered} of 300 each")
        return {"answered": sum(answered)}


if __name__ == "__main__":
    main()

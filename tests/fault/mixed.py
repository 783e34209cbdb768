"""All kinds of clients at once, for a long time: memory, descriptors and threads stay flat."""

import threading
import time

import grpc

from calls import channel, cheap, expensive, details, linkage, long_sweep, request, require_served, stub
from framework import Server, check, main, require, tools, wait_until
from http2 import SERVICE, RawConnection

GOOD = {grpc.StatusCode.OK, grpc.StatusCode.RESOURCE_EXHAUSTED, grpc.StatusCode.DEADLINE_EXCEEDED}


class Clients:
    """Threads that ask until they are told to stop, and what they counted."""

    def __init__(self, server):
        self.server = server
        self.slow = expensive(server)
        self.stop = threading.Event()
        self.lock = threading.Lock()
        self.counts = {}
        self.wrong = []
        self.threads = []

    def start(self, name, work, pause_s):
        def run():
            rng = tools().random(name)
            while not self.stop.is_set():
                try:
                    outcome = work(rng)
                except grpc.RpcError as error:
                    outcome = error.code().name
                    if error.code() not in GOOD:
                        self.wrong.append(f"{name}: {outcome} {error.details()}")
                    self.stop.wait(details(error)[1] or 0)
                with self.lock:
                    self.counts[f"{name} {outcome}"] = self.counts.get(f"{name} {outcome}", 0) + 1
                self.stop.wait(pause_s)

        self.threads.append(threading.Thread(target=run, daemon=True))
        self.threads[-1].start()

    def finish(self):
        self.stop.set()
        for thread in self.threads:
            thread.join(60)

    def solve(self, rng):
        with channel(self.server.address) as line:
            for _ in range(rng.randint(1, 50)):
                stub(line).Solve(cheap(), timeout=20)
        return "OK"

    def bounds(self, rng):
        with channel(self.server.address) as line:
            stub(line).Bounds(request("Bounds", f"scene {{ {linkage(rng.randint(1, 4))} }}"), timeout=20)
        return "OK"

    def expensive(self, rng):
        with channel(self.server.address) as line:
            stub(line).Solve(self.slow.request, timeout=self.slow.seconds * rng.choice([0.1, 1, 20]))
        return "OK"

    def sweep(self, rng):
        with channel(self.server.address) as line:
            points = rng.choice([10, 1000, 300000])
            got = sum(chunk.count for chunk in stub(line).Sweep(long_sweep(points), timeout=60))
        require(got == points, f"{got} of {points} points came")
        return "OK"

    def cancel(self, rng):
        with channel(self.server.address) as line:
            call = stub(line).Sweep(long_sweep(), timeout=60)
            for _, _ in zip(range(rng.randint(0, 3)), call):
                pass
            call.cancel()
        return "cancelled"

    def vanish(self, rng):
        connection = RawConnection(self.server.host, self.server.port, window=rng.choice([0, 1000, 65535]))
        for _ in range(rng.randint(0, 5)):
            connection.open(SERVICE + rng.choice(["Sweep", "Solve"]), rng.choice([b"", long_sweep().SerializeToString()]),
                            end=rng.random() < 0.5)
        connection.read(0.05)
        connection.close()
        return "gone"

    def nonsense(self, rng):
        with channel(self.server.address) as line:
            call = line.unary_unary(SERVICE + "Solve")
            for _ in range(20):
                try:
                    call(rng.randbytes(rng.randint(0, 300)), timeout=20)
                except grpc.RpcError:
                    pass
        return "refused"


@check("mixed load", "no well-made call fails, the memory of the last third stays within 16 MiB of that of the second, and "
       "descriptors and threads go back", kind="load")
def mixed_load():
    seconds = 60 * tools().minutes if tools().soak else 10
    with Server(log_level="warning") as server:
        for _ in range(20):
            require_served(server)
        descriptors, threads = server.descriptors(), server.threads()
        clients = Clients(server)
        for work, pause in ((clients.solve, 0.01), (clients.solve, 0.05), (clients.bounds, 0.02), (clients.expensive, 0.2),
                            (clients.sweep, 0.05), (clients.cancel, 0.05), (clients.vanish, 0.02), (clients.nonsense, 0.05)):
            clients.start(work.__name__, work, pause)
        samples = []
        start = time.monotonic()
        while time.monotonic() - start < seconds and server.alive():
            samples.append(server.rss_mib())
            time.sleep(max(0.2, seconds / 3000))
        clients.finish()
        require(server.alive(), f"the process ended with {server.child.returncode}")
        require(not clients.wrong, f"{len(clients.wrong)} calls failed: {clients.wrong[:3]}")
        third = len(samples) // 3
        middle, last = max(samples[third:2 * third]), max(samples[2 * third:])
        require(last <= middle + tools().memory_mib(16), f"memory: {middle:.0f} MiB in the second third, {last:.0f} MiB in the last")
        require(wait_until(lambda: server.descriptors() <= descriptors + 3, 60),
                f"{server.descriptors()} descriptors, {descriptors} before")
        require(wait_until(lambda: server.threads() <= threads + 32, 60), f"{server.threads()} threads, {threads} before")
        require_served(server)
        return {"minutes": seconds / 60, "calls": sum(clients.counts.values()), **clients.counts, "MiB": last,
                "descriptors": server.descriptors(), "threads": server.threads()}


if __name__ == "__main__":
    main()

"""Several servers behind HAProxy, behind nginx, and by the client's own round robin, while each in turn dies and returns.

RICOCHET_POOL_POINTS=N gives the sweep that three servers share N points instead of three million.
"""

import hashlib
import os
import shutil
import signal
import socket
import struct
import subprocess
import threading
import time

import grpc

from calls import LIMIT_S, PENDULUM, call_until, channel, cheap, code_of, request, stub
from framework import (
    Process, Server, Skipped, check, command_line, in_threads, main, require, tools, wait_until)

POINTS = 3_000_000
SHARED_POINTS = int(os.environ.get("RICOCHET_POOL_POINTS", POINTS))


def sweep_of(points):
    return ["sweep", "--a", "0.3", "--b", "1", "--energetic", "1", "--axis", f"friction.kinetic_coefficient=lin:0:0.4:{points}",
            "--column", "coefficients.newton", "--format", "npy"]


SWEEP = sweep_of(POINTS)


class Servers:
    """Three servers, of which one after another is killed or drained and comes back at its own port."""

    def __init__(self):
        first = Server(drain_grace=0.5, host="127.0.0.1")
        # One port, as the pods of a Deployment have.
        self.servers = [first, *(Server(drain_grace=0.5, host=f"127.0.0.{i}", port=first.port) for i in (2, 3))]
        self.addresses = [server.address for server in self.servers]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for server in self.servers:
            server.kill()

    def replace(self, which, drained):
        old = self.servers[which]
        if drained:
            old.drain()
        else:
            old.kill()
        time.sleep(0.3)
        self.servers[which] = Server(drain_grace=0.5, host=old.host, port=old.port)
        # It is in use again before the next one goes.
        require(wait_until(lambda: "Solve" in self.servers[which].log_text(), 60), "no call reaches the server that is back")


class Proxy:
    """A program that listens at `address` and ends with this object."""

    count = 0

    def __init__(self, name, command, address, environment):
        Proxy.count += 1
        self.address = address
        self.place = tools().work / f"proxy_{name}_{os.getpid()}_{Proxy.count}"
        shutil.rmtree(self.place, ignore_errors=True)
        self.place.mkdir(parents=True)
        with open(self.place / "log", "wb") as log:
            self.process = Process(command(self.place), stdout=log, stderr=log, env={**os.environ, **environment})

    def __enter__(self):
        with channel(self.address) as line:
            require(wait_until(lambda: code_of(lambda: stub(line).Solve(cheap(), timeout=5)) == grpc.StatusCode.OK, 30),
                    f"the proxy lets no call through: {(self.place / 'log').read_text()[-500:]}")
        return self

    def __exit__(self, *_):
        self.process.kill()


class Names(threading.Thread):
    """A name server that gives three addresses to every name, as that of Kubernetes does for a headless Service."""

    def __init__(self):
        super().__init__(daemon=True)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.asked = 0
        self.start()

    def run(self):
        while True:
            query, sender = self.socket.recvfrom(512)
            if not query:
                return
            self.asked += 1
            end = query.index(b"\0", 12) + 5
            question = query[12:end]
            addresses = [bytes((127, 0, 0, i)) for i in (1, 2, 3)] if question[-4:-2] == b"\0\x01" else []
            # A pointer to the name of the question, type A, class IN, 1 s, 4 bytes.
            answers = b"".join(b"\xc0\x0c" + struct.pack(">HHIH", 1, 1, 1, 4) + address for address in addresses)
            self.socket.sendto(query[:2] + struct.pack(">HHHHH", 0x8180, 1, len(addresses), 0, 0) + question + answers, sender)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.sendto(b"", ("127.0.0.1", self.port))
        self.join()
        self.socket.close()


def program(name):
    found = shutil.which(name, path="/usr/sbin:/usr/bin:/sbin:/bin")
    if found is None:
        raise Skipped(f"{name} is not installed")
    return found


def recipe(name):
    return tools().proto.parent / "deploy/pool" / name


def free_address():
    """An address that nobody uses: servers and proxies have hosts of their own."""
    with Server(host="127.0.0.9") as server:
        return server.address


def haproxy(addresses):
    address = free_address()
    environment = dict(zip(("RICOCHET_ONE", "RICOCHET_TWO", "RICOCHET_THREE"), addresses), RICOCHET_BIND=address)
    path = program("haproxy")
    return Proxy("haproxy", lambda place: [path, "-db", "-f", recipe("haproxy.cfg")], address, environment)


def nginx(addresses):
    address = free_address()
    path = program("nginx")

    def command(place):
        text = recipe("nginx.conf").read_text(encoding="utf-8").replace("listen 50051", f"listen {address}")
        for name, server in zip(("one", "two", "three"), addresses):
            text = text.replace(f"server {name}:50051", f"server {server}")
        text = text.replace("pid nginx.pid", f"pid {place}/nginx.pid")
        for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi"):
            text = text.replace("access_log off;", f"access_log off;\n  {kind}_temp_path {place}/{kind};", 1)
        (place / "nginx.conf").write_text(text, encoding="utf-8")
        return [path, "-p", place, "-c", place / "nginx.conf", "-e", "stderr"]

    return Proxy("nginx", command, address, {})


def try_pool(servers, target, server_option):
    """Replaces each server once while clients call and a sweep runs; returns the figures."""
    stop = threading.Event()
    failed = []
    output = tools().work / f"pool_{os.getpid()}.npy"

    def disturb():
        try:
            for i in range(12 if tools().soak else 3):
                servers.replace(i % 3, drained=i % 2 == 1)
        finally:
            stop.set()

    def sweep():
        count = 0
        while not stop.is_set():
            runs = 0
            while True:
                done = command_line(*SWEEP, "--server", server_option, "-o", output, *(["--resume"] if runs else []))
                runs += 1
                if done.returncode == 0:
                    break
                require(done.returncode == 75 and runs < 50, f"the sweep ended with {done.returncode}: {done.stderr}")
            require(output.read_bytes() == whole.read_bytes(), "the sweep differs from that of the embedded engine")
            count += 1
        return count

    whole = tools().work / f"whole_{os.getpid()}.npy"
    require(command_line(*SWEEP, "-o", whole).returncode == 0, "the embedded engine fails")
    caller = lambda: call_until(stop, target, failed)  # noqa: E731
    _, sweeps, *calls = in_threads([disturb, sweep, caller, caller])
    require(not failed, f"{len(failed)} of {sum(calls)} calls failed: {sorted(set(failed))}")
    return {"calls": sum(calls), "failed": 0, "sweeps": sweeps, "points of each": POINTS}


RULE = "no unary call fails while each of three servers dies or drains and returns, and sweeps end with the embedded engine's bytes"


@check("HAProxy before three servers", RULE)
def behind_haproxy():
    with Servers() as servers, haproxy(servers.addresses) as proxy:
        return try_pool(servers, proxy.address, proxy.address)


@check("nginx before three servers", RULE)
def behind_nginx():
    with Servers() as servers, nginx(servers.addresses) as proxy:
        return try_pool(servers, proxy.address, proxy.address)


@check("round robin over a list of addresses", RULE)
def address_list():
    with Servers() as servers:
        return try_pool(servers, "ipv4:" + ",".join(servers.addresses), ",".join(servers.addresses))


@check("round robin over the addresses of a name", RULE)
def headless_service():
    with Servers() as servers, Names() as names:
        target = f"dns://127.0.0.1:{names.port}/ricochet:{servers.servers[0].port}"
        figures = try_pool(servers, target, ",".join(servers.addresses))
        require(names.asked, "nobody asked for the addresses of the name")
        return figures


PIECES = 24  # Each has a mebibyte: together they are more than nginx lets through in one call unless it is told to.
BATCH_RULE = "one call takes 24 MiB of batches, each of which is sent after the answer to the one before"


def try_batches(proxy_before):
    piece = request("SolveBatches", f"""setup {{ scene {{ {PENDULUM} }} fields: "friction.kinetic_coefficient"
      columns: "coefficients.newton" }}""")
    piece.inputs.append(struct.pack("<d", 0.1) * (1 << 17))
    may_send = threading.Semaphore(1)

    def pieces():
        for _ in range(PIECES):
            may_send.acquire(timeout=LIMIT_S)
            yield piece

    def read(on):
        for answer in on.SolveBatches(pieces(), timeout=LIMIT_S):
            sizes.append(len(answer.outputs[0]))
            may_send.release()

    sizes = []
    with Servers() as servers, proxy_before(servers.addresses) as proxy, channel(proxy.address) as line:
        code = code_of(lambda: read(stub(line)))
    require(code == grpc.StatusCode.OK, f"after {len(sizes)} answers the call ended with {code.name}")
    require(sizes == [1 << 20] * PIECES, f"the answers have {sizes} bytes")
    return {"pieces": PIECES}


@check("batches behind HAProxy", BATCH_RULE)
def batches_behind_haproxy():
    return try_batches(haproxy)


@check("batches behind nginx", BATCH_RULE)
def batches_behind_nginx():
    return try_batches(nginx)


def checksum(*arguments, events=()):
    """The SHA-256 of what `ricochet` prints, its bytes and its seconds. Each event (bytes, function) is called once so many
    bytes have come."""
    events = list(events)
    start = time.monotonic()
    with open(tools().work / "shared_errors", "w+b") as errors:
        process = Process([tools().ricochet, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=errors)
        whole, size = hashlib.sha256(), 0
        while block := process.child.stdout.read(1 << 20):
            whole.update(block)
            size += len(block)
            while events and size > events[0][0]:
                events.pop(0)[1]()
        code = process.child.wait()
        errors.seek(0)
        require(code == 0, f"ricochet ended with {code}: {errors.read()[-500:]}")
    require(not events, "the sweep ended before every server was disturbed")
    return whole.hexdigest(), size, time.monotonic() - start


@check("one sweep shared by three servers behind HAProxy", "one server is killed and one drained, neither comes back, and the sweep "
       "ends with the checksum of the undisturbed embedded run")
def shared_behind_haproxy():
    sweep = sweep_of(SHARED_POINTS)
    expected, size, alone_s = checksum(*sweep)
    with Servers() as servers, haproxy(servers.addresses) as proxy:
        one, two, three = servers.servers
        events = [(size // 4, one.kill), (size // 2, lambda: two.signal(signal.SIGTERM))]
        found, _, shared_s = checksum(*sweep, "--server", ",".join([proxy.address] * 3), "--fan-out", events=events)
        require(found == expected, f"the checksum {found} is not {expected}, that of the embedded engine")
        require(two.wait(20) == 0, "the drained server did not end with 0")
        require(not one.alive() and three.alive(), "the killed server runs, or the third one does not")
    return {"points": SHARED_POINTS, "bytes": size, "sha256": found, "embedded s": alone_s, "shared s": shared_s}


if __name__ == "__main__":
    main()

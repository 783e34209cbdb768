"""Faults of machines, disks, networks and people: signals, full disks, lost packets, servers that die and return."""

import fcntl
import functools
import os
import random
import select
import shutil
import signal
import socket
import struct
import subprocess
import threading
import time

import grpc

from calls import (call_until, channel, cheap, code_of, expensive, health, long_sweep, require_served, stub,
                   wait_served)
from framework import (Group, Process, Server, Skipped, check, command_line, cpu_until_idle, in_threads, main, remove,
                       require, tools, wait_until)
from http2 import SERVICE, RawConnection

TRY_AGAIN = 75  # The exit code of the command line for an error that another try may mend.
ELASTIC = ["--a", "0.35", "--b", "1.1", "--mu", "0.12", "--energetic", "0.95"]


def sweep_arguments(points, *more):
    return ["sweep", *ELASTIC, "--axis", f"pendulum.b_m=lin:0.5:2:{points}", "--column", "coefficients.newton", "--format",
            "csv", *more]


def undisturbed(name, arguments):
    """The bytes that the embedded solver writes."""
    out = tools().work / name
    remove(out)
    done = command_line(*arguments, "-o", out, timeout_s=300)
    require(done.returncode == 0, f"the embedded run ended with {done.returncode}: {done.stderr}")
    return out.read_bytes()


# Signals and the end of a process.


@check("a client killed by SIGKILL", "its sweep ends, and the server rests within 1 CPU s")
def client_killed():
    with Server() as server:
        client = Process([tools().ricochet, *sweep_arguments(10**9, "--summary-only"), "--server", server.address],
                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(1)
        client.kill()
        used = cpu_until_idle(server, 1)
        require(used is not None, "the server computes on")
        require(wait_until(lambda: "CANCELLED" in server.log_text(), 5), "the log does not say CANCELLED")
        require_served(server)
        return {"CPU s": used}


@check("SIGTERM with everything connected", "watches, reflection, sweeps that nobody reads, silent and idle connections and a "
       "running expensive call: the process ends with 0 within 10 s")
def drain_with_everything():
    # The defaults take up to 9 s, which a busy machine may draw out to more than 10 s.
    with Server(**({} if tools().soak else {"drain_grace": 1})) as server, channel(server.address) as idle, channel(server.address) as busy:
        stub(idle).Solve(cheap(), timeout=20)
        slow = expensive(server, 0.5)
        raw = RawConnection(server.host, server.port, window=0)
        raw.open("/grpc.health.v1.Health/Watch", b"")
        raw.open("/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo")
        raw.open(SERVICE + "Solve")
        for _ in range(5):
            raw.open(SERVICE + "Sweep", long_sweep().SerializeToString())
        raw.pump()
        silent = [socket.create_connection((server.host, server.port)) for _ in range(20)]
        time.sleep(0.5)
        running = stub(busy).Solve.future(slow.request, timeout=60)
        time.sleep(0.1)
        took = server.drain()
        code = code_of(running.result)
        raw.close()
        for connection in silent:
            connection.close()
        require(code in (grpc.StatusCode.OK, grpc.StatusCode.UNAVAILABLE), f"the expensive call ended with {code.name}")
        return {"s": took, "expensive call": code.name}


@check("SIGTERM twice", "the second one ends the process within 2 s, whatever is connected")
def sigterm_twice():
    with Server(drain_grace=30) as server:
        raw = RawConnection(server.host, server.port, window=0)
        raw.open(SERVICE + "Sweep", long_sweep().SerializeToString())
        raw.pump()
        time.sleep(0.3)
        server.signal(signal.SIGTERM)
        time.sleep(0.5)
        start = time.monotonic()
        server.signal(signal.SIGTERM)
        code = server.wait(2)
        raw.close()
        require(code is not None, "it still runs 2 s after the second SIGTERM")
        return {"s": time.monotonic() - start, "code": code}


@check("other signals", "HUP, USR1, USR2, PIPE, ALRM and XFSZ leave the server serving; QUIT and INT drain it with 0")
def other_signals():
    with Server() as server:
        for number in (signal.SIGHUP, signal.SIGUSR1, signal.SIGUSR2, signal.SIGPIPE, signal.SIGALRM, signal.SIGXFSZ):
            server.signal(number)
            time.sleep(0.1)
            require(server.alive(), f"{number.name} ended the process")
            require_served(server)
    for number in (signal.SIGQUIT, signal.SIGINT):
        with Server(drain_grace=0.2) as server:
            server.signal(number)
            code = server.wait(10)
            require(code == 0, f"after {number.name} it ended with {code}")
    return {}


@check("SIGSTOP", "a sweep goes on with the same bytes after its server stood still for 3 s; 30 s in the long run")
def sigstop():
    pause = 30 if tools().soak else 3
    arguments = sweep_arguments(1000000)
    expected = undisturbed("sigstop.embedded", arguments)
    out = tools().work / "sigstop.csv"
    with Server() as server:
        client = Process([tools().ricochet, *arguments, "--server", server.address, "-o", out],
                         stderr=subprocess.PIPE, text=True)
        part = out.with_name(out.name + ".part")
        require(wait_until(lambda: part.exists() and part.stat().st_size > 0, 20, 0.01), "the client writes nothing")
        server.signal(signal.SIGSTOP)
        time.sleep(pause)
        server.signal(signal.SIGCONT)
        code = client.wait(60)
        require(code == 0, f"the client ended with {code}: {client.child.stderr.read() if code is not None else ''}")
        require(out.read_bytes() == expected, "the bytes differ")
        require_served(server)
        return {"s still": pause, "bytes": len(expected)}


@check("drain beside a second server", "no unary call fails while two servers are drained and started in turn")
def rolling_restart():
    servers = [Server(drain_grace=0.5), Server(drain_grace=0.5)]
    ports = [server.port for server in servers]
    target = "ipv4:" + ",".join(server.address for server in servers)
    stop = threading.Event()
    failed = []

    def restart():
        try:
            for i in range(12 if tools().soak else 4):
                servers[i % 2].drain()
                servers[i % 2] = Server(drain_grace=0.5, port=ports[i % 2])
                # The clients connect to it again before the other one goes.
                require(wait_until(lambda: "Solve" in servers[i % 2].log_text(), 60), "no client comes back")  # pylint: disable=cell-var-from-loop
        finally:
            stop.set()

    client = functools.partial(call_until, stop, target, failed)
    counts = in_threads([restart, client, client, client])[1:]
    for server in servers:
        server.kill()
    require(not failed, f"{len(failed)} of {sum(counts)} calls failed: {sorted(set(failed))}")
    return {"calls": sum(counts), "failed": 0}


@check("SIGKILL and a start on the same port", "the server is up again within 10 s")
def restart_on_same_port():
    with Server() as server, channel(server.address) as line:
        stub(line).Solve(cheap(), timeout=20)
        server.child.kill()
        server.child.wait()
        start = time.monotonic()
        with Server(port=server.port) as again:
            require_served(again)
            return {"s": time.monotonic() - start}


# Files.


@check("a port in use, bad options, a missing directory", "the process ends with 1 or 2 and says why")
def bad_starts():
    def start(*options):
        done = subprocess.run([tools().ricochetd, *options], capture_output=True, text=True, timeout=20, check=False)
        return done.returncode, done.stderr

    with Server() as server:
        code, text = start("--listen", server.address)
        require(code == 1 and str(server.port) in text, f"a port in use: {code} {text}")
    code, text = start("--listen", "127.0.0.1:0", "--max-live-calls", "none")
    require(code == 2 and "max-live-calls" in text, f"a bad option: {code} {text}")
    code, text = start("--listen", "127.0.0.1:0", "--port-file", str(tools().work / "no/such/port"))
    require(code == 1 and "no/such" in text, f"a missing directory: {code} {text}")
    code, text = start("--listen", "0.0.0.0:0")
    require(code == 2, f"an address beyond loopback: {code} {text}")
    return {}


@check("a port file", "it is gone once the server has ended")
def port_file():
    with Server(drain_grace=0) as server:
        took = server.drain()
        require(not server.port_file.exists(), "the port file is left")
        return {"drain s": took}


@check("port files that are no plain files", "a symbolic link, a pipe and a device stay what they are")
def port_files():
    place = tools().work / "port_files"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    target = place / "target"
    target.write_text("kept", encoding="ascii")
    (place / "link").symlink_to(target)
    os.mkfifo(place / "pipe")
    names = ["link", "pipe"]
    if os.geteuid() == 0:
        os.mknod(place / "device", 0o600 | 0o020000, os.makedev(1, 3))
        names.append("device")
    before = {name: (place / name).lstat().st_mode for name in names}
    for name in names:
        child = Process([tools().ricochetd, "--listen", "127.0.0.1:0", "--port-file", place / name],
                        stderr=subprocess.DEVNULL)
        child.wait(1)
        child.signal(signal.SIGTERM)
        child.wait(10)
        child.kill()
    after = {name: (place / name).lstat().st_mode for name in names if os.path.lexists(place / name)}
    require(after == before, f"modes before {before}, after {after}")
    require(target.read_text(encoding="ascii") == "kept", "the target of the link was written")
    return {"kept": names}


@check("a log to /dev/full", "the server serves and drains")
def full_device():
    with open("/dev/full", "wb") as full, Server(stderr=full, drain_grace=0.2) as server:
        for _ in range(50):
            require_served(server)
        return {"drain s": server.drain()}


@check("a log disk that is full for a time", "the server serves meanwhile, and logs again once there is room")
def full_disk():
    place = tools().work / "small_disk"
    place.mkdir(exist_ok=True)
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=256k,nr_inodes=100", "tmpfs", place], capture_output=True, text=True,
                             check=False)
    if mounted.returncode != 0:
        raise Skipped(f"no tmpfs can be mounted here: {mounted.stderr.strip()}")
    try:
        ballast, log = place / "ballast", place / "log"
        with open(log, "ab") as file, Server(stderr=file, drain_grace=0.2, log_calls="all") as server:
            require_served(server)
            with open(ballast, "wb", buffering=0) as filler:
                try:
                    while filler.write(bytes(1024)):
                        pass
                except OSError:
                    pass  # The disk is full now.
            with channel(server.address) as line:
                for _ in range(300):
                    stub(line).Solve(cheap(), timeout=20)
            full = log.stat().st_size
            ballast.unlink()

            def logs_again():
                require_served(server)
                return log.stat().st_size > full

            require(wait_until(logs_again, 15), "nothing is logged after the disk has room again")
            return {"bytes when full": full, "bytes after": log.stat().st_size, "drain s": server.drain()}
    finally:
        subprocess.run(["umount", "--lazy", place], check=False)


@check("a log pipe that nobody reads", "1000 calls with a line each are answered, and SIGTERM ends the process with 0 within 10 s")
def unread_pipe():
    reading, writing = os.pipe()
    try:
        with Server(stderr=writing, drain_grace=0.2, log_calls="all") as server, channel(server.address) as line:
            on = stub(line)
            for i in range(1000):
                code = code_of(lambda: on.Solve(cheap(), timeout=10))
                require(code == grpc.StatusCode.OK, f"call {i} ended with {code.name}")
            return {"drain s": server.drain()}
    finally:
        os.close(reading)
        os.close(writing)


@check("closed standard descriptors", "the server serves, and no socket of it gets lines of the log")
def closed_descriptors():
    with Server(prefix=["/bin/sh", "-c", 'exec "$@" 0<&- 1>&- 2>&-', "sh"], drain_grace=0.2) as server:
        for _ in range(20):
            require_served(server)
        kinds = [os.readlink(f"/proc/{server.pid}/fd/{i}") for i in (1, 2)
                 if os.path.lexists(f"/proc/{server.pid}/fd/{i}")]
        require(not any("socket" in kind or "event" in kind for kind in kinds), f"descriptors 1 and 2 are {kinds}")
        return {"descriptors 1 and 2": kinds, "drain s": server.drain()}


# Resources.


def burst_of_connections(hard):
    with Server(limits=[f"--nofile=64:{hard}"]) as server:
        require_served(server)
        connections = []
        for i in range(300):
            try:
                connections.append(socket.create_connection((server.host, server.port), 2,
                                                            source_address=(f"127.0.2.{i % 250 + 1}", 0)))
            except OSError:
                break
        time.sleep(1)
        held = server.descriptors()
        state = health(server, 2)
        for connection in connections:
            connection.close()
        took = wait_served(server, 20)
        return {"connections": len(connections), "descriptors": held, "health in the burst": state, "Solve after s": took}


@check("64 descriptors", "300 connections at once, and the server serves again once they are gone")
def few_descriptors():
    return burst_of_connections(64)


@check("a soft limit of 64 descriptors", "the server raises it to the hard limit of 4096 and serves beside 300 connections")
def soft_limit():
    figures = burst_of_connections(4096)
    require(figures["descriptors"] > 64, f"{figures}")
    return figures


@check("deadlines of 1 ms", "300 Solves with them end with OK or DEADLINE_EXCEEDED, and the command line with 0 or 75")
def one_millisecond():
    with Server() as server, channel(server.address) as line:
        on = stub(line)
        calls = [on.Solve.future(cheap(), timeout=0.001) for _ in range(300)]
        codes = {code_of(call.result) for call in calls}
        require(codes <= {grpc.StatusCode.OK, grpc.StatusCode.DEADLINE_EXCEEDED}, f"{codes}")
        done = command_line("solve", *ELASTIC, "--server", server.address, "--deadline", "1ms")
        require(done.returncode in (0, 75), f"the command line ended with {done.returncode}: {done.stderr}")
        require_served(server)
        return {"statuses": sorted(code.name for code in codes), "command line": done.returncode}


@check("512 MiB of memory", "64 Solves with full histories at once are answered or refused by a server in a control group of that "
       "size, which goes on serving")
def little_memory():
    what = cheap()
    what.history_intervals = 65535
    with Group("memory", 512 << 20) as group, Server(prefix=group.prefix) as server:
        def ask():
            with channel(server.address) as line:
                return code_of(lambda: stub(line).Solve(what, timeout=60)).name

        codes = in_threads([ask] * (64 if tools().soak else 16))
        require(server.alive(), f"the process ended with {server.child.returncode}")
        require(set(codes) <= {"OK", "RESOURCE_EXHAUSTED"}, f"statuses: {codes}")
        require_served(server)
        return {**{code: codes.count(code) for code in sorted(set(codes))}, "most MiB": server.peak_mib()}


@check("40 threads", "120 sweeps at once that nobody reads leave a server in a control group of that size which serves once they end")
def few_threads():
    with Group("pids", 40) as group, Server(prefix=group.prefix, write_stall_timeout=3) as server:
        with RawConnection(server.host, server.port, source="127.0.0.2", window=0) as connection:
            for _ in range(120):
                connection.open(SERVICE + "Sweep", long_sweep().SerializeToString())
            connection.pump()
            time.sleep(1)
            held = server.threads()
        return {"threads": held, "Solve after s": wait_served(server, 30)}


# Networks.


class Network:
    """A server's namespace, joined to this one by two tunnels whose packets pass through this process."""

    # Addresses of this process's own, as several of these may run at once.
    HERE, THERE = [f"10.{200 + os.getpid() // 256 % 50}.{os.getpid() % 256}.{end}" for end in (1, 2)]

    def __init__(self, seed):
        self.name = f"ricochet{os.getpid()}"
        self.rng = random.Random(seed)
        self.loss = 0.0
        self.cut = False
        self.passed = self.lost = 0
        self.over = False
        try:
            self._ip("netns", "add", self.name)
            self.ends = [self._tunnel(f"rc{os.getpid() % 100000}a"), self._tunnel(f"rc{os.getpid() % 100000}b")]
            here, there = (f"rc{os.getpid() % 100000}a", f"rc{os.getpid() % 100000}b")
            self._ip("link", "set", there, "netns", self.name)
            self._ip("addr", "add", self.HERE, "peer", self.THERE, "dev", here)
            self._ip("link", "set", here, "up")
            inside = ("netns", "exec", self.name, "ip")
            self._ip(*inside, "addr", "add", self.THERE, "peer", self.HERE, "dev", there)
            self._ip(*inside, "link", "set", there, "up")
            self._ip(*inside, "link", "set", "lo", "up")
        except (OSError, subprocess.CalledProcessError) as error:
            self.close()
            raise Skipped(f"no network namespace or tunnel can be made here: {error}") from error
        threading.Thread(target=self._carry, daemon=True).start()

    @staticmethod
    def _ip(*words):
        subprocess.run(["ip", *words], check=True, capture_output=True)

    @staticmethod
    def _tunnel(name):
        end = os.open("/dev/net/tun", os.O_RDWR)
        fcntl.ioctl(end, 0x400454CA, struct.pack("16sH22x", name.encode(), 0x1001))  # TUNSETIFF: IFF_TUN, IFF_NO_PI.
        return end

    def _carry(self):
        while not self.over:
            for end in select.select(self.ends, [], [], 0.2)[0]:
                try:
                    packet = os.read(end, 65536)
                    if self.cut or self.rng.random() < self.loss:
                        self.lost += 1
                        continue
                    self.passed += 1
                    os.write(self.ends[1 - self.ends.index(end)], packet)
                except OSError:
                    pass  # The interface is not up yet, or not any more.

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.over = True
        time.sleep(0.3)
        for end in getattr(self, "ends", ()):
            os.close(end)
        subprocess.run(["ip", "netns", "del", self.name], check=False, capture_output=True)

    def server(self, *options, **more):
        return Server(*options, "--insecure", host=self.THERE, prefix=["ip", "netns", "exec", self.name], **more)


def over_a_bad_line(points, disturb):
    """A sweep through a network that `disturb` makes worse; returns the finished client and what it should have written."""
    arguments = sweep_arguments(points)
    expected = undisturbed("network.embedded", arguments)
    out = tools().work / "network.csv"
    part = out.with_name(out.name + ".part")
    remove(out)
    with Network(tools().seed) as network, network.server() as server:
        command = [tools().ricochet, *arguments, "--server", server.address, "-o", out]
        client = Process(command, stderr=subprocess.PIPE, text=True)
        disturb(network)
        code = client.wait(150)
        gave_up = code == TRY_AGAIN
        if gave_up:
            client = Process([*command, *(["--resume"] if part.exists() else [])], stderr=subprocess.PIPE, text=True)
            code = client.wait(150)
        require(code == 0, f"the client ended with {code}: {client.child.stderr.read() if code is not None else ''}")
        require(out.read_bytes() == expected, "the bytes differ")
        network.loss = 0.0
        require_served(server)
        return {"bytes": len(expected), "packets": network.passed, "lost": network.lost, "--resume was needed": gave_up}


@check("10 % of packets lost", "a sweep arrives with the same bytes")
def lossy_network():
    def disturb(network):
        network.loss = 0.1

    return over_a_bad_line(1000000 if tools().soak else 100000, disturb)


@check("a partition that heals", "a sweep that is cut off for 3 s, or 20 s in the long run, arrives with the same bytes, by --resume if "
       "its client gave up")
def partition():
    def disturb(network):
        network.loss = 0.02
        time.sleep(0.3)
        network.cut = True
        time.sleep(20 if tools().soak else 3)
        network.cut = False

    return over_a_bad_line(1000000 if tools().soak else 300000, disturb)


@check("a partition that stays", "the server gives up the sweep and its place within 120 s", soak=True)
def lasting_partition():
    with Network(tools().seed) as network, network.server() as server:
        idle = server.threads()
        client = Process([tools().ricochet, *sweep_arguments(10**9, "--summary-only"), "--server", server.address],
                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(1)
        network.cut = True
        start = time.monotonic()
        code = client.wait(120)
        require(code == TRY_AGAIN, f"the client ended with {code}")
        told = time.monotonic() - start
        require(wait_until(lambda: "method=/ricochet.v1.ImpactService/Sweep" in server.log_text(), 120),
                "the sweep has not ended after 120 s")
        return {"client knew after s": told, "server knew after s": time.monotonic() - start, "threads": server.threads() - idle}


if __name__ == "__main__":
    main()

"""The attacks on HTTP/2 of transport.py, through what must stand between the service and a network: mutual TLS or the proxy."""

import os
import re
import shutil
import socket
import ssl
import tempfile
import time
from pathlib import Path

import grpc

from calls import cheap, code_of, stub
from certificates import Authority
from credentials import Secured
from framework import NotLevel, Process, Server, Skipped, check, cpu_until_idle, in_threads, main, require, tools, wait_until
from http2 import SERVICE, RawConnection
from transport import ATTACKS, MOST_MIB

def struck(server, connect, function, count, ask):
    """Attacks by `count` connections of `connect()` while `ask()` must be OK; returns figures."""
    require(ask() == "OK", "a good client is not answered before the attack")
    before, cpu = server.peak_mib(), server.cpu_s()
    done, slowest = [], [0.0]

    def good_client():
        while len(done) < count:
            start = time.monotonic()
            code = ask()
            slowest[0] = max(slowest[0], time.monotonic() - start)
            require(code == "OK", f"a good client meanwhile: {code}")
            time.sleep(0.05)

    def strike():
        try:
            with connect() as connection:
                connection.read(0.3, lambda: connection.settings > 0)
                return function(connection)
        except (OSError, NotLevel):  # The connection was refused, or what was sent got no answer.
            return 0
        finally:
            done.append(1)

    sent = in_threads([good_client, *[strike] * count])[1:]
    require(cpu_until_idle(server, 60) is not None, "the server does not come to rest")
    grown, used = server.peak_mib() - before, server.cpu_s() - cpu
    require(server.alive() and ask() == "OK", "a good client is not answered after the attack")
    require(grown <= MOST_MIB, f"{grown:.0f} MiB")
    require(used <= 10, f"{used:.1f} CPU s")
    return {"bytes sent": sum(sent), "MiB": grown, "CPU s": used, "slowest Solve s": slowest[0]}


def encrypted(host, port):
    """A TLS connection that shows no certificate and trusts everybody."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    context.set_alpn_protocols(["h2"])
    return context.wrap_socket(socket.create_connection((host, port), 10, source_address=("127.0.0.2", 0)))


def register_mutual(name, function, count):
    @check(f"{name}, mutual TLS", f"without a certificate it takes at most {MOST_MIB} MiB and 10 CPU s, and others are served",
           kind="input")
    def run():
        with Secured("boundary", mutual=True) as secured:
            server = secured.server

            def connect():
                return RawConnection(server.host, server.port, sock=encrypted(server.host, server.port), acknowledge=False)

            good = secured.authority.issue("client")
            with secured.channel(client=good) as line:
                return struck(server, connect, function, count,
                              lambda: code_of(lambda: stub(line).Solve(cheap(), timeout=20)).name)

    return run


def listens(port):
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


class Proxied:
    """A server on a Unix socket, and HAProxy before it by deploy/haproxy.cfg, open to clients without a certificate."""

    def __init__(self):
        recipe = tools().proto.parent / "deploy/haproxy.cfg"
        program = shutil.which("haproxy", path="/usr/sbin:/usr/bin:/sbin:/bin")
        if not recipe.exists() or program is None or not tools().has_option("socket-mode"):
            raise Skipped("HAProxy, its recipe or a server with Unix sockets is not here")
        self.place = Path(tempfile.mkdtemp(prefix="ricochet"))  # The path of a Unix socket must be short.
        path = self.place / "socket"
        self.server = Server(also=f",unix:{path}", max_connections_per_peer=4096)
        authority = Authority("authority")
        cert, key, _ = authority.issue("proxy")
        (self.place / "proxy.pem").write_bytes(cert + key)
        text = recipe.read_text(encoding="utf-8")
        text = re.sub(r' ca-file "\$RICOCHET_CLIENT_CA" verify required', "", text)
        require("verify required" not in re.sub(r"(?m)^\s*#.*$", "", text), "the recipe's line of client certificates is another")
        (self.place / "haproxy.cfg").write_text(text, encoding="utf-8")
        # The proxy takes over a socket that is bound, because a port that is only known to be free may be taken
        # meanwhile.
        with socket.socket() as bound, open(self.place / "log", "wb") as log:
            bound.bind(("127.0.0.1", 0))
            self.port = bound.getsockname()[1]
            environment = {**os.environ, "RICOCHET_BIND": f"fd@{bound.fileno()}", "RICOCHET_TLS": str(self.place / "proxy.pem"),
                           "RICOCHET_SOCKET": str(path)}
            self.process = Process([program, "-db", "-f", self.place / "haproxy.cfg"], pass_fds=[bound.fileno()], stdout=log,
                                   stderr=log, env=environment)
        # A channel that was once refused a connection waits for seconds before it tries again.
        wait_until(lambda: listens(self.port), 15)
        self.line = grpc.secure_channel(
            f"localhost:{self.port}", grpc.ssl_channel_credentials(authority.pem),
            options=[("grpc.use_local_subchannel_pool", 1), ("grpc.initial_reconnect_backoff_ms", 200),
                     ("grpc.min_reconnect_backoff_ms", 200), ("grpc.max_reconnect_backoff_ms", 500)])
        if not wait_until(lambda: self.ask(2) == "OK", 15, 0.3):
            log_text = (self.place / "log").read_text(encoding="utf-8", errors="replace")
            self.__exit__()
            raise NotLevel(f"the proxy lets no call through: {log_text[-800:]}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.line.close()
        self.process.kill()
        self.server.__exit__()
        shutil.rmtree(self.place, ignore_errors=True)

    def ask(self, seconds=20):
        return code_of(lambda: stub(self.line).Solve(cheap(), timeout=seconds)).name

    def connect(self):
        return RawConnection("127.0.0.1", self.port, sock=encrypted("127.0.0.1", self.port), acknowledge=False)


def register_proxy(name, function, count):
    @check(f"{name}, behind the proxy", f"the server takes at most {MOST_MIB} MiB and 10 CPU s, and others are served", kind="input")
    def run():
        with Proxied() as proxied:
            return struck(proxied.server, proxied.connect, function, count, proxied.ask)

    return run


@check("malformed metadata, behind the proxy", "one client's bad grpc-timeout or encoding harms no call of another", kind="input")
def bad_metadata():
    with Proxied() as proxied:
        for _ in range(5):
            for extra in ([("grpc-timeout", "-1S")], [("grpc-encoding", "nonsense")], [("x-bin", "not base64!")]):
                running = stub(proxied.line).Solve.future(cheap(), timeout=20)
                with proxied.connect() as connection:
                    connection.answer(connection.open(SERVICE + "Solve", cheap().SerializeToString(), extra), 2)
                code = code_of(running.result).name
                require(code == "OK", f"beside {extra} a call ended with {code}")
        return {}


@check("many calls, behind the proxy", "calls that are answered are never refused, whatever their rate")
def answered_calls():
    with Proxied() as proxied:
        start = time.monotonic()
        ask = stub(proxied.line).Solve
        for _ in range(50):
            for running in [ask.future(cheap(), timeout=60) for _ in range(100)]:
                require(code_of(running.result).name == "OK", f"a call ended with {running.code()}")
        return {"calls": 5000, "s": time.monotonic() - start}


for row_name, row_function, row_count, _ in ATTACKS:
    register_mutual(row_name, row_function, row_count)
    register_proxy(row_name, row_function, row_count)


if __name__ == "__main__":
    main()

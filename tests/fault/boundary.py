"""The attacks on HTTP/2 of transport.py, through what must stand between the service and a network: mutual TLS or the proxy."""

import re
import shutil
import socket
import ssl
import time

from calls import channel, cheap, code_of, stub
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


def register_mutual(name, function, count):
    @check(f"{name}, mutual TLS", f"without a certificate it takes at most {MOST_MIB} MiB and 10 CPU s, and others are served",
           kind="input")
    def run():
        with Secured("boundary", mutual=True) as secured:
            context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
            context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
            context.set_alpn_protocols(["h2"])
            server = secured.server

            def connect():
                plain = socket.create_connection((server.host, server.port), 10, source_address=("127.0.0.2", 0))
                return RawConnection(server.host, server.port, sock=context.wrap_socket(plain), acknowledge=False)

            good = secured.authority.issue("client")
            with secured.channel(client=good) as line:
                return struck(server, connect, function, count,
                              lambda: code_of(lambda: stub(line).Solve(cheap(), timeout=20)).name)

    return run


class Proxy:
    """HAProxy by the recipe of deploy/haproxy.cfg, between a free port and a server."""

    def __init__(self, server):
        recipe = tools().proto.parent / "deploy/haproxy.cfg"
        program = shutil.which("haproxy", path="/usr/sbin:/usr/bin:/sbin:/bin")
        if not recipe.exists() or program is None:
            raise Skipped("HAProxy or its recipe is not here")
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        text = recipe.read_text(encoding="utf-8")
        # The recipe's certificate is its user's own; these checks are about what passes after the handshake.
        text = re.sub(r"(?m)^(\s*)bind .*$", rf"\1bind 127.0.0.1:{self.port} proto h2", text)
        text = re.sub(r"(?m)^(\s*server \S+) \S+(.*)$", rf"\1 {server.address}\2", text)
        text = re.sub(r"(?m)^\s*(user|group|chroot|daemon|stats|log|pidfile)\b.*$", "", text)
        config = tools().work / "haproxy.cfg"
        config.write_text(text, encoding="utf-8")
        self.process = Process([program, "-db", "-f", config], stderr=open(tools().work / "haproxy.log", "wb"))  # pylint: disable=consider-using-with
        self.address = f"127.0.0.1:{self.port}"

        def up():
            with socket.socket() as probe:
                return probe.connect_ex(("127.0.0.1", self.port)) == 0

        if not wait_until(up, 10):
            raise NotLevel(f"HAProxy does not start: {(tools().work / 'haproxy.log').read_text(encoding='utf-8')[-800:]}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()


def register_proxy(name, function, count):
    @check(f"{name}, behind the proxy", f"the server takes at most {MOST_MIB} MiB and 10 CPU s, and others are served", kind="input")
    def run():
        with Server() as server, Proxy(server) as proxy, channel(proxy.address) as line:
            def connect():
                return RawConnection("127.0.0.1", proxy.port, source="127.0.0.2", acknowledge=False)

            return struck(server, connect, function, count,
                          lambda: code_of(lambda: stub(line).Solve(cheap(), timeout=20)).name)

    return run


@check("malformed metadata, behind the proxy", "one client's bad grpc-timeout or encoding harms no call of another", kind="input")
def bad_metadata():
    with Server() as server, Proxy(server) as proxy, channel(proxy.address) as line:
        on = stub(line)
        for _ in range(5):
            for extra in ([("grpc-timeout", "-1S")], [("grpc-encoding", "nonsense")], [("x-bin", "not base64!")]):
                running = on.Solve.future(cheap(), timeout=20)
                with RawConnection("127.0.0.1", proxy.port) as connection:
                    connection.answer(connection.open(SERVICE + "Solve", cheap().SerializeToString(), extra), 2)
                require(code_of(running.result).name == "OK", f"beside {extra} a call ended with {code_of(running.result).name}")
        return {}


for row_name, row_function, row_count, _ in ATTACKS:
    register_mutual(row_name, row_function, row_count)
    register_proxy(row_name, row_function, row_count)


if __name__ == "__main__":
    main()

"""TLS, client certificates and tokens: wrong, expired, rotated while the server runs, and handshakes that never end."""

import contextlib
import hashlib
import os
import re
import secrets
import socket
import ssl
import time

import grpc

from calls import cheap, code_of, long_sweep, pb, stub
from certificates import Authority
from framework import Server, Skipped, check, main, require, tools, wait_until

TAKES_S = 20  # A changed file is taken within this time.
HANDSHAKE_S = 2  # The server of the check of handshakes closes a connection without one after this time.


def replace(path, content):
    """Puts a file into place at once, as people who rotate files should."""
    new = path.with_suffix(".new")
    new.write_bytes(content)
    os.replace(new, path)


class Secured:
    """An authority, the files of a server, and the server."""

    def __init__(self, name, mutual=False, tokens=None, **more):
        if not tools().has_option("tls-cert"):
            raise Skipped("this server has no TLS")
        self.place = tools().work / name
        self.place.mkdir(parents=True, exist_ok=True)
        self.authority = Authority("authority")
        self.cert, self.key, self.ca, self.tokens = [
            self.place / file for file in ("cert.pem", "key.pem", "ca.pem", "tokens")]
        self.serial = self.renew()
        self.ca.write_bytes(self.authority.pem)
        options = ["--tls-cert", self.cert, "--tls-key", self.key]
        if mutual:
            options += ["--tls-client-ca", self.ca]
        if tokens is not None:
            self.tokens.write_text(tokens, encoding="ascii")
            options += ["--tokens", self.tokens]
        self.server = Server(*options, **{"log_level": "info", **more})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.server.__exit__()

    def renew(self):
        cert, key, serial = self.authority.issue("server")
        # Both halves are never read together while only one is new, as long as the key comes first.
        replace(self.key, key)
        replace(self.cert, cert)
        return serial

    def channel(self, client=None, authority=None, token=None, address=None):
        """client: certificate and key in PEM form."""
        credentials = grpc.ssl_channel_credentials(
            (authority or self.authority).pem, client[1] if client else None, client[0] if client else None)
        if token is not None:
            credentials = grpc.composite_channel_credentials(credentials, grpc.access_token_call_credentials(token))
        options = [("grpc.use_local_subchannel_pool", 1), ("grpc.ssl_target_name_override", "localhost")]
        return grpc.secure_channel(address or self.server.address, credentials, options=options)

    def ask(self, seconds=10, **how):
        with self.channel(**how) as line:
            return code_of(lambda: stub(line).Solve(cheap(), timeout=seconds)).name

    def shown_serial(self, client=None):
        """The serial number of the certificate that the server shows to a new connection."""
        from cryptography import x509  # pylint: disable=import-outside-toplevel
        context = ssl.create_default_context(cadata=self.authority.pem.decode())
        context.set_alpn_protocols(["h2"])
        if client:
            (self.place / "client.pem").write_bytes(client[0] + client[1])
            context.load_cert_chain(self.place / "client.pem")
        with contextlib.closing(socket.create_connection((self.server.host, self.server.port), 10)) as plain:
            with context.wrap_socket(plain, server_hostname="localhost") as line:
                return x509.load_der_x509_certificate(line.getpeercert(binary_form=True)).serial_number


@check("TLS", "a client of the authority is answered; one of another authority and one in plain text are not")
def tls():
    with Secured("tls") as secured:
        require(secured.ask() == "OK", f"a good client: {secured.ask()}")
        other = secured.ask(seconds=3, authority=Authority("other"))
        require(other in ("UNAVAILABLE", "DEADLINE_EXCEEDED"), f"a client that trusts another authority: {other}")
        with grpc.insecure_channel(secured.server.address) as line:
            plain = code_of(lambda: stub(line).Solve(cheap(), timeout=3)).name
        require(plain in ("UNAVAILABLE", "DEADLINE_EXCEEDED"), f"plain text: {plain}")
        return {"another authority": other, "plain text": plain}


@check("an expired certificate of the server", "clients refuse it; the server takes a new one without a restart")
def expired_server():
    with Secured("expired_server") as secured:
        cert, key, _ = secured.authority.expired("server")
        replace(secured.key, key)
        replace(secured.cert, cert)
        refused = wait_until(lambda: secured.ask(seconds=2) != "OK", TAKES_S, 0.5)
        renewed = secured.renew()
        require(wait_until(lambda: secured.ask(seconds=2) == "OK", TAKES_S, 0.5), "the renewed certificate is not taken")
        require(secured.shown_serial() == renewed, "an old certificate is shown")
        return {"the expired one was taken": refused}


@check("client certificates", "with one of the authority a client is answered; without, of another authority, or expired not")
def client_certificates():
    with Secured("mutual", mutual=True) as secured:
        good = secured.authority.issue("client")
        answers = {
            "good": secured.ask(client=good),
            "none": secured.ask(seconds=3),
            "of another authority": secured.ask(seconds=3, client=Authority("authority").issue("client")),
            "expired": secured.ask(seconds=3, client=secured.authority.expired("client")),
            "not yet valid": secured.ask(seconds=3, client=secured.authority.issue("client", *[
                (secured.authority.certificate.not_valid_after - secured.authority.certificate.not_valid_before) / 4 * k
                for k in (1, 2)])),
            "good again": secured.ask(client=good),
        }
        require(answers["good"] == answers["good again"] == "OK", f"{answers}")
        require("OK" not in list(answers.values())[1:5], f"{answers}")
        return answers


@check("certificates rotated under load", f"a new one is shown within {TAKES_S} s, and no call and no sweep fails")
def rotation():
    with Secured("rotation", mutual=True) as secured:
        client = secured.authority.issue("client")
        with secured.channel(client=client) as line:
            on = stub(line)
            sweep = iter(on.Sweep(long_sweep(10**10), timeout=120))
            next(sweep)
            took = []
            for _ in range(5 if tools().soak else 2):
                serial = secured.renew()
                start = time.monotonic()
                while secured.shown_serial(client) != serial:
                    require(time.monotonic() - start < TAKES_S, f"the new certificate is not shown after {TAKES_S} s")
                    on.Solve(cheap(), timeout=20)
                    next(sweep)
                took.append(time.monotonic() - start)
            secured.cert.write_text("no certificate", encoding="ascii")
            time.sleep(2)  # The server looks at its files once a second.
            require(secured.ask(client=client) == "OK", "a bad file ended the service")
            on.Solve(cheap(), timeout=20)
            next(sweep)
        return {"slowest s": max(took)}


@check("handshakes that never end", "300 connections that send nothing, half a greeting or noise to a TLS port are closed within 30 s, "
       "and others are served")
def half_open_tls():
    with Secured("half_open", handshake_timeout=HANDSHAKE_S) as secured:
        server = secured.server
        require(secured.ask() == "OK", "no answer")
        before = server.descriptors()
        hello = b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(100)
        connections = []
        for start in (b"", hello, os.urandom(300)):
            for i in range(100):
                connection = socket.create_connection((server.host, server.port), 10, source_address=(f"127.0.1.{i + 1}", 0))
                connection.sendall(start)
                connections.append(connection)
        answered = secured.ask()
        require(answered == "OK", f"another client meanwhile: {answered}")
        require(wait_until(lambda: server.descriptors() <= before + 3, 30),
                f"{server.descriptors() - before} descriptors are held after 30 s")
        for connection in connections:
            connection.close()
        return {}


@check("tokens", "none, a wrong one and one without the scope are refused and told nothing; a rotated file is taken")
def tokens():
    good, other = secrets.token_urlsafe(24), secrets.token_urlsafe(24)

    def line(name, token, scopes):
        return f"{name} sha256:{hashlib.sha256(token.encode()).hexdigest()} {scopes}\n"

    with Secured("tokens", tokens=line("lab", good, "solve") + line("auditor", other, "audit")) as secured:
        answers = {"good": secured.ask(token=good), "none": secured.ask(), "wrong": secured.ask(token="x" * 32),
                   "almost": secured.ask(token=good[:-1] + ("a" if good[-1] != "a" else "b")),
                   "long": secured.ask(token="x" * 6000), "without the scope": secured.ask(token=other)}
        require(answers == {"good": "OK", "none": "UNAUTHENTICATED", "wrong": "UNAUTHENTICATED",
                            "almost": "UNAUTHENTICATED", "long": "UNAUTHENTICATED",
                            "without the scope": "PERMISSION_DENIED"}, f"{answers}")
        texts = set()
        for token in (None, "x" * 32):
            with secured.channel(token=token) as channel:
                try:
                    stub(channel).Solve(cheap(), timeout=10)
                except grpc.RpcError as error:
                    texts.add(error.details())
        require(len(texts) == 1, f"refusals tell more than that they refuse: {texts}")
        log = secured.server.log_text()
        require(good not in log and other not in log and "x" * 32 not in log, "a token is in the log")
        new = secrets.token_urlsafe(24)
        replace(secured.tokens, line("lab", new, "solve").encode())
        require(wait_until(lambda: secured.ask(token=new) == "OK", TAKES_S, 0.5), "the new token is not taken")
        require(secured.ask(token=good) == "UNAUTHENTICATED", "the old token is taken still")
        secured.tokens.write_text("lab sha256:zz everything\n", encoding="ascii")
        time.sleep(2)  # The server looks at its files once a second.
        require(secured.ask(token=new) == "OK", "a bad file ended the service")
        return answers


# Each scope lets its caller do this, as deploy/README.md states it under "Tokens".
SCOPES = {
    "solve": {"Solve", "SolveBatch", "SolveBatches", "Plan", "Bounds", "MultiContact"},
    "sweep": {"Sweep"},
    "audit": {"Audit", "AuditBatch", "Fit"},
    "cost": {"Cost"},
    "info": {"Info", "ServerReflectionInfo"},
}
OPEN = {"Check", "Watch"}  # Health, which probes without a token ask.
REFLECTION = "/grpc.reflection.v1.ServerReflection/ServerReflectionInfo"
REFUSED = {"PERMISSION_DENIED", "UNAUTHENTICATED"}


def methods():
    """The path of every method that a server has, by its name."""
    service = pb().DESCRIPTOR.services_by_name["ImpactService"]
    found = {method.name: f"/{service.full_name}/{method.name}" for method in service.methods}
    return {**found, "Check": "/grpc.health.v1.Health/Check", "ServerReflectionInfo": REFLECTION}


def scopes_of_server():
    """The scopes that the server takes, by its own words."""
    words = re.sub(r"\s+", " ", tools().help)
    return re.search(r"with scopes from ([a-z, ]+);", words).group(1).split(", ")


def ask_method(channel, path):
    """The status of a call with one empty message, which suits every method on the wire."""
    def call():
        for _ in channel.stream_stream(path)(iter([b""]), timeout=20):
            break  # The first answer has been let through.
    return code_of(call).name


@check("every scope and every method", "by token and by certificate a caller may call what its scopes name, no more")
def permissions():
    scopes = scopes_of_server()
    require(set(scopes) == {*SCOPES, "all"}, f"the scopes of the server are {scopes}")
    everything = {name for names in SCOPES.values() for name in names}
    require(everything | OPEN == {*methods(), "Watch"}, "the methods of this test are not the server's")
    callers = {scope: [scope] for scope in scopes} | {"two": ["info", "audit"], "nobody": None}
    granted = {name: everything if given == ["all"] else set().union(*(SCOPES[scope] for scope in given or ()))
               for name, given in callers.items()}
    secret = {name: secrets.token_urlsafe(24) for name in callers}
    lines = [f"{name} sha256:{hashlib.sha256(secret[name].encode()).hexdigest()} {','.join(given)}\n"
             f"{name}.test certificate {','.join(given)}\n" for name, given in callers.items() if given]
    calls = 0
    with Secured("permissions", mutual=True, tokens="".join(lines), reflection="127.0.0.1:0") as secured:
        reflection = re.search(r" reflection address=(\S+)", secured.server.log_text()).group(1)
        stranger = secured.authority.issue("stranger.test")
        for name in callers:
            own = secured.authority.issue(f"{name}.test")
            for how in ({"client": stranger, "token": secret[name]}, {"client": own}):
                with secured.channel(**how) as service, secured.channel(address=reflection, **how) as described:
                    for method, path in methods().items():
                        code = ask_method(described if path == REFLECTION else service, path)
                        may = method in granted[name] | OPEN
                        expected = "UNAUTHENTICATED" if callers[name] is None else "PERMISSION_DENIED"
                        require(code not in REFUSED if may else code == expected,
                                f"{name} by {'token' if 'token' in how else 'certificate'} on {method}: {code}")
                        calls += 1
    return {"calls": calls}


if __name__ == "__main__":
    main()

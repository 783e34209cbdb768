"""Connection: which server is asked and how, from arguments, the environment and a file, as the command line does."""

from __future__ import annotations

import os
import re
import tomllib
from dataclasses import dataclass, fields
from pathlib import Path

import grpc

from ricochet.errors import InvalidRequest, Violation

DEFAULT_DEADLINE_S = 10.0
DEFAULT_MAX_RECEIVE = 64 << 20
_MOST_RECEIVE = 2**31 - 1
_UNITS_S = {"": 1.0, "s": 1.0, "ms": 1e-3, "m": 60.0, "h": 3600.0}

_SERVICE_CONFIG = """{"methodConfig": [{"name": [{"service": "ricochet.v1.ImpactService"}], "retryPolicy": {
  "maxAttempts": 3, "initialBackoff": "0.1s", "maxBackoff": "2s", "backoffMultiplier": 2,
  "retryableStatusCodes": ["UNAVAILABLE"]}}], "retryThrottling": {"maxTokens": 10, "tokenRatio": 0.1}}"""


@dataclass
class Connection:
    """The options of a connection; an empty text is not set.

    Each is also read from the environment, ``RICOCHET_TLS_CA`` for ``tls_ca``, and from the TOML file that ``config``
    or ``RICOCHET_CONFIG`` names, as a line ``tls-ca = "FILE"``. An argument wins over the environment, which wins over
    the file.
    """

    server: str = ""
    """``HOST:PORT`` or ``unix:PATH``; several, with commas between them, stand in for each other. Unset: an own one."""
    deadline: str = ""
    """Time that one call may take: ``"250ms"``, ``"30s"``, ``"5m"``. Unset: 10 s, and no limit for a sweep."""
    max_receive: str = ""
    """Bytes of one message of an answer, in [1, 2147483647]. Unset: 67108864."""
    tls: str = ""
    """``"true"``: encrypt, and make sure of the server. The next four imply it."""
    tls_ca: str = ""
    """PEM file with the authorities that the server's certificate must come from. Unset: the system's."""
    tls_cert: str = ""
    """PEM file with this client's certificate."""
    tls_key: str = ""
    """PEM file with the private key of ``tls_cert``."""
    server_name: str = ""
    """Name that the server's certificate must have, if it is not that of ``server``."""
    token_file: str = ""
    """File that holds the token to send."""
    token: str = ""
    """The token to send."""
    config: str = ""
    """TOML file with these options."""

    @property
    def targets(self) -> list[str]:
        """The servers, in their order."""
        return [target for target in self.server.split(",") if target]

    @property
    def is_tls(self) -> bool:
        return self.tls == "true" or bool(self.tls_ca or self.tls_cert or self.server_name)

    def deadline_s(self) -> float | None:
        """Returns the deadline in seconds; None if it is not set."""
        if not self.deadline:
            return None
        match = re.fullmatch(r"(\d+(?:\.\d+)?)(ms|s|m|h|)", self.deadline)
        seconds = float(match[1]) * _UNITS_S[match[2]] if match else 0.0
        if seconds <= 0:
            raise InvalidRequest.of(
                [Violation("deadline", f"= {self.deadline}: must be a time > 0 such as 250ms or 30s")]
            )
        return seconds

    def max_receive_bytes(self) -> int:
        if not self.max_receive:
            return DEFAULT_MAX_RECEIVE
        if not self.max_receive.isdecimal() or not 1 <= int(self.max_receive) <= _MOST_RECEIVE:
            raise InvalidRequest.of(
                [Violation("max_receive", f"= {self.max_receive}: must be in [1, {_MOST_RECEIVE}]")]
            )
        return int(self.max_receive)


def resolve(given: Connection) -> Connection:
    """Returns the options with what the environment and the file add to those that are given."""
    config = given.config or os.environ.get("RICOCHET_CONFIG", "")
    lines = _read_config(config) if config else {}
    values = {}
    for field in fields(Connection):
        environment = os.environ.get(f"RICOCHET_{field.name.upper()}", "")
        values[field.name] = getattr(given, field.name) or environment or lines.get(field.name, "")
    connection = Connection(**values)
    _check(connection)
    return connection


def _read_config(path: str) -> dict[str, str]:
    try:
        lines = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise InvalidRequest.of([Violation("config", f"= {path}: {error}")]) from None
    known = {field.name.replace("_", "-") for field in fields(Connection)} - {"config"}
    wrong = [
        Violation("config", f"= {path}: {name} must be one of {', '.join(sorted(known))}")
        for name in lines
        if name not in known
    ]
    if wrong:
        raise InvalidRequest.of(wrong)
    return {
        name.replace("-", "_"): str(value).lower() if isinstance(value, bool) else str(value)
        for name, value in lines.items()
    }


def _check(options: Connection) -> None:
    wrong = []
    if options.tls not in ("", "true", "false"):
        wrong.append(Violation("tls", f"= {options.tls}: must be true or false"))
    if bool(options.tls_cert) != bool(options.tls_key):
        missing = "tls_cert" if options.tls_key else "tls_key"
        wrong.append(Violation(missing, "is not set: must be if the other one of tls_cert and tls_key is"))
    if options.token and options.token_file:
        wrong.append(Violation("token", "is set: must not be if token_file is"))
    if options.token and not re.fullmatch(r"[!-~]+", options.token):
        wrong.append(Violation("token", "must have visible ASCII characters only"))
    has_token = bool(options.token or options.token_file)
    if has_token and not options.is_tls and not all(map(_is_local, options.targets)):
        name = "token" if options.token else "token_file"
        wrong.append(Violation(name, "is set: needs tls unless the server is a Unix socket or a loopback address"))
    if wrong:
        raise InvalidRequest.of(wrong)


def _is_local(target: str) -> bool:
    return (
        re.match(r"unix(-abstract)?:|(dns:(///)?|ipv[46]:)?(127\.[\d.]+|localhost|\[::1\])(:\d+)?$", target) is not None
    )


def open_channel(target: str, options: Connection) -> grpc.Channel:
    """Returns a channel to one server. Raises OSError for a file that cannot be read."""
    arguments: list[tuple[str, str | int]] = [
        ("grpc.max_receive_message_length", options.max_receive_bytes()),
        ("grpc.max_send_message_length", -1),
        ("grpc.service_config", _SERVICE_CONFIG),
    ]
    if not options.is_tls:
        return grpc.insecure_channel(target, options=arguments)
    if options.server_name:
        arguments.append(("grpc.ssl_target_name_override", options.server_name))
    credentials = grpc.ssl_channel_credentials(
        root_certificates=_read(options.tls_ca),
        private_key=_read(options.tls_key),
        certificate_chain=_read(options.tls_cert),
    )
    return grpc.secure_channel(target, credentials, options=arguments)


def _read(path: str) -> bytes | None:
    return Path(path).read_bytes() if path else None


def metadata(options: Connection) -> list[tuple[str, str]]:
    """Returns the headers of a call: the token, which a file may have renewed."""
    token = options.token
    if options.token_file:
        token = Path(options.token_file).read_text(encoding="ascii").strip()
    return [("authorization", f"Bearer {token}")] if token else []

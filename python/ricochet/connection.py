"""Connection: which server is asked and how, from arguments, the environment and a file, as the command line does."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, fields
from typing import Any

from ricochet.errors import InvalidRequest, Violation
from ricochet.values import refuse

_DEFAULT_MAX_RECEIVE = 64 << 20
_UNITS_S = {"": 1.0, "s": 1.0, "ms": 1e-3, "m": 60.0, "h": 3600.0}


@dataclass
class Connection:
    """The options of a Client, which describes them; an empty text is not set.

    Each is also read from the environment, ``RICOCHET_TLS_CA`` for ``tls_ca``, and from the TOML file that ``config``
    or ``RICOCHET_CONFIG`` names, as a line ``tls-ca = "FILE"``. An argument wins over the environment, which wins over
    the file.
    """

    server: str = ""
    deadline: str = ""
    max_receive: str = ""
    tls: str = ""
    tls_ca: str = ""
    tls_cert: str = ""
    tls_key: str = ""
    server_name: str = ""
    token_file: str = ""
    token: str = ""
    config: str = ""

    def deadline_s(self) -> float | None:
        """Returns the deadline in seconds; None if it is not set."""
        if not self.deadline:
            return None
        match = re.fullmatch(r"(\d+(?:\.\d+)?)(ms|s|m|h|)", self.deadline)
        seconds = float(match[1]) * _UNITS_S[match[2]] if match else 0.0
        return seconds if seconds > 0 else refuse("deadline", f"= {self.deadline}: must be a time > 0 such as 250ms or 30s")

    def options(self) -> dict[str, Any]:
        """Returns the options as the module in C++ takes them."""
        if self.max_receive and not re.fullmatch(r"\d{1,18}", self.max_receive):
            refuse("max_receive", f"= {self.max_receive}: must be a whole number of bytes")
        if self.tls not in ("", "true", "false"):
            refuse("tls", f"= {self.tls}: must be true or false")
        return {
            **vars(self),
            "deadline": self.deadline_s(),
            "max_receive": int(self.max_receive or _DEFAULT_MAX_RECEIVE),
            "tls": self.tls == "true" or bool(self.tls_ca or self.tls_cert or self.server_name),
        }


def resolve(given: Connection) -> Connection:
    """Returns the options with what the environment and the file add to those that are given."""
    config = given.config or os.environ.get("RICOCHET_CONFIG", "")
    lines = _read_config(config) if config else {}
    values = {}
    for field in fields(Connection):
        environment = os.environ.get(f"RICOCHET_{field.name.upper()}", "")
        values[field.name] = getattr(given, field.name) or environment or lines.get(field.name, "")
    return Connection(**values)


def _read_config(path: str) -> dict[str, str]:
    import tomllib  # Few callers have such a file.

    try:
        with open(path, "rb") as file:
            lines = tomllib.load(file)
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

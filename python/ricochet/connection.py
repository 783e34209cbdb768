"""Connection: which server is asked and how, from arguments, the environment and a file, as the command line does."""

from __future__ import annotations

import os
import re
from typing import Any, Mapping

from ricochet.errors import InvalidRequest, Violation
from ricochet.values import refuse, shown

# The options of a Client, which describes them.
_NAMES = "server deadline max_receive tls tls_ca tls_cert tls_key server_name token_file token".split()
_DEFAULT_MAX_RECEIVE = "67108864"
_UNITS_S = {"": 1.0, "s": 1.0, "ms": 1e-3, "m": 60.0, "h": 3600.0}
_YEAR_S = 365.0 * 24 * 3600
_EMPTY = "is empty: must have a value, or not be set"


def resolve(given: Mapping[str, str | None]) -> dict[str, Any]:
    """Returns the options as the module in C++ takes them; an argument that is an empty text is not set.

    An argument wins over the environment, ``RICOCHET_TLS_CA`` for ``tls_ca``, which wins over a line ``tls-ca =
    "FILE"`` of the TOML file that ``config`` or ``RICOCHET_CONFIG`` names.
    """
    for name, value in given.items():
        if not isinstance(value, str) and not (name == "server" and value is None):
            refuse(name, f"= {shown(value)}: must be a text")
    for variable in (f"RICOCHET_{name.upper()}" for name in ("config", *_NAMES)):
        if os.environ.get(variable) == "":  # It may stand for a protection that is wanted.
            refuse(variable, _EMPTY)
    config = given.get("config") or os.environ.get("RICOCHET_CONFIG")
    lines = _read_config(config) if config else {}
    options: dict[str, Any] = {
        name: given.get(name) or os.environ.get(f"RICOCHET_{name.upper()}") or lines.get(name, "") for name in _NAMES
    }
    if given.get("server", "") is None:  # The engine in this process is asked for.
        options["server"] = ""
    max_receive = options["max_receive"] or _DEFAULT_MAX_RECEIVE
    if not re.fullmatch(r"\d{1,18}", max_receive):
        refuse("max_receive", f"= {max_receive}: must be a whole number of bytes")
    if options["tls"] not in ("", "true", "false"):
        refuse("tls", f"= {options['tls']}: must be true or false")
    options["max_receive"] = int(max_receive)
    options["deadline"] = _seconds(options["deadline"]) if options["deadline"] else None
    options["tls"] = options["tls"] == "true" or any(options[name] for name in ("tls_ca", "tls_cert", "server_name"))
    return options


def _seconds(text: str) -> float:
    match = re.fullmatch(r"(\d+(?:\.\d+)?(?:e[+-]?\d+)?)(ms|s|m|h|)", text)
    seconds = float(match[1]) * _UNITS_S[match[2]] if match else 0.0
    if not 1e-3 <= seconds <= _YEAR_S:
        refuse("deadline", f"= {text}: must be a time from 1ms to a year, such as 250ms or 30s")
    return seconds


def _read_config(path: str) -> dict[str, str]:
    import tomllib  # Few callers have such a file.

    try:
        with open(path, "rb") as file:
            lines = tomllib.load(file)
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise InvalidRequest.of([Violation("config", f"= {path}: {error}")]) from None
    known = sorted(name.replace("_", "-") for name in _NAMES)
    unknown = [name for name in lines if name not in known]
    if unknown:
        rule = f"must be one of {', '.join(known)}"
        raise InvalidRequest.of([Violation("config", f"= {path}: {name} {rule}") for name in unknown])
    empty = [name for name, value in lines.items() if value == ""]
    if empty:
        raise InvalidRequest.of([Violation("config", f"= {path}: {name} {_EMPTY}") for name in empty])
    return {
        name.replace("-", "_"): str(value).lower() if isinstance(value, bool) else str(value)
        for name, value in lines.items()
    }

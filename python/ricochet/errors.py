"""Errors: what a call can fail with, as exceptions that name every wrong field."""

from __future__ import annotations

import contextlib
import re
from dataclasses import dataclass
from typing import Iterable, Iterator, Sequence


@dataclass(frozen=True)
class Violation:
    """A rule that a request breaks."""

    field: str
    """The path of the field, such as ``"scene.friction.kinetic_coefficient"``."""
    description: str
    """The value found, and the rule."""

    def __str__(self) -> str:
        return f"{self.field} {self.description}"


class RicochetError(Exception):
    """A call failed.

    Attributes:
        code: the gRPC code by name, such as ``"UNAVAILABLE"``.
        reason: the name of ``ricochet.v1.ErrorReason`` without its prefix, such as ``"DRAINING"``; empty if unknown.
        violations: the rules that the request breaks; empty for other errors.
        retry_after_s: time after which the server asks to try again, s; None if it does not.
    """

    def __init__(
        self,
        message: str,
        *,
        code: str = "UNKNOWN",
        reason: str = "",
        violations: Iterable[Violation] = (),
        retry_after_s: float | None = None,
    ) -> None:
        super().__init__(message)
        self.code = code
        self.reason = reason
        self.violations = tuple(violations)
        self.retry_after_s = retry_after_s


class InvalidRequest(RicochetError, ValueError):
    """The request breaks rules; ``violations`` lists all of them."""

    @classmethod
    def of(cls, violations: Iterable[Violation]) -> "InvalidRequest":
        """Makes the error for rules that this package has checked itself."""
        found = list(violations)
        text = "; ".join(map(str, found))
        return cls(text, code="INVALID_ARGUMENT", reason="INVALID_REQUEST", violations=found)


class Inadmissible(RicochetError):
    """The outcome would create energy, and the call was strict."""


class OutOfRange(RicochetError, OverflowError):
    """An exact result lies above the largest double."""


class LimitReached(RicochetError):
    """The request is larger, or the server busier, than a limit allows."""


class NotAllowed(RicochetError, PermissionError):
    """The server does not know the caller, or the caller may not call this method."""


class Unavailable(RicochetError, ConnectionError):
    """No server answers, or it is about to stop."""


class TimedOut(RicochetError, TimeoutError):
    """The call took longer than its deadline, or than the server allows."""


@contextlib.contextmanager
def naming(**names: Sequence[str]) -> Iterator[None]:
    """Names what the request calls otherwise than the caller: an entry of a list by its path, ``unknowns[0].low`` as
    ``pendulum.a_m.low``; and a list alone by the argument, ``rates.values`` as ``rates_after``."""
    def path(found: re.Match[str]) -> str:
        name = names.get(found[1], found[0])
        return name if isinstance(name, str) else name[int(found[2])]

    try:
        yield
    except InvalidRequest as error:
        raise InvalidRequest.of(
            Violation(re.sub(r"^(\w+)(?:\[(\d+)\](?=\.(?!path$))|\.values)", path, violation.field),
                      violation.description)
            for violation in error.violations
        ) from None


_CLASSES: dict[str, type[RicochetError]] = {
    "INVALID_ARGUMENT": InvalidRequest,
    "OUT_OF_RANGE": OutOfRange,
    "RESOURCE_EXHAUSTED": LimitReached,
    "UNAUTHENTICATED": NotAllowed,
    "PERMISSION_DENIED": NotAllowed,
    "UNAVAILABLE": Unavailable,
    "DEADLINE_EXCEEDED": TimedOut,
}


def from_status(
    code: str, message: str, reason: str, violations: list[Violation], retry_after_s: float | None
) -> RicochetError:
    """Makes the exception for a call that failed."""
    kind = _CLASSES.get(code, RicochetError)
    if reason == "INADMISSIBLE_OUTCOME":
        kind = Inadmissible
    return kind(message or code, code=code, reason=reason, violations=violations, retry_after_s=retry_after_s)

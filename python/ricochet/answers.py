"""Answers: what lies in the bytes and lists of a message, which must be as much as was asked for."""

from __future__ import annotations

from typing import Sequence, TypeVar

import numpy as np
from numpy.typing import NDArray

from ricochet.errors import RicochetError

_Entry = TypeVar("_Entry")


def _check(found: int, wanted: int, what: str) -> None:
    if found != wanted:
        raise RicochetError(f"the answer of the server has {found} {what}: must have {wanted}", code="DATA_LOSS")


def entries(found: Sequence[_Entry], count: int, what: str) -> Sequence[_Entry]:
    """Returns the list if it has so many entries: an answer that is not whole is never spread over what was asked."""
    _check(len(found), count, what)
    return found


def numbers(data: bytes, count: int, what: str) -> NDArray[np.float64]:
    """Returns the doubles that the bytes hold, if they are so many."""
    _check(len(data), 8 * count, f"bytes of {what}")
    return np.frombuffer(data, "<f8")


def codes(data: bytes, count: int, what: str) -> NDArray[np.uint8]:
    """Returns the codes, one in each byte, if they are so many."""
    _check(len(data), count, what)
    return np.frombuffer(data, np.uint8)


def at_least_one(number: int, what: str) -> int:
    """Returns a limit, which allows something at least."""
    if number < 1:
        raise RicochetError(f"the server's {what} is {number}: must be at least 1", code="DATA_LOSS")
    return number

"""Axes: the values that a sweep gives to one field."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ricochet.errors import InvalidRequest, Violation
from ricochet.messages import to_message as fill_message
from ricochet.v1 import sweep_pb2
from ricochet.values import column, shown


@dataclass(frozen=True)
class Linspace:
    """``count`` evenly spaced values from ``start`` to ``stop``, both exact. The server makes them."""

    start: float
    stop: float
    count: int

    def values(self) -> NDArray[np.float64]:
        """Returns the values: the doubles that the server computes with."""
        a, b = float(self.start), float(self.stop)
        t = np.arange(self.count) / max(self.count - 1, 1)
        if min(a, b) <= 0 <= max(a, b):
            return t * b + (1 - t) * a
        x = a + t * (b - a)
        x = np.maximum(x, b) if b < a else np.minimum(x, b)
        return np.where(t == 1, b, x)


@dataclass(frozen=True)
class Logspace:
    """``count`` values from ``start`` to ``stop``, both > 0 and exact, that are evenly spaced in their logarithm. The
    server makes them."""

    start: float
    stop: float
    count: int

    def values(self) -> NDArray[np.float64]:
        """Returns the values; they may differ from those of the server in their last digit."""
        values: NDArray[np.float64] = np.geomspace(self.start, self.stop, self.count)
        return values


Axis = Union[Linspace, Logspace, ArrayLike]
"""The values of an axis: a Linspace or a Logspace of any size, or an array of at most 65,536 numbers."""


def coordinates(path: str, axis: Axis) -> NDArray[np.float64]:
    """Returns the values of an axis. Raises InvalidRequest, which names `path`, for what is no number."""
    if isinstance(axis, (Linspace, Logspace)):
        return axis.values()
    values = np.atleast_1d(column(axis, path))
    if values.ndim != 1:
        raise InvalidRequest.of([Violation(path, f"= {shown(axis)}: must be one number or a list of numbers")])
    return values


def length(path: str, axis: Axis) -> int:
    """Returns the number of values of an axis. Raises InvalidRequest as `coordinates` does."""
    return axis.count if isinstance(axis, (Linspace, Logspace)) else len(coordinates(path, axis))


def to_message(path: str, axis: Axis) -> Any:
    """Returns the axis as ricochet.v1.Axis."""
    message = sweep_pb2.Axis(path=path)
    if isinstance(axis, (Linspace, Logspace)):
        fill_message(message.linspace if isinstance(axis, Linspace) else message.logspace, vars(axis), path)
    else:
        message.list.values.extend(coordinates(path, axis))
    return message

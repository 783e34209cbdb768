"""Axes: the values that a sweep gives to one field."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from ricochet import _core
from ricochet.values import column, number, refuse, scalar, shown

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class Linspace:
    """``count`` evenly spaced values from ``start`` to ``stop``, both exact. The engine makes them."""

    start: float
    stop: float
    count: int

    def values(self) -> NDArray[np.float64]:
        """Returns the values: the doubles that a sweep computes with."""
        return _core.linspace(*_checked(self))


@dataclass(frozen=True)
class Logspace:
    """``count`` values from ``start`` to ``stop``, both > 0 and exact, that are evenly spaced in their logarithm. The
    engine makes them."""

    start: float
    stop: float
    count: int

    def values(self) -> NDArray[np.float64]:
        """Returns the values: the doubles that a sweep computes with."""
        return _core.logspace(*_checked(self))


Axis = Union[Linspace, Logspace, "ArrayLike"]
"""The values of an axis: a Linspace or a Logspace of any size, or an array of at most 65,536 numbers."""


def _checked(axis: Linspace | Logspace) -> tuple[float, float, int]:
    """Returns the ends and the count of an axis. Raises InvalidRequest where a sweep would."""
    start, stop = number(axis.start, "start"), number(axis.stop, "stop")
    least, rule = (0.0, "finite and > 0") if isinstance(axis, Logspace) else (-math.inf, "finite")
    for name, end in (("start", start), ("stop", stop)):
        if not least < end < math.inf:
            refuse(name, f"= {shown(getattr(axis, name))}: must be {rule}")
    count = int(scalar("int64", axis.count, "count"))
    if not 1 <= count <= 2**53:
        refuse("count", f"= {count}: must be in [1, 2^53]")
    return start, stop, count


def to_fields(path: str, axis: Axis) -> dict[str, Any]:
    """Returns the fields of ricochet.v1.Axis. Raises InvalidRequest, which names `path`, for what is no number."""
    if isinstance(axis, (Linspace, Logspace)):
        ends = {name: number(getattr(axis, name), f"{path}.{name}") for name in ("start", "stop")}
        values = {**ends, "count": scalar("int64", axis.count, f"{path}.count")}
        return {"path": path, type(axis).__name__.lower(): values}
    listed = np.atleast_1d(column(axis, path))
    if listed.ndim != 1:
        refuse(path, f"= {shown(axis)}: must be one number or a list of numbers")
    return {"path": path, "list": {"values": listed}}

"""Axes: the values that a sweep gives to one field."""

from __future__ import annotations

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
        return _core.linspace(**_numbers(self))


@dataclass(frozen=True)
class Logspace:
    """``count`` values from ``start`` to ``stop``, both > 0 and exact, that are evenly spaced in their logarithm. The
    engine makes them."""

    start: float
    stop: float
    count: int

    def values(self) -> NDArray[np.float64]:
        """Returns the values: the doubles that a sweep computes with."""
        return _core.logspace(**_numbers(self))


Axis = Union[Linspace, Logspace, "ArrayLike"]
"""The values of an axis: a Linspace or a Logspace of any size, or an array of at most 65,536 numbers."""


def _numbers(axis: Linspace | Logspace, prefix: str = "") -> dict[str, Any]:
    """Returns the ends and the count of an axis. Raises InvalidRequest for what is no number; the engine checks more.
    """
    ends = {name: number(getattr(axis, name), prefix + name) for name in ("start", "stop")}
    return {**ends, "count": scalar("int64", axis.count, prefix + "count")}


def to_fields(path: str, axis: Axis) -> dict[str, Any]:
    """Returns the fields of ricochet.v1.Axis. Raises InvalidRequest, which names `path`, for what is no number."""
    if isinstance(axis, (Linspace, Logspace)):
        return {"path": path, type(axis).__name__.lower(): _numbers(axis, f"{path}.")}
    listed = np.atleast_1d(column(axis, path))
    if listed.ndim != 1:
        refuse(path, f"= {shown(axis)}: must be one number or a list of numbers")
    return {"path": path, "list": {"values": listed}}

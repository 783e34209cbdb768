"""Ricochet: what happens when something hits a surface with friction. Units are SI and radians.

>>> import ricochet
>>> scene = {
...     "pendulum": {"inertia_kg_m2": 1, "a_m": 0.3, "b_m": 1, "omega_minus_rad_s": -1},
...     "friction": {"kinetic_coefficient": 0.1},
...     "restitution": {"energetic": 1},
... }
>>> outcome = ricochet.solve(scene)
>>> outcome.regime, round(outcome.coefficients.newton, 6)
('REBOUND', 0.707107)

The functions of this module ask the server that the environment names (``RICOCHET_SERVER``) or start a ``ricochetd`` of
their own; a ``Client`` does so with options of its own.
"""

from __future__ import annotations

import atexit
import os
import threading
from typing import TYPE_CHECKING, Any, Iterable, Literal, Mapping, Sequence, overload

from numpy.typing import ArrayLike

from ricochet.axes import Axis, Linspace, Logspace
from ricochet.client import Client, Progress, Scene
from ricochet.errors import (
    Inadmissible,
    InvalidRequest,
    LimitReached,
    OutOfRange,
    RicochetError,
    TimedOut,
    Unavailable,
    Violation,
)
from ricochet.messages import Record, read_scene
from ricochet.table import Codes, Table
from ricochet.units import unit_of

if TYPE_CHECKING:
    import pandas
    import xarray

__all__ = [
    "Axis",
    "Client",
    "Codes",
    "Inadmissible",
    "InvalidRequest",
    "LimitReached",
    "Linspace",
    "Logspace",
    "OutOfRange",
    "Record",
    "RicochetError",
    "Scene",
    "Table",
    "TimedOut",
    "Unavailable",
    "Violation",
    "audit",
    "audit_batch",
    "bounds",
    "close",
    "info",
    "read_scene",
    "solve",
    "solve_batch",
    "sweep",
    "unit_of",
]

_lock = threading.Lock()
_client: tuple[int, Client] | None = None


def _default_client() -> Client:
    global _client
    with _lock:
        # A process that was forked must not use the connection of its parent.
        if _client is None or _client[0] != os.getpid():
            _client = (os.getpid(), Client())
        return _client[1]


def close() -> None:
    """Closes the connection of this module's functions, and stops their server; the next call opens another."""
    global _client
    with _lock:
        if _client is not None and _client[0] == os.getpid():
            _client[1].close()
        _client = None


atexit.register(close)


def solve(
    scene: Scene,
    *,
    tolerance: float | None = None,
    require: Iterable[str] = (),
    exclude: Iterable[str] = (),
    strict: bool = False,
    history: int = 0,
    force_history: int = 0,
    certified: int = 0,
) -> Record:
    """Computes one impact. See ``Client.solve``."""
    return _default_client().solve(
        scene,
        tolerance=tolerance,
        require=require,
        exclude=exclude,
        strict=strict,
        history=history,
        force_history=force_history,
        certified=certified,
    )


def bounds(scene: Scene, *, ranges: Mapping[str, tuple[float, float]] | None = None, certified: int = 0) -> Record:
    """Computes the values that the coefficients of an impact can take. See ``Client.bounds``."""
    return _default_client().bounds(scene, ranges=ranges, certified=certified)


def audit(
    scene: Scene,
    *,
    contact_velocity: Mapping[str, Any] | None = None,
    rates_rad_s: ArrayLike | None = None,
    velocity_uncertainty_m_s: float = 0.0,
) -> Record:
    """Computes what an observed impact implies, and which limits it breaks. See ``Client.audit``."""
    return _default_client().audit(
        scene,
        contact_velocity=contact_velocity,
        rates_rad_s=rates_rad_s,
        velocity_uncertainty_m_s=velocity_uncertainty_m_s,
    )


def audit_batch(scene: Scene, columns: Mapping[str, Any]) -> Table:
    """Audits many observed impacts at one contact. See ``Client.audit_batch``."""
    return _default_client().audit_batch(scene, columns)


def solve_batch(
    scene: Scene,
    inputs: Mapping[str, ArrayLike],
    columns: Sequence[str],
    *,
    tolerance: float | None = None,
    require: Iterable[str] = (),
    exclude: Iterable[str] = (),
) -> Table:
    """Computes many different impacts of one system. See ``Client.solve_batch``."""
    return _default_client().solve_batch(scene, inputs, columns, tolerance=tolerance, require=require, exclude=exclude)


@overload
def sweep(
    scene: Scene,
    axes: Mapping[str, Axis],
    columns: Sequence[str],
    *,
    form: Literal["xarray"] = "xarray",
    **options: Any,
) -> "xarray.Dataset":
    ...


@overload
def sweep(
    scene: Scene, axes: Mapping[str, Axis], columns: Sequence[str], *, form: Literal["pandas"], **options: Any
) -> "pandas.DataFrame":
    ...


@overload
def sweep(
    scene: Scene, axes: Mapping[str, Axis], columns: Sequence[str], *, form: Literal["table"], **options: Any
) -> Table:
    ...


def sweep(
    scene: Scene,
    axes: Mapping[str, Axis],
    columns: Sequence[str],
    *,
    form: Literal["xarray", "pandas", "table"] = "xarray",
    **options: Any,
) -> Any:
    """Computes impacts over a grid. See ``Client.sweep`` for the other options.

    Args:
        form: ``"xarray"``: a dataset with a dimension for each axis; ``"pandas"``: a frame with a row for each point;
            ``"table"``: a ``Table`` of numpy arrays. The first two need the package of that name.
    """
    if form not in ("xarray", "pandas", "table"):
        raise InvalidRequest.of([Violation("form", f"= {form!r}: must be 'xarray', 'pandas' or 'table'")])
    table = _default_client().sweep(scene, axes, columns, **options)
    if form == "table":
        return table
    return table.to_xarray() if form == "xarray" else table.to_pandas()


def info() -> Record:
    """Returns which engine answers, what it can compute, and its limits. See ``Client.info``."""
    return _default_client().info()

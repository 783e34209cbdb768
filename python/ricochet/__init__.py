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
from typing import TYPE_CHECKING, Any, Iterable, Literal, Mapping, Sequence, overload

from ricochet.axes import Axis, Linspace, Logspace
from ricochet.client import Client, InvalidRows, ModuleClient, Progress, Scene
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
from ricochet.version import __version__

if TYPE_CHECKING:
    import pandas
    import xarray

__all__ = [
    "Axis",
    "Client",
    "Codes",
    "Inadmissible",
    "InvalidRequest",
    "InvalidRows",
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
    "__version__",
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

_client = ModuleClient()

solve = _client.solve
solve_batch = _client.solve_batch
bounds = _client.bounds
audit = _client.audit
audit_batch = _client.audit_batch
info = _client.info
close = _client.close

atexit.register(close)


@overload
def sweep(
    scene: Scene,
    axes: Mapping[str, Axis],
    columns: str | Sequence[str],
    *,
    form: Literal["xarray"] = "xarray",
    zip_axes: bool = False,
    tolerance: float | None = None,
    require: str | Iterable[str] = (),
    exclude: str | Iterable[str] = (),
    progress: Progress | None = None,
) -> "xarray.Dataset":
    ...


@overload
def sweep(
    scene: Scene,
    axes: Mapping[str, Axis],
    columns: str | Sequence[str],
    *,
    form: Literal["pandas"],
    zip_axes: bool = False,
    tolerance: float | None = None,
    require: str | Iterable[str] = (),
    exclude: str | Iterable[str] = (),
    progress: Progress | None = None,
) -> "pandas.DataFrame":
    ...


@overload
def sweep(
    scene: Scene,
    axes: Mapping[str, Axis],
    columns: str | Sequence[str],
    *,
    form: Literal["table"],
    zip_axes: bool = False,
    tolerance: float | None = None,
    require: str | Iterable[str] = (),
    exclude: str | Iterable[str] = (),
    progress: Progress | None = None,
) -> Table:
    ...


def sweep(
    scene: Scene,
    axes: Mapping[str, Axis],
    columns: str | Sequence[str],
    *,
    form: Literal["xarray", "pandas", "table"] = "xarray",
    zip_axes: bool = False,
    tolerance: float | None = None,
    require: str | Iterable[str] = (),
    exclude: str | Iterable[str] = (),
    progress: Progress | None = None,
) -> Any:
    """Computes impacts over a grid.

    A connection that breaks, or a server that stops, does not end the sweep: it goes on from the first point that
    has not arrived, if another call reaches the same engine.

    Args:
        scene: gives every field that no axis drives.
        axes: the values of each field that varies, by the field's path, ``"friction.kinetic_coefficient"``, or a
            short name, ``"mu"``. An array, or ``ricochet.Linspace`` or ``ricochet.Logspace`` for more than 65,536
            values.
        columns: the numbers of the outcome to compute: ``"coefficients.newton"``, or short names, ``["newton"]``.
            The answer has their full names.
        form: what is returned. ``"xarray"``: a dataset with a dimension for each axis; ``"pandas"``: a frame with a row
            for each point; ``"table"``: a ``Table`` of numpy arrays. The first two need the package of that name.
        zip_axes: the axes advance together; otherwise the points are all combinations of their values.
        tolerance, require, exclude: as in ``solve``, for every point.
        progress: is called with the points done and the points in all, after each part of the answer.

    Returns:
        The numbers of each column, ``regime``, and ``status``, which says whether a point is ``"OK"`` or
        ``"INADMISSIBLE"``; one that breaks a rule is ``"INVALID"`` and has NaN, and a warning ``InvalidRows`` says so;
        one whose outcome leaves a number unset is ``"INCOMPLETE"`` and has NaN there. ``attrs`` has the request and the
        engine, under the names that the files of the command line have.

    Raises:
        InvalidRequest: the scene, an axis or a column is wrong.
        RicochetError: the call failed otherwise.
    """
    if form not in ("xarray", "pandas", "table"):
        raise InvalidRequest.of([Violation("form", f"= {form!r}: must be 'xarray', 'pandas' or 'table'")])
    table = _client.sweep(
        scene,
        axes,
        columns,
        zip_axes=zip_axes,
        tolerance=tolerance,
        require=require,
        exclude=exclude,
        progress=progress,
    )
    if form == "table":
        return table
    return table.to_xarray() if form == "xarray" else table.to_pandas()

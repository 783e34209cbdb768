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

The functions of this module compute in this process, or ask the server that the environment names
(``RICOCHET_SERVER``); a ``Client`` does so with options of its own.
"""

from __future__ import annotations

from ricochet._core import Scene
from ricochet.axes import Axis, Linspace, Logspace
from ricochet.client import Client, InvalidRows, ModuleClient, NoEnd, Progress, SceneLike
from ricochet.errors import (
    Inadmissible,
    InvalidRequest,
    LimitReached,
    NotAllowed,
    OutOfRange,
    RicochetError,
    TimedOut,
    Unavailable,
    Violation,
)
from ricochet.mechanisms import AtContact
from ricochet.record import Record
from ricochet.scenes import read_scene
from ricochet.table import Codes, Table
from ricochet.units import unit_of
from ricochet.version import __version__

__all__ = [
    "AtContact",
    "Axis",
    "Client",
    "Codes",
    "Inadmissible",
    "InvalidRequest",
    "InvalidRows",
    "LimitReached",
    "Linspace",
    "Logspace",
    "NoEnd",
    "NotAllowed",
    "OutOfRange",
    "Progress",
    "Record",
    "RicochetError",
    "Scene",
    "SceneLike",
    "Table",
    "TimedOut",
    "Unavailable",
    "Violation",
    "__version__",
    "at_contact",
    "audit",
    "audit_batch",
    "bounds",
    "close",
    "cost",
    "fit",
    "info",
    "jacobian",
    "multicontact",
    "plan",
    "read_scene",
    "solve",
    "solve_batch",
    "sweep",
    "unit_of",
]

_client = ModuleClient()

solve = _client.solve
solve_batch = _client.solve_batch
jacobian = _client.jacobian
sweep = _client.sweep
bounds = _client.bounds
audit = _client.audit
audit_batch = _client.audit_batch
fit = _client.fit
plan = _client.plan
at_contact = _client.at_contact
multicontact = _client.multicontact
cost = _client.cost
info = _client.info
close = _client.close

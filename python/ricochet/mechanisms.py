"""Mechanisms: states of them as M, J and q', and what an impact makes of these."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ricochet import _core
from ricochet.errors import InvalidRequest, OutOfRange, Violation
from ricochet.record import Record
from ricochet.table import Table
from ricochet.values import column, is_list, refuse, scalar

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ricochet.values import Numbers

CONTACT = _core.Scene({"spatial_contact": {"w_per_kg": [0.0] * 6, "tangential_m_s": [0.0] * 2}})
_FIELDS = [f"spatial_contact.{name}" for name in (
    *(f"w_per_kg[{i}]" for i in range(6)), "tangential_m_s[0]", "tangential_m_s[1]", "normal_m_s")]
_IMPULSE = ["impulse.tangential_n_s[0]", "impulse.tangential_n_s[1]", "impulse.normal_total_n_s"]
COLUMNS = [*_IMPULSE, *(f"contact_velocity_after.{name}" for name in (
    "tangential_m_s[0]", "tangential_m_s[1]", "normal_m_s")), "energy_change_j", "accuracy.relative_error"]


class AtContact(NamedTuple):
    """The answer of ``at_contact``; for a batch the arrays have a leading axis of states."""

    rates_after: "Numbers"
    """The generalised velocities after the impact."""
    impulse_n_s: "Numbers"
    """The impulse on the mechanism in world axes, N s."""
    answer: Any
    """The outcome of a single state, or the table of a batch."""


_NO_DIRECTION = Violation("normal", "has no direction: must be finite and not 0")
# The entries of M across the diagonal may differ by so much of the diagonal: products of matrices round so.
_ROUNDING = 1e-12
_ROUNDING_OF_FLOAT32 = 1e-5


def _has_direction(normal: Numbers) -> bool:
    return bool(0 < np.abs(normal).max() < np.inf)


def _without_rounding(mass: Numbers, rounding: float) -> Numbers:
    """Returns (M + M^T)/2 where M is symmetric but for rounding; other matrices stay as they are, to be refused."""
    across = np.swapaxes(mass, -1, -2)
    if np.array_equal(mass, across):
        return mass
    roots = np.sqrt(np.abs(np.diagonal(mass, axis1=-2, axis2=-1)))
    with np.errstate(invalid="ignore"):  # Infinite entries are refused as they are.
        mean = 0.5 * mass + 0.5 * across  # The sum itself may overflow.
        is_rounding = np.abs(mass - across) <= rounding * roots[..., :, None] * roots[..., None, :]
    every: Numbers = np.where(is_rounding.all(axis=(-2, -1), keepdims=True), mean, mass)
    return every


class States:
    """States of a mechanism, with the contact of each: n along the normal, t1 along the slip."""

    def __init__(self, M: ArrayLike, J: ArrayLike, qdot: ArrayLike, normal: ArrayLike, held: Any) -> None:
        given = {name: column(value, name) for name, value in
                 (("M", M), ("J", J), ("qdot", qdot), ("normal", normal))}
        sizes = [given[name].shape[-1] if given[name].ndim else 0 for name in ("M", "J", "qdot")]
        n = max(sizes, key=sizes.count)  # The size that most arrays state, so that the one that differs is named.
        shapes = {"M": (n, n), "J": (3, n), "qdot": (n,), "normal": (3,)}
        lead = {array.shape[:-len(shapes[name])] for name, array in given.items()} - {()}
        several = lead - {(1,)}
        wrong = [
            Violation(name, f"has shape {array.shape}: must be {shapes[name]}, or that after one axis of states")
            for name, array in given.items()
            if array.shape[-len(shapes[name]):] != shapes[name] or array.ndim > len(shapes[name]) + 1
        ]
        if not wrong and len(several) > 1:
            found = ", ".join(f"{name} {array.shape}" for name, array in given.items())
            wrong.append(Violation("M", f"and the others have shapes {found}: must have as many states, or one"))
        self.is_batch = bool(lead)
        if not wrong and not self.is_batch and not _has_direction(given["normal"]):
            wrong.append(_NO_DIRECTION)
        listed = list(held) if is_list(held) else [held]
        if any(isinstance(entry, (bool, np.bool_)) for entry in listed):
            rule = "has truth values: must have the numbers of coordinates, from 0; np.flatnonzero makes them of a mask"
            refuse("held", rule)
        self.held = [int(scalar("int32", entry, f"held[{i}]")) for i, entry in enumerate(listed)]
        wrong += [Violation(f"held[{i}]", f"= {entry}: must be in [0, {n})")
                  for i, entry in enumerate(self.held) if not 0 <= entry < n]
        wrong += [Violation(f"held[{i}]", f"= {entry}: must be named once")
                  for i, entry in enumerate(self.held) if entry in self.held[:i]]
        if wrong:
            raise InvalidRequest.of(wrong)
        entry: Any = M
        while isinstance(entry, (list, tuple)) and entry:
            entry = entry[0]
        is_float32 = str(getattr(entry, "dtype", "")).endswith("float32")
        given["M"] = _without_rounding(given["M"], _ROUNDING_OF_FLOAT32 if is_float32 else _ROUNDING)
        count = several.pop() if several else (1,)
        self.count = count[0]
        arrays = {name: np.ascontiguousarray(np.broadcast_to(array, count + shapes[name]))
                  for name, array in given.items()}
        self._mass, jacobian, self._rates, self._normals = arrays.values()
        contacts, self._axes, self._turned, self._response = _core.reduce_states(
            self._mass, jacobian, self._rates, self._normals, self.held)
        self.columns: dict[str, ArrayLike] = dict(zip(_FIELDS, contacts))

    def scene(self, state: int) -> dict[str, Any]:
        """Returns the system of one state."""
        return {"mechanism": {
            "mass_matrix": self._mass[state], "jacobian": self._turned[state],
            "rates": self._rates[state], "kept_coordinates": self.held}}

    def in_world(self, outcome: Record) -> Numbers:
        """Returns the impulse of a single state in world axes."""
        impulse: Numbers = np.array([*outcome.impulse.tangential_n_s, outcome.impulse.normal_total_n_s]) @ self._axes[0]
        return impulse

    def after(self, table: Table) -> tuple[Numbers, Numbers]:
        """Returns the rates after the impacts of a batch, and their impulses in world axes."""
        impulses = np.stack([table.columns[name] for name in _IMPULSE], axis=-1)
        rates = self._rates + np.einsum("bij,bj->bi", self._response, impulses)
        return rates, np.einsum("bj,bji->bi", impulses, self._axes)

    def explain(self, bad: Record) -> None:
        """Names the rule that a state of a batch breaks by its own field, and not by the contact it has no part of."""
        state = min(bad.row, len(self._mass) - 1)  # One state may be struck in several ways.
        if not _has_direction(self._normals[state]):
            bad.update(field=_NO_DIRECTION.field, description=_NO_DIRECTION.description)
            return
        try:
            _core.in_process(None).solve(
                {**self.scene(state), "restitution": {"newton": 0.0}},
                None, (), (), False, 0, 0, 0, False, None)
        except InvalidRequest as error:
            bad.update(field=error.violations[0].field, description=error.violations[0].description)
        except OutOfRange as error:
            bad.update(field="mechanism", description=f"is out of range: {error}")

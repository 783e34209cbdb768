"""Contact matrix: W = J M^-1 J^T as an array, which is how a robot's model gives it, in place of its single entries."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Mapping, Sequence

import numpy as np

from ricochet.errors import InvalidRequest, Violation
from ricochet.values import column, is_list

if TYPE_CHECKING:
    from ricochet.values import Numbers

# What a matrix may differ from its transpose by rounding, as a part of sqrt(W_ii W_jj), which bounds its entries.
_ROUNDING = 1e-9

_NAME = "w_per_kg"
_PLANAR = ("w_tt_per_kg", "w_tn_per_kg", "w_nn_per_kg")


def unpacked(contact: str, values: Mapping[str, Any], path: str) -> tuple[Mapping[str, Any], Sequence[Violation]]:
    """Returns the dictionary of a contact with the entries of its message in place of a matrix ``w_per_kg``, and what is
    wrong with that: each entry that its mirror image contradicts.

    The rows of W are those of the contact velocity: t, n in the plane and t1, t2, n in space. What `contact`, a message
    of ricochet.v1, does not take stays as it is.
    """
    size = {"PlanarContact": 2, "SpatialContact": 3}.get(contact)
    if size is None or values.get(_NAME) is None:
        return values, ()
    rest = {name: value for name, value in values.items() if name != _NAME}
    where = f"{path}.{_NAME}"
    try:
        w = column(values[_NAME], where) if is_list(values[_NAME]) else np.empty(())
    except InvalidRequest as error:
        return rest, error.violations
    if size == 3 and w.shape == (6,):
        return values, ()
    if w.shape != (size, size):
        order = ", or its entries 11, 12, 13, 22, 23, 33 in this order" if size == 3 else ""
        return rest, [Violation(where, f"has shape {w.shape}: must be a symmetric {size} x {size} matrix{order}")]
    entries = [float(w[i, j]) for i in range(size) for j in range(i, size)]
    if size == 3:
        return {**rest, _NAME: entries}, _asymmetries(w, where)
    twice = [name for name in _PLANAR if values.get(name) is not None]
    violations = [Violation(f"{path}.{name}", f"is set together with {_NAME}: must not be") for name in twice]
    return {**rest, **dict(zip(_PLANAR, entries))}, violations + _asymmetries(w, where)


def _asymmetries(w: Numbers, path: str) -> list[Violation]:
    return [
        Violation(f"{path}[{i}][{j}]",
                  f"= {float(w[i, j])!r}: must equal [{j}][{i}] = {float(w[j, i])!r}: W is symmetric")
        for i in range(len(w))
        for j in range(i + 1, len(w))
        if abs(w[i, j] - w[j, i]) > _ROUNDING * math.sqrt(abs(w[i, i] * w[j, j]))
    ]

"""Labels: what pandas and xarray call the rows of a column. Rows belong together by them, and are not aligned here."""

from __future__ import annotations

from typing import Any, Iterable

import numpy as np

from ricochet.values import refuse


def _is_labelled(column: Any) -> bool:
    return hasattr(column, "iloc") or hasattr(column, "dims")


def _with_entries(columns: Iterable[Any]) -> Iterable[Any]:
    """Gives columns, and those in a list of columns such as ``rates_after``."""
    for column in columns:
        yield column
        if isinstance(column, (list, tuple)) and any(map(np.ndim, column[:1])):
            yield from column


def common(argument: str, columns: Iterable[Any], rows: int) -> Any:
    """Returns the index that all columns, or matrices, with so many rows have; None if they have none.

    Raises:
        InvalidRequest: two columns have different indices or dimensions.
    """
    found = [one for one in _with_entries(columns)
             if _is_labelled(one) and getattr(one, "ndim", 0) > 0 and len(one) == rows]
    dimensions = {str(one.dims[0]) for one in found if hasattr(one, "dims")}
    if len(dimensions) > 1:
        names = ", ".join(sorted(dimensions))
        refuse(argument, f"has arrays along different dimensions, {names}: must have one for all")
    indices = [one.index if hasattr(one, "iloc") else one.indexes.get(one.dims[0]) for one in found]
    indices = [index for index in indices if index is not None]
    if not all(index.equals(indices[0]) for index in indices):
        refuse(argument, "has columns of different indices: must have one index for all")
    return indices[0] if indices else None

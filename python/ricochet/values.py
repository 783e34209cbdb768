"""Values: the numbers of a caller, from whatever holds them. What is no number is named and never converted."""

from __future__ import annotations

import numbers
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ricochet.errors import InvalidRequest, Violation

Numbers = NDArray[np.float64]

_LONGEST_SHOWN = 60


def shown(value: Any) -> str:
    """Returns a value for a message: on one line, and cut if it is long."""
    if isinstance(value, int) and value.bit_length() > 4 * _LONGEST_SHOWN:
        return f"an integer of {value.bit_length()} bits"
    text = " ".join(repr(value).split())
    return text if len(text) <= _LONGEST_SHOWN else text[: _LONGEST_SHOWN - 3] + "..."


def plain(value: Any) -> Any:
    """Returns the Python object in a numpy scalar or in an array of one element; any other value as it is."""
    return value.item() if isinstance(value, (np.generic, np.ndarray)) and value.size == 1 else value


def number(value: Any, path: str) -> float:
    """Returns a real number as a double. Raises InvalidRequest, which names `path`, for True, "1", 1j and 10**400."""
    found = plain(value)
    is_number = isinstance(found, numbers.Complex) and not isinstance(found, bool)
    rule = "a real number" if is_number else "a number"
    if is_number and isinstance(found, numbers.Real):
        try:
            return float(found)
        except OverflowError:
            rule = f"a number of at most {sys.float_info.max:.4g}"
    raise InvalidRequest.of([Violation(path, f"= {shown(value)}: must be {rule}")])


def is_list(value: Any) -> bool:
    """Returns whether a value is a list: neither a text, nor a dictionary, nor an array without dimensions."""
    return not isinstance(value, (str, bytes, dict)) and hasattr(value, "__iter__") and getattr(value, "ndim", 1) > 0


def is_missing(value: Any) -> bool:
    """Returns whether a value is None or pandas.NA."""
    return value is None or value is getattr(sys.modules.get("pandas"), "NA", None)


def column(values: Any, path: str) -> Numbers:
    """Returns an array of doubles with the shape of `values`; what is missing (None, pandas.NA, masked) is NaN.

    Raises:
        InvalidRequest: names the first entry that is no number.
    """
    if isinstance(values, np.ma.MaskedArray):
        values = values.astype(object).tolist()
    # Of a list numpy would make numbers whatever it holds: of [0.1, True] and of [0.1, "2"].
    is_mixed = not hasattr(values, "dtype") and is_list(values) and not set(map(type, values)) <= {float}
    try:
        array = np.asarray(values, dtype=object if is_mixed else None)
    except ValueError:  # The arrays in a list differ in shape.
        raise InvalidRequest.of([Violation(path, f"= {shown(values)}: must be an array of numbers")]) from None
    if array.dtype.kind in "iuf":
        return array.astype(np.float64)
    entries = [
        np.nan if is_missing(entry) else number(entry, path + "".join(f"[{i}]" for i in place))
        for place, entry in np.ndenumerate(array)
    ]
    return np.array(entries, dtype=np.float64).reshape(array.shape)


def names(values: Any, path: str) -> list[str]:
    """Returns a list of names; a text is one name."""
    found: list[Any] = [values] if isinstance(values, str) else list(values) if is_list(values) else [None]
    if not all(isinstance(name, str) for name in found):
        raise InvalidRequest.of([Violation(path, f"= {shown(values)}: must be a name or a list of names")])
    return [str(name) for name in found]

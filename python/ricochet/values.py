"""Values: the numbers of a caller, from whatever holds them. What is no number is named and never converted.

The module in C++ asks here for every value that is not plainly what it should be, and for the words of its errors.
"""

from __future__ import annotations

import numbers
import sys
from collections.abc import Iterator, ValuesView
from typing import TYPE_CHECKING, Any, Iterable, NoReturn

import numpy as np

from ricochet.errors import InvalidRequest, Violation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.float64]

_LONGEST_SHOWN = 60
_BITS = {"int32": 31, "int64": 63}
_KINDS: dict[str, tuple[Any, str]] = {
    "bool": (bool, "True or False"),
    "text": (str, "a text"),
    "enum": ((), "the name of a value"),
    **{kind: (numbers.Integral, f"a whole number below 2^{bits}") for kind, bits in _BITS.items()},
}


def shown(value: Any) -> str:
    """Returns a value for a message: on one line, and cut if it is long."""
    if isinstance(value, int) and value.bit_length() > 4 * _LONGEST_SHOWN:
        return f"an integer of {value.bit_length()} bits"
    text = " ".join(repr(value).split())
    return text if len(text) <= _LONGEST_SHOWN else text[: _LONGEST_SHOWN - 3] + "..."


def refuse(path: str, description: str) -> NoReturn:
    """Raises InvalidRequest for one field."""
    raise InvalidRequest.of([Violation(path, description)])


def suggestion(name: str, known: Iterable[str]) -> str:
    """Returns the known name that is nearest, or all of them, as the end of a message."""
    import difflib  # Only errors need it.

    names = list(known)
    near = difflib.get_close_matches(name, names, n=1)
    if near:
        return f"; did you mean {near[0]!r}?"
    return f"; there are {', '.join(sorted(names))}"


def unknown_field(path: str, name: Any, known: list[str]) -> NoReturn:
    if name == "contacts" and "planar_contact" in known:
        refuse(path, "is a list of several contacts, which only multicontact and cost take")
    refuse(path, f"is unknown{suggestion(str(name), known)}")


def unknown_name(path: str, name: str, known: list[str]) -> NoReturn:
    refuse(path, f"= {name!r} is unknown{suggestion(name.lower(), known)}")


def dictionary_expected(values: Any, path: str, known: list[str]) -> NoReturn:
    refuse(path, f"= {shown(values)}: must be a dictionary, with {', '.join(known)}")


def plain(value: Any) -> Any:
    """Returns the Python object in a numpy scalar or in an array of one element that is not masked; any other value as
    it is. Times of numpy, which count as whole numbers there, become texts, so that they are refused."""
    if not isinstance(value, (np.generic, np.ndarray)) or value.size != 1 or np.any(getattr(value, "mask", False)):
        return value
    return str(value) if value.dtype.kind in "mM" else value.item()


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
    refuse(path, f"= {shown(value)}: must be {rule}")


def scalar(kind: str, value: Any, path: str) -> Any:
    """Returns a value of a field as Python's own type. True and 1.0 are no whole numbers, and 1 is not True."""
    if kind == "double":
        return number(value, path)
    found = plain(value)
    wanted, rule = _KINDS[kind]
    fits = isinstance(found, wanted) and isinstance(found, bool) == (kind == "bool")
    if fits and kind in _BITS:
        found = int(found)
        fits = -(2 ** _BITS[kind]) <= found < 2 ** _BITS[kind]
    return found if fits else refuse(path, f"= {shown(value)}: must be {rule}")


def is_list(value: Any) -> bool:
    """Returns whether a value is a list: neither a text, nor a dictionary, nor an array without dimensions."""
    return not isinstance(value, (str, bytes, dict)) and hasattr(value, "__iter__") and getattr(value, "ndim", 1) > 0


def entries(value: Any) -> Any:
    """Returns the entries of a list; a value that is none, or a set, which has no order, is the only entry."""
    return value if is_list(value) and not isinstance(value, (set, frozenset)) else [value]


def is_missing(value: Any) -> bool:
    """Returns whether a value is None, pandas.NA or masked."""
    return value is None or value is np.ma.masked or value is getattr(sys.modules.get("pandas"), "NA", None)


def _without_masks(values: Any) -> Any:
    """Returns lists with None for what is masked."""
    if isinstance(values, np.ma.MaskedArray):
        return values.astype(object).tolist()
    return [_without_masks(entry) for entry in values] if isinstance(values, (list, tuple)) else values


def column(values: Any, path: str) -> Numbers:
    """Returns an array of doubles with the shape of `values`; what is missing (None, pandas.NA, masked) is NaN.

    Raises:
        InvalidRequest: names the first entry that is no number.
    """
    # Numpy would take an iterator as one object, and the bytes of a bytearray as numbers.
    if isinstance(values, memoryview):
        values = np.asarray(values)
    elif isinstance(values, bytearray):
        values = bytes(values)
    elif isinstance(values, (Iterator, ValuesView)):
        values = list(values)
    # Numpy would make numbers of a list whatever it holds: of [0.1, True], of [0.1, "2"] and of what is masked.
    is_mixed = isinstance(values, np.ma.MaskedArray) or (
        not hasattr(values, "dtype") and is_list(values) and not set(map(type, values)) <= {float})
    if is_mixed:
        values = _without_masks(values)
    try:
        array = np.asarray(values, dtype=object if is_mixed else None)
    except ValueError:  # The arrays in a list differ in shape.
        raise InvalidRequest.of([Violation(path, f"= {shown(values)}: must be an array of numbers")]) from None
    if array.dtype.kind in "iuf":
        return array.astype(np.float64, copy=False)
    entries = [
        np.nan if is_missing(entry) else number(entry, path + "".join(f"[{i}]" for i in place))
        for place, entry in np.ndenumerate(array)
    ]
    return np.array(entries, dtype=np.float64).reshape(array.shape)


def names(values: Any, path: str) -> list[str]:
    """Returns a list of names; a text is one name."""
    found: list[Any] = [values] if isinstance(values, str) else list(values) if is_list(values) else [None]
    if not all(isinstance(name, str) for name in found):
        refuse(path, f"= {shown(values)}: must be a name or a list of names")
    return [str(name) for name in found]

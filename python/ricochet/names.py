"""Names: the paths of fields and columns in full, from the short names that the command line takes, too.

A short name is the end of a path, with or without its unit: "newton" for "coefficients.newton", "links[1].theta" for
"linkage.links[1].theta_rad", "mu" for "friction.kinetic_coefficient".
"""

from __future__ import annotations

from typing import Any, Collection, Iterable

from ricochet.errors import InvalidRequest, Violation
from ricochet.units import derivative_of, without_unit
from ricochet.values import refuse, suggestion

# Letters of the paper whose field is called otherwise; the command line has the same (a test compares them).
_LETTERS = {
    "mu": "friction.kinetic_coefficient",
    "mu_static": "friction.static_coefficient",
    "omega": "pendulum.omega_minus_rad_s",
}


def meanings(name: str, known: Collection[str]) -> list[str]:
    """Returns the paths that a name can mean."""
    for whole in (name, _LETTERS.get(name, name)):
        if whole in known:
            return [whole]
    derivative = derivative_of(name)
    if derivative:
        pairs = {path: derivative_of(path) for path in known}
        return [path for path, pair in pairs.items() if pair and all(map(meanings, derivative, [[p] for p in pair]))]
    return [path for path in known if _ends_in(path, name) or _ends_in(without_unit(path), name)]


def _ends_in(path: str, name: str) -> bool:
    # Paths under errors. and free_end. end in the names of other numbers, so that the name alone never means them.
    return path == name or (path.endswith(f".{name}") and not path.startswith(("errors.", "free_end.")))


def full_names(given: Iterable[str], known: Collection[str], what: str) -> list[str]:
    """Returns the paths that names mean; a name that means nothing stays as it is, for the server to refuse.

    Raises:
        InvalidRequest: a name means several paths, or is nearly the end of one.
    """
    violations: list[Violation] = []
    full = [_full_name(name, known, what, violations) for name in given]
    if violations:
        raise InvalidRequest.of(violations)
    return full


def full_columns(given: Iterable[str], columns: Collection[str], fields: Collection[str]) -> list[str]:
    """Returns the names of columns in full; the derivative "d(OF)/d(BY)" has a number of the outcome and a field."""
    violations: list[Violation] = []
    full: list[str] = []
    for name in given:
        derivative = derivative_of(name)
        parts = zip(derivative, (columns, fields)) if derivative else [(name, columns)]
        paths = [_full_name(part, known, "columns", violations) for part, known in parts]
        full.append(f"d({paths[0]})/d({paths[1]})" if derivative else paths[0])
    if violations:
        raise InvalidRequest.of(violations)
    return full


def _full_name(name: str, known: Collection[str], what: str, violations: list[Violation]) -> str:
    meant = meanings(name, known)
    if len(meant) == 1:
        return meant[0]
    if meant:
        violations.append(Violation(what, f"= {name!r}: must name one of {', '.join(meant)}"))
    elif "." not in name:
        ends = {without_unit(path).rpartition(".")[2]: path for path in reversed(list(known))}
        near = _nearest(name, ends)
        hint = f"; did you mean {ends[near]}?" if near else ""
        violations.append(Violation(what, f"= {name!r}: must be the path of a number, or its end{hint}"))
    return name


def _nearest(name: str, ends: Collection[str]) -> str | None:
    import difflib  # Only errors need it.

    return next(iter(difflib.get_close_matches(name, ends, n=1)), None)


def by_name_of(values: Any, chosen: list[str], known: Collection[str], what: str, rule: str) -> dict[str, Any]:
    """Returns a dictionary by the full names of its keys, each of which must be one of `chosen`.

    A name that means none of these is one of `known`, for the message.
    """
    means_chosen = hasattr(values, "keys") and all(isinstance(key, str) and meanings(key, chosen) for key in values)
    named = by_full_name(values, chosen if means_chosen else known, what)
    for key, name in zip(values.keys(), named):
        if name not in chosen:
            refuse(what, f"= {key!r}: must be {rule}{suggestion(key, chosen)}")
    return named


def by_full_name(values: Any, known: Collection[str], what: str) -> dict[str, Any]:
    """Returns a dictionary, a pandas frame or an xarray dataset by the full names of its keys. The coordinates of a
    dataset are columns, too, but for those that only label its rows, or all of it."""
    if not hasattr(values, "keys"):
        refuse(what, "must be a dictionary, a pandas frame or an xarray dataset")
    keys = list(values.keys())
    if hasattr(values, "data_vars"):
        keys += [name for name, coordinate in values.coords.items()
                 if meanings(name, known) or (coordinate.ndim and name not in values.indexes)]
    if not all(isinstance(key, str) for key in keys):
        refuse(what, "must have texts for its names")
    full = full_names(keys, known, what)
    twice = [f"= {key!r}: is {name} a second time" for i, (key, name) in enumerate(zip(keys, full)) if name in full[:i]]
    if twice:
        raise InvalidRequest.of([Violation(what, text) for text in twice])
    return {name: values[key] for key, name in zip(keys, full)}

"""Record: an answer, as a dictionary whose entries are attributes, too."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any, Callable, Iterable, Iterator, Literal

import numpy as np

from ricochet import _core, names, values
from ricochet.units import unit_of
from ricochet.values import suggestion

if TYPE_CHECKING:
    from numpy.typing import NDArray

_WIDTH = 110  # A record on one line is at most so wide.
_MOST_ENTRIES = 12  # A list in a record for people shows so many.
_SIDES = {"both": "value", "below": "from_below", "above": "from_above"}


class Record(dict[str, Any]):
    """An answer: a dictionary whose entries can be read as attributes, too.

    The names are those of the proto files, with the unit as their ending. A value is a number, a text, a record or a
    list; an enum is its name without the prefix, such as ``"REBOUND"``; what is not set is None. Printed it is one
    line, in a notebook a table; ``dict(record)`` has everything.
    """

    __slots__ = ("_unread",)

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"no {name!r}{suggestion(name, self)}") from None

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *self]

    def jacobian(
        self, of: str | Iterable[str], by: str | Iterable[str], *, side: Literal["both", "below", "above"] = "both",
    ) -> NDArray[np.float64]:
        """Gives the derivatives of an outcome, or of bounds, that were asked for with ``derivatives``, as an array.

        Args:
            of, by, side: as in ``ricochet.jacobian``.

        Returns:
            An array with a row for each number of ``of`` and a column for each of ``by``, with NaN where there is no
            such derivative; ``derivatives`` says why.

        Raises:
            InvalidRequest: a name means none of the numbers that were asked for, or several.
        """
        check_side(side)
        known = {(each["of"], each["by"]): each[_SIDES[side]] for each in self.get("derivatives") or ()}
        if not known:
            values.refuse("derivatives", 'must be asked for: solve(scene, derivatives={"of": [...], "by": [...]})')
        rows = _asked_for(of, [of for of, _ in known], "of")
        columns = _asked_for(by, [by for _, by in known], "by")
        return np.array([[known[row, column] for column in columns] for row in rows], dtype=np.float64).reshape(
            len(rows), len(columns))

    def __reduce__(self) -> tuple[Any, ...]:
        return Record, (dict(self),)

    def __repr__(self) -> str:
        parts = [f"{path}={_short(value)}" for path, value in leaves(self)]
        most = 0
        width = 0
        while most < len(parts) and width + len(parts[most]) <= _WIDTH:
            width += len(parts[most]) + 2
            most += 1
        left_out = [f"... {len(parts) - most} more"] if most < len(parts) else []
        return f"Record({', '.join(parts[:most] + left_out)})"

    def _repr_html_(self) -> str:
        import html  # Only notebooks need it.

        rows = "".join(
            f"<tr><td style='text-align: left'>{html.escape(path)}</td><td>{html.escape(_short(value))}</td>"
            f"<td style='text-align: left'>{html.escape(unit_of(path)) if isinstance(value, float) else ''}</td></tr>"
            for path, value in leaves(self)
        )
        return f"<table><tr><th>name</th><th>value</th><th>unit</th></tr>{rows}</table>"


class UnreadRecord(Record):
    """An answer whose entries are made when they are first asked for. It becomes a Record once all of them are."""

    __slots__ = ()

    def __getitem__(self, name: str) -> Any:
        return _core.read_entry(self, name)


def check_side(side: str) -> None:
    if side not in _SIDES:
        values.refuse("side", f"= {side!r}: must be one of {', '.join(_SIDES)}")


def _asked_for(given: str | Iterable[str], paths: list[str], what: str) -> list[str]:
    """Returns the paths that names mean among those that were asked for."""
    known = list(dict.fromkeys(paths))
    found = []
    for name in values.names(given, what):
        meant = names.meanings(name, known)
        if len(meant) != 1:
            values.refuse(what, f"= {name!r}: must name one of {', '.join(meant or known)}")
        found += meant
    return found


def _reading(name: str) -> Callable[..., Any]:
    def read(self: Record, *arguments: Any, **options: Any) -> Any:
        _core.read(self)
        return getattr(self, name)(*arguments, **options)

    return read


def _reading_both(operation: Callable[[Any, Any], Any]) -> Callable[..., Any]:
    # If `other` is still unread, the operator calls its method first, because its class is a subclass of Record.
    def read(self: Record, other: Any) -> Any:
        _core.read(self)
        return operation(self, other)

    return read


for _name in (
    "__contains__ __delitem__ __iter__ __len__ __reversed__ __setitem__ __sizeof__ "
    "clear copy get items keys pop popitem setdefault update values"
).split():
    setattr(UnreadRecord, _name, _reading(_name))
for _operation in (operator.eq, operator.ne, operator.or_, operator.ior):
    setattr(UnreadRecord, f"__{_operation.__name__.strip('_')}__", _reading_both(_operation))
setattr(UnreadRecord, "__ror__", _reading_both(lambda self, other: other | self))


def _short(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else repr(value)


def leaves(record: Record, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yields what is set in a record and those below it, by path; of a long list its first entries and its length."""
    for name, value in record.items():
        entries = [(f"{path}{name}", value)]
        if isinstance(value, list):
            entries = [(f"{path}{name}[{i}]", entry) for i, entry in enumerate(value[:_MOST_ENTRIES])]
            if len(value) > _MOST_ENTRIES:
                entries.append((f"len({path}{name})", len(value)))
        for where, entry in entries:
            if isinstance(entry, Record):
                yield from leaves(entry, f"{where}.")
            elif entry is not None:
                yield where, entry

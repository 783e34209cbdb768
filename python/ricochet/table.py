"""Table: columns of numbers, each of which has a name and a unit, and what happened to each row."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Iterable, Iterator, overload

import numpy as np

from ricochet.names import meanings
from ricochet.record import Record
from ricochet.units import unit_of
from ricochet.values import refuse, suggestion

if TYPE_CHECKING:
    import pandas
    import xarray
    from numpy.typing import NDArray

    Numbers = NDArray[np.float64]


def _is_equal(one: Any, other: Any) -> bool:
    """Whether two values are equal, arrays number by number; NaN is equal to NaN."""
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
    if type(one) is dict:
        return one.keys() == other.keys() and all(_is_equal(value, other[name]) for name, value in one.items())
    if isinstance(one, (Codes, Table)):
        return _is_equal(vars(one), vars(other))
    return bool(one.equals(other) if hasattr(one, "equals") else one == other)


@dataclass(frozen=True, eq=False)
class Codes:
    """One name for each row, as numbers into a list of names."""

    numbers: NDArray[np.uint8]
    """One number for each row."""
    names: list[str]
    """The name of each number."""

    def __eq__(self, other: object) -> Any:
        return self.equal(other) if isinstance(other, str) else _is_equal(self, other)

    def __ne__(self, other: object) -> Any:
        return ~self.equal(other) if isinstance(other, str) else not _is_equal(self, other)

    def __len__(self) -> int:
        return len(self.numbers)

    @overload
    def __getitem__(self, row: int) -> str: ...
    @overload
    def __getitem__(self, row: slice | NDArray[Any] | list[int]) -> list[str]: ...
    def __getitem__(self, row: int | slice | NDArray[Any] | list[int]) -> str | list[str]:
        numbers = self.numbers[row]
        return [self.names[number] for number in numbers] if np.ndim(numbers) else self.names[int(numbers)]

    def counts(self) -> dict[str, int]:
        """Returns how many rows have each name, for the names that occur."""
        numbers, counts = np.unique(self.numbers, return_counts=True)
        return {self.names[number]: int(count) for number, count in zip(numbers, counts)}

    def equal(self, name: str) -> NDArray[np.bool_]:
        """Returns for each row whether it has this name, as ``codes == name`` does."""
        if name not in self.names:
            refuse("name", f"= {name!r} is unknown{suggestion(name, self.names)}")
        equal: NDArray[np.bool_] = self.numbers == self.names.index(name)
        return equal


@dataclass(frozen=True, eq=False)
class Table:
    """Rows of numbers: the points of a sweep, the impacts of a batch or the observations of an audit."""

    columns: dict[str, Numbers]
    """The numbers by name; NaN in a row without numbers, and where an outcome leaves the number unset.
    ``ricochet.unit_of`` tells the unit of a name."""
    codes: dict[str, Codes]
    """``regime`` and ``status``: names instead of numbers."""
    axes: dict[str, Numbers] = field(default_factory=dict)
    """The values that the fields of the scene had: along each axis of a sweep, or in each row."""
    is_grid: bool = False
    """True if the rows are all combinations of the axes, the last of which runs fastest."""
    summary: Record = field(default_factory=Record)
    """Counts of rows: ``inadmissible``, ``without_end``, ``not_converged``, ``separating``, and by regime for a sweep;
    a batch has ``bad_rows``, too."""
    attrs: dict[str, str] = field(default_factory=dict)
    """A sweep has its request and the engine here, by the names that the NetCDF files of the command line have."""
    index: Any = None
    """The index of the pandas frame or series that the rows are from; None if they are from others."""

    def __eq__(self, other: object) -> bool:
        return _is_equal(self, other)

    def __len__(self) -> int:
        return len(next(iter(self.codes.values())))

    def __getitem__(self, name: str) -> Numbers:
        meant = meanings(name, self.columns)
        return self.columns[meant[0] if len(meant) == 1 else name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and len(meanings(name, self.columns)) == 1

    def keys(self) -> Iterable[str]:
        """Returns the names of the columns."""
        return self.columns.keys()

    def __repr__(self) -> str:
        counts = ", ".join(f"{name} {count}" for codes in self.codes.values() for name, count in codes.counts().items())
        return f"Table({len(self)} rows: {', '.join([*self.axes, *self.columns, *self.codes])}; {counts})"

    def inputs(self) -> dict[str, Numbers]:
        """Returns the values of the axes in each row."""
        if not self.is_grid:
            return dict(self.axes)
        grid = np.meshgrid(*self.axes.values(), indexing="ij")
        return {name: values.reshape(-1) for name, values in zip(self.axes, grid)}

    def inputs_of(self, row: int) -> dict[str, float]:
        """Returns the values of the axes in one row."""
        shape = [len(values) for values in self.axes.values()]
        places = list(map(int, np.unravel_index(row, shape))) if self.is_grid else [row] * len(shape)
        return {name: float(values[place]) for (name, values), place in zip(self.axes.items(), places)}

    def to_xarray(self) -> "xarray.Dataset":
        """Returns a dataset whose variables have the attribute ``units``.

        A grid has a dimension for each axis, other rows have the dimension ``row`` with the inputs as coordinates.
        ``regime`` and ``status`` hold numbers, which the attributes ``flag_values`` and ``flag_meanings`` explain (the
        CF conventions). The rows of a pandas frame have its index as the coordinate ``row``. A derivative is called
        ``"d(OF)|d(BY)"``, as in the files of the command line, because the names in a NetCDF file have no slash.
        """
        import xarray

        def attributes(name: str) -> dict[str, str]:
            unit = unit_of(name)
            return {"units": unit} if unit else {}

        shape = [len(values) for values in self.axes.values()] if self.is_grid else [len(self)]
        dimensions = list(self.axes) if self.is_grid else ["row"]
        coordinates: dict[str, Any] = {
            name: ([name] if self.is_grid else dimensions, values, attributes(name))
            for name, values in self.axes.items()
        }
        variables: dict[str, Any] = {
            name.replace("/", "|"): (dimensions, values.reshape(shape), attributes(name))
            for name, values in self.columns.items()
        }
        for name, codes in self.codes.items():
            flags = {"flag_values": np.arange(len(codes.names), dtype=np.uint8), "flag_meanings": " ".join(codes.names)}
            variables[name] = (dimensions, codes.numbers.reshape(shape), flags)
        if self.index is not None:
            is_plain = self.index.nlevels == 1  # Its name may be that of a column.
            coordinates["row"] = self.index.rename("row") if is_plain else self.index
        return xarray.Dataset(variables, coordinates, self.attrs)

    def to_pandas(self) -> "pandas.DataFrame":
        """Returns a frame with a row for each row: the inputs, the numbers, and the codes as categories.

        It has the index of the frame that the inputs came in. ``frame.attrs["units"]`` maps each name to its unit.
        """
        import pandas

        columns: dict[str, Any] = {**self.inputs(), **self.columns}
        units = {name: unit_of(name) for name in columns}
        for name, codes in self.codes.items():
            columns[name] = pandas.Categorical.from_codes(codes.numbers.astype(np.int8), categories=codes.names)
        frame = pandas.DataFrame(columns, index=self.index)
        frame.attrs.update(self.attrs, units=units)
        return frame

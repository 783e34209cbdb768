"""A program that mypy checks: it sees the types of the package."""

import numpy as np
import ricochet

table: ricochet.Table = ricochet.sweep({}, {"friction.kinetic_coefficient": np.zeros(3)}, [""], form="table")
column: np.ndarray[tuple[int, ...], np.dtype[np.float64]] = table["coefficients.newton"]
ricochet.solve(["not", "a", "scene"])  # type: ignore[arg-type]
ricochet.sweep({}, {}, [], form="netcdf")  # type: ignore[call-overload]

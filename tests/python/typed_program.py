"""A program that mypy checks: it sees the types of the package."""

import numpy as np
import pandas
import ricochet

scene = ricochet.Scene({"pendulum": {"a_m": 0.3}})
table: ricochet.Table = ricochet.sweep(scene, {"friction.kinetic_coefficient": np.zeros(3)}, [""], form="table")
column: np.ndarray[tuple[int, ...], np.dtype[np.float64]] = table["coefficients.newton"]
frame: pandas.DataFrame = ricochet.Client().sweep({}, {"mu": ricochet.Linspace(0, 1, 3)}, "newton", form="pandas")
outcome: ricochet.Record = ricochet.solve(scene, tolerance=1e-9, require="friction")
study: ricochet.Record = ricochet.cost(scene, progress=print)
ricochet.solve(["not", "a", "scene"])  # type: ignore[arg-type]
ricochet.sweep({}, {}, [], form="netcdf")  # type: ignore[call-overload]
ricochet.Scene(3)  # type: ignore[arg-type]

"""Units: the unit of a field or column, which is the ending of its name."""

from __future__ import annotations

import re
from functools import lru_cache

# The numbers of a mechanism in its generalised coordinates, whose units only the caller knows.
_IN_COORDINATES = ("jacobian", "mass_matrix", "momentum_change", "rates", "rates_after")

_UNITS = {
    "stiffness_n_m1_5": "N/m^1.5",
    "stiffness_n_m_p": "N/m^p",
    "stiffness_n_m": "N/m",
    "damping_s_m": "s/m",
    "_kg_m2": "kg m^2",
    "_per_kg": "1/kg",
    "_rad_s": "rad/s",
    "_m_s2": "m/s^2",
    "_m_s": "m/s",
    "_n_s": "N s",
    "moment_n_m": "N m",
    "_rad": "rad",
    "_kg": "kg",
    "_m": "m",
    "_n": "N",
    "_j": "J",
    "_s": "s",
    "power_law.alpha": "1/(m/s)^exponent",
}


def derivative_of(path: str) -> tuple[str, str] | None:
    """Returns OF and BY of the column ``"d(OF)/d(BY)"``, or of ``"d(OF)|d(BY)"``, as it is called in a dataset."""
    match = re.fullmatch(r"d\((.*?)\)[/|]d\((.*)\)", path)
    return (match[1], match[2]) if match else None


def unit_of(path: str) -> str:
    """Returns the unit of a field of a scene or of an answer, such as ``"rad/s"``; ``"1"`` for a pure number.

    It is empty for a number of a mechanism in generalised coordinates, whose units only the caller knows.

    >>> unit_of("pendulum.omega_minus_rad_s"), unit_of("coefficients.newton"), unit_of("rates_after_rad_s[0]")
    ('rad/s', '1', 'rad/s')
    >>> unit_of("d(impulse.normal_total_n_s)/d(planar_body.velocity_n_m_s)")
    '(N s)/(m/s)'
    """
    derivative = derivative_of(path)
    if derivative:
        of, by = map(unit_of, derivative)
        if not (of and by):
            return ""
        return of if by == "1" else f"{_grouped(of)}/{_grouped(by)}"
    name = re.sub(r"\[\d+\]$", "", path)
    if name.rpartition(".")[2] in _IN_COORDINATES:
        return ""
    for ending, unit in _UNITS.items():
        if name.endswith(ending):
            return unit
    return "1"


def _grouped(unit: str) -> str:
    return f"({unit})" if re.search("[/ ]", unit) else unit


@lru_cache(4096)
def without_unit(path: str) -> str:
    """Returns a path without the unit in its name.

    >>> without_unit("pendulum.omega_minus_rad_s"), without_unit("rates_after_rad_s[0]"), without_unit("a.newton")
    ('pendulum.omega_minus', 'rates_after[0]', 'a.newton')
    """
    unit = unit_of(path)
    if unit in ("", "1") or derivative_of(path):
        return path
    ending = re.sub(r"[/ .]", "_", unit.lower().replace("1/", "per_")).replace("^", "")
    return re.sub(rf"_{ending}(\[\d+\])?$", r"\1", path)

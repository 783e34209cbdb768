"""Client: asks the engine in this process, or a server that is named."""

from __future__ import annotations

import functools
import os
import sys
import threading
import warnings
import weakref
from types import TracebackType
from typing import TYPE_CHECKING, Any, Callable, Iterable, Literal, Mapping, Union, overload

import numpy as np

from ricochet import _core, errors, labels, mechanisms, names, values
from ricochet import axes as sweep_axes
from ricochet._core import Scene
from ricochet.connection import resolve
from ricochet.errors import InvalidRequest, RicochetError, Violation
from ricochet.mechanisms import AtContact
from ricochet.record import Record, check_side
from ricochet.table import Codes, Table

if TYPE_CHECKING:
    import pandas
    import xarray
    from numpy.typing import ArrayLike, NDArray

SceneLike = Union[Scene, Mapping[str, Any]]
"""A scene: a dictionary with the names of ricochet.v1.Scene, or a ``Scene`` that was made of one."""
Names = Union[str, Iterable[str]]
Progress = Callable[[int, int], object]

_TITLE = "Sweep of impacts with friction"
_REGIMES = _core.enum_names("Regime")
_STATUSES = _core.enum_names("RowStatus")
_VERDICTS = _core.enum_names("LimitCheck.Verdict")
_WITHOUT_NUMBERS = [_STATUSES.index(name) for name in ("INVALID", "NOT_REPRESENTABLE")]
_WITHOUT_END = [_REGIMES.index(name) for name in ("WEDGED", "NO_SOLUTION")]
_COUNTS = ("invalid", "inadmissible", "without_end", "not_converged", "separating")
_MOST_AUDIT_ROWS = 8192  # In one call, where the server allows as many.
_clients: "weakref.WeakSet[Client]" = weakref.WeakSet()


class InvalidRows(UserWarning):
    """Rows of an answer have no numbers, because they break a rule; the text says how many, and the first of them."""


class NoEnd(UserWarning):
    """Some impacts have no end that is known, so that there are no velocities after them."""


class Client:
    """Computes in this process, or asks the server that is named. Both give the same answers, bit by bit.

    Use it as a context manager, or call ``close``. The options are those of the command line; one that is not given is
    taken from the environment (``RICOCHET_TLS_CA`` for ``tls_ca``), then from the TOML file that ``config`` or
    ``RICOCHET_CONFIG`` names, as a line ``tls-ca = "FILE"``. Several threads may use one client, and compute at once.
    After a fork it has threads of its own in the new process, and both processes connect anew. Ctrl-C ends a call.

    Args:
        server: ``"HOST:PORT"`` or ``"unix:PATH"``; several with commas between them stand in for each other. None: the
            engine in this process, whatever the environment and the file name.
        deadline: the time that one call may take, s, or ``"250ms"``, ``"5m"``; by default any in this process and for a
            sweep, 10 s for other calls of a server.
        max_receive: bytes of one message of an answer, in [1, 2147483647]; by default 67108864.
        tls: encrypt, and make sure of the server; ``tls_ca``, ``tls_cert``, ``tls_key`` and ``server_name`` imply it.
        tls_ca: PEM file with the authorities that the server's certificate must come from; by default the system's.
        tls_cert: PEM file with this client's certificate.
        tls_key: PEM file with the private key of ``tls_cert``.
        server_name: the name that the server's certificate must have, if it is not that of ``server``.
        token_file: the file that holds the token to send; it may be renewed.
        token: the token to send.
        config: a TOML file with these options.

    Raises:
        InvalidRequest: an option is wrong.
    """

    def __init__(
        self, server: str | None = "", *, deadline: str | float = "", max_receive: str | int = "", tls: str | bool = "",
        tls_ca: str = "", tls_cert: str = "", tls_key: str = "", server_name: str = "", token_file: str = "",
        token: str = "", config: str = "",
    ) -> None:
        options = {name: value for name, value in locals().items()
                   if name != "self" and (value is not None or name == "server")}
        converted = {"deadline": str(deadline), "max_receive": str(max_receive), "tls": str(tls).lower()}
        self._given = {name: converted.get(name, value) for name, value in options.items()}
        self._options: dict[str, Any] | None = None
        self._start()
        # Wrong options are an error here, and not at the first call.
        self._resolved()

    def _start(self) -> None:
        self._lock = threading.Lock()
        self._made: _core.Solver | None = None
        self._info: Record | None = None
        _clients.add(self)

    def _resolved(self) -> dict[str, Any]:
        """Returns the options as the module takes them. Raises InvalidRequest if one is wrong."""
        if self._options is None:
            options = resolve(self._given)
            if options["server"]:
                _core.check_options(options)
            self._options = options
        return self._options

    def __reduce__(self) -> tuple[Any, ...]:
        """A copy, or what another process gets, has the same options and a connection of its own."""
        return functools.partial(Client, **self._given), ()

    def __enter__(self) -> "Client":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Closes the connection to a server. The next call opens another."""
        with self._lock:
            self._made = None
            self._info = None

    @property
    def _solver(self) -> "_core.Solver":
        made = self._made
        if made is not None:
            return made
        with self._lock:
            if self._made is None:
                options = self._resolved()
                is_remote = bool(options["server"])
                self._made = _core.of_server(options) if is_remote else _core.in_process(options["deadline"])
            return self._made

    def _close_connection(self) -> None:
        """Before a fork: gRPC must have no connection then. The next call opens another."""
        if self._options is not None and self._options["server"]:
            with self._lock:
                self._made = None

    def _leave_to_parent(self) -> None:
        """In a forked process: leaves the threads of the solver to the parent, whose they are."""
        if self._made is not None:
            self._made.abandon()
        self._start()

    def solve(
        self, scene: SceneLike, *, tolerance: float | None = None, require: Names = (), exclude: Names = (),
        strict: bool = False, history: int = 0, force_history: int = 0, certified: int = 0, both_ends: bool = False,
        derivatives: Mapping[str, Names | bool] | None = None,
    ) -> Record:
        """Computes one impact.

        Args:
            scene: the impact, a dictionary with the names of ricochet.v1.Scene; units are SI and radians. A ``Scene``
                made of one saves reading it at each call.
            tolerance: largest relative error of the contact velocity after the impact, in [0, 0.1]; default 1e-12.
            require: effects that are simulated even if they are negligible, such as ``"tangential_compliance"``.
            exclude: effects that are left out whatever that changes.
            strict: raise ``Inadmissible`` for an outcome that would create energy.
            history: also give the states at this number of equal steps of the normal impulse.
            force_history: also give the forces at this number of equal time steps; needs a spring along n.
            certified: also give numbers with this many proved significant digits, at most 1000.
            both_ends: also give the impact in which no coordinate of a mechanism is held, as ``free_end``.
            derivatives: also give how fast numbers of the outcome change with numbers of the scene:
                ``{"of": ["impulse.normal_total_n_s"], "by": ["friction.kinetic_coefficient"]}``; ``jacobian(of, by)``
                of the outcome gives them as an array. ``"find_thresholds": True`` also gives how far each number of
                ``by`` may move before the impact takes another course, as ``below`` and ``above`` of each derivative.

        Returns:
            The outcome as ricochet.v1.Outcome has it: ``outcome.coefficients.newton``,
            ``outcome.contact_velocity_after.normal_m_s`` (m/s), ``outcome.energy_change_j`` (J), ``outcome.regime``.

        Raises:
            InvalidRequest: the scene breaks a rule.
            RicochetError: the call failed otherwise.
        """
        if derivatives is not None:
            scene = Scene(scene)
            derivatives = _full_paths(derivatives, {"of": scene._columns(), "by": scene._fields()})
        return self._solver.solve(
            scene, tolerance, require, exclude, strict, history, force_history, certified, both_ends, derivatives)

    def jacobian(
        self, scene: SceneLike, of: Names, by: Names, *, side: Literal["both", "below", "above"] = "both",
    ) -> NDArray[np.float64]:
        """Computes how fast numbers of an outcome change with numbers of its scene.

        Derivatives of rigid impacts in a plane are exact to rounding; others have an estimated error, which
        ``solve(scene, derivatives={"of": of, "by": by})`` gives.

        Args:
            scene: as in ``solve``.
            of: velocities, impulses, works and coefficients of the outcome: ``"coefficients.newton"`` or, in short,
                ``"newton"``.
            by: numbers of the scene: ``"friction.kinetic_coefficient"`` or, in short, ``"mu"``.
            side: ``"both"`` gives a derivative where both sides agree; the others give the limit of the difference
                quotient from that side, which may differ, or exist alone, on a threshold such as the limit of friction.

        Returns:
            An array with a row for each number of ``of`` and a column for each of ``by``. It has NaN where there is no
            such derivative; ``solve(scene, derivatives={"of": of, "by": by}).derivatives`` says why.

        Raises:
            InvalidRequest: the scene breaks a rule, it has no derivatives, or a name means no number or several; the
                message has the names that it may mean.
            RicochetError: the call failed otherwise.
        """
        check_side(side)
        scene = Scene(scene)
        paths = _full_paths({"of": of, "by": by}, {"of": scene._columns(), "by": scene._fields()})
        return self.solve(scene, derivatives=paths).jacobian(paths["of"], paths["by"], side=side)

    def plan(
        self, scene: SceneLike, *, tolerance: float | None = None, require: Names = (), exclude: Names = (),
    ) -> Record:
        """Plans one impact without computing it: which effects are simulated, which are left out, and why.

        Args:
            scene, tolerance, require, exclude: as in ``solve``.

        Returns:
            ``plan`` as ricochet.v1.Plan: ``plan.model``, and ``plan.effects`` with the reason for each.

        Raises:
            InvalidRequest: the scene breaks a rule.
            RicochetError: the call failed otherwise.
        """
        arguments = {"tolerance": tolerance, "require": require, "exclude": exclude}
        return self._solver.plan(scene, arguments)

    def bounds(
        self, scene: SceneLike, *, ranges: Mapping[str, tuple[float, float]] | None = None, certified: int = 0,
        derivatives: Mapping[str, Names] | None = None,
    ) -> Record:
        """Computes the values that the coefficients of an impact can take.

        Args:
            scene: as in ``solve``; its restitution may be left out.
            ranges: fields that are uncertain, and the least and the largest value of each, in the field's unit:
                ``{"friction.kinetic_coefficient": (0.1, 0.3)}`` or, in short, ``{"mu": (0.1, 0.3)}``.
            certified: also give numbers with this many proved significant digits, at most 1000.
            derivatives: also give how fast ends of ranges and critical coefficients of friction change with numbers of
                the scene: ``{"of": ["sharp.newton.upper", "critical.stick"], "by": ["friction.kinetic_coefficient"]}``.

        Returns:
            ``bounds`` as ricochet.v1.Bounds, ``enclosure`` if ranges were given, ``certificate`` and ``derivatives`` if
            asked for.

        Raises:
            InvalidRequest: the scene or a range breaks a rule.
            RicochetError: the call failed otherwise.
        """
        scene = Scene(scene)
        named = names.by_full_name(ranges or {}, scene._fields(), "ranges")
        listed = tuple(_range(path, ends) for path, ends in named.items())
        paths = None if derivatives is None else _full_paths(derivatives, {"by": scene._fields()})
        arguments = {"ranges": listed, "certified": certified, "derivatives": paths}
        with errors.naming(ranges=list(named)):
            return self._solver.bounds(scene, arguments)

    def audit(
        self, scene: SceneLike, *, contact_velocity: Mapping[str, Any] | None = None,
        rates_after: ArrayLike | None = None, velocity_uncertainty_m_s: float = 0.0,
    ) -> Record:
        """Computes what an observed impact implies, and which limits it breaks.

        Args:
            scene: the contact and its state before the impact.
            contact_velocity: observed velocity of the contact after the impact, relative to the surface, m/s:
                ``{"tangential_m_s": 0.1, "normal_m_s": 0.4}``.
            rates_after: in its place, all velocities of the system after the impact in the order in which an outcome
                lists them: the rate of a pendulum, those of links or coordinates, or of each body its linear velocity,
                then its angular one.
            velocity_uncertainty_m_s: uncertainty of each component of the contact velocity, m/s.

        Returns:
            ``report`` as ricochet.v1.AuditReport, and ``contact_energy_j``, the energy that an impact can take, J.

        Raises:
            InvalidRequest: the scene or the observation breaks a rule.
            RicochetError: the call failed otherwise.
        """
        arguments: dict[str, Any] = {"velocity_uncertainty_m_s": velocity_uncertainty_m_s}
        if contact_velocity is not None:
            arguments["contact_velocity"] = contact_velocity
        if rates_after is not None:
            arguments["rates"] = {"values": np.atleast_1d(values.column(rates_after, "rates_after"))}
        with errors.naming(rates="rates_after"):
            return self._solver.audit(scene, arguments)

    def audit_batch(self, scene: SceneLike, columns: Mapping[str, Any]) -> Table:
        """Audits many observed impacts of scenes of one form.

        Args:
            scene: gives every number that no column states.
            columns: arrays with the names of ricochet.v1.AuditColumns, such as ``tangential_after_m_s`` and
                ``normal_after_m_s``, m/s, or of fields of the scene that differ by row, such as
                ``planar_body.velocity_n_m_s``, all equally long or single numbers; ``rates_after`` is a list with an
                array for each velocity of the system, in the order of ``audit``, or each of them has a column, such as
                ``bodies_after[0].angular_rad_s[0]``. A pandas frame or an xarray dataset will do.

        Returns:
            A table with every number of ricochet.v1.AuditReport; ``limits.sharp.verdict`` and its like are codes.

        Raises:
            InvalidRequest: the scene or a column breaks a rule.
            RicochetError: the call failed otherwise.
        """
        scene = Scene(scene)
        observed = _core.field_names("AuditColumns")
        # The short name of an observed number is not that of a field, too.
        fields = [path for path in scene._fields() if path.rpartition(".")[2] not in observed]
        velocities = scene._velocities()
        given = names.by_full_name(columns, [*observed, *fields, *velocities], "columns")
        arrays = {name: _columns_of(name, column) for name, column in given.items()}
        if not arrays.keys().isdisjoint(velocities) and "rates_after" not in arrays:
            missing = [name for name in velocities if name not in arrays]
            if missing:
                values.refuse("columns", f"has velocities after: must have {', '.join(missing)}, too")
            arrays["rates_after"] = _columns_of("rates_after", [arrays.pop(name) for name in velocities])
        rows = _row_count([column.shape[-1] for column in arrays.values()])
        index = labels.common("columns", given.values(), rows)
        most = self._most_audit_rows(sum(1 if column.ndim == 1 else len(column) for column in arrays.values()))
        parts = []
        for start in range(0, max(rows, 1), most):  # Without rows one call checks the scene.
            part: dict[str, Any] = {
                name: _part(column, start, start + most) for name, column in arrays.items() if rows}
            if "rates_after" in part:
                part["rates_after"] = [{"values": rate} for rate in np.atleast_2d(part["rates_after"])]
            inputs = [{"path": name, "values": part.pop(name)} for name in list(part) if name not in observed]
            with errors.naming(inputs=[column["path"] for column in inputs]):
                parts.append(self._solver.audit_batch(scene, {"columns": part, "inputs": inputs}))
            found = len(parts[-1][1]["regime"])
            if found != min(most, rows - start):
                raise RicochetError(f"the server answers {found} rows of an audit", code="DATA_LOSS")
        stated = {name: np.broadcast_to(column, rows).copy() for name, column in arrays.items() if name not in observed}
        return _audit_table(parts, stated, index)

    def fit(
        self, scene: SceneLike, table: Mapping[str, ArrayLike], unknown: Names | Mapping[str, float | None], *,
        sigma: Mapping[str, ArrayLike] | None = None,
        bounds: Mapping[str, tuple[float | None, float | None]] | None = None, loss: str | None = None,
        loss_scale: float | None = None, starts: int | None = None, max_iterations: int | None = None,
        region: Names = (),
    ) -> Record:
        """Finds the numbers of a scene that measured impacts tell, and how well they tell them.

        Args:
            scene: gives every number that is neither unknown nor a column of the table.
            table: an array for each column: numbers of the scene that differ by row, numbers of the outcome that were
                measured (NaN or masked where they were not), and ``"NAME.sigma"``, the standard deviations of the
                column ``NAME``. A pandas frame or an xarray dataset will do. Names may be short.
            unknown: the numbers to find, each with the value where the search starts if it is a dictionary; None and
                names alone start at the scene's own number.
            sigma: standard deviations of columns that the table has none of: numbers or arrays. A number of the scene
                without any is exact.
            bounds: ``(low, high)`` of unknowns, in their units; None is the bound that the number has by its rule.
            loss: ``"squares"``, ``"huber"`` or ``"cauchy"``; by default squares.
            loss_scale: where a robust loss bends, in sigmas, in [1e-6, 1e9]; by default 1.345 for Huber's and 2.385
                for Cauchy's.
            starts: searches, in [1, 1000]; further ones spread over the bounds.
            max_iterations: the most iterations of a search, in [1, 10000].
            region: two unknowns whose 95 % region is wanted.

        Returns:
            The answer as ricochet.v1.FitResponse: ``unknowns`` with ``value``, ``sigma``, ``low`` and ``high``,
            ``chi2``, ``p_value``, ``rows``, ``outliers``, ``notes``.

        Raises:
            InvalidRequest: the scene, a name, a column or an option breaks a rule.
            RicochetError: the call failed otherwise.
        """
        scene = Scene(scene)
        fields, numbers = list(scene._fields()), list(scene._columns())
        inputs, measured, listed = {}, {}, {}
        columns_given = names.by_full_name(table, fields + numbers, "table")
        for path, given in columns_given.items():
            column = np.atleast_1d(values.column(given, path))
            if path.endswith(".sigma"):
                listed[path[: -len(".sigma")]] = column
            elif path in fields:
                inputs[path] = {"path": path, "values": column}
            else:
                measured[path] = {"path": path, "values": column}
        columns = inputs | measured
        for what, sigmas in (("table", listed), ("sigma", sigma or {})):
            rule = "a column of the table"
            for path, given in names.by_name_of(sigmas, list(columns), fields + numbers, what, rule).items():
                if "sigma" in columns[path]:
                    values.refuse(what, f"= {path!r}: is {path}.sigma of the table a second time")
                columns[path]["sigma"] = np.atleast_1d(values.column(given, f"{path}.sigma"))
        rows = _row_count([np.size(column) for column in columns_given.values()])
        labels.common("table", [*columns_given.values(), *(sigma or {}).values()], rows)
        if isinstance(unknown, Mapping):
            given_starts = list(names.by_full_name(unknown, fields, "unknown").items())
        else:
            given_starts = [(name, None) for name in values.names(unknown, "unknown")]
        paths = names.full_names([name for name, _ in given_starts], fields, "unknown")
        unknowns = [{"path": path, "start": start} for path, (_, start) in zip(paths, given_starts)]
        for path, ends in names.by_name_of(bounds or {}, paths, fields, "bounds", "an unknown").items():
            pair = list(ends) if values.is_list(ends) else []
            if len(pair) != 2:
                values.refuse(path, f"= {values.shown(ends)}: must be two numbers or None, the least first")
            unknowns[paths.index(path)].update(low=pair[0], high=pair[1])
        arguments = {
            "unknowns": unknowns, "inputs": list(inputs.values()), "measured": list(measured.values()),
            "loss": loss, "loss_scale": loss_scale, "starts": starts,
            "max_iterations": max_iterations,
            "region": names.full_names(values.names(region, "region"), paths, "region"),
        }
        with errors.naming(unknowns=paths, inputs=list(inputs), measured=list(measured)):
            return self._solver.fit(scene, arguments)

    def solve_batch(
        self, scene: SceneLike, inputs: Mapping[str, ArrayLike], columns: Names, *,
        tolerance: float | None = None, require: Names = (), exclude: Names = (),
    ) -> Table:
        """Computes many different impacts of one system.

        Args:
            scene: gives every field that no column states.
            inputs: an array for each field that varies, by the field's path, ``"planar_contact.normal_m_s"``, or a
                short name, ``"mu"``. They are equally long, or single numbers for all rows. A pandas frame or an xarray
                dataset will do; its index is kept. What is missing (None, pandas.NA, masked) is NaN, which makes the
                row invalid. An array of doubles that lie side by side is read where it is; the table has a copy.
            columns: the numbers of the outcome to compute: ``"contact_velocity_after.normal_m_s"``, or short names,
                ``["newton", "poisson"]``; ``"d(newton)/d(mu)"`` is a derivative. The table has their full names.
            tolerance, require, exclude: as in ``solve``, for every row.

        Returns:
            A table with a row for each impact. A row that breaks a rule has NaN and the status ``"INVALID"``; a number
            that the outcome of a row leaves unset is NaN, and the status is ``"INCOMPLETE"``; ``"NOT_CONVERGED"`` is
            that of a row whose ``accuracy.relative_error`` exceeds the tolerance. A warning ``InvalidRows`` counts rows
            that break a rule, and ``table.summary.bad_rows`` has the reasons of the first ones. A warning ``NoEnd``
            counts rows whose impact has no end, or whose impact law has no solution.

        Raises:
            InvalidRequest: the scene, a path, an entry or the length of an array is wrong.
            RicochetError: the call failed otherwise.
        """
        arguments = {"tolerance": tolerance, "require": require, "exclude": exclude}
        table = self._batch(Scene(scene), inputs, columns, arguments)
        _warn_of_rows(table)
        return table

    def _batch(
        self, scene: Scene, inputs: Mapping[str, ArrayLike], columns: Names, arguments: dict[str, Any]
    ) -> Table:
        given = names.by_full_name(inputs, scene._fields(), "inputs")
        if not given:
            values.refuse("inputs", "is empty: must have at least one column")
        arrays = _equally_long(
            {name: np.atleast_1d(values.column(given[name], name)) for name in given}, scene._fields())
        wanted = names.full_columns(values.names(columns, "columns"), scene._columns(), scene._fields())
        index = labels.common("inputs", given.values(), len(next(iter(arrays.values()))))
        arguments = {"fields": list(arrays), "columns": wanted, **arguments}
        solved = self._solver.solve_batch(scene, arguments, list(arrays.values()))
        outputs, regimes, statuses, counts, bad_rows = solved
        return Table(
            dict(zip(wanted, outputs)),
            {"regime": Codes(regimes, _REGIMES), "status": Codes(statuses, _STATUSES)},
            axes={name: array.copy() for name, array in arrays.items()},
            summary=Record(
                rows=len(regimes),
                **dict(zip(_COUNTS, counts)),
                bad_rows=[
                    Record(row=row, status=_STATUSES[status], field=field, description=description)
                    for row, status, field, description in bad_rows
                ],
            ),
            index=index,
        )

    @overload
    def sweep(
        self, scene: SceneLike, axes: Mapping[str, sweep_axes.Axis], columns: Names, *,
        form: Literal["xarray"] = "xarray", zip_axes: bool = False, tolerance: float | None = None,
        require: Names = (), exclude: Names = (), progress: Progress | None = None,
    ) -> "xarray.Dataset": ...

    @overload
    def sweep(
        self, scene: SceneLike, axes: Mapping[str, sweep_axes.Axis], columns: Names, *, form: Literal["pandas"],
        zip_axes: bool = False, tolerance: float | None = None, require: Names = (), exclude: Names = (),
        progress: Progress | None = None,
    ) -> "pandas.DataFrame": ...

    @overload
    def sweep(
        self, scene: SceneLike, axes: Mapping[str, sweep_axes.Axis], columns: Names, *, form: Literal["table"],
        zip_axes: bool = False, tolerance: float | None = None, require: Names = (), exclude: Names = (),
        progress: Progress | None = None,
    ) -> Table: ...

    def sweep(
        self, scene: SceneLike, axes: Mapping[str, sweep_axes.Axis], columns: Names, *,
        form: Literal["xarray", "pandas", "table"] = "xarray", zip_axes: bool = False,
        tolerance: float | None = None, require: Names = (), exclude: Names = (),
        progress: Progress | None = None,
    ) -> Any:
        """Computes impacts over a grid.

        A connection that breaks, or a server that stops, does not end the sweep: it goes on from the first point that
        has not arrived, if another call reaches the same engine.

        Args:
            scene: gives every field that no axis drives.
            axes: the values of each field that varies, by the field's path, ``"friction.kinetic_coefficient"``, or a
                short name, ``"mu"``. An array, or ``ricochet.Linspace`` or ``ricochet.Logspace``; a server takes arrays
                of at most 65,536 values.
            columns: the numbers of the outcome to compute: ``"coefficients.newton"``, or short names, ``["newton"]``.
                A derivative is ``"d(newton)/d(mu)"``. The answer has their full names.
            form: what is returned. ``"xarray"``: a dataset with a dimension for each axis; ``"pandas"``: a frame with a
                row for each point; ``"table"``: a ``Table`` of numpy arrays. The first two need the package of that
                name.
            zip_axes: the axes advance together; otherwise the points are all combinations of their values.
            tolerance, require, exclude: as in ``solve``, for every point.
            progress: is called with the points done and the points in all, after each part of the answer.

        Returns:
            The numbers of each column, ``regime``, and ``status``, which says whether a point is ``"OK"`` or
            ``"INADMISSIBLE"``; one that breaks a rule is ``"INVALID"`` and has NaN, and a warning ``InvalidRows`` says
            so; one whose outcome leaves a number unset is ``"INCOMPLETE"`` and has NaN there; ``"NOT_CONVERGED"`` is
            one whose ``accuracy.relative_error`` exceeds the tolerance. A warning ``NoEnd`` counts points whose impact
            has no end, or whose impact law has no solution. ``attrs`` has the request and the engine, under the names
            that the files of the command line have.

        Raises:
            InvalidRequest: the scene, an axis or a column is wrong.
            RicochetError: the call failed otherwise.
        """
        if form not in ("xarray", "pandas", "table"):
            values.refuse("form", f"= {form!r}: must be 'xarray', 'pandas' or 'table'")
        scene = Scene(scene)
        given = names.by_full_name(axes, scene._fields(), "axes")
        index = None
        if zip_axes:
            index = labels.common("axes", given.values(), _row_count([np.size(axis) for axis in given.values()]))
        wanted = names.full_columns(values.names(columns, "columns"), scene._columns(), scene._fields())
        arguments = {
            "axes": [sweep_axes.to_fields(path, axis) for path, axis in given.items()],
            "columns": wanted, "combination": "zip" if zip_axes else "product", "with_regime": True,
            "tolerance": tolerance, "require": require, "exclude": exclude,
        }
        with errors.naming(axes=list(given)):
            numbers, regimes, statuses, counts, coordinates, attrs = self._solver.sweep(scene, arguments, progress)
        codes = {"regime": Codes(regimes, _REGIMES), "status": Codes(statuses, _STATUSES)}
        table = Table(
            dict(zip(wanted, numbers)),
            codes,
            axes=dict(zip(given, coordinates)),
            is_grid=not zip_axes and bool(given),
            summary=Record(
                points=len(regimes), by_regime=codes["regime"].counts(), **dict(zip(_COUNTS, counts))),
            attrs={"Conventions": "CF-1.8", "title": _TITLE, **attrs},
            index=index,
        )
        _warn_of_rows(table)
        if form == "table":
            return table
        return table.to_xarray() if form == "xarray" else table.to_pandas()

    def multicontact(
        self, scene: Mapping[str, Any], *, states: ArrayLike | None = None, methods: Names = (),
        outputs: Mapping[str, ArrayLike] | None = None, stiffness_range: tuple[int, float, float] | None = None,
    ) -> Any:
        """Computes what several contacts at once can do, and whether the order of their impacts matters.

        Args:
            scene: a dictionary with the names of ricochet.v1.MultiContactScene. Matrices may have two dimensions.
            states: velocities before, in place of the scene's own: an array with a row for each state.
            methods: the ways to answer, of ``"orders"``, ``"springs"`` and ``"possible"``; by default each that the
                scene allows.
            outputs: linear functions of the velocities that get bounds too: their names and coefficients.
            stiffness_range: ``(contact, low, high)`` also gives the outcomes of springs while the relative stiffness of
                this contact, counted from 1, runs from ``low`` to ``high``.

        Returns:
            The answer as ricochet.v1.MultiContactAnswer: ``answer.verdict``, ``answer.orders``, ``answer.springs``,
            ``answer.possible``. With ``states``, a list of answers.

        Raises:
            InvalidRequest: the scene or an argument breaks a rule.
            RicochetError: the call failed otherwise.
        """
        arguments: dict[str, Any] = {"methods": methods}
        if states is not None:
            listed = values.column(states, "states")
            rows: Any = np.atleast_2d(listed) if listed.shape != (0,) else ()
            arguments["states"] = [{"velocity": state} for state in rows]
        if outputs is not None:
            if not isinstance(outputs, Mapping):
                values.dictionary_expected(outputs, "outputs", ["the coefficients of each name"])
            arguments["outputs"] = [{"name": name, "coefficients": outputs[name]} for name in outputs]
        if stiffness_range is not None:
            if not values.is_list(stiffness_range) or len(stiffness_range) != 3:
                values.refuse("stiffness_range", f"= {values.shown(stiffness_range)}: must be (contact, low, high)")
            arguments["stiffness_range"] = dict(zip(("contact", "low", "high"), stiffness_range))
        answers = self._solver.multicontact(scene, arguments).answers
        return answers[0] if states is None else answers[: len(arguments["states"])]

    def cost(
        self, scene: SceneLike, *, time_limit_s: float | None = None, samples: int | None = None,
        progress: Progress | None = None,
    ) -> Record:
        """Studies what the accuracy of one impact costs in time, on the machine that answers.

        Args:
            scene: as in ``solve``; or as in ``multicontact``, a dictionary with ``contacts``.
            time_limit_s: time for the whole study, s; default 3.
            samples: samples taken of each time; default 21.
            progress: is called with the methods done and the methods in all, after each of them.

        Returns:
            ``rows``, every method that applies with its time and its error as ricochet.v1.CostRow, and ``summary``, the
            Pareto front and the methods that the plan picks, as ricochet.v1.CostSummary.

        Raises:
            InvalidRequest: the scene or an option breaks a rule.
            RicochetError: the call failed otherwise.
        """
        arguments: dict[str, Any] = {"time_limit_s": time_limit_s, "samples": samples}
        if isinstance(scene, Mapping) and "contacts" in scene:
            scene, arguments["multi_contact"] = {}, scene
        return self._solver.cost(scene, arguments, progress)

    def at_contact(
        self, M: ArrayLike, J: ArrayLike, qdot: ArrayLike, normal: ArrayLike, *, friction: ArrayLike = 0.0,
        energetic: ArrayLike | None = None, newton: ArrayLike | None = None, poisson: ArrayLike | None = None,
        held: Iterable[int] = (), tolerance: float | None = None,
        derivatives: Mapping[str, Names | bool] | None = None,
    ) -> AtContact:
        """Computes the impact of a mechanism from what a library of multibody dynamics gives at one instant.

        Many states are computed at once if any of the arrays has a leading axis of them; the others hold for all. The
        contact frame is made here: n along `normal`, t1 along the slip.

        Args:
            M: the mass matrix, n x n, positive definite, and symmetric but for rounding: (M + M^T)/2 is taken.
            J: the Jacobian of the contact point in world axes, 3 x n: its velocity relative to what it strikes is
                ``J @ qdot``, m/s.
            qdot: the generalised velocities before the impact, n.
            normal: the direction out of the surface that is struck, in world axes; of any length.
            friction: the coefficient of kinetic friction, one for all states or one for each.
            energetic, newton, poisson: the coefficient of restitution in one of its definitions, likewise.
            held: coordinates that a brake or a stiff controller holds: their velocities do not change. With a floating
                base, ``held=range(6, n)`` takes the mechanism for one rigid body.
            tolerance: as in ``solve``.
            derivatives: of a single state, as in ``solve``: ``{"of": ["rates_after[0]"], "by": ["rates[0]", "mu"]}``;
                ``answer.jacobian(of, by)`` gives them. The numbers are those of the mechanism, ``jacobian`` among them
                in the contact frame of this state.

        Returns:
            ``rates_after``, the generalised velocities after the impact, and ``impulse_n_s`` on the mechanism in world
            axes, N s, as arrays; ``answer`` is the outcome of a single state, which has errors of all numbers, or the
            table of a batch in the contact frame. A state that breaks a rule has NaN in a batch. One whose impact has
            no end that is known, because friction and what is held keep the contact from parting, has NaN too, and a
            warning ``NoEnd`` says so; ``answer`` has the state that was reached.

        Raises:
            InvalidRequest: the shapes do not fit, or a single state breaks a rule.
            RicochetError: the call failed otherwise.
        """
        states = mechanisms.States(M, J, qdot, normal, held)
        given = {"energetic": energetic, "newton": newton, "poisson": poisson}
        restitution = {name: value for name, value in given.items() if value is not None}
        several = {name: np.size(value) for name, value in {"friction": friction, **restitution}.items()
                   if np.ndim(value) == 1}
        sizes = {*several.values(), states.count} - {1}
        if len(sizes) > 1:
            raise InvalidRequest.of([
                Violation(name, f"has {size} numbers: must have one, or one for each of the {states.count} states")
                for name, size in several.items() if size not in (1, states.count)])
        is_single = not states.is_batch and not several
        if derivatives is not None and not is_single:
            values.refuse("derivatives", "is set: must not be for several states, whose batch has none")
        if is_single:
            parts = {"friction": {"kinetic_coefficient": friction}, "restitution": restitution}
            outcome = self.solve({**states.scene(0), **parts}, tolerance=tolerance, derivatives=derivatives)
            rates, impulse = _without_ends(
                np.array(outcome.rates_after), states.in_world(outcome), np.array(outcome.accuracy.relative_error))
            return AtContact(rates, impulse, outcome)
        arrays = [(M, 3), (J, 3), (qdot, 2), (normal, 2), (friction, 1)]
        arrays += [(value, 1) for value in restitution.values()]
        columns = [array for array, dimensions in arrays if getattr(array, "ndim", 0) == dimensions]
        labels.common("qdot", columns, max(sizes, default=1))
        inputs = {"friction.kinetic_coefficient": friction, **states.columns}
        inputs.update({f"restitution.{name}": value for name, value in restitution.items()})
        table = self._batch(mechanisms.CONTACT, inputs, mechanisms.COLUMNS, {"tolerance": tolerance})
        for bad in table.summary.bad_rows:
            states.explain(bad)
        _warn_of_invalid(table)
        rates, impulse = _without_ends(*states.after(table), table.columns["accuracy.relative_error"])
        return AtContact(rates, impulse, table)

    def info(self) -> Record:
        """Returns which engine answers, what it can compute, and its limits, as ricochet.v1.InfoResponse has them."""
        return self._solver.info()

    def _most_audit_rows(self, columns: int) -> int:
        """Returns how many rows one call of an audit with so many columns takes."""
        if self._info is None:
            self._info = self.info()
        limit = self._info.limits["max_audit_rows"]
        most = _MOST_AUDIT_ROWS if limit is None else min(int(limit), _MOST_AUDIT_ROWS)
        if most < 1:  # Rows in parts of no row would be lost in silence.
            raise RicochetError(f"the server states max_audit_rows = {limit}: must be >= 1", code="DATA_LOSS")
        server = self._info.server_limits
        if server is None:
            return most
        # A quarter of a message is left for the scene.
        return max(1, min(most, int(server.max_message_bytes) // 4 * 3 // (8 * max(columns, 1))))


def _module_client() -> Client:
    import ricochet

    return ricochet._client


class ModuleClient(Client):
    """The client of the package's own functions: it reads its options from the environment at the first call."""

    def __init__(self) -> None:
        self._given = {}
        self._options = None
        self._start()

    def __reduce__(self) -> tuple[Any, ...]:
        return _module_client, ()

    def close(self) -> None:
        """Closes the connection to a server. The next call reads the environment and opens another."""
        super().close()
        self._options = None


def _before_fork() -> None:
    for client in list(_clients):
        client._close_connection()
    _core.before_fork()


def _after_fork_in_child() -> None:
    _core.after_fork_in_child()
    for client in list(_clients):
        client._leave_to_parent()


os.register_at_fork(
    before=_before_fork, after_in_parent=_core.after_fork_in_parent, after_in_child=_after_fork_in_child
)


def _range(path: str, ends: Any) -> dict[str, Any]:
    pair = values.column(ends, path)
    if pair.shape != (2,):
        values.refuse(path, f"= {values.shown(ends)}: must be two numbers, the least first")
    return {"path": path, "low": pair[0], "high": pair[1]}


def _full_paths(derivatives: Mapping[str, Any], known: Mapping[str, Any]) -> dict[str, Any]:
    """Returns what is asked of derivatives, with the full names of those numbers whose names are known."""
    if not isinstance(derivatives, Mapping):
        values.dictionary_expected(derivatives, "derivatives", ["by", "find_thresholds", "of"])
    return {key: names.full_names(values.names(value, key), known[key], key) if key in known else value
            for key, value in derivatives.items()}


def _without_ends(rates: values.Numbers, impulse: values.Numbers, errors: values.Numbers) -> tuple[
    values.Numbers, values.Numbers]:
    """Returns the arrays with NaN for the states whose impact has no end, which have an infinite error."""
    has_no_end = np.isinf(errors)
    count = int(np.count_nonzero(has_no_end))
    if count == 0:
        return rates, impulse
    warnings.warn(f"impacts without an end that is known, which have NaN: {count} of {errors.size}; friction and what "
                  "is held keep the contact from parting", NoEnd, stacklevel=_depth_of_caller())
    unknown = has_no_end[..., None]
    return np.where(unknown, np.nan, rates), np.where(unknown, np.nan, impulse)


def _depth_of_caller() -> int:
    """Returns the stack level, for ``warnings.warn`` in the function that asks, of the line outside of this package."""
    depth, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").split(".")[0] == "ricochet":
        depth, frame = depth + 1, frame.f_back
    return depth


def _warn_of_invalid(table: Table) -> None:
    """Warns of rows without numbers, at the line that has asked for them."""
    if not table.summary.invalid:
        return
    reasons = table.summary.get("bad_rows")
    first = (f"row {reasons[0].row}: {reasons[0].field} {reasons[0].description}" if reasons
             else _first_row(table, "status", _WITHOUT_NUMBERS))
    text = f"rows that break a rule and have NaN: {table.summary.invalid} of {len(table)}; the first is {first}"
    warnings.warn(text, InvalidRows, stacklevel=_depth_of_caller())


def _warn_of_rows(table: Table) -> None:
    """Warns of rows without numbers, and of those whose numbers are not those of an end."""
    _warn_of_invalid(table)
    if table.summary.without_end:
        first = _first_row(table, "regime", _WITHOUT_END)
        text = (f"impacts without an end or a solution, which have the numbers of the state that was reached: "
                f"{table.summary.without_end} of {len(table)}; the first is {first}")
        warnings.warn(text, NoEnd, stacklevel=_depth_of_caller())


def _first_row(table: Table, kind: str, codes: list[int]) -> str:
    """Returns "row N: FIELD = VALUE, ..." of the first row that has one of the codes."""
    row = int(np.flatnonzero(np.isin(table.codes[kind].numbers, codes))[0])
    return f"row {row}: " + ", ".join(f"{name} = {value:.6g}" for name, value in table.inputs_of(row).items())


def _row_count(lengths: list[int]) -> int:
    """Returns the rows of arrays of these lengths, as NumPy broadcasts them: none for an empty one and a number."""
    return max((length for length in lengths if length != 1), default=min(len(lengths), 1))


def _equally_long(arrays: dict[str, NDArray[np.float64]], known: Iterable[str]) -> dict[str, NDArray[np.float64]]:
    rows = _row_count([len(array) for array in arrays.values()])
    wrong = [
        Violation(name, f"has shape {array.shape}: must be one number, or {rows} as the longest array"
                  + (f"; the columns of a matrix are stated as {name}[0], {name}[1], ..."
                     if array.ndim > 1 and f"{name}[0]" in known else ""))
        for name, array in arrays.items()
        if array.ndim != 1 or len(array) not in (1, rows)
    ]
    if wrong:
        raise InvalidRequest.of(wrong)
    return {
        name: np.ascontiguousarray(array) if len(array) == rows else np.full(rows, array[0])
        for name, array in arrays.items()
    }


def _columns_of(name: str, value: Any) -> NDArray[Any]:
    if name == "rates_after" and isinstance(value, (list, tuple)) and any(np.ndim(rates) for rates in value):
        columns = {f"rates_after[{i}]": np.atleast_1d(values.column(rates, f"rates_after[{i}]"))
                   for i, rates in enumerate(value)}
        rows = _row_count([len(column) for column in columns.values()])
        for path, column in columns.items():
            if len(column) not in (1, rows):
                values.refuse(path, f"has {len(column)} values: must have 1 or {rows}")
        return np.stack([np.broadcast_to(column, rows) for column in columns.values()])
    array = values.column(value, name)
    return np.atleast_2d(array) if name == "rates_after" else np.atleast_1d(array)


def _part(column: NDArray[Any], start: int, end: int) -> NDArray[Any]:
    return column if column.shape[-1] == 1 else column[..., start:end]


def _audit_table(
    parts: list[tuple[dict[str, NDArray[np.float64]], dict[str, NDArray[np.uint8]], Record]],
    stated: dict[str, NDArray[Any]], index: Any,
) -> Table:
    codes = {name: Codes(np.concatenate([part[1][name] for part in parts]),
                         _REGIMES if name == "regime" else _VERDICTS) for name in parts[0][1]}
    invalid = codes["regime"].equal("INVALID")
    columns: dict[str, NDArray[np.float64]] = {}
    # Lists of invalid rows are empty, so that a part may have fewer columns.
    for name in max((part[0] for part in parts), key=len):
        columns[name] = np.concatenate(
            [part[0].get(name, np.full(len(part[1]["regime"]), np.nan)) for part in parts])
        columns[name][invalid] = np.nan
    summary = Record(
        rows=sum(part[2].rows for part in parts),
        admissible=sum(part[2].admissible for part in parts),
        invalid=sum(part[2].invalid.count for part in parts),
        parts=[part[2] for part in parts],
    )
    return Table(columns, codes, stated, summary=summary, index=index)

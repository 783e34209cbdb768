"""Client: asks a server, or one that it starts itself."""

from __future__ import annotations

import math
import os
import sys
import threading
import warnings
import weakref
from functools import cached_property
from types import TracebackType
from typing import Any, Callable, Iterable, Iterator, Mapping, Sequence, TypeVar

import grpc
import numpy as np
from google.protobuf import json_format
from numpy.typing import ArrayLike, NDArray

from ricochet import answers
from ricochet import axes as sweep_axes
from ricochet import names, values
from ricochet.connection import DEFAULT_DEADLINE_S, Connection, metadata, open_channel, resolve
from ricochet.embedded import EmbeddedServer
from ricochet.errors import InvalidRequest, RicochetError, Unavailable, Violation, from_rpc
from ricochet.messages import Record, enum_names, fill, to_message, to_record
from ricochet.table import Codes, Table
from ricochet.v1 import (
    audit_pb2,
    batch_pb2,
    impact_service_pb2,
    impact_service_pb2_grpc,
    info_pb2,
    outcome_pb2,
    sweep_pb2,
)

Scene = Mapping[str, Any]
Progress = Callable[[int, int], object]
_Answer = TypeVar("_Answer")

_MOST_RESUMES = 10
_TITLE = "Sweep of impacts with friction"
_REGIMES = enum_names(outcome_pb2.Regime.DESCRIPTOR)
_STATUSES = enum_names(sweep_pb2.RowStatus.DESCRIPTOR)
_clients: "weakref.WeakSet[Client]" = weakref.WeakSet()


class InvalidRows(UserWarning):
    """Rows of an answer have no numbers, because they break a rule; the text says how many, and the first of them."""


class Client:
    """Asks the server that is named, or starts a ``ricochetd`` of its own at the first call and stops it at the end.

    Use it as a context manager, or call ``close``; an own server ends with the process in any case. The options are
    those of the command line; one that is not given is taken from the environment (``RICOCHET_TLS_CA`` for ``tls_ca``),
    then from the TOML file that ``config`` or ``RICOCHET_CONFIG`` names, as a line ``tls-ca = "FILE"``. Several threads
    may use one client; after a fork it opens a connection of its own in the new process.

    Args:
        server: ``"HOST:PORT"`` or ``"unix:PATH"``; several with commas between them stand in for each other.
        deadline: the time that one call may take, s, or ``"250ms"``, ``"5m"``; by default 10 s, for a sweep any.
        max_receive: bytes of one message of an answer, in [1, 2147483647]; by default 67108864.
        tls: encrypt, and make sure of the server; the next four imply it.
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
        self,
        server: str = "",
        *,
        deadline: str | float = "",
        max_receive: str | int = "",
        tls: str | bool = "",
        tls_ca: str = "",
        tls_cert: str = "",
        tls_key: str = "",
        server_name: str = "",
        token_file: str = "",
        token: str = "",
        config: str = "",
    ) -> None:
        self._given = Connection(
            server=server,
            deadline=str(deadline),
            max_receive=str(max_receive),
            tls=str(tls).lower(),
            tls_ca=tls_ca,
            tls_cert=tls_cert,
            tls_key=tls_key,
            server_name=server_name,
            token_file=token_file,
            token=token,
            config=config,
        )
        self._disconnect()
        _clients.add(self)
        # Wrong options are an error here, and not at the first call.
        self._options.deadline_s()
        self._options.max_receive_bytes()

    def _disconnect(self) -> None:
        self._lock = threading.Lock()
        self._embedded: EmbeddedServer | None = None
        self._channels: list[grpc.Channel] = []
        self._limits: Record | None = None

    @cached_property
    def _options(self) -> Connection:
        return resolve(self._given)

    def __enter__(self) -> "Client":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Closes the connection, and stops the server if it is an own one. The next call opens another."""
        with self._lock:
            for channel in self._channels:
                channel.close()
            self._channels = []
            if self._embedded is not None:
                self._embedded.stop()
                self._embedded = None

    def _open(self) -> list[grpc.Channel]:
        with self._lock:
            if not self._channels:
                targets = self._options.targets
                if not targets:
                    self._embedded = EmbeddedServer()
                    targets = [self._embedded.target]
                self._channels = [open_channel(target, self._options) for target in targets]
            return self._channels

    def _ask(self, call: Callable[[Any], _Answer]) -> _Answer:
        """Returns what `call` makes of the stub of the first server that is available."""
        error: RicochetError | None = None
        make_stub: Callable[[grpc.Channel], Any] = impact_service_pb2_grpc.ImpactServiceStub
        for channel in self._open():
            try:
                return call(make_stub(channel))
            except grpc.RpcError as failure:
                error = from_rpc(failure)
                if not isinstance(error, Unavailable):
                    break
        assert error is not None
        raise error

    def _unary(self, method: str, request: Any) -> Any:
        deadline_s = self._options.deadline_s() or DEFAULT_DEADLINE_S
        headers = metadata(self._options)

        def call(stub: Any) -> Any:
            return getattr(stub, method)(request, timeout=deadline_s, metadata=headers)

        return self._ask(call)

    def solve(
        self,
        scene: Scene,
        *,
        tolerance: float | None = None,
        require: str | Iterable[str] = (),
        exclude: str | Iterable[str] = (),
        strict: bool = False,
        history: int = 0,
        force_history: int = 0,
        certified: int = 0,
    ) -> Record:
        """Computes one impact.

        Args:
            scene: the impact, a dictionary with the names of ricochet.v1.Scene; units are SI and radians.
            tolerance: largest relative error of the contact velocity after the impact, in [0, 0.1]; default 1e-12.
            require: effects that are simulated even if they are negligible, such as ``"tangential_compliance"``.
            exclude: effects that are left out whatever that changes.
            strict: raise ``Inadmissible`` for an outcome that would create energy.
            history: also give the states at this number of equal steps of the normal impulse.
            force_history: also give the forces at this number of equal time steps; needs a spring along n.
            certified: also give numbers with this many proved significant digits, at most 1000.

        Returns:
            The outcome as ricochet.v1.Outcome has it: ``outcome.coefficients.newton``,
            ``outcome.contact_velocity_after.normal_m_s`` (m/s), ``outcome.energy_change_j`` (J), ``outcome.regime``.

        Raises:
            InvalidRequest: the scene breaks a rule.
            RicochetError: the call failed otherwise.
        """
        request = impact_service_pb2.SolveRequest()
        fill(
            request,
            scene,
            tolerance=tolerance,
            require=require,
            exclude=exclude,
            strict=strict,
            history=history,
            force_history=force_history,
            certified=certified,
        )
        return to_record(self._unary("Solve", request).outcome)

    def bounds(
        self, scene: Scene, *, ranges: Mapping[str, tuple[float, float]] | None = None, certified: int = 0
    ) -> Record:
        """Computes the values that the coefficients of an impact can take.

        Args:
            scene: as in ``solve``; its restitution may be left out.
            ranges: fields that are uncertain, and the least and the largest value of each, in the field's unit:
                ``{"friction.kinetic_coefficient": (0.1, 0.3)}`` or, in short, ``{"mu": (0.1, 0.3)}``.
            certified: also give numbers with this many proved significant digits, at most 1000.

        Returns:
            ``bounds`` as ricochet.v1.Bounds, ``enclosure`` if ranges were given, and ``certificate`` if asked for.

        Raises:
            InvalidRequest: the scene or a range breaks a rule.
            RicochetError: the call failed otherwise.
        """
        request = impact_service_pb2.BoundsRequest()
        fill(request, scene, certified=certified)
        for path, ends in names.by_full_name(ranges or {}, names.fields_of(request.scene), "ranges").items():
            pair = values.column(ends, path)
            if pair.shape != (2,):
                raise InvalidRequest.of(
                    [Violation(path, f"= {values.shown(ends)}: must be two numbers, the least first")])
            request.ranges.add(path=path, low=pair[0], high=pair[1])
        return to_record(self._unary("Bounds", request))

    def audit(
        self,
        scene: Scene,
        *,
        contact_velocity: Mapping[str, Any] | None = None,
        rates_rad_s: ArrayLike | None = None,
        velocity_uncertainty_m_s: float = 0.0,
    ) -> Record:
        """Computes what an observed impact implies, and which limits it breaks.

        Args:
            scene: the contact and its state before the impact.
            contact_velocity: observed velocity of the contact after the impact, relative to the surface, m/s:
                ``{"tangential_m_s": 0.1, "normal_m_s": 0.4}``.
            rates_rad_s: in its place, the angular velocities of a pendulum or a linkage after the impact, rad/s.
            velocity_uncertainty_m_s: uncertainty of each component of the contact velocity, m/s.

        Returns:
            ``report`` as ricochet.v1.AuditReport, and ``contact_energy_j``, the energy that an impact can take, J.

        Raises:
            InvalidRequest: the scene or the observation breaks a rule.
            RicochetError: the call failed otherwise.
        """
        request = impact_service_pb2.AuditRequest()
        fill(request, scene, velocity_uncertainty_m_s=velocity_uncertainty_m_s)
        if contact_velocity is not None:
            to_message(request.contact_velocity, contact_velocity, "contact_velocity")
        if rates_rad_s is not None:
            request.rates.rates_rad_s.extend(np.atleast_1d(values.column(rates_rad_s, "rates_rad_s")))
        return to_record(self._unary("Audit", request))

    def audit_batch(self, scene: Scene, columns: Mapping[str, Any]) -> Table:
        """Audits many observed impacts at one contact.

        Args:
            scene: the contact; its velocity is used for rows that state none.
            columns: arrays with the names of ricochet.v1.AuditColumns, such as ``tangential_after_m_s`` and
                ``normal_after_m_s``, m/s, all equally long or single numbers; ``rates_after``, rad/s, is a list with an
                array for each link. A pandas frame will do.

        Returns:
            A table with every number of ricochet.v1.AuditReport; ``limits.sharp.verdict`` and its like are codes.

        Raises:
            InvalidRequest: the scene or a column breaks a rule.
            RicochetError: the call failed otherwise.
        """
        known = [field.name for field in audit_pb2.AuditColumns.DESCRIPTOR.fields]
        given = names.by_full_name(columns, known, "columns")
        arrays = {name: _columns_of(name, column) for name, column in given.items()}
        rows = max((column.shape[-1] for column in arrays.values()), default=0)
        index = _index_of(columns, given, rows)
        most = self._limit("max_audit_rows")
        reports: list[Record] = []
        summaries = []
        for start in range(0, rows, most):
            request = impact_service_pb2.AuditBatchRequest()
            to_message(request.scene, scene, "")
            part: dict[str, Any] = {name: _part(column, start, start + most) for name, column in arrays.items()}
            if "rates_after" in part:
                part["rates_after"] = [{"rates_rad_s": link} for link in np.atleast_2d(part["rates_after"])]
            to_message(request.columns, part, "columns")
            response = self._unary("AuditBatch", request)
            reports += map(to_record, answers.entries(response.reports, min(most, rows - start), "reports"))
            summaries.append(to_record(response.summary))
        flat = [_flat(report) for report in reports]
        return _audit_table(flat, summaries, index)

    def solve_batch(
        self,
        scene: Scene,
        inputs: Mapping[str, ArrayLike],
        columns: str | Sequence[str],
        *,
        tolerance: float | None = None,
        require: str | Iterable[str] = (),
        exclude: str | Iterable[str] = (),
    ) -> Table:
        """Computes many different impacts of one system.

        Args:
            scene: gives every field that no column states.
            inputs: an array for each field that varies, by the field's path, ``"planar_contact.normal_m_s"``, or a
                short name, ``"mu"``. They are equally long, or single numbers for all rows. A pandas frame will do; its
                index is kept. What is missing (None, pandas.NA) is NaN, which makes the row invalid.
            columns: the numbers of the outcome to compute: ``"contact_velocity_after.normal_m_s"``, or short names,
                ``["newton", "poisson"]``. The table has their full names.
            tolerance, require, exclude: as in ``solve``, for every row.

        Returns:
            A table with a row for each impact. A row that breaks a rule has NaN and the status ``"INVALID"``; a number
            that the outcome of a row leaves unset is NaN, and the status is ``"INCOMPLETE"``. A warning ``InvalidRows``
            counts rows that break a rule, and ``table.summary.bad_rows`` has the reasons of the first ones.

        Raises:
            InvalidRequest: the scene, a path, an entry or the length of an array is wrong.
            RicochetError: the call failed otherwise.
        """
        setup = batch_pb2.BatchSetup()
        fill(setup, scene, tolerance=tolerance, require=require, exclude=exclude)
        given = names.by_full_name(inputs, names.fields_of(setup.scene), "inputs")
        if not given:
            raise InvalidRequest.of([Violation("inputs", "is empty: must have at least one column")])
        arrays = _equally_long({name: np.atleast_1d(values.column(given[name], name)) for name in given})
        rows = len(next(iter(arrays.values())))
        index = _index_of(inputs, given, rows)
        wanted = names.full_names(values.names(columns, "columns"), names.columns_of(setup.scene), "columns")
        setup.fields.extend(arrays)
        setup.columns.extend(wanted)
        outputs = {column: np.empty(rows) for column in wanted}
        regimes, statuses = np.empty(rows, np.uint8), np.empty(rows, np.uint8)
        parts = []
        most = self._most_batch_rows(max(len(arrays), len(outputs), 1))
        for start in range(0, max(rows, 1), most):
            part = slice(start, start + most)
            data = [array[part].astype("<f8").tobytes() for array in arrays.values()]
            request = batch_pb2.SolveBatchRequest(setup=setup, inputs=data)
            response = self._unary("SolveBatch", request)
            count = len(regimes[part])
            for column, numbers in zip(outputs.values(), answers.entries(response.outputs, len(outputs), "columns")):
                column[part] = answers.numbers(numbers, count, "a column")
            regimes[part] = answers.codes(response.regimes, count, "regimes")
            statuses[part] = answers.codes(response.statuses, count, "statuses")
            parts.append((start, response.summary))
        table = Table(
            outputs,
            {"regime": Codes(regimes, _REGIMES), "status": Codes(statuses, _STATUSES)},
            axes=arrays,
            summary=_batch_summary(parts),
            index=index,
        )
        _warn_of_invalid(table)
        return table

    def sweep(
        self,
        scene: Scene,
        axes: Mapping[str, sweep_axes.Axis],
        columns: str | Sequence[str],
        *,
        zip_axes: bool = False,
        tolerance: float | None = None,
        require: str | Iterable[str] = (),
        exclude: str | Iterable[str] = (),
        progress: Progress | None = None,
    ) -> Table:
        """Computes impacts over a grid: what ``ricochet.sweep``, which describes the arguments, gives as a table."""
        product = sweep_pb2.SweepRequest.COMBINATION_ZIP if zip_axes else sweep_pb2.SweepRequest.COMBINATION_PRODUCT
        request = sweep_pb2.SweepRequest(combination=product, with_regime=True)
        fill(request, scene, tolerance=tolerance, require=require, exclude=exclude)
        given = names.by_full_name(axes, names.fields_of(request.scene), "axes")
        request.axes.extend(sweep_axes.to_message(path, axis) for path, axis in given.items())
        wanted = names.full_names(values.names(columns, "columns"), names.columns_of(request.scene), "columns")
        request.columns.extend(wanted)
        text = json_format.MessageToJson(request, indent=None)
        lengths = [sweep_axes.length(path, axis) for path, axis in given.items()]
        received = _Received(len(wanted), lengths[0] if zip_axes and lengths else math.prod(lengths))
        for chunk in self._chunks(request, received):
            received.take(chunk)
            if progress is not None:
                progress(received.points, received.total)
        table = Table(
            dict(zip(wanted, received.values)),
            {"regime": Codes(received.regimes, _REGIMES), "status": Codes(received.statuses, _STATUSES)},
            axes={path: sweep_axes.coordinates(path, axis) for path, axis in given.items()},
            is_grid=not zip_axes and bool(given),
            summary=received.summary,
            attrs={"Conventions": "CF-1.8", "title": _TITLE, "ricochet_request": text, **received.provenance},
        )
        _warn_of_invalid(table)
        return table

    def _chunks(self, request: Any, received: "_Received") -> Iterator[Any]:
        """Yields the chunks of a sweep. A call that breaks off is followed by one for the rest."""
        resumes = 0
        while not received.complete:
            before = received.points
            request.first_index = before
            try:
                yield from self._stream(request)
            except RicochetError as error:
                resumes = 0 if received.points > before else resumes + 1
                if not received.points or not isinstance(error, Unavailable) or resumes > _MOST_RESUMES:
                    raise
            else:
                break
        received.check_complete()

    def _stream(self, request: Any) -> Iterator[Any]:
        """Yields the chunks of one call, from the first server that is available."""
        timeout, headers = self._options.deadline_s(), metadata(self._options)

        def start(stub: Any) -> tuple[Any, Any]:
            stream = stub.Sweep(request, timeout=timeout, metadata=headers)
            return next(stream), stream

        first, stream = self._ask(start)
        yield first
        try:
            yield from stream
        except grpc.RpcError as failure:
            raise from_rpc(failure) from None
        finally:
            stream.cancel()

    def info(self) -> Record:
        """Returns which engine answers, what it can compute, and its limits, as ricochet.v1.InfoResponse has them."""
        return to_record(self._unary("Info", info_pb2.InfoRequest()))

    def _limit(self, name: str) -> int:
        """Returns a limit of a request; 2^31 if the server has none."""
        if self._limits is None:
            self._limits = self.info().limits
        limit = self._limits[name]
        return 1 << 31 if limit is None else answers.at_least_one(int(limit), name)

    def _most_batch_rows(self, columns: int) -> int:
        numbers = min(
            self._limit("max_batch_numbers"),
            self._limit("max_request_bytes") // 16,
            self._options.max_receive_bytes() // 16,
        )
        return max(numbers // columns, 1)


class ModuleClient(Client):
    """The client of the package's own functions: it reads its options from the environment at the first call."""

    def __init__(self) -> None:
        self._given = Connection()
        self._disconnect()
        _clients.add(self)

    def close(self) -> None:
        """Closes the connection, and stops the server if it is an own one. The next call opens another."""
        super().close()
        self.__dict__.pop("_options", None)


def _disconnect_all() -> None:
    """In a forked process: leaves the connections and servers to the parent, whose they are."""
    for client in _clients:
        client._disconnect()


os.register_at_fork(after_in_child=_disconnect_all)


class _Received:
    """What has arrived of a sweep of so many points."""

    def __init__(self, columns: int, total: int) -> None:
        self.values = np.empty((columns, 0))
        self.regimes = np.empty(0, np.uint8)
        self.statuses = np.empty(0, np.uint8)
        self.points = 0
        self.total = total
        self.complete = False
        self.summary = Record()
        self.provenance: dict[str, str] = {}
        self._origin: tuple[str, str] | None = None

    def take(self, chunk: Any) -> None:
        origin = (chunk.engine.fingerprint, chunk.grid_fingerprint)
        if self._origin is None:
            self._origin = origin
            self.provenance = {
                "ricochet_grid_fingerprint": chunk.grid_fingerprint,
                "source": f"ricochet {chunk.engine.version}",
                "ricochet_engine_fingerprint": chunk.engine.fingerprint,
            }
            if chunk.points_total != self.total:
                raise RicochetError(
                    f"the server answers {chunk.points_total} points of {self.total}", code="DATA_LOSS"
                )
            self.values = np.empty((len(self.values), self.total))
            self.regimes = np.empty(self.total, np.uint8)
            self.statuses = np.empty(self.total, np.uint8)
        fits = chunk.first_index == self.points and 0 <= chunk.count <= self.total - self.points
        if origin != self._origin or not fits:
            raise RicochetError(
                "the server that goes on with the sweep is another engine, or points are missing", code="DATA_LOSS"
            )
        part = slice(self.points, self.points + chunk.count)
        columns = len(self.values)
        values = answers.numbers(chunk.values, columns * chunk.count, "values")
        self.values[:, part] = values.reshape(columns, chunk.count)
        self.regimes[part] = answers.codes(chunk.regimes, chunk.count, "regimes")
        self.statuses[part] = answers.codes(chunk.statuses, chunk.count, "statuses")
        self.points += chunk.count
        self.complete = self.points == self.total and chunk.HasField("summary")
        if self.complete:
            self.summary = Record(
                points=self.total,
                by_regime=Codes(self.regimes, _REGIMES).counts(),
                inadmissible=int(Codes(self.statuses, _STATUSES).equal("INADMISSIBLE").sum()),
            )

    def check_complete(self) -> None:
        if not self.complete:
            raise RicochetError(f"the sweep ended after {self.points} of {self.total} points", code="DATA_LOSS")


def _index_of(given: Any, columns: Mapping[str, Any], rows: int) -> Any:
    """Returns the index of a pandas frame, or the one that all series with so many rows have; None if there is none."""
    indices = [one.index for one in (given, *columns.values()) if hasattr(one, "iloc") and len(one) == rows]
    if not all(index.equals(indices[0]) for index in indices):
        raise InvalidRequest.of([Violation("inputs", "has series of different indices: must have one index for all")])
    return indices[0] if indices else None


def _warn_of_invalid(table: Table) -> None:
    """Warns of rows without numbers, at the line that has asked for them."""
    without_numbers = (sweep_pb2.ROW_STATUS_INVALID, sweep_pb2.ROW_STATUS_NOT_REPRESENTABLE)
    bad = np.flatnonzero(np.isin(table.codes["status"].numbers, without_numbers))
    if not len(bad):
        return
    first = int(bad[0])
    reasons = table.summary.get("bad_rows")
    if reasons:
        why = f"{reasons[0].field} {reasons[0].description}"
    else:
        why = ", ".join(f"{name} = {value:.6g}" for name, value in table.inputs_of(first).items())
    depth = 1
    while sys._getframe(depth).f_globals.get("__name__", "").split(".")[0] == "ricochet":
        depth += 1
    text = f"rows that break a rule and have NaN: {len(bad)} of {len(table)}; the first is row {first}: {why}"
    warnings.warn(text, InvalidRows, stacklevel=depth + 1)


def _equally_long(arrays: dict[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
    rows = max(len(array) for array in arrays.values())
    wrong = [
        Violation(name, f"has shape {array.shape}: must be one number, or {rows} as the longest array")
        for name, array in arrays.items()
        if array.ndim != 1 or len(array) not in (1, rows)
    ]
    if wrong:
        raise InvalidRequest.of(wrong)
    return {name: np.broadcast_to(array, rows) for name, array in arrays.items()}


def _batch_summary(parts: list[tuple[int, Any]]) -> Record:
    """Joins the summaries of the parts of a batch, whose rows are counted from the first of all."""
    bad_rows = [Record(to_record(bad), row=bad.row + start) for start, summary in parts for bad in summary.bad_rows]
    return Record(
        rows=sum(summary.counts.points for _, summary in parts),
        inadmissible=sum(summary.counts.inadmissible.count for _, summary in parts),
        bad_rows=bad_rows,
    )


def _columns_of(name: str, value: Any) -> NDArray[Any]:
    array = values.column(value, name)
    return np.atleast_2d(array) if name == "rates_after" else np.atleast_1d(array)


def _part(column: NDArray[Any], start: int, end: int) -> NDArray[Any]:
    return column if column.shape[-1] == 1 else column[..., start:end]


def _flat(record: Record, path: str = "") -> dict[str, Any]:
    """Returns the numbers and names of nested records by their paths."""
    flat: dict[str, Any] = {}
    for name, value in record.items():
        where = f"{path}{name}"
        if isinstance(value, Record):
            flat.update(_flat(value, where + "."))
        elif isinstance(value, list):
            flat.update({f"{where}[{i}]": entry for i, entry in enumerate(value)})
        else:
            flat[where] = value
    return flat


def _audit_table(rows: list[dict[str, Any]], summaries: list[Record], index: Any) -> Table:
    # Lists of invalid rows are empty, so that the names are those of the fullest row.
    fullest: dict[str, Any] = max(rows, key=len, default={})
    names = list(fullest)
    codes: dict[str, Codes] = {}
    columns: dict[str, NDArray[np.float64]] = {}
    for name in names:
        values = [row.get(name) for row in rows]
        if any(isinstance(value, str) for value in values):
            known = _REGIMES if name == "regime" else enum_names(audit_pb2.LimitCheck.Verdict.DESCRIPTOR)
            codes[name] = Codes(np.array([known.index(str(value)) for value in values], np.uint8), known)
        else:
            columns[name] = np.array(values, dtype=np.float64)
    invalid = codes["regime"].equal("INVALID") if codes else np.empty(0, np.bool_)
    for column in columns.values():
        column[invalid] = np.nan
    summary = Record(
        rows=sum(each.rows for each in summaries),
        admissible=sum(each.admissible for each in summaries),
        invalid=sum(each.invalid.count for each in summaries),
        parts=summaries,
    )
    regimes = {"regime": Codes(np.empty(0, np.uint8), _REGIMES)}
    return Table(columns, codes or regimes, summary=summary, index=index)

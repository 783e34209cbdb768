"""Messages: requests from dictionaries, and answers as records with names instead of numbers."""

from __future__ import annotations

import difflib
import html
import numbers
import os
from typing import Any, Iterable, Iterator, Mapping

import numpy as np
from google.protobuf import descriptor as descriptors
from google.protobuf import json_format, text_format
from google.protobuf.message import Message

from ricochet.contact_matrix import unpacked
from ricochet.errors import InvalidRequest, Violation
from ricochet.units import unit_of
from ricochet.v1 import scene_pb2
from ricochet.values import is_list, names, number, plain, shown

_Field = descriptors.FieldDescriptor
_INTEGERS = {_Field.TYPE_INT32: 31, _Field.TYPE_INT64: 63}

_WIDTH = 110  # Of a record on one line.
_MOST_ENTRIES = 12  # Of a list in a record for people.


class Record(dict[str, Any]):
    """An answer: a dictionary whose entries can be read as attributes, too.

    The names are those of the proto files, with the unit as their ending. A value is a number, a text, a record or a
    list; an enum is its name without the prefix, such as ``"REBOUND"``; what is not set is None. Printed it is one
    line, in a notebook a table; ``dict(record)`` has everything.
    """

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"no {name!r}{_suggestion(name, self)}") from None

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *self]

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
        rows = "".join(
            f"<tr><td style='text-align: left'>{html.escape(path)}</td><td>{html.escape(_short(value))}</td>"
            f"<td style='text-align: left'>{html.escape(unit_of(path)) if isinstance(value, float) else ''}</td></tr>"
            for path, value in leaves(self)
        )
        return f"<table><tr><th>name</th><th>value</th><th>unit</th></tr>{rows}</table>"


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


def _suggestion(name: str, known: Iterable[str]) -> str:
    names = list(known)
    near = difflib.get_close_matches(name, names, n=1)
    if near:
        return f"; did you mean {near[0]!r}?"
    return f"; there are {', '.join(sorted(names))}"


def _prefix(enum: descriptors.EnumDescriptor) -> str:
    """The words with which every name of an enum begins: "REGIME_"."""
    names = [str(value.name) for value in enum.values]
    return os.path.commonprefix(names).rpartition("_")[0] + "_"


def enum_name(enum: descriptors.EnumDescriptor, number: int) -> str:
    """Returns the name of a number without the enum's prefix; the number itself, as text, if it has no name here."""
    value = enum.values_by_number.get(number)
    return str(number) if value is None else str(value.name).removeprefix(_prefix(enum))


def enum_names(enum: descriptors.EnumDescriptor) -> list[str]:
    """Returns the names of the numbers 0, 1, 2, ..., without the enum's prefix."""
    return [enum_name(enum, number) for number in range(1 + max(enum.values_by_number))]


def enum_number(enum: descriptors.EnumDescriptor, name: str, path: str) -> int:
    """Returns the number of a name, which may lack the enum's prefix and be in lower case."""
    for candidate in (name.upper(), _prefix(enum) + name.upper()):
        if candidate in enum.values_by_name:
            return int(enum.values_by_name[candidate].number)
    known = [value.name.removeprefix(_prefix(enum)).lower() for value in enum.values[1:]]
    raise InvalidRequest.of([Violation(path, f"= {name!r} is unknown{_suggestion(name.lower(), known)}")])


def to_record(message: Message) -> Record:
    """Returns the message as a record."""
    record = Record()
    for field in message.DESCRIPTOR.fields:
        value = getattr(message, field.name)
        if field.label == _Field.LABEL_REPEATED:
            record[field.name] = [_plain(field, entry) for entry in value]
        elif field.has_presence and not message.HasField(field.name):
            record[field.name] = None
        else:
            record[field.name] = _plain(field, value)
    return record


def _plain(field: descriptors.FieldDescriptor, value: Any) -> Any:
    if field.type == _Field.TYPE_MESSAGE:
        return to_record(value)
    if field.type == _Field.TYPE_ENUM:
        return enum_name(field.enum_type, value)
    return value


def to_message(message: Message, values: Mapping[str, Any], path: str) -> None:
    """Fills a message from a dictionary with the names of its fields.

    Raises:
        InvalidRequest: names every unknown field and every value of a wrong kind.
    """
    violations: list[Violation] = []
    _fill(message, values, path, violations)
    if violations:
        raise InvalidRequest.of(violations)


def _fill(message: Message, values: Any, path: str, violations: list[Violation]) -> None:
    if isinstance(values, type(message)):
        message.CopyFrom(values)
        return
    if not isinstance(values, Mapping):
        violations.append(Violation(path or "scene", f"= {shown(values)}: must be a dictionary"))
        return
    try:
        values = unpacked(message.DESCRIPTOR.name, values, path, violations)
    except InvalidRequest as error:
        violations += error.violations
        return
    # An empty dictionary sets the message as well.
    message.SetInParent()
    fields = message.DESCRIPTOR.fields_by_name
    for name, value in values.items():
        where = f"{path}.{name}" if path else name
        if name not in fields:
            violations.append(Violation(where, f"is unknown{_suggestion(str(name), fields)}"))
        elif value is not None:
            _fill_field(message, fields[name], value, where, violations)


def _fill_field(
    message: Message, field: descriptors.FieldDescriptor, value: Any, path: str, violations: list[Violation]
) -> None:
    oneof = field.containing_oneof
    already = message.WhichOneof(oneof.name) if oneof is not None else None
    if already not in (None, field.name):
        violations.append(Violation(path, f"is set together with {already}: must not be"))
    elif field.label == _Field.LABEL_REPEATED:
        entries = getattr(message, field.name)
        is_column = isinstance(value, np.ndarray) and value.dtype == np.float64 and value.ndim == 1
        if is_column and field.type == _Field.TYPE_DOUBLE:
            entries.extend(value.tolist())
            return
        for i, entry in enumerate(value if is_list(value) else [value]):
            if field.type == _Field.TYPE_MESSAGE:
                _fill(entries.add(), entry, f"{path}[{i}]", violations)
            else:
                _set(entries.append, field, entry, f"{path}[{i}]", violations)
    elif field.type == _Field.TYPE_MESSAGE:
        _fill(getattr(message, field.name), value, path, violations)
    else:
        _set(lambda number: setattr(message, field.name, number), field, value, path, violations)


def _set(store: Any, field: descriptors.FieldDescriptor, value: Any, path: str, violations: list[Violation]) -> None:
    try:
        store(_scalar(field, value, path))
    except InvalidRequest as error:
        violations.extend(error.violations)
    except (TypeError, ValueError):
        violations.append(Violation(path, f"= {shown(value)}: must be {_kind(field)}"))


def _scalar(field: descriptors.FieldDescriptor, value: Any, path: str) -> Any:
    if field.type == _Field.TYPE_DOUBLE:
        return number(value, path)
    found = plain(value)
    if field.type == _Field.TYPE_ENUM and isinstance(found, str):
        return enum_number(field.enum_type, found, path)
    # True and 1.0 are not taken for whole numbers, and 1 is not taken for True.
    wanted: Any = numbers.Integral if field.type in _INTEGERS else bool if field.type == _Field.TYPE_BOOL else str
    if not isinstance(found, wanted) or (isinstance(found, bool) and wanted is not bool):
        raise TypeError
    return found


def _kind(field: descriptors.FieldDescriptor) -> str:
    if field.type in _INTEGERS:
        return f"a whole number below 2^{_INTEGERS[field.type]}"
    return {_Field.TYPE_BOOL: "True or False", _Field.TYPE_STRING: "a text"}.get(field.type, "the name of a value")


# The arguments of Python whose field is called otherwise.
_FIELDS = {
    "tolerance": "relative_tolerance",
    "require": "required",
    "exclude": "excluded",
    "strict": "inadmissible_is_error",
    "history": "history_intervals",
    "force_history": "force_intervals",
    "certified": "certified_digits",
}


def fill(request: Message, scene: Any, **arguments: Any) -> None:
    """Fills a request from a scene and from arguments by their Python names; None leaves a field unset.

    Raises:
        InvalidRequest: names everything that is wrong.
    """
    violations: list[Violation] = []
    _fill(getattr(request, "scene"), scene, "", violations)
    for name, value in arguments.items():
        field = request.DESCRIPTOR.fields_by_name[_FIELDS.get(name, name)]
        if field.type != _Field.TYPE_ENUM:
            if value is not None:
                _fill_field(request, field, value, name, violations)
            continue
        try:
            effects = [enum_number(field.enum_type, text, name) for text in names(value, name)]
            getattr(request, field.name).extend(effects)
        except InvalidRequest as error:
            violations += error.violations
    if violations:
        raise InvalidRequest.of(violations)


def read_scene(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Reads a scene from a file that ``ricochet --scene`` takes: JSON or the text format of protobuf.

    Returns:
        The scene as a dictionary, with only what the file sets.

    Raises:
        InvalidRequest: the file is no scene.
        OSError: the file cannot be read.
    """
    with open(path, encoding="utf-8") as file:
        text = file.read()
    scene = scene_pb2.Scene()
    try:
        if text.lstrip().startswith("{"):
            json_format.Parse(text, scene)
        else:
            text_format.Parse(text, scene)
    except (json_format.ParseError, text_format.ParseError) as error:
        raise InvalidRequest.of([Violation(os.fspath(path), f"is not a scene: {error}")]) from None
    return dict(json_format.MessageToDict(scene, preserving_proto_field_name=True))

"""Names: the paths of fields and columns in full, from the short names that the command line takes, too.

A short name is the end of a path, with or without its unit: "newton" for "coefficients.newton", "links[1].theta" for
"linkage.links[1].theta_rad", "mu" for "friction.kinetic_coefficient".
"""

from __future__ import annotations

import difflib
from typing import Any, Collection, Iterable, Mapping

from google.protobuf import descriptor as descriptors
from google.protobuf.message import Message

from ricochet.errors import InvalidRequest, Violation
from ricochet.units import without_unit
from ricochet.v1 import outcome_pb2

_Field = descriptors.FieldDescriptor

# Letters of the paper whose field is called otherwise; the command line has the same (a test compares them).
_LETTERS = {
    "mu": "friction.kinetic_coefficient",
    "mu_static": "friction.static_coefficient",
    "omega": "pendulum.omega_minus_rad_s",
}
# The parts of an outcome whose numbers are columns; there are others with numbers of the same names.
_COLUMNS = (
    "coefficients rates_after_rad_s contact_velocity_after impulse work energy_change_j bodies_after rates_after "
    "momentum_change effective accuracy contact errors").split()


def fields_of(scene: Message) -> list[str]:
    """Returns the paths of the numbers of a scene, and of those that an axis may add to it."""
    paths = _paths(scene, "", {"surface_velocity.tangential_m_s": _tangential_directions(scene)})
    rates = len(scene.mechanism.rates)
    # An entry of a mass matrix beside the diagonal drives the one across it.
    lower = {f"mechanism.mass_matrix[{i * rates + j}]" for i in range(rates) for j in range(i)}
    paths = [path for path in paths if path not in lower]
    return paths + (["pendulum.phi_rad"] if scene.HasField("pendulum") else [])


def columns_of(scene: Message) -> list[str]:
    """Returns the paths of the numbers of an outcome, whose lists are as long as the system of the scene makes them."""
    tangential = _tangential_directions(scene)
    system = scene.WhichOneof("system")
    bodies = {"planar_body": 1, "spatial_body": 1, "body_pair": 2}.get(system, 0)
    rates = len(scene.linkage.links) if system == "linkage" else int(system == "pendulum")
    angular = 1 if tangential == 1 else 3
    lengths = {"rates_after_rad_s": rates, "bodies_after": bodies}
    for path in ("rates_after", "momentum_change", "errors.rates_after", "errors.momentum_change"):
        lengths[path] = len(scene.mechanism.rates)
    for path in ("contact_velocity_after.tangential_m_s", "impulse.tangential_n_s"):
        lengths[path] = tangential
    for i in range(bodies):
        lengths.update({f"bodies_after[{i}].linear_m_s": tangential + 1, f"bodies_after[{i}].angular_rad_s": angular})
    paths = _paths(outcome_pb2.Outcome(), "", lengths)
    return [path for path in paths if path.replace("[", ".").split(".")[0] in _COLUMNS]


def _tangential_directions(scene: Message) -> int:
    system = scene.WhichOneof("system") or ""
    is_spatial = system.startswith("spatial") or (system == "body_pair" and scene.body_pair.HasField("spatial"))
    if system == "mechanism":
        is_spatial = len(scene.mechanism.jacobian) == 3 * len(scene.mechanism.rates)
    return 2 if is_spatial else 1


def _paths(message: Message, path: str, lengths: Mapping[str, int]) -> list[str]:
    """Returns the paths of the numbers of a message; `lengths` says how long its empty lists are meant to be."""
    paths: list[str] = []
    for field in message.DESCRIPTOR.fields:
        where = f"{path}{field.name}"
        places = [where]
        value = getattr(message, field.name)
        if field.label == _Field.LABEL_REPEATED:
            places = [f"{where}[{i}]" for i in range(len(value) or lengths.get(where, 0))]
            value = value[0] if len(value) else field.message_type and _new(field.message_type)
        # One of several alternatives is there only if it is set.
        elif field.type == _Field.TYPE_MESSAGE and field.containing_oneof and not message.HasField(field.name):
            continue
        if field.type == _Field.TYPE_DOUBLE:
            paths += places
        elif field.type == _Field.TYPE_MESSAGE:
            paths += [found for place in places for found in _paths(value, f"{place}.", lengths)]
    return paths


def _new(descriptor: descriptors.Descriptor) -> Message:
    made: Message = descriptor._concrete_class()
    return made


def meanings(name: str, known: Collection[str]) -> list[str]:
    """Returns the paths that a name can mean."""
    for whole in (name, _LETTERS.get(name, name)):
        if whole in known:
            return [whole]
    return [path for path in known if _ends_in(path, name) or _ends_in(without_unit(path), name)]


def _ends_in(path: str, name: str) -> bool:
    # An error has the name of its number, which is what the name alone means.
    return path == name or (path.endswith(f".{name}") and not path.startswith("errors."))


def full_names(given: Iterable[str], known: list[str], what: str) -> list[str]:
    """Returns the paths that names mean; a name that means nothing stays as it is, for the server to refuse.

    Raises:
        InvalidRequest: a name means several paths, or is nearly the end of one.
    """
    violations: list[Violation] = []
    full = [_full_name(name, known, what, violations) for name in given]
    if violations:
        raise InvalidRequest.of(violations)
    return full


def _full_name(name: str, known: list[str], what: str, violations: list[Violation]) -> str:
    meant = meanings(name, known)
    if len(meant) == 1:
        return meant[0]
    if meant:
        violations.append(Violation(what, f"= {name!r}: must name one of {', '.join(meant)}"))
    elif "." not in name:
        ends = {without_unit(path).rpartition(".")[2]: path for path in reversed(known)}
        near = difflib.get_close_matches(name, ends, n=1)
        hint = f"; did you mean {ends[near[0]]}?" if near else ""
        violations.append(Violation(what, f"= {name!r}: must be the path of a number, or its end{hint}"))
    return name


def by_full_name(values: Any, known: list[str], what: str) -> dict[str, Any]:
    """Returns a dictionary, or a pandas frame, by the full names of its keys."""
    if not hasattr(values, "keys"):
        raise InvalidRequest.of([Violation(what, "must be a dictionary or a pandas frame")])
    keys = list(values.keys())
    if not all(isinstance(key, str) for key in keys):
        raise InvalidRequest.of([Violation(what, "must have texts for its names")])
    full = full_names(keys, known, what)
    twice = [f"= {key!r}: is {name} a second time" for i, (key, name) in enumerate(zip(keys, full)) if name in full[:i]]
    if twice:
        raise InvalidRequest.of([Violation(what, text) for text in twice])
    return {name: values[key] for key, name in zip(keys, full)}

"""Fuzzes the messages that the Python package reads: answers to sweeps, batches, audits and info, one number, list or
chunk of which is wrong.

It checks that a call gives the columns, regimes and statuses of the right answer, or raises RicochetError: no answer that
is not whole becomes a table, and no other exception comes out. It covers python/ricochet/client.py.

usage: python_messages.py [--inputs N | --seconds S] [--seed SEED]
"""

import argparse
import collections
import random
import sys
import time
from unittest import mock

import numpy as np

import ricochet
from ricochet import client as package
from ricochet.v1 import audit_pb2, batch_pb2, impact_service_pb2, info_pb2, sweep_pb2

SCENE = {
    "pendulum": {"inertia_kg_m2": 1, "a_m": 0.3, "b_m": 1, "omega_minus_rad_s": -1},
    "friction": {"kinetic_coefficient": 0.1},
    "restitution": {"energetic": 1},
}
COLUMNS = ["coefficients.newton", "energy_change_j"]
POINTS, PIECE, MOST_ROWS = 12, 4, 5
VALUES = np.arange(len(COLUMNS) * POINTS, dtype="<f8").reshape(len(COLUMNS), POINTS) + 0.5
REGIMES = bytes(3 + i % 4 for i in range(POINTS))
STATUSES = bytes(1 + i % 2 for i in range(POINTS))


def chunks():
    """The stream of a sweep."""
    for first in range(0, POINTS, PIECE):
        part = slice(first, first + PIECE)
        chunk = sweep_pb2.SweepResponse(
            first_index=first, count=PIECE, values=VALUES[:, part].tobytes(), regimes=REGIMES[part],
            statuses=STATUSES[part], points_total=POINTS, grid_fingerprint="grid")
        chunk.engine.fingerprint = "engine"
        if first + PIECE == POINTS:
            chunk.summary.points = POINTS
        yield chunk


def batch_answer(request):
    """The answer to some rows of a batch, whose first column is the row's number."""
    rows = np.frombuffer(request.inputs[0], "<f8").astype(int)
    answer = batch_pb2.SolveBatchResponse(
        outputs=[VALUES[i, rows].tobytes() for i in range(len(COLUMNS))], regimes=bytes(REGIMES[i] for i in rows),
        statuses=bytes(STATUSES[i] for i in rows))
    answer.summary.counts.points = len(rows)
    return answer


def audit_answer(request):
    """The answer to some rows of an audit, whose first column is the row's number."""
    answer = impact_service_pb2.AuditBatchResponse()
    for row in request.columns.normal_after_m_s:
        report = answer.reports.add()
        report.regime = REGIMES[int(row)]
        report.energy_change_j = VALUES[0, int(row)]
    answer.summary.rows = len(answer.reports)
    answer.summary.invalid.SetInParent()
    return answer


def info_answer():
    answer = info_pb2.InfoResponse()
    answer.limits.max_batch_numbers = 2 * MOST_ROWS
    answer.limits.max_audit_rows = MOST_ROWS
    return answer


class Damage:
    """Changes messages by chance; at most one of those that a call receives."""

    def __init__(self, chance):
        self.chance = chance
        self.left = 1

    def number(self, old):
        return self.chance.choice([0, 1, -1, old + 1, old - 1, 2 * old, 2**31, 2**62, -(2**62)])

    def bytes(self, old):
        place = self.chance.randrange(len(old) + 1)
        return self.chance.choice([b"", old[:1], old[:8], old[:place], old + old, old + b"\0", old[8:]])

    def field(self, message):
        """Changes a field of the message or of one in it. The values of a number or a byte that can be right stay: they
        are the answer."""
        fields = [
            field for field in message.DESCRIPTOR.fields
            if field.name not in ("energy_change_j", "crc32c", "tallies", "summary", "engine", "grid_fingerprint")]
        field = self.chance.choice(fields)
        old = getattr(message, field.name)
        if field.label == field.LABEL_REPEATED:
            self.repeated(field, old)
        elif field.type == field.TYPE_MESSAGE:
            self.field(old)
        elif field.type == field.TYPE_BYTES:
            setattr(message, field.name, self.bytes(old))
        elif field.type in (field.TYPE_INT64, field.TYPE_INT32):
            try:
                setattr(message, field.name, self.number(old))
            except ValueError:
                setattr(message, field.name, -1)

    def repeated(self, field, entries):
        how = self.chance.randrange(3)
        if how == 0:
            del entries[self.chance.randrange(len(entries) + 1):]
        elif field.type == field.TYPE_BYTES:
            if how == 1 or not entries:
                entries.append(b"\0" * 8)
            else:
                place = self.chance.randrange(len(entries))
                entries[place] = self.bytes(entries[place])
        elif field.type == field.TYPE_MESSAGE:
            entries.add()

    def message(self, message):
        if self.left and self.chance.random() < 0.5:
            self.left = 0
            self.field(message)
        return message

    def stream(self, messages):
        messages = list(messages)
        place = self.chance.randrange(len(messages))
        how = self.chance.randrange(6)
        if how == 0:
            del messages[place]
        elif how == 1:
            messages.insert(place, messages[place])
        elif how == 2:
            self.chance.shuffle(messages)
        elif how == 3:
            messages[place].ClearField("summary")
        else:
            self.field(messages[place])
        return messages


class Stream:
    """What gRPC gives for a call with many answers."""

    def __init__(self, messages):
        self._messages = iter(messages)

    def __iter__(self):
        return self

    def __next__(self):
        return next(self._messages)

    def cancel(self):
        pass


class Stub:
    """A server whose answers are damaged."""

    def __init__(self, damage):
        self.damage = damage

    def Sweep(self, request, **_):
        return Stream(self.damage.stream(list(chunks())))

    def SolveBatch(self, request, **_):
        return self.damage.message(batch_answer(request))

    def AuditBatch(self, request, **_):
        return self.damage.message(audit_answer(request))

    def Info(self, request, **_):
        return self.damage.message(info_answer())


def sweep(client):
    table = client.sweep(SCENE, {"friction.kinetic_coefficient": ricochet.Linspace(0, 1, POINTS)}, COLUMNS)
    return [table[name] for name in COLUMNS], table.codes["regime"], table.codes["status"]


def solve_batch(client):
    table = client.solve_batch(SCENE, {"pendulum.a_m": np.arange(POINTS)}, COLUMNS)
    return [table[name] for name in COLUMNS], table.codes["regime"], table.codes["status"]


def audit_batch(client):
    table = client.audit_batch(SCENE, {"normal_after_m_s": np.arange(POINTS)})
    return [table["energy_change_j"]], table.codes["regime"], None


def is_right(answer):
    """Whether the answer has what the server meant."""
    columns, regimes, statuses = answer
    numbers = all(np.array_equal(column, VALUES[i]) for i, column in enumerate(columns))
    codes = bytes(regimes.numbers) == REGIMES and (statuses is None or bytes(statuses.numbers) == STATUSES)
    regimes.counts()
    return numbers and codes


def run(seed):
    """One call with a damaged answer. Returns what came out: "answer" or "refusal"."""
    chance = random.Random(seed)
    call = chance.choice([sweep, solve_batch, audit_batch])
    stub = Stub(Damage(chance))
    with mock.patch.object(package.Client, "_ask", lambda self, ask: ask(stub)):
        client = ricochet.Client(server="127.0.0.1:1")
        try:
            right = is_right(call(client))
        except ricochet.RicochetError:
            return "refusal"
        except Exception as error:
            raise AssertionError(f"--seed {seed} --inputs 1: {call.__name__} raises {error!r}") from error
    if not right:
        raise AssertionError(f"--seed {seed} --inputs 1: {call.__name__} takes a wrong answer")
    return "answer"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--inputs", type=int)
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    if options.inputs is None and options.seconds is None:
        options.inputs = 2000
    end = time.monotonic() + (options.seconds or 0)
    seed = options.seed
    outcomes = collections.Counter()
    while seed < options.seed + options.inputs if options.inputs is not None else time.monotonic() < end:
        outcomes[run(seed)] += 1
        seed += 1
    print(f"{sum(outcomes.values())} answers: {outcomes['answer']} taken, {outcomes['refusal']} refused")
    # A test of which nothing goes either way tests nothing.
    sys.exit(0 if min(outcomes["answer"], outcomes["refusal"]) > 0 or options.inputs == 1 else 1)


if __name__ == "__main__":
    main()

"""Fuzzes the messages that the Python package reads: answers of a server to batches, audits and info, one number or
list of which is wrong. Those to sweeps are fuzzed by chunks_fuzz.cc.

It checks that a call gives the columns, regimes and statuses of the right answer, or raises RicochetError: no answer that
is not whole becomes a table, and no other exception comes out. It covers python/ricochet/client.py and python/module.

usage: python_messages.py [--inputs N | --seconds S] [--seed SEED]
"""

import argparse
import collections
import concurrent.futures
import random
import sys
import time

import grpc
import numpy as np

import ricochet
from ricochet.v1 import batch_pb2, impact_service_pb2, impact_service_pb2_grpc, info_pb2

SCENE = {
    "pendulum": {"inertia_kg_m2": 1, "a_m": 0.3, "b_m": 1, "omega_minus_rad_s": -1},
    "friction": {"kinetic_coefficient": 0.1},
    "restitution": {"energetic": 1},
}
COLUMNS = ["coefficients.newton", "energy_change_j"]
POINTS, MOST_ROWS = 12, 5
VALUES = np.arange(len(COLUMNS) * POINTS, dtype="<f8").reshape(len(COLUMNS), POINTS) + 0.5
REGIMES = bytes(3 + i % 4 for i in range(POINTS))
STATUSES = bytes(1 + i % 2 for i in range(POINTS))


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
            if field.name not in ("energy_change_j", "summary", "engine")]
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


class Service(impact_service_pb2_grpc.ImpactServiceServicer):
    """A server whose answers are damaged."""

    damage = None

    def SolveBatch(self, request, context):
        return self.damage.message(batch_answer(request))

    def AuditBatch(self, request, context):
        return self.damage.message(audit_answer(request))

    def Info(self, request, context):
        return self.damage.message(info_answer())


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


def run(service, address, seed):
    """One call with a damaged answer. Returns what came out: "answer" or "refusal"."""
    chance = random.Random(seed)
    call = chance.choice([solve_batch, audit_batch])
    service.damage = Damage(chance)
    with ricochet.Client(address) as client:
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
    service = Service()
    server = grpc.server(concurrent.futures.ThreadPoolExecutor(2))
    impact_service_pb2_grpc.add_ImpactServiceServicer_to_server(service, server)
    address = f"127.0.0.1:{server.add_insecure_port('127.0.0.1:0')}"
    server.start()
    end = time.monotonic() + (options.seconds or 0)
    seed = options.seed
    outcomes = collections.Counter()
    while seed < options.seed + options.inputs if options.inputs is not None else time.monotonic() < end:
        outcomes[run(service, address, seed)] += 1
        seed += 1
    print(f"{sum(outcomes.values())} answers: {outcomes['answer']} taken, {outcomes['refusal']} refused")
    # A test of which nothing goes either way tests nothing.
    sys.exit(0 if min(outcomes["answer"], outcomes["refusal"]) > 0 or options.inputs == 1 else 1)


if __name__ == "__main__":
    main()

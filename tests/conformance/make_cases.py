#!/usr/bin/python3
"""Makes conformance/impacts.json: impacts with their right answers by each law, to 17 digits.

make_cases.py RICOCHET           writes conformance/impacts.json anew. It refuses to change a digit of a version that
                                 conformance/versions.txt has on record: raise VERSION first.
make_cases.py RICOCHET --check   compares instead, and fails if a byte differs.

The answers come from arbitrary precision (exact_impacts.py), those of several contacts on springs from the core with the
bound that it proves. It needs mpmath (Debian: python3-mpmath).
"""

import hashlib
import json
import os
import re
import sys

import core_answers
import scenes
from exact_impacts import LAWS, follow, mpf, orders, solve_linear, times
from mpmath import mp, nstr

VERSION = 3
FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'conformance')
FILE, VERSIONS = os.path.join(FOLDER, 'impacts.json'), os.path.join(FOLDER, 'versions.txt')
DIGITS = 17
NOTHING = mpf(10) ** -40  # Results below this are exact zeros with rounding.
MOST_IMPACTS = 12  # Orders that take more are left out.


def exact(matrix):
    return [[mpf(x) for x in row] for row in matrix]


class Case:
    """A case with its W and velocities in arbitrary precision."""

    def __init__(self, data):
        self.data = data
        self.mass, self.jacobian = exact(data['mass_matrix']), exact(data['jacobian'])
        self.before = [mpf(x) for x in data['velocity_before']]
        self.frame = [mpf(x) for x in data.get('frame_velocity', [0] * len(self.before))]
        self.contacts = [(mpf(c['friction']), mpf(c['coefficient'])) for c in data['contacts']]
        self.dimension = len(self.jacobian) // len(self.contacts)
        self.columns = [solve_linear(self.mass, row) for row in self.jacobian]  # The columns of M^-1 J^T.
        self.w = [[sum(a * b for a, b in zip(row, column)) for column in self.columns] for row in self.jacobian]
        self.velocity = times(self.jacobian, [q - f for q, f in zip(self.before, self.frame)])

    def after(self, impulse):
        return [q + sum(column[i] * p for column, p in zip(self.columns, impulse)) for i, q in enumerate(self.before)]

    def energy(self, rates):
        moving = [q - f for q, f in zip(rates, self.frame)]
        return sum(q * p for q, p in zip(moving, times(self.mass, moving))) / 2

    def answer(self, law, impulse, **rest):
        after = self.after(impulse)
        moving = [q - f for q, f in zip(after, self.frame)]
        return {'law': law, 'velocity_after': after, 'contact_velocity_after': times(self.jacobian, moving), **rest,
                'impulse_n_s': list(impulse), 'energy_change_j': self.energy(after) - self.energy(self.before)}


def single_answers(case):
    """The answers of one contact by the three laws, and the regime of the energetic one."""
    found = []
    for law in LAWS:
        end = follow(case.w, case.velocity, *case.contacts[0][:1], law, case.contacts[0][1])
        if end is None:
            found.append(case.answer(law, [mpf(0)] * len(case.velocity), regime='separating', admissible=True))
            continue
        answer = case.answer(law, end['impulse'], regime=end['regime'])
        energetic = end['coefficients'][2]
        answer['admissible'] = bool(energetic <= 1 + NOTHING and answer['energy_change_j'] <= NOTHING)
        answer['normal_compression_n_s'] = end['normal_compression_n_s']
        works = ('normal_compression_j', 'normal_restitution_j', 'tangential_compression_j', 'tangential_restitution_j')
        answer['works'] = dict(zip(works, end['works']))
        answer['coefficients'] = dict(zip(LAWS, end['coefficients']))
        answer['events'] = [{'kind': kind, 'normal_impulse_n_s': tau} for kind, tau in end['events']]
        found.append(answer)
    return found


def differs(first, second):
    return max(abs(x - y) for x, y in zip(first['velocity_after'], second['velocity_after']))


def several_answers(case, core):
    """The outcomes of all orders that end, and of springs of equal stiffness where the core bounds their errors."""
    found = []
    for hit, _, impulse in orders(case.w, case.velocity, case.contacts, MOST_IMPACTS):
        answer = case.answer('order ' + '-'.join(map(str, hit)), impulse)
        same = next((a for a in found if differs(a, answer) < NOTHING), None)
        if same:
            same.setdefault('also', []).append(answer['law'])
        else:
            found.append(answer)
    springs = core_answers.springs(core)
    if springs:
        rates, impulse = ([mpf(x) for x in springs[name]] for name in ('velocity', 'impulse_n_s'))
        answer = {**case.answer('springs', impulse), 'velocity_after': rates, 'error': max(springs['velocity_error'])}
        same = next((a for a in found if differs(a, answer) < 10 * answer['error']), None)
        if same:
            same.setdefault('also', []).append('springs')
        else:
            found.append(answer)
    return found


def check_symmetry(case):
    """A symmetry maps the masses and the velocity before to themselves. -3 stands for minus the third coordinate."""
    for symmetry in case.data.get('symmetries', []):
        signs, places = [1 if i > 0 else -1 for i in symmetry], [abs(i) - 1 for i in symmetry]
        assert [s * case.before[i] for s, i in zip(signs, places)] == case.before, case.data['name']
        image = [[s * t * case.mass[i][j] for t, j in zip(signs, places)] for s, i in zip(signs, places)]
        assert image == case.mass, case.data['name']


def text_of(value):
    """17 significant digits that read back as the double nearest to the number."""
    return '0' if abs(value) < NOTHING else re.sub(r'\.0$', '', nstr(value, DIGITS, strip_zeros=True))


def largest_error(values):
    """How far the printed numbers lie from the exact ones at most, rounded up to two digits."""
    with mp.workdps(60):
        error = max(abs(mpf(text_of(x)) - x) for x in values)
        return 0 if error < NOTHING else float(nstr(error * mpf('1.05'), 2))


def written(value, indent):
    """JSON in which lists of numbers stand on one line."""
    space = ' ' * indent
    if isinstance(value, mpf):
        return text_of(value)
    if isinstance(value, dict):
        flat = indent > 3 and len(value) <= 4 and not any(isinstance(x, (dict, list)) for x in value.values())
        parts = [json.dumps(key) + ': ' + written(x, indent + 1) for key, x in value.items()]
        return '{' + ', '.join(parts) + '}' if flat else '{\n' + ',\n'.join(space + ' ' + p for p in parts) + '\n' + space + '}'
    if isinstance(value, list):
        parts = [written(x, indent + 1) for x in value]
        flat = not any('\n' in p for p in parts) and not any(isinstance(x, dict) for x in value)
        return '[' + ', '.join(parts) + ']' if flat else '[\n' + ',\n'.join(space + ' ' + p for p in parts) + '\n' + space + ']'
    return json.dumps(int(value) if isinstance(value, float) and value == int(value) and abs(value) < 1e15 else value)


def finished(data, ricochet):
    case = Case(data)
    check_symmetry(case)
    core = core_answers.several(ricochet, data) if len(case.contacts) > 1 else None
    answers = several_answers(case, core) if core else single_answers(case)
    for answer in answers:
        answer.setdefault('error', largest_error(answer['velocity_after']))
    entry = {key: data[key] for key in ('name', 'family', 'shows', 'source')}
    entry['dimension'] = case.dimension
    for key in ('bodies', 'contacts'):
        if key in data:
            entry[key] = data[key]
    entry['coordinates'] = data['coordinates']
    for key in ('mass_matrix', 'jacobian', 'velocity_before', 'frame_velocity', 'symmetries'):
        if key in data:
            entry[key] = data[key]
    entry['delassus'], entry['contact_velocity_before'] = case.w, case.velocity
    entry['answers'] = answers
    if core:
        entry['possible'] = core_answers.possible(core, len(case.before))
    return entry


HEAD = {
    'title': 'Impacts with friction and restitution, and their right answers',
    'version': VERSION,
    'fingerprint': '',
    'units': 'SI units and radians. The numbers of a contact stand in the order t, n in a plane and t1, t2, n in space. '
             'mass_matrix, jacobian and velocity_before are the doubles nearest to the decimals and are exact; answers are '
             'theirs. Springs at several contacts are equally stiff; possible bounds each number after for every law that takes '
             'energy. error bounds what each number of velocity_after is away from the exact one.',
}


def fingerprint(text):
    """SHA-256 of the file in which the fingerprint itself is empty."""
    return hashlib.sha256(re.sub(r'"fingerprint": "[0-9a-f]*"', '"fingerprint": ""', text).encode()).hexdigest()


def made(ricochet):
    text = written({**HEAD, 'cases': [finished(data, ricochet) for data in scenes.cases()]}, 0) + '\n'
    return text.replace('"fingerprint": ""', f'"fingerprint": "{fingerprint(text)}"')


def recorded():
    with open(VERSIONS, encoding='utf-8') as file:
        return dict(line.split() for line in file if not line.startswith('#'))


def main():
    ricochet, check = sys.argv[1], sys.argv[2:] == ['--check']
    text = made(ricochet)
    known, new = recorded().get(str(VERSION)), fingerprint(text)
    if known not in (None, new):
        sys.exit(f'version {VERSION} has the fingerprint {known}, these cases have {new}: must raise VERSION in make_cases.py')
    if check:
        with open(FILE, encoding='utf-8') as file:
            if file.read() != text:
                sys.exit(f'{FILE} differs from what make_cases.py makes')
        print(f'version {VERSION}: as made')
        return
    with open(FILE, 'w', encoding='utf-8') as file:
        file.write(text)
    if known is None:
        with open(VERSIONS, 'a', encoding='utf-8') as file:
            file.write(f'{VERSION} {new}\n')


if __name__ == '__main__':
    main()

#!/usr/bin/env python3
"""Grades the answers of a simulator to the conformance cases, as `ricochet conformance grade` does, without ricochet.

usage: grade.py ANSWERS [--tolerance X] [--law newton|poisson|energetic] [--family NAME]... [--case NAME]... [--json]

ANSWERS is JSON or CSV (docs/conformance.md, answers.schema.json). The cases are those of impacts.json beside this file.
It needs Python 3 and NumPy. Exit codes: 0 all cases are right, 2 wrong input, 42 some are not.
"""

import argparse
import difflib
import hashlib
import itertools
import json
import math
import os
import re
import sys

try:
    import numpy as np
except ImportError:
    print('grade.py: needs NumPy, which this Python does not have', file=sys.stderr)
    sys.exit(2)

BLANKS = ' \t\r\v\f'
LAWS = ('newton', 'poisson', 'energetic')
LIMITS = ('energy', 'approach', 'cone', 'symmetry')
ROUNDING = 2.0 ** -46
DEPENDENT = 3e-7  # Columns whose singular values are below this share of the largest are taken for dependent.


def refuse(message):
    print(f'grade.py: {message}', file=sys.stderr)
    sys.exit(2)


class Case:
    def __init__(self, data):
        self.name, self.family, self.coordinates = data['name'], data['family'], data['coordinates']
        self.dimension = data['dimension']
        self.friction = [contact['friction'] for contact in data['contacts']]
        self.mass, self.jacobian = np.array(data['mass_matrix'], float), np.array(data['jacobian'], float)
        self.before = np.array(data['velocity_before'], float)
        self.frame = np.array(data.get('frame_velocity', np.zeros(len(self.before))), float)
        self.symmetries = data.get('symmetries', [])
        self.answers = [(a['law'], a.get('also', []), np.array(a['velocity_after'], float)) for a in data['answers']]


def read_cases():
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), 'impacts.json'), encoding='utf-8') as file:
        text = file.read()
    whole = json.loads(text)
    empty = re.sub(r'"fingerprint": "[0-9a-f]*"', '"fingerprint": ""', text)
    if hashlib.sha256(empty.encode()).hexdigest() != whole['fingerprint']:
        refuse('impacts.json was changed: its fingerprint does not fit')
    return whole, {data['name']: Case(data) for data in whole['cases']}


# --- The answers ---


def add_answer(where, name, law, velocity, cases, answers):
    if not isinstance(name, str) or not isinstance(law, str):
        refuse(f'{where}: the case and the law must be texts')
    if name not in cases:
        near = difflib.get_close_matches(name, cases, 1)
        hint = f'; did you mean {near[0]}?' if near else ''
        refuse(f'{where}.case = {name}: must be a case of impacts.json{hint}')
    if law and law not in LAWS:
        refuse(f'{where}.law = {law}: must be {", ".join(LAWS)}')
    if name in answers:
        refuse(f'{where}.case = {name}: must not be answered twice')
    names = cases[name].coordinates
    if len(velocity) != len(names):
        rule = f'must have {len(names)}, {", ".join(names)}'
        refuse(f'{where}.velocity_after of {name} has {len(velocity)} numbers: {rule}')
    if not all(abs(x) < 1e100 for x in velocity):  # Below neither energies nor impulses overflow.
        rule = 'must have numbers of a size below 1e100; leave out a case without any'
        refuse(f'{where}.velocity_after of {name}: {rule}')
    answers[name] = (law, np.array(velocity, float))


def known_keys(entry, where, known):
    for key in entry:
        if key not in known:
            refuse(f'{where}.{key}: is unknown; must be {", ".join(known)}')


def object_of(pairs):
    """An object of JSON, whose keys must differ."""
    keys = [key for key, _ in pairs]
    for key in keys:
        if keys.count(key) > 1:
            raise ValueError(f'{key} is given twice')
    return dict(pairs)


def no_constant(name):
    raise ValueError(f'{name} is no number of JSON')


def read_json(text, path, cases):
    try:
        whole = json.loads(text, object_pairs_hook=object_of, parse_int=float, parse_constant=no_constant)
        json.dumps(whole, ensure_ascii=False).encode()  # Half of a surrogate pair is no text.
    except (ValueError, RecursionError) as error:
        refuse(f'{path} is not JSON: {error}; is it whole?')
    if not isinstance(whole, dict):
        refuse(f'{path}: must be an object')
    known_keys(whole, path, ('simulator', 'law', 'answers'))
    if not isinstance(whole.get('simulator', ''), str):
        refuse(f'{path}.simulator: must be a text')
    if not isinstance(whole.get('answers'), list):
        refuse(f'{path}.answers: must be a list')
    general = whole.get('law', '')
    if not isinstance(general, str) or (general and general not in LAWS):
        refuse(f'{path}.law = {general}: must be {", ".join(LAWS)}')
    answers = {}
    for i, entry in enumerate(whole['answers']):
        if not isinstance(entry, dict):
            refuse(f'answers[{i}]: must be an object')
        known_keys(entry, f'answers[{i}]', ('case', 'law', 'velocity_after'))
        velocity = entry.get('velocity_after')
        if not isinstance(velocity, list) or not all(isinstance(x, float) for x in velocity):
            refuse(f'answers[{i}].velocity_after: must be a list of numbers')
        law = entry.get('law', '')
        add_answer(f'answers[{i}]', entry.get('case', ''), general if law == '' else law, velocity, cases, answers)
    return whole.get('simulator', ''), answers


def number(text):
    """A number as ricochet reads it: a decimal, or a fraction of two."""
    parts = text.split('/')
    decimal = re.compile(r'[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)(e[+-]?[0-9]+)?', re.IGNORECASE)
    if len(parts) > 2 or not all(decimal.fullmatch(part) for part in parts):
        raise ValueError(f'{text} must be a number such as 0.1 or 1e-3, or a fraction such as 1/3')
    numbers = [float(x) for x in parts]
    if len(numbers) == 2 and re.fullmatch('[+-]?[0.]*', re.split('e', parts[1], flags=re.IGNORECASE)[0]):
        raise ValueError(f'{text} must have a denominator other than 0')
    numbers.append(numbers[0] / (numbers[1] or math.nan) if len(numbers) == 2 else numbers[0])
    for x, value in zip([*parts, parts[0]], numbers):
        if not math.isfinite(value) or value == 0 and re.search('[1-9]', re.split('e', x, flags=re.IGNORECASE)[0]):
            raise ValueError(f'{text} must be 0, or a number of a size from 4.95e-324 to 1.7976931348623157e+308')
    return numbers[-1]


def cells_of(line):
    """The cells between the commas of a line, except those within quotes, without blanks and quotes around them."""
    for cell in re.findall(r'(?:^|,)((?:"[^"]*"|[^",])*)', line):
        cell = cell.strip(BLANKS)
        quoted = len(cell) > 1 and cell[0] == cell[-1] == '"'
        yield cell[1:-1].replace('""', '"').strip(BLANKS) if quoted else cell


def read_csv(text, path, cases):
    lines = {place: line.strip(BLANKS) for place, line in enumerate(text.split('\n'), 1)}
    lines = {place: line for place, line in lines.items() if line and line[0] != '#'}
    for line in lines.values():
        if line.count('"') % 2:
            refuse(f'{path}: {line} begins a cell in quotes that does not end')
    for separator, name in ((';', 'semicolons'), ('\t', 'tabs')):
        if separator in next(iter(lines.values()), ''):
            refuse(f'{path} separates its columns by {name}: must use commas')
    rows = [list(cells_of(line)) for line in lines.values()]
    header = rows[0] if rows else []
    if header != ['case', 'law', 'velocity_after']:
        refuse(f'{path} has the header {",".join(header)}: must have case,law,velocity_after')
    answers = {}
    for place, row in zip(list(lines)[1:], rows[1:]):
        try:
            velocity = [number(cell) for cell in row[2:]]
        except ValueError as error:
            refuse(f'line {place}: {error}')
        add_answer(f'line {place}', row[0], row[1] if len(row) > 1 else '', velocity, cases, answers)
    return '', answers


def read_answers(path, cases):
    try:
        with (sys.stdin.buffer if path == '-' else open(path, 'rb')) as file:
            text = file.read().decode('utf-8-sig', 'surrogateescape')
    except OSError as error:
        refuse(f'cannot read {path}: {error.strerror}')
    if not text.strip():
        refuse(f'{path} is empty: must have answers')
    simulator, answers = (read_json if text.lstrip()[0] in '{[' else read_csv)(text, path, cases)
    if not answers:
        refuse(f'{path} has no answer: must have one at least')
    return simulator or path, answers


# --- The verdicts ---


def check(value, excess, allowance):
    return {'value': float(value), 'excess': float(excess), 'broken': bool(excess > allowance)}


def least_squares(a, b):
    """Returns the x that makes |a x - b| least; none if the columns of a depend on each other."""
    x, _, rank, _ = np.linalg.lstsq(a, b, rcond=DEPENDENT)
    return x if rank == a.shape[1] else None


def edge_impulses(case, angle):
    """Impulses along the edges of the friction cones; in space of a pyramid inside that has an edge at this angle."""
    c, s, d = math.cos(angle), math.sin(angle), case.dimension
    edges = [[1.0], [-1.0]] if d == 2 else [[c, s], [-c, -s], [-s, c], [s, -c]]
    for contact, friction in enumerate(case.friction):
        for edge in edges[:1] if friction == 0 else edges:
            impulse = np.zeros(len(case.jacobian))
            impulse[contact * d:contact * d + d] = [friction * x for x in edge] + [1.0]
            yield impulse


def outside_pyramids(case, effects, change, angle):
    """Returns what is left of the change after the impulse within the pyramids that leaves the least sum of squares."""
    edges = effects @ np.array(list(edge_impulses(case, angle))).T
    lengths = np.linalg.norm(edges, axis=0)
    edges = edges / np.where(lengths > 0, lengths, 1)  # So that effects on heavy bodies count as those on light ones.
    least = change
    for size in range(1, edges.shape[1] + 1):
        for chosen in itertools.combinations(range(edges.shape[1]), size):
            shares = least_squares(edges[:, chosen], change)
            if shares is not None and min(shares) >= 0:
                least = min(least, change - edges[:, chosen] @ shares, key=np.linalg.norm)
    return least


def outside_cones(case, change):
    """Returns what is left outside the friction cones. In space, with one contact, the edge of the pyramid is moved."""
    effects = np.linalg.solve(case.mass, case.jacobian.T)
    impulse = least_squares(effects, change)
    middle = 0.0 if impulse is None else math.atan2(impulse[1], impulse[0])
    least = outside_pyramids(case, effects, change, middle)
    step = 0.5
    while case.dimension == 3 and step > 1e-7:
        for angle in (middle - step, middle + step):
            beside = outside_pyramids(case, effects, change, angle)
            if np.linalg.norm(beside) < np.linalg.norm(least):
                least, middle = beside, angle
        step *= 0.6
    return least


def limits_of(case, after, tolerance):
    moving, change = after - case.frame, after - case.before
    momentum = case.mass @ moving
    gained = 0.5 * (moving + case.before - case.frame) @ (case.mass @ change)
    limits = {'energy': check(gained, gained, ROUNDING * moving @ momentum + tolerance * np.abs(momentum).sum())}
    normals = case.jacobian[case.dimension - 1::case.dimension]
    speeds, allowances = normals @ moving, tolerance * np.abs(normals).sum(axis=1) + ROUNDING
    worst = int(np.argmax(-speeds - allowances))
    limits['approach'] = check(speeds[worst], -speeds[worst], allowances[worst])
    left = outside_cones(case, change)
    # Any impulse within the cones leaves a vector whose product with `left` is left @ left or more.
    least = left @ left / (np.abs(left).sum() or 1.0)
    allowance = ROUNDING * (np.linalg.norm(case.before) + np.linalg.norm(after)) + tolerance
    limits['cone'] = check(np.abs(left).max(), least, allowance)
    differences = [abs(after[i] - math.copysign(1, place) * after[abs(place) - 1])
                   for symmetry in case.symmetries for i, place in enumerate(symmetry)]
    largest = max(differences, default=0.0)
    limits['symmetry'] = check(largest, largest, 2 * tolerance + ROUNDING)
    return limits


def errors_of(case, after):
    return {name: float(np.abs(after - right).max()) for name, _, right in case.answers}


def grade_case(case, after, law, tolerance):
    errors = errors_of(case, after)
    judge = law if len(case.friction) == 1 else min(errors, key=errors.get)
    obeyed = [name for law_, also, _ in case.answers if errors[law_] <= tolerance for name in (law_, *also)]
    gaps = [np.abs(np.sort(after) - np.sort(right)).max() for _, _, right in case.answers]
    other = not obeyed and bool(min(gaps) <= tolerance)
    right = errors.get(judge, math.inf) <= tolerance
    limits = limits_of(case, after, tolerance)
    if right and len(case.friction) > 1:  # An order of impacts has no symmetry, though its answer is right.
        limits['symmetry'] = check(0.0, 0.0, 0.0)
    return {'law': judge, 'error': errors.get(judge, math.inf), 'right': right, 'errors': errors, 'obeyed': obeyed,
            'other_order': other, **limits}


def nearest_law(cases, answers, tolerance):
    """Returns the law that answers come nearest to most often; all within the tolerance are as near."""
    counts = dict.fromkeys(LAWS, 0)
    for name, (_, after) in answers.items():
        errors = errors_of(cases[name], after)
        nearest = max(tolerance, min(errors.values()))
        for law, also, _ in cases[name].answers:
            for each in (law, *also) if errors[law] <= nearest else ():
                counts[each] = counts.get(each, 0) + 1
    return max(reversed(LAWS), key=counts.get)


# --- The report ---

LAW_TEXT = {'newton': "Newton's law", 'poisson': "Poisson's law", 'energetic': 'the energetic law'}


def rounded(value):
    """A number with the digits that the rounding of the checks leaves."""
    return '%.2g' % (value + 0.0)


def complaint(case, grade):
    if not grade:
        return 'no answer'
    parts = []
    if not grade['right']:
        parts.append(f"{rounded(grade['error'])} from {LAW_TEXT.get(grade['law'], grade['law'])}")
        if grade['obeyed']:
            parts.append('obeys ' + ', '.join(grade['obeyed']))
    if grade['other_order']:
        parts.append('has the right numbers in another order than ' + ', '.join(case.coordinates))
    if grade['energy']['broken']:
        parts.append(f"the kinetic energy grows by {rounded(grade['energy']['excess'])} J")
    if grade['approach']['broken']:
        parts.append(f"the bodies still approach at {rounded(grade['approach']['excess'])} m/s")
    if grade['cone']['broken']:
        parts.append('no impulse within the friction cones explains it, the nearest is '
                     f"{rounded(grade['cone']['value'])} away")
    if grade['symmetry']['broken']:
        parts.append(f"is no mirror image of itself, by {rounded(grade['symmetry']['value'])}")
    return '; '.join(parts)


def family_row(name, members):
    answered = [grade for _, grade in members if grade]
    cells = [name, len(members), len(answered), sum(grade['right'] for grade in answered),
             '%.1e' % max(grade['error'] for grade in answered) if answered else '-']
    for law in LAWS:
        known = any(law == name for case, _ in members for name, _, _ in case.answers)
        cells.append(sum(law in grade['obeyed'] for grade in answered) if known else '-')
    return [str(cell) for cell in cells] + [str(sum(grade[limit]['broken'] for grade in answered)) for limit in LIMITS]


def text_of(head, origin, graded):
    rows = [['family', 'cases', 'answered', 'right', 'worst error', 'Newton', 'Poisson', 'energetic', *LIMITS]]
    families = list(dict.fromkeys(case.family for case, _ in graded))
    rows += [family_row(family, [one for one in graded if one[0].family == family]) for family in families]
    if len(families) > 1:
        rows.append(family_row('all', graded))
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = [head, '']
    for row in rows:
        cells = [cell.rjust(width) for cell, width in zip(row[1:], widths[1:])]
        lines.append('  ' + '   '.join([row[0].ljust(widths[0])] + cells))
    wrong = [f'  {case.name}: {complaint(case, grade)}' for case, grade in graded if complaint(case, grade)]
    lines += ['', origin]
    return '\n'.join(lines + (['', 'Not right, or beyond a limit:', *wrong] if wrong else []))


def tolerance(text):
    try:
        if 0 < (value := number(text)) < 1e100:
            return value
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error))
    raise argparse.ArgumentTypeError(f'{text} must be above 0 and below 1e100')


def laws_text(graded, general, found):
    differ = any(grade and len(case.friction) == 1 and grade['law'] != general for case, grade in graded)
    if not found:
        return 'the laws that the answers state' if differ else LAW_TEXT[general]
    others = 'the laws that answers state, else by ' if differ else ''
    return f'{others}{LAW_TEXT[general]}, which answers come nearest to'


def main():
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors='backslashreplace')  # Names may hold what UTF-8 cannot say.
    parser = argparse.ArgumentParser(description='Grades a simulator by the conformance cases.', allow_abbrev=False)
    parser.add_argument('answers')
    parser.add_argument('--tolerance', type=tolerance, default=1e-9)
    parser.add_argument('--law', choices=LAWS)
    parser.add_argument('--family', action='append', default=[])
    parser.add_argument('--case', action='append', default=[])
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    whole, cases = read_cases()
    for given, known in ((options.family, {case.family for case in cases.values()}), (options.case, cases)):
        for name in given:
            if name not in known:
                refuse(f'{name} is not known: must be one of {", ".join(sorted(known))}')
    simulator, answers = read_answers(options.answers, cases)
    asked = [case for case in cases.values() if case.family in options.family or case.name in options.case
             or not options.family and not options.case]
    laws = [law for name, (law, _) in answers.items() if len(cases[name].friction) == 1]  # A law counts at one contact.
    stated = options.law or (laws[0] if laws and all(laws) else '')
    general = stated or nearest_law(cases, answers, options.tolerance)
    graded = []
    for case in asked:
        law, after = answers.get(case.name, ('', None))
        graded.append((case, None if after is None else
                       grade_case(case, after, options.law or law or general, options.tolerance)))
    right = sum(grade['right'] for _, grade in graded if grade)
    if options.json:
        print(json.dumps({'simulator': simulator, 'version': whole['version'], 'fingerprint': whole['fingerprint'],
                          'tolerance': options.tolerance, 'law': general, 'right_cases': right,
                          'cases': [{'case': case.name, 'family': case.family, 'answered': bool(grade),
                                     **(grade or {}), 'complaint': complaint(case, grade)}
                                    for case, grade in graded]}, indent=2))
    else:
        origin = (f"The cases are version {whole['version']}, {whole['fingerprint'][:16]}. Errors are in m/s or rad/s. "
                  'At several contacts any order will do, or springs.\n'
                  'The last four columns count the cases that break a limit.')
        print(text_of('%s: %d of %d cases are right to %.2g, by %s.' %
                      (simulator, right, len(graded), options.tolerance, laws_text(graded, general, not stated)),
                      origin, graded))
    return 0 if right == len(graded) else 42


if __name__ == '__main__':
    try:
        code = main()
        sys.stdout.flush()
    except OSError as error:  # A broken pipe is a reader that has enough, as with `| head`.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = 0
        if not isinstance(error, BrokenPipeError):
            refuse(f'cannot write the report: {error.strerror}')
    sys.exit(code)

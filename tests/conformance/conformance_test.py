"""The conformance cases, the command that grades by them, and the script that grades without it.

usage: conformance_test.py RICOCHET SOURCE_DIRECTORY WORK_DIRECTORY Cases|Grades
"""
import copy
import csv
import io
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import jsonschema
import numpy as np
from mpmath import mp, mpf

SUITE = sys.argv.pop()
WORK, SOURCE, RICOCHET = [pathlib.Path(sys.argv.pop()).resolve() for _ in range(3)]
sys.path.append(str(SOURCE / 'tests/conformance'))
import core_answers  # noqa: E402
import make_cases  # noqa: E402

FOLDER = SOURCE / 'conformance'
LAWS = ('newton', 'poisson', 'energetic')
TOLERANCE = 1e-12


def read(path):
    return json.loads(path.read_text(encoding='utf-8'))


WHOLE = read(FOLDER / 'impacts.json')
CASES = WHOLE['cases']
SINGLE = [case for case in CASES if len(case['contacts']) == 1]


def by_law(case, law):
    return next(answer for answer in case['answers'] if answer['law'] == law)


def run(*arguments, stdin=None):
    return subprocess.run(list(map(str, arguments)), input=stdin, capture_output=True, text=True, check=False, timeout=300)


def grade(answers, *options):
    """Returns what the command and the script say; both must say the same."""
    path = WORK / 'answers.json'
    path.write_text(answers if isinstance(answers, str) else json.dumps(answers), encoding='utf-8')
    command = run(RICOCHET, 'conformance', 'grade', path, '--format', 'json', *options)
    script = run(sys.executable, FOLDER / 'grade.py', path, '--json', *options)
    assert command.returncode == script.returncode, (command.stderr, script.stderr)
    if command.returncode == 2:
        return command.stderr, script.stderr
    found, other = json.loads(command.stdout), json.loads(script.stdout)
    for name in ('simulator', 'version', 'fingerprint', 'law', 'right_cases'):
        assert found[name] == other[name], name
    for one, two in zip(found['cases'], other['cases'], strict=True):
        for name in ('case', 'answered', 'complaint', 'right', 'law', 'obeyed', 'errors'):
            assert one.get(name, False) == two.get(name, False), (name, one, two)
        for name in ('energy', 'approach', 'cone', 'symmetry') if one['answered'] else ():
            assert one[name]['broken'] == two[name]['broken'], (name, one, two)
            values = one[name]['value'], two[name]['value']
            delta = 1e-9 * (1 + abs(values[0] or 0)) + 2.0 ** -44 * (one['error'] or 0)  # Of large velocities.
            assert values == (None, None) or abs(values[0] - values[1]) < delta, (name, one, two)
    return found, command.returncode


def right_answers(law, cases=None):
    rows = [{'case': case['name'], 'velocity_after': (by_law(case, law) if len(case['contacts']) == 1 else case['answers'][0])
             ['velocity_after']} for case in cases or CASES]
    return {'law': law, 'answers': copy.deepcopy(rows)}


def state(found, name):
    return next(one for one in found['cases'] if one['case'] == name)


class Cases(unittest.TestCase):
    def test_they_are_what_arbitrary_precision_makes(self):
        done = run(sys.executable, SOURCE / 'tests/conformance/make_cases.py', RICOCHET, '--check')
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_they_keep_their_schema(self):
        validator = jsonschema.Draft202012Validator(read(FOLDER / 'impacts.schema.json'))
        self.assertEqual([error.message for error in validator.iter_errors(WHOLE)], [])
        self.assertEqual(len({case['name'] for case in CASES}), len(CASES))
        self.assertTrue(80 <= len(CASES) <= 120, len(CASES))

    def test_a_digit_that_changes_takes_a_new_version(self):
        text = (FOLDER / 'impacts.json').read_text(encoding='utf-8')
        self.assertEqual(make_cases.recorded()[str(WHOLE['version'])], make_cases.fingerprint(text))
        self.assertEqual(WHOLE['fingerprint'], make_cases.fingerprint(text))
        digit = re.search(r'0\.\d{16}(\d)', text).start(1)
        changed = text[:digit] + str((int(text[digit]) + 1) % 10) + text[digit + 1:]
        self.assertNotEqual(make_cases.fingerprint(changed), WHOLE['fingerprint'])

    def test_the_core_agrees_with_each_of_them(self):
        for case in SINGLE:
            for law in LAWS:
                with self.subTest(case=case['name'], law=law):
                    outcome, answer = core_answers.single(RICOCHET, case, law), by_law(case, law)
                    self.assertEqual(outcome['regime'], 'REGIME_' + answer['regime'].upper().replace(' ', '_'))
                    self.assertEqual(outcome['admissible'], answer['admissible'])
                    ledger = {**{name: outcome['work'][name] for name in answer.get('works', {})},
                              **{name: outcome['coefficients'][name] for name in answer.get('coefficients', {})}}
                    expected = {**answer.get('works', {}), **answer.get('coefficients', {})}
                    if answer['regime'] == 'locked':  # The core has no coefficients there, these have none either.
                        self.assertEqual([ledger[name] for name in LAWS], [0, 0, 0])
                    for name, value in expected.items():
                        self.assertAlmostEqual(ledger[name], value, delta=1e-12 * (1 + abs(value)), msg=name)

    def test_a_certificate_proves_the_digits_of_planar_bodies(self):
        proved = 0
        mp.dps = 60
        for case in SINGLE:
            scene = core_answers.certifiable_scene(case)
            for law in LAWS if scene else ():
                with self.subTest(case=case['name'], law=law):
                    scene['restitution'] = {law: case['contacts'][0]['coefficient']}
                    done = core_answers.run(RICOCHET, ['solve', '--certified', '30'], scene)['outcome']
                    numbers = {one['path']: one['decimal'] for one in done['certificate']['numbers']}
                    answer = by_law(case, law)
                    for i, path in enumerate(core_answers.certified_velocities(case)):
                        printed = mpf(repr(answer['contact_velocity_after'][i]))
                        # The file has 17 digits; read as doubles they may be off by half a unit more.
                        self.assertLessEqual(abs(printed - mpf(numbers[path])), abs(printed) * mpf(2) ** -52, path)
                    proved += 1
        self.assertGreaterEqual(proved, 3 * 60)


class Grades(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)

    def test_the_core_is_right_by_each_law(self):
        for law in LAWS:
            found, code = grade(core_answers.answers(RICOCHET, CASES, law), '--tolerance', TOLERANCE)
            self.assertEqual((code, found['law'], found['right_cases']), (0, law, len(CASES)))

    def test_each_number_that_is_wrong_is_found(self):
        for law in LAWS:
            perfect = right_answers(law)
            self.assertEqual(grade(perfect, '--tolerance', TOLERANCE)[1], 0)
            longest = max(len(case['coordinates']) for case in CASES)
            for i in range(longest):
                answers = copy.deepcopy(perfect)
                touched = [row for row in answers['answers'] if len(row['velocity_after']) > i]
                for row in touched:
                    row['velocity_after'][i] += 1.02 * TOLERANCE * (-1) ** i
                found, code = grade(answers, '--tolerance', TOLERANCE)
                self.assertEqual(code, 42)
                wrong = {one['case'] for one in found['cases'] if not one['right']}
                self.assertEqual(wrong, {row['case'] for row in touched})

    def test_the_law_that_most_answers_obey_is_found(self):
        for law in LAWS:
            answers = right_answers(law)
            del answers['law']
            found, code = grade(answers)
            self.assertEqual((code, found['law']), (0, law))

    def test_the_law_that_answers_come_nearest_to_is_found_where_none_is_obeyed(self):
        for law in LAWS:
            answers = right_answers(law)
            del answers['law']
            for row in answers['answers']:
                row['velocity_after'] = [x + 1e-7 for x in row['velocity_after']]
            found, code = grade(answers)
            self.assertEqual((code, found['law'], found['right_cases']), (42, law, 0))
            self.assertLess(max(one['error'] for one in found['cases']), 1.1e-7)
        found, _ = grade('case,law,velocity_after\nrod-jams,,0.5,-1,0\n')
        self.assertEqual(found['right_cases'], 0)

    def test_one_wrong_velocity_is_outside_the_cone_by_itself(self):
        rows = ('ball-drops-elastic,,0,1,0.0000{}', 'cradle-of-five,,0,0,0.0000{},0,0,0,0,0,0,0,0,0,1,0,0')
        for spin, broken in (('102', True), ('098', False)):
            for row in rows:
                found, _ = grade('case,law,velocity_after\n' + row.format(spin) + '\n', '--tolerance', '1e-5')
                self.assertEqual(state(found, row.split(',')[0])['cone']['broken'], broken, (row, spin))

    def test_an_impulse_within_the_cones_explains_velocities_of_any_size(self):
        random = np.random.default_rng(2)
        for size in (1.0, 1e6, 1e12):
            rows = []
            for case in SINGLE:
                normal, share = size * random.uniform(0.1, 1), random.uniform(-0.9, 0.9)
                impulse = [case['contacts'][0]['friction'] * share * normal, *[0] * (case['dimension'] - 2), normal]
                change = np.linalg.solve(np.array(case['mass_matrix'], float), np.array(case['jacobian'], float).T @ impulse)
                rows.append({'case': case['name'], 'velocity_after': (case['velocity_before'] + change).tolist()})
            found, _ = grade({'answers': rows}, '--tolerance', '1e-13')
            broken = [row['case'] for row in rows if state(found, row['case'])['cone']['broken']]
            self.assertEqual(broken, [], size)

    def test_right_answers_break_a_limit_only_where_their_law_does(self):
        for law in LAWS:
            found, _ = grade(right_answers(law), '--tolerance', TOLERANCE)
            for case, one in zip(CASES, found['cases']):
                with self.subTest(case=case['name'], law=law):
                    answer = case['answers'][0] if len(case['contacts']) > 1 else by_law(case, law)
                    self.assertEqual(one['energy']['broken'], answer['energy_change_j'] > 1e-10)
                    # The rounding of a heavy body's velocity is much energy.
                    delta = 1e-12 + 2.0 ** -50 * max(map(max, case['mass_matrix']))
                    self.assertAlmostEqual(one['energy']['value'], answer['energy_change_j'], delta=delta)
                    self.assertFalse(one['cone']['broken'] or one['approach']['broken'])

    def test_each_limit_is_found(self):
        answers = right_answers('energetic')
        rows = {row['case']: row['velocity_after'] for row in answers['answers']}
        rows['ball-drops-elastic'][1] = 1.5
        rows['ball-drops-three-quarters'][1] = -0.25
        rows['sphere-slides'][2] += 1.0
        rows['box-corner-turns'][3] += 0.5
        rows['equal-balls-mirrored'][0] += 0.1
        rows['two-balls-and-a-wall'][:] = [-2, 0, 0, 2, 0, 0]
        found, code = grade(answers)
        self.assertEqual(code, 42)
        broken = {one['case']: {name for name in ('energy', 'approach', 'cone', 'symmetry') if one[name]['broken']}
                  for one in found['cases'] if not one['right']}
        self.assertEqual(broken, {'ball-drops-elastic': {'energy'}, 'ball-drops-three-quarters': {'approach'},
                                  'sphere-slides': {'cone'}, 'box-corner-turns': {'cone'},
                                  'equal-balls-mirrored': {'cone', 'symmetry'},
                                  'two-balls-and-a-wall': {'energy', 'approach'}})
        self.assertIn('the kinetic energy grows by 0.62 J', state(found, 'ball-drops-elastic')['complaint'])

    def test_huge_velocities_break_a_limit(self):
        found, _ = grade('case,law,velocity_after\npendulum-2-paper,,9e99\n')
        self.assertTrue(state(found, 'pendulum-2-paper')['energy']['broken'])

    def test_friction_beyond_the_cone_is_seen_beside_a_heavy_body(self):
        for name, tolerance in (('heavy-ball-on-light-1e9', '1e-5'), ('light-rod-on-heavy-1e6', '1e-6')):
            case = next(case for case in CASES if case['name'] == name)
            answer = by_law(case, 'newton')
            friction, normal = answer['impulse_n_s']
            limit = case['contacts'][0]['friction'] * normal
            unit = np.linalg.solve(np.array(case['mass_matrix'], float), case['jacobian'][0]).tolist()
            for factor, broken in ((1, False), (1.01, True)):
                after = [v + (factor * limit - friction) * x for v, x in zip(answer['velocity_after'], unit)]
                found, _ = grade({'answers': [{'case': name, 'velocity_after': after}]}, '--tolerance', tolerance)
                self.assertEqual(state(found, name)['cone']['broken'], broken, name)

    def test_right_answers_with_errors_of_the_tolerance_keep_the_cone(self):
        random = np.random.default_rng(1)
        for tolerance in (1e-6, 1e-3, 2e-2):
            for law in LAWS:
                answers = right_answers(law)
                for row in answers['answers']:
                    signs = random.choice([-0.999, 0.999], len(row['velocity_after']))
                    row['velocity_after'] = [v + sign * tolerance for v, sign in zip(row['velocity_after'], signs.tolist())]
                found, _ = grade(answers, '--tolerance', tolerance)
                for one in found['cases']:
                    self.assertFalse(one['cone']['broken'], (tolerance, law, one))

    def test_a_law_that_one_answer_states_judges_no_other(self):
        answers = right_answers('energetic')
        del answers['law']
        row = next(row for row in answers['answers'] if row['case'] == 'ball-drops-elastic')
        row['law'] = 'newton'
        found, code = grade(answers)
        self.assertEqual((code, found['law'], state(found, row['case'])['law']), (0, 'energetic', 'newton'))
        several = {case['name'] for case in CASES if len(case['contacts']) > 1}
        for row in answers['answers']:  # At several contacts no law is stated.
            row['law'] = '' if row['case'] in several else 'poisson'
        self.assertEqual(grade(answers)[0]['law'], 'poisson')

    def test_no_order_of_impacts_that_is_right_breaks_a_limit(self):
        several = [case for case in CASES if len(case['contacts']) > 1]
        for i in range(max(len(case['answers']) for case in several)):
            answers = [{'case': case['name'], 'velocity_after': case['answers'][i]['velocity_after']}
                       for case in several if i < len(case['answers'])]
            found, _ = grade({'answers': answers})
            for one in answers:
                self.assertEqual(state(found, one['case'])['complaint'], '', (one, i))

    def test_audit_says_the_same_of_energy_and_approach(self):
        for case in SINGLE[::7]:
            for factor in (0.5, 1.5):
                after = [q + factor * (x - q) for q, x in zip(case['velocity_before'], by_law(case, 'poisson')['velocity_after'])]
                found, _ = grade({'answers': [{'case': case['name'], 'velocity_after': after}]}, '--case', case['name'])
                frame = case.get('frame_velocity', [0] * len(after))
                seen = [sum(j * (x - f) for j, x, f in zip(row, after, frame)) for row in case['jacobian']]
                report = core_answers.audit(RICOCHET, case, seen)
                limits = report['limits']
                with self.subTest(case=case['name'], factor=factor):
                    self.assertEqual(found['cases'][0]['energy']['broken'], limits['energy']['verdict'] == 'VERDICT_BROKEN')
                    self.assertEqual(found['cases'][0]['approach']['broken'], limits['penetration']['verdict'] == 'VERDICT_BROKEN')

    def test_numbers_in_another_order_are_named(self):
        answers = right_answers('newton')
        for row in answers['answers']:
            row['velocity_after'].reverse()
        found, _ = grade(answers)
        self.assertIn('right numbers in another order than body_1.x, body_1.y, body_1.rate', state(found, 'rod-jams')['complaint'])

    def test_missing_answers_are_no_right_ones_unless_they_are_not_asked_for(self):
        some = right_answers('newton', [case for case in CASES if case['family'] == 'sliding'])
        found, code = grade(some)
        self.assertEqual((code, found['right_cases']), (42, 9))
        self.assertEqual(state(found, 'rod-jams')['complaint'], 'no answer')
        self.assertEqual(grade(some, '--family', 'sliding')[1], 0)
        self.assertEqual(grade(some, '--case', 'disk-slides', '--case', 'sphere-slides')[1], 0)

    def test_csv_is_read_like_json(self):
        answers = right_answers('poisson')
        rows = ''.join(f"{row['case']},poisson,{','.join(map(repr, row['velocity_after']))}\n" for row in answers['answers'])
        found, code = grade('case,law,velocity_after\n' + rows)
        self.assertEqual((code, found['right_cases']), (0, len(CASES)))

    def test_a_wrong_file_is_explained(self):
        text = json.dumps(right_answers('newton'))
        row = {'case': 'rod-jams', 'velocity_after': [0, 0, 0]}
        for wrong, says in (
                ('', 'is empty'),
                (' \n', 'is empty'),
                ('{"answers": []}', 'has no answer'),
                ('case,law,velocity_after\n', 'has no answer'),
                (text[:len(text) // 2], 'is it whole?'),
                ('law,case,velocity_after\nnewton,rod-jams,0,0,0\n', 'must have case,law,velocity_after'),
                ('case,law,velocity_after\nrod-jams,newton,0,0\n', 'has 2 numbers: must have 3, body_1.x, body_1.y, body_1.rate'),
                ('case,law,velocity_after\nrod-jams,newton,0,0,x\n', 'x'),
                ({'answers': [row, row]}, 'must not be answered twice'),
                ('{"answers": [], "answers": []}', 'is given twice'),
                ('{"answers": [{"case": "pendulum-2-paper", "velocity_after": [1e400]}]}', ''),
                ('{"answers": [{"case": "pendulum-2-paper", "velocity_after": [NaN]}]}', 'is it whole?'),
                ({'answers': [{'case': 'pendulum-2-paper', 'velocity_after': [True]}]}, 'must be a list of numbers'),
                ({'answers': [{**row, 'case': ['rod-jams']}]}, 'must be'),
                ({'answers': [{**row, 'law': None}]}, 'must be'),
                ({'answers': [row], 'simulator': 5}, 'must be a text'),
                ({'answers': [{**row, 'law': 'newton'}], 'law': 'Moreau'}, 'must be'),
                ('# Nothing.\n', 'header'),
                ('case,law,velocity_after\n"pendulum-2-paper",newton,"1\n', 'in quotes that does not end'),
                ('case,law,velocity_after\n"pendulum-2-\npaper",newton,1\n', ''),
                ('case,law,velocity_after\npendulum-2-paper,newton,\u00a01\n', 'must '),
                ('{"simulator": "\\ud800", "answers": [{"case": "pendulum-2-paper", "velocity_after": [1]}]}', ''),
                *((f'case,law,velocity_after\npendulum-2-paper,newton,{x}\n', 'must ')
                  for x in ('1_0', '\u0663', '1e400', '1e-400', '1/0', '0x1', '', '1/inf', '1e308/1e-308', '1e-300/1e300', '0/nan')),
                ('case,law,velocity_after\npendulum-2-paper,newton,-1e100\n', 'of a size below 1e100'),
                ('case;law;velocity_after\npendulum-2-paper;newton;1\n', 'by semicolons: must use commas'),
                ('case,law\t,velocity_after\npendulum-2-paper,newton,1\n', 'by tabs: must use commas'),
                (json.dumps({'answers': [{'case': 'pendulum-2-paper', 'velocity_after': [1]}]}) + '\0', ''),
                ('[1]', 'must be an object'),
                ({'answers': [{**row, 'case': 'rod-jam'}]}, 'did you mean rod-jams?'),
                ({'answers': [{**row, 'law': 'Moreau'}]}, 'must be'),
                ({'answers': [{**row, 'velocities': []}]}, 'velocities: is unknown'),
                ({'answers': [{'case': 'rod-jams'}]}, 'must be a list of numbers')):
            for message in grade(wrong):
                self.assertIn(says, str(message), wrong)

    def test_a_wrong_tolerance_is_refused(self):
        for tolerance in ('0', '-1', 'nan', '1_0', 'x', 'inf', '1e100', '1e308/1e-308'):
            for message in grade(right_answers('newton'), f'--tolerance={tolerance}'):
                self.assertIn('tolerance', message)

    def test_blanks_and_comments_in_csv_do_not_count(self):
        found, code = grade(' case , law,velocity_after\r\n\n  # One.\n "pendulum-2-paper"\t, newton , "2/2"\n', '--case',
                            'pendulum-2-paper')
        self.assertEqual((code, found['right_cases']), (0, 1))

    def test_the_script_ends_well_without_a_reader_or_text(self):
        path = WORK / 'core.json'
        path.write_text(json.dumps(right_answers('newton')), encoding='utf-8')
        script = f'{sys.executable} {FOLDER}/grade.py'
        ended = run('bash', '-c', f'{{ sleep 0.5; {script} {path}; echo "ends with $?" >&2; }} | true')
        self.assertEqual(ended.stderr, 'ends with 0\n')
        path.write_bytes(b'case,law,velocity_after\n\xff,newton,0\n')
        ended = run('bash', '-c', f'{script} {path}')
        self.assertEqual(ended.returncode, 2)
        self.assertIn('grade.py: line 2.case = \\udcff: must be a case', ended.stderr)

    def test_a_name_that_is_no_text_is_shown_as_well_as_can_be(self):
        path = WORK / 'b\udcff.csv'
        path.write_text('case,law,velocity_after\npendulum-2-paper,newton,1\n', encoding='utf-8')
        for words in ([RICOCHET, 'conformance', 'grade', path, '--format', 'json'], [sys.executable, FOLDER / 'grade.py', path]):
            self.assertEqual(run(*words, '--case', 'pendulum-2-paper').returncode, 0)

    def test_text_csv_and_page_say_what_json_says(self):
        path = WORK / 'core.json'
        answers = right_answers('energetic')
        answers['answers'][3]['velocity_after'][0] += 0.25
        path.write_text(json.dumps(answers), encoding='utf-8')
        words = [RICOCHET, 'conformance', 'grade', path, '--law', 'poisson']
        text, page = run(*words, '--html', WORK / 'page.html'), None
        page = (WORK / 'page.html').read_text(encoding='utf-8')
        found = json.loads(run(*words, '--format', 'json').stdout)
        rows = list(csv.DictReader(io.StringIO(run(*words, '--format', 'csv').stdout)))
        script = run(sys.executable, FOLDER / 'grade.py', path, '--law', 'poisson')
        self.assertEqual(text.stdout, script.stdout)
        for one, row in zip(found['cases'], rows, strict=True):
            self.assertEqual((row['case'], row['right'], float(row['error']), row['complaint']),
                             (one['case'], str(one['right']).lower(), one['error'], one['complaint']))
            if one['complaint']:
                self.assertIn(f"  {one['case']}: {one['complaint']}\n", text.stdout)
                self.assertIn(f"<td>{one['case']}</td>", page)

    def test_a_new_user_takes_the_test_by_the_page_alone(self):
        place = WORK / 'page'
        place.mkdir()
        done = subprocess.run([sys.executable, SOURCE / 'tests/integration/page.py', SOURCE / 'docs/conformance.md'], cwd=place,
                              env={'PATH': f'{RICOCHET.parent}:/usr/bin:/bin'}, capture_output=True, text=True,
                              check=False, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_adaptor_of_the_page_is_the_one_that_dev_peers_runs(self):
        page = (SOURCE / 'docs/conformance.md').read_text(encoding='utf-8')
        shown = re.search(r'^```py\n(.*?)^```$', page, re.MULTILINE | re.DOTALL).group(1)
        self.assertEqual(shown, (SOURCE / 'tests/peers/chipmunk_adaptor.py').read_text(encoding='utf-8'))

    def test_each_case_is_shown(self):
        listed = json.loads(run(RICOCHET, 'conformance', 'list', '--format', 'json').stdout)
        self.assertEqual([one['name'] for one in listed], [case['name'] for case in CASES])
        for case in CASES:
            shown = run(RICOCHET, 'conformance', 'show', case['name'], '--format', 'json').stdout
            self.assertEqual(json.loads(shown), case)
        text = run(RICOCHET, 'conformance', 'show', 'pendulum-2-paper').stdout
        self.assertRegex(text, r'body_1.rate +-1 +1 +0\.4999+4 +0\.70710678')
        self.assertTrue(re.search('Source: V. A. Lubarda', text))


if __name__ == '__main__':
    unittest.main(argv=[sys.argv[0], SUITE])

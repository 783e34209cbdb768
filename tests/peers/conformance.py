"""Lets engines take the conformance cases and writes the tables "engine x family" into docs/peers.md.

usage: conformance.py RESULTS.csv FOLDER_FOR_ANSWERS

Chipmunk and ODE take every case that they can state, by their adaptors; the other engines those of the pendulum, whose
velocities ricochet_peers has measured. Every answer goes through an answers file and conformance/grade.py.
"""

import csv
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, '..', '..')
CASES, PAGE = os.path.join(ROOT, 'conformance', 'impacts.json'), os.path.join(ROOT, 'docs', 'peers.md')
BEGIN, END = '<!-- conformance: begin -->\n', '<!-- conformance: end -->\n'
TOLERANCE = 1e-4
ADAPTORS = (('Chipmunk, 10 iterations', 'chipmunk_adaptor.py', '10'),
            ('Chipmunk, 10000 iterations', 'chipmunk_adaptor.py', '10000'),
            ('ODE, dWorldStep', 'ode_adaptor.py', 'World'),
            ('ODE, dWorldQuickStep, 20 iterations', 'ode_adaptor.py', '20'),
            ('ODE, dWorldQuickStep, 1000 iterations', 'ode_adaptor.py', '1000'))
LAWS = {'Newton': 'newton', 'Poisson': 'poisson'}  # Springs are held against the energetic law.


def grades(path, law):
    """The graded cases that the file answers."""
    grade = os.path.join(ROOT, 'conformance', 'grade.py')
    done = subprocess.run(['/usr/bin/python3', grade, path, '--json', '--law', law, '--tolerance', str(TOLERANCE)],
                          capture_output=True, text=True, check=False)
    if done.returncode == 2:
        sys.exit(done.stderr)
    return [one for one in json.loads(done.stdout)['cases'] if one['answered']]


def summary(cases):
    """How many cases are right, the worst error, and the most energy created."""
    created = max((one['energy']['value'] for one in cases if one['energy']['broken']), default=0.0)
    return [f"{sum(one['right'] for one in cases)} of {len(cases)}", '%.1g' % max(one['error'] for one in cases),
            '+%.2g J' % created if created else '-']


def cell(cases):
    return ', '.join(text for text in summary(cases) if text != '-') if cases else '-'


def broken(cases, limit):
    return str(sum(one[limit]['broken'] for one in cases))


def full_table(folder):
    graded = []
    for number, (_, adaptor, argument) in enumerate(ADAPTORS):
        path = os.path.join(folder, f'adaptor_{number}.csv')
        subprocess.run(['/usr/bin/python3', os.path.join(HERE, adaptor), CASES, argument, path], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        graded.append(grades(path, 'newton'))
    rows = [['family', *(name for name, _, _ in ADAPTORS)]]
    for family in families():
        rows.append([family, *(cell([one for one in cases if one['family'] == family]) for cases in graded)])
    rows.append(['all', *map(cell, graded)])
    for limit, words in (('approach', 'cases in which bodies still approach'),
                         ('cone', 'cases outside the friction cone')):
        rows.append([words, *(broken(cases, limit) for cases in graded)])
    lines = ['| ' + ' | '.join(row) + ' |' for row in rows if set(row[1:]) != {'-'}]
    return [lines[0], '| --- |' + ' ---: |' * len(ADAPTORS), *lines[1:]]


def families():
    with open(CASES, encoding='utf-8') as file:
        return dict.fromkeys(case['family'] for case in json.load(file)['cases'])


def pendulum_table(results, folder):
    with open(CASES, encoding='utf-8') as file:
        names = {case['name'].split('-')[1]: case['name'] for case in json.load(file)['cases']
                 if case['family'] == 'pendulum'}
    setups = {}
    with open(results, newline='', encoding='utf-8') as file:
        for row in csv.DictReader(file):
            if row['in_table'] == '1' and row['engine'] != 'Ricochet':
                key = tuple(row[name] for name in ('engine', 'law', 'method', 'step_s', 'iterations', 'varied'))
                setups.setdefault(key, []).append(row)
    lines = ['| engine | law | settings | right | worst error | energy created | still approach |',
             '| --- | --- | --- |' + ' ---: |' * 4]
    for number, ((engine, law, method, _, iterations, _), rows) in enumerate(setups.items()):
        path = os.path.join(folder, f'pendulum_{number}.csv')
        with open(path, 'w', encoding='utf-8') as file:
            print('case,law,velocity_after', file=file)
            for row in rows:
                print(names[row['case']], '', row['omega_plus'], sep=',', file=file)
        graded = grades(path, LAWS.get(law, 'energetic'))
        settings = method + (f', {iterations} iterations' if iterations != '0' else '')
        lines.append('| ' + ' | '.join([engine, law, settings, *summary(graded), broken(graded, 'approach')]) + ' |')
    return lines


def main():
    results, folder = sys.argv[1:]
    os.makedirs(folder, exist_ok=True)
    lines = ['### All cases', '', *full_table(folder), '', '### The five cases of the pendulum', '',
             *pendulum_table(results, folder)]
    with open(PAGE, encoding='utf-8') as file:
        before, rest = file.read().split(BEGIN)
    with open(PAGE, 'w', encoding='utf-8') as file:
        file.write(before + BEGIN + '\n' + '\n'.join(lines) + '\n\n' + END + rest.split(END)[1])


if __name__ == '__main__':
    main()

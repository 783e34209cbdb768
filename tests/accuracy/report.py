"""Writes what `./dev accuracy` has measured into docs/accuracy.md.

usage: report.py DIRECTORY

The directory holds claims.txt, bench.txt and, for each scene, a study of cost in JSON. In the page, only the text
between a line "<!-- measured: NAME -->" and the next "<!-- end -->" is replaced.
"""

import json
import os
import re
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'support', 'processes'))
import provenance  # pylint: disable=wrong-import-position

PAGE = os.path.join(provenance.ROOT, 'docs', 'accuracy.md')
SCENES = ('pendulum', 'planar', 'spatial')


def replace(page, name, lines):
    start = '<!-- measured: %s -->\n' % name
    pattern = re.compile(re.escape(start) + '.*?(?=^<!-- end -->$)', re.MULTILINE | re.DOTALL)
    text = start + ''.join(line + '\n' for line in lines)
    replaced, count = pattern.subn(lambda match: text, page)
    if count != 1:
        sys.exit('docs/accuracy.md has %d places for what was measured as %s, not 1' % (count, name))
    return replaced


def time(seconds):
    for unit, size in (('s', 1), ('ms', 1e-3), ('µs', 1e-6), ('ns', 1e-9)):
        if seconds >= 0.9995 * size or unit == 'ns':
            return '%.*f %s' % (max(0, 2 - len('%d' % (seconds / size)) + 1), seconds / size, unit)
    return ''


def error(value):
    value = float(value)
    return 'unknown' if value == float('inf') else '%.1e' % value if value else '0'


def picked(study, index):
    ranges = []
    for pick in study['summary']['picks']:
        if int(pick['row']) == index:
            ends = ['%g' % float(pick[end]) for end in ('least_tolerance', 'most_tolerance')]
            ranges.append(ends[0] if ends[0] == ends[1] else ' to '.join(ends))
    return ', '.join(ranges)


def cost_table(study):
    lines = ['| method | one solve | of a batch | error claimed | error made | numerical | modelling '
             '| picked for tolerances |',
             '| --- |' + ' ---: |' * 6 + ' --- |']
    front = {int(row) for row in study['summary']['front']}
    for index, row in enumerate(study['rows']):
        made = row.get('achieved')
        cells = [row['name'] + (' ●' if index in front else '')]
        cells += [time(row[part]['median_s']) if row.get(part) else '-' for part in ('solve', 'batch')]
        cells.append(error(row['claimed']['total']) if row['status'] == 'STATUS_MEASURED' else '-')
        cells += [error(made[part]) if made else '-' for part in ('total', 'numerical', 'modelling')]
        cells.append(picked(study, index))
        lines.append('| ' + ' | '.join(cells) + ' |')
    return lines


def cost(study):
    summary = study['summary']
    answers = sum('achieved' in row and row['achieved'] is not None for row in study['rows'])
    return cost_table(study) + [
        '', provenance.lines(
            'Answers that err by more than they claim: %s of %d. Methods without an answer: %s; without time left: %s. '
            'Exact answer: %s' % (summary['deceived'], answers, summary['failed'], summary['out_of_time'],
                                  summary['reference_source']))]


def block(path):
    with open(path, encoding='utf-8') as file:
        return ['```text'] + file.read().splitlines() + ['```']


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    directory = sys.argv[1]
    with open(PAGE, encoding='utf-8') as file:
        page = file.read()
    for scene in SCENES:
        with open(os.path.join(directory, scene + '.json'), encoding='utf-8') as file:
            page = replace(page, 'cost of ' + scene, cost(json.load(file)))
    for name in ('claims', 'bench'):
        page = replace(page, name, [provenance.sentence(), ''] + block(os.path.join(directory, name + '.txt')))
    page = replace(page, 'cost', [provenance.sentence()])
    with open(PAGE, 'w', encoding='utf-8') as file:
        file.write(page)


if __name__ == '__main__':
    main()

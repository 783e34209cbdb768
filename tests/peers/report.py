"""Writes what ricochet_peers has measured into docs/peers.md and draws docs/images/peers.svg.

usage: report.py RESULTS.csv PACKAGE...

In the page, only the text between the two marks "measured" is replaced: the machine, the commit and the packages, and the
tables. The diagram is drawn by gnuplot.
"""

import csv
import os
import re
import statistics
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'support', 'processes'))
import provenance  # pylint: disable=wrong-import-position

ROOT = provenance.ROOT
PAGE = os.path.join(ROOT, 'docs', 'peers.md')
PICTURE = os.path.join(ROOT, 'docs', 'images', 'peers.svg')
BEGIN = '<!-- measured: begin -->\n'
END = '<!-- measured: end -->\n'

# Kinetic energy may rise by this much, in J, through rounding, single precision included.
ENERGY_ROUNDING = 1e-5

# A Solve shall take at most this part of the fastest impact of another engine.
MOST_OF_A_PEER = 0.6

# Okabe and Ito's colours, which the colour-blind can tell apart, with a mark for each engine.
STYLES = {
    'Ricochet': ('#000000', 13),
    'Box2D': ('#E69F00', 5),
    'Bullet': ('#56B4E9', 7),
    'Chipmunk': ('#009E73', 9),
    'DART': ('#0072B2', 11),
    'MuJoCo': ('#D55E00', 4),
    'ODE': ('#CC79A7', 6),
    'Siconos': ('#8C6D31', 8),
    'Simbody': ('#7F7F7F', 12),
}


class Row:
    """One engine with one choice of settings, over all cases."""

    def __init__(self, cases):
        self.cases = cases
        self.engine = cases[0]['engine']
        self.law = cases[0]['law']
        self.method = cases[0]['method']
        self.in_table = cases[0]['in_table'] == '1'
        self.ns = statistics.median(float(c['ns_per_impact']) for c in cases)
        self.times_ours = statistics.median(float(c['times_ours']) for c in cases)
        self.gained_j = max(float(c['energy_gained_j']) for c in cases)

    def worst(self, law):
        return max(float(c['error_' + law]) for c in self.cases)

    def gains_energy(self):
        return self.gained_j > ENERGY_ROUNDING

    def key(self):
        """Everything that was set but the step."""
        return tuple(self.cases[0][name] for name in ('engine', 'law', 'method', 'iterations', 'varied'))

    def step(self):
        step = float(self.cases[0]['step_s'])
        return exponent('%.3g' % step) if step > 0 else ''

    def settings(self, steps):
        parts = [self.method, 'Δt = %s s' % steps if steps else '', self.cases[0]['varied']]
        iterations = int(self.cases[0]['iterations'])
        if iterations > 0:
            parts.append('%d iteration%s' % (iterations, '' if iterations == 1 else 's'))
        return ', '.join(part for part in parts if part)


def read(path):
    """Returns the rows of a file of measurements in its order."""
    names = ('engine', 'law', 'method', 'step_s', 'iterations', 'varied', 'fixed')
    settings = {}
    with open(path, newline='', encoding='utf-8') as file:
        for line in csv.DictReader(file):
            settings.setdefault(tuple(line[name] for name in names), []).append(line)
    return [Row(cases) for cases in settings.values()]


def header(packages):
    lines = [provenance.sentence(' Packages:'), '']
    return lines + ['%s %s%s' % (package, provenance.version(package), '.' if package == packages[-1] else ',')
                    for package in packages]


def exponent(number):
    """Writes the exponent of a number as superscripts: 3.2e-07 becomes 3.2·10⁻⁷, and 1.2e+02 becomes 120."""
    match = re.fullmatch(r'(-?[\d.]+)e([+-]\d+)', number)
    if not match:
        return number
    if 0 <= int(match.group(2)) < 5:
        return '%d' % float(number)
    power = str(int(match.group(2))).translate(str.maketrans('-0123456789', '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'))
    return ('10' if match.group(1) == '1' else match.group(1) + '·10') + power


def error(value):
    return '%.2g' % value if value >= 0.01 else exponent('%.1e' % value)


def duration(ns):
    for unit, size in (('ms', 1e6), ('µs', 1e3), ('ns', 1)):
        if ns >= size:
            return '%.*f %s' % (max(0, 2 - len('%d' % (ns / size))), ns / size, unit)
    return '%.2g ns' % ns


def omega(case):
    value = float(case['omega_plus'])
    text = '0' if abs(value) < 5e-5 else '%.4f' % value
    return text + ('*' if float(case['energy_gained_j']) > ENERGY_ROUNDING else '')


def answers(rows):
    lines = ['| engine, law | settings | 1 | 2 | 3 | 4 | 5 | time | times ours |', '|' + ' --- |' * 2 + ' ---: |' * 7]
    for row in rows:
        if row.in_table:
            cells = [row.engine + ', ' + row.law, row.settings(row.step()) + '; ' + row.cases[0]['fixed']]
            cells += [omega(c) for c in row.cases] + [duration(row.ns), exponent('%.2g' % row.times_ours)]
            lines.append('| ' + ' | '.join(cells) + ' |')
    return lines


def error_cells(row):
    # The kinetic energy before an impact is 1/2 J.
    gained = exponent('%.2g' % (200 * row.gained_j)) + ' %' if row.gains_energy() else '-'
    return [error(row.worst(law)) for law in ('newton', 'poisson', 'energetic')] + [gained]


def errors(rows):
    """One line for each choice of settings; steps that give the same errors share a line."""
    groups = {}
    for row in rows:
        groups.setdefault((row.key(), *error_cells(row)), []).append(row)
    lines = ['| engine, law | settings | Newton | Poisson | energetic | energy gained | time | times ours |',
             '|' + ' --- |' * 2 + ' ---: |' * 6]
    for (_, *cells), group in groups.items():
        steps = ', '.join(row.step() for row in sorted(group, key=lambda row: -float(row.cases[0]['step_s'])))
        cells += [duration(statistics.median(row.ns for row in group)),
                  exponent('%.2g' % statistics.median(row.times_ours for row in group))]
        lines.append('| ' + ' | '.join([group[0].engine + ', ' + group[0].law, group[0].settings(steps)] + cells) + ' |')
    return lines


def write_page(rows, packages):
    with open(PAGE, encoding='utf-8') as file:
        before, rest = file.read().split(BEGIN)
    after = rest.split(END)[1]
    text = header(packages) + ['', '### The answers', ''] + answers(rows)
    text += ['', '### The largest errors of all settings', ''] + errors(rows)
    with open(PAGE, 'w', encoding='utf-8') as file:
        file.write(before + BEGIN + '\n' + '\n'.join(text) + '\n\n' + END + after)


def blocks(rows):
    """Yields, for each engine, the points of its methods: one line of the diagram a method."""
    for engine in dict.fromkeys(row.engine for row in rows):
        methods = {}
        for row in rows:
            if row.engine == engine:
                methods.setdefault((row.law, row.method), []).append(row)
        lines = []
        for points in methods.values():
            points.sort(key=lambda row: (int(row.cases[0]['iterations']), -float(row.cases[0]['step_s'])))
            lines += ['%.6g %.6g' % (row.worst('energetic'), row.ns) for row in points] + ['']
        yield engine, lines


def exact_law(rows, law):
    """Largest difference between the exact answers of a law and the energetic ones, taken from our own exact rows."""
    return max(float(case['error_' + law]) for row in rows if row.engine == 'Ricochet' for case in row.cases)


HEAD = """set terminal svg size 960,620 font 'DejaVu Sans,15' background 'white'
set output '{picture}'
set multiplot title 'One impact of a pendulum: time against error'
set logscale xy
set format '10^{{%T}}'
set yrange [1:1e8]
set grid linetype 1 linecolor rgb '#d8d8d8' linewidth 1
set tics nomirror scale 0.6
set mxtics 1
set border 3
set tmargin at screen 0.92
set bmargin at screen 0.15
set label 100 'largest error of ω⁺ over five cases, as a fraction of |ω⁻|, against the energetic answer' at screen 0.44, 0.03 center
"""

# Nothing lies between the errors of doubles and those of the engines: the axis is broken there.
LEFT = """set lmargin at screen 0.10
set rmargin at screen 0.25
set xrange [1e-17:1e-15]
set ylabel 'time of one impact [ns]'
set xtics (1e-17, 1e-16)
unset key
{labels}"""
# Short names of our own rows, which come first.
OUR_NAMES = ('in SIMD lanes', 'plain doubles', 'double-double', 'Solve')
OUR_LABEL = """set label '{name}' at {x}, {y} left offset 1,0 font ',12'
"""

RIGHT = """unset label
set lmargin at screen 0.28
set rmargin at screen 0.78
set xrange [1e-4:10]
unset ylabel
set format y ''
set xtics 10
set border 1
set key at screen 1.0, 0.91 reverse Left
set label 1 '//' at graph -0.03, 0 center
set arrow from {newton}, graph 0 to {newton}, graph 1 nohead dashtype 2 linecolor rgb 'gray40'
set arrow from {poisson}, graph 0 to {poisson}, graph 1 nohead dashtype 2 linecolor rgb 'gray40'
set label 2 "Poisson's law\\nsolved exactly" at {poisson}, graph 0.10 right offset -0.6,0 font ',12'
set label 3 "Newton's\\nlaw solved\\nexactly" at {newton}, graph 0.10 left offset 0.6,0 font ',12'
"""


def gnuplot_script(rows):
    script = [HEAD.format(picture=PICTURE)]
    plots = []
    for number, (engine, lines) in enumerate(blocks(rows)):
        script += ['$e%d << EOD' % number] + lines + ['EOD']
        colour, mark = STYLES[engine]
        plots.append("$e%d using 1:2 with linespoints linewidth 1 linecolor rgb '%s' pointtype %d pointsize 0.9 title '%s'"
                     % (number, colour, mark, engine))
    gaining = ['%.6g %.6g' % (row.worst('energetic'), row.ns) for row in rows if row.gains_energy()]
    script += ['$gain << EOD'] + gaining + ['EOD']
    if gaining:
        plots.append("$gain using 1:2 with points pointtype 6 pointsize 1.8 linewidth 1.5 linecolor rgb 'red' "
                     "title 'creates energy'")
    plot = 'plot ' + ', \\\n  '.join(plots)
    left = LEFT.format(labels=''.join(OUR_LABEL.format(name=name, x=row.worst('energetic'), y=row.ns)
                                      for name, row in zip(OUR_NAMES, rows)))
    right = RIGHT.format(newton=exact_law(rows, 'newton'), poisson=exact_law(rows, 'poisson'))
    return '\n'.join(script + [left, plot, right, plot, 'unset multiplot']) + '\n'


def print_goal(rows):
    """A Solve, with all that its answer holds, against the engine that takes the least time for one impact."""
    times = {row.engine: min(other.times_ours for other in rows if other.engine == row.engine)
             for row in rows if row.engine != 'Ricochet'}
    if times:
        fastest = min(times, key=times.get)
        print('A Solve takes %.2f of the fastest impact in %s; goal %.1f' % (1 / times[fastest], fastest, MOST_OF_A_PEER))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    rows = read(sys.argv[1])
    print_goal(rows)
    write_page(rows, sys.argv[2:])
    subprocess.run(['gnuplot'], input=gnuplot_script(rows), text=True, check=True)


if __name__ == '__main__':
    main()

"""Where measurements come from: the commit, the machine, the system and the compiler, in words for docs/."""

import os
import re
import subprocess
import textwrap

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', '..'))


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout.strip()


def commit():
    """The commit, and whether files that measurements depend on differ from it."""
    changed = run(
        'git', 'status', '--porcelain', '--untracked-files=no', '--', '.', ':!docs', ':!tests/peers/results.csv')
    return run('git', 'rev-parse', '--short', 'HEAD') + (' with changes' if changed else '')


def machine():
    with open('/proc/cpuinfo', encoding='utf-8') as file:
        name = re.search(r'model name\s*: (.*)', file.read())
    cores = os.cpu_count()
    return '%s, %d core%s' % (name.group(1) if name else run('uname', '-m'), cores, '' if cores == 1 else 's')


def system():
    with open('/etc/os-release', encoding='utf-8') as file:
        return re.search(r'PRETTY_NAME="(.*)"', file.read()).group(1)


def compiler():
    return run('c++', '--version').splitlines()[0]


def version(package):
    shown = subprocess.run(['dpkg-query', '--show', '--showformat=${Version}', package], capture_output=True, text=True,
                           check=False)
    return shown.stdout if shown.returncode == 0 and shown.stdout else 'not installed, left out'


def lines(text):
    """A paragraph of a page, in lines of at most 120 columns."""
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False)


def sentence(end=''):
    return lines('Measured at commit %s on %s; %s; %s, release build.%s' % (
        commit(), machine(), system(), compiler(), end))

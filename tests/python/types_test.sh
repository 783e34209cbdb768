#!/usr/bin/env bash
# mypy finds no fault with the types of the Python package, and sees them from a program.
# usage: types_test.sh PACKAGE_DIRECTORY CACHE_DIRECTORY
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
cd "$1"
exec mypy --config-file "$here/mypy.ini" --python-executable /usr/bin/python3 \
  --cache-dir "$2" ricochet "$here/typed_program.py"

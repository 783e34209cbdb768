#!/usr/bin/env bash
# ./dev format: formats the sources, or says what differs. Usage: format.sh [--check]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/dev_lib.sh"

our_sources() {
  find core proto server client python tests \( -name '*.h' -o -name '*.cc' -o -name '*.proto' \) -print0
}

# Every line beyond 120 columns of what is written by hand: sources, comments, scripts, and the prose of pages. Tables,
# pictures and the output of programs cannot be broken; the Python of tests is left out.
long_lines() {
  find core proto server client python conformance tests tools packaging deploy dev .ci CMakeLists.txt -type f \
    -not -path 'tests/*.py' \
    \( -name '*.h' -o -name '*.cc' -o -name '*.cpp' -o -name '*.proto' -o -name '*.py' -o -name '*.sh' \
    -o -name CMakeLists.txt -o -name '*.cmake' -o -path dev -o -path .ci/run \) -print0 |
    LC_ALL=C.UTF-8 xargs -0 grep -HnoE '^.{121}' | cut -d: -f1,2
  local page
  for page in ./*.md docs/*.md docs/theory/*.md deploy/*.md tests/data/*.md; do
    # shellcheck disable=SC2016  # The backquotes are those of Markdown.
    LC_ALL=C.UTF-8 sed -E '/^```/,/^```$/s/.*//; s/^(\||!\[|    ).*//' "$page" |
      LC_ALL=C.UTF-8 grep -nE '^.{121}' | cut -d: -f1 | sed "s#^#${page#./}:#" || true
  done
}

case ${1-} in
  "") how=(-i) ;;
  --check) how=(--dry-run -Werror) ;;
  *) usage_error "format takes --check or nothing, not '$1'" ;;
esac
install_missing clang-format
our_sources | xargs -0 clang-format "${how[@]}"
if [[ ${1-} == --check ]]; then
  too_long=$(long_lines)
  [[ -z $too_long ]] || die $'these lines are longer than 120 columns:\n'"$too_long"
fi

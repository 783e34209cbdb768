#!/usr/bin/env bash
# ./dev soak: random impacts in bulk, then load, faults and abuse of the service. Usage: run.sh [--short] [MINUTES]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"
if [[ ${1-} == --short ]]; then shift && short=yes; fi

(($# <= 1)) || usage_error "soak takes a number of minutes or nothing"
minutes=${1-30} cases=${SOAK_CASES:-1000000} where=()
if is_short; then
  minutes=0
  cases=10000
  # The tests run all topics short; this tries what runs them and writes the page, on a copy of it.
  mkdir -p build/soak-short
  cp deploy/README.md build/soak-short/README.md
  where=(--page build/soak-short/README.md boundary)
fi
[[ $minutes =~ ^(0|[1-9][0-9]*)$ ]] || usage_error "soak takes a number of minutes, not '$minutes'"
install_missing "${test_packages[@]}"
build_for_tests ricochet_soak
say "Random impacts, planar and in space"
show build/dev/tests/soak/ricochet_soak "$cases"
build_programs
say "Load, faults and abuse of the service"
work=build/soak${short:+-short}
show /usr/bin/python3 tests/fault/soak.py "$ricochetd" "$ricochet" "$work" "$minutes" "${where[@]}"
echo "-> ${where[1]-deploy/README.md}, $work/results.json"

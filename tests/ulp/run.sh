#!/usr/bin/env bash
# ./dev ulp: errors of every output of the closed forms in ulp. Usage: run.sh [--short] [POINTS]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"
if [[ ${1-} == --short ]]; then shift && short=yes; fi

(($# <= 1)) || usage_error "ulp takes a number of points or nothing"
install_missing "${test_packages[@]}"
build_for_tests ricochet_ulp
say "Every output of the closed forms against ball arithmetic"
points=10000000
! is_short || points=20000
show build/dev/tests/ulp/ricochet_ulp "${1:-$points}"

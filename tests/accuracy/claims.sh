#!/usr/bin/env bash
# ./dev claims: the errors that every model claims and makes. Usage: claims.sh [--short]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"
if [[ ${1-} == --short ]]; then shift && short=yes; fi

install_missing "${test_packages[@]}"
build_for_tests ricochet_claims
say "The error that a model claims against the error that it makes"
scenes=10000
! is_short || scenes=100
show build/dev/tests/accuracy/ricochet_claims "$scenes"

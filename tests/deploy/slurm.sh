#!/usr/bin/env bash
# ./dev slurm: a sweep on a Slurm cluster of three nodes here, then by Open MPI. Usage: slurm.sh [--short]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"
if [[ ${1-} == --short ]]; then shift && short=yes; fi

readonly cluster_packages=("${build_packages[@]}" munge openmpi-bin python3 slurm-wlm)
require_root slurm "its cluster starts tasks as any user"
install_missing "${cluster_packages[@]}"
build_programs
points=30000
! is_short || points=12000
say "A sweep on three nodes of Slurm, one of which is killed, and by Open MPI"
show /usr/bin/python3 tests/deploy/slurm_test.py . "$ricochet" build/slurm "$points"

#!/usr/bin/env bash
# ./dev pool: a sweep shared by three servers, one killed and one drained. Usage: pool.sh [--short] [POINTS]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"
if [[ ${1-} == --short ]]; then shift && short=yes; fi

(($# <= 1)) || usage_error "pool takes a number of points or nothing"
points=1000000000
! is_short || points=3000000
points=${1-$points}
[[ $points =~ ^[1-9][0-9]*$ ]] || usage_error "pool takes a number of points, not '$points'"
install_missing "${build_packages[@]}" haproxy python3-grpcio python3-protobuf
build_programs
say "A sweep of $points points shared by three servers behind HAProxy, one of which is killed and one drained"
show env RICOCHET_POOL_POINTS="$points" GRPC_ENABLE_FORK_SUPPORT=0 /usr/bin/python3 tests/fault/pool.py \
  --ricochetd "$ricochetd" --ricochet "$ricochet" --proto proto --work build/pool --only shared

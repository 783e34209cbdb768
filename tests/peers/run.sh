#!/usr/bin/env bash
# ./dev peers: physics engines strike the paper's pendulum; writes docs/peers.md.
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"

readonly peers_packages=(
  "${core_packages[@]}" gnuplot-nox libflint-arb-dev libflint-dev libgmock-dev libgmp-dev libgtest-dev
  nlohmann-json3-dev python3 python3-numpy)
# Physics engines; those that cannot be installed are left out.
readonly engine_packages=(
  libbox2d-dev libbullet-dev libchipmunk-dev libdart-dev libmujoco-dev libode-dev libsiconos-kernel-dev libsimbody-dev)

install_missing "${peers_packages[@]}"
for package in "${engine_packages[@]}"; do
  install_missing "$package" || printf 'dev: %s cannot be installed here; going on without it\n' "$package" >&2
done
say "Building: ricochet_peers with the engines that are installed"
cmake --preset release -B build/peers --log-level=STATUS -DRICOCHET_PEERS=ON -DRICOCHET_SERVICE=OFF \
  -DRICOCHET_TESTS=OFF -DRICOCHET_BENCHMARKS=OFF | { grep '^-- Peers:' || true; }
cmake --build build/peers --target ricochet_peers
say "The recipes of docs/your_robot.md in the libraries that they are for"
for recipe in mujoco simbody; do
  cmake --build build/peers --target "ricochet_${recipe}_recipe_test" >/dev/null 2>&1 || continue
  show "build/peers/tests/robots/ricochet_${recipe}_recipe_test" --gtest_brief=1
done
say "One impact of the paper's pendulum in each engine"
# The numerical libraries of some engines would start threads for matrices of one row.
show env OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 build/peers/tests/peers/ricochet_peers \
  conformance/impacts.json tests/peers/results.csv
show /usr/bin/python3 tests/peers/report.py tests/peers/results.csv "${engine_packages[@]}"
say "The conformance cases in each engine, by answers files and conformance/grade.py"
show /usr/bin/python3 tests/peers/conformance.py tests/peers/results.csv build/peers/answers
echo "-> docs/peers.md, docs/images/peers.svg, tests/peers/results.csv"

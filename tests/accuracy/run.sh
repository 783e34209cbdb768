#!/usr/bin/env bash
# ./dev accuracy: what accuracy costs; writes docs/accuracy.md and docs/peers.md.
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"

# Writes a study of cost into build/accuracy/NAME.json, and its picture into docs/images.
# usage: study_cost NAME SCENE-ARGUMENT...
study_cost() {
  local name=$1
  shift
  show "$ricochet" cost "$@" --time-limit 20s --format json -o "build/accuracy/$name.json" \
    --plot "docs/images/cost_$name.svg" --html "build/accuracy/$name.html"
}

install_missing "${demo_packages[@]}" "${bench_packages[@]}"
mkdir -p build/accuracy
build_benchmarks
say "What accuracy costs: three scenes, each by every method"
study_cost pendulum "${example[@]}"
study_cost planar --scene tests/data/scenes/sphere_20.textproto
study_cost spatial --scene tests/data/scenes/turning_contact.textproto
say "Speed, as ratios"
run_benchmarks | tee build/accuracy/bench.txt
tests/accuracy/claims.sh | tee build/accuracy/claims.log
sed -n '/^method /,$p' build/accuracy/claims.log >build/accuracy/claims.txt
tests/peers/run.sh
show /usr/bin/python3 tests/accuracy/report.py build/accuracy
echo "-> docs/accuracy.md, docs/images/cost_*.svg, docs/peers.md, docs/images/peers.svg, build/accuracy/*.html"

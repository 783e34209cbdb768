#!/usr/bin/env bash
# ./dev bench: speed, as ratios to what is measured in the same run. Usage: run.sh [--short]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"

build_benchmarks
show /usr/bin/python3 tests/benchmark/plan_cost.py build/release/tests/benchmark/ricochet_plan_cost
[[ ${1-} != --short ]] || exit 0
run_benchmarks
show /usr/bin/python3 tests/benchmark/start.py
show /usr/bin/python3 tests/benchmark/numpy_peer.py
show /usr/bin/python3 tests/benchmark/python_calls.py
show /usr/bin/python3 tests/benchmark/growth.py
echo "-> docs/growth.md, docs/images/growth.svg"
show /usr/bin/python3 tests/benchmark/fan_out.py
show /usr/bin/python3 tests/benchmark/baseline.py

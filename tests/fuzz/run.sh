#!/usr/bin/env bash
# ./dev fuzz: every target on its corpus and for some seconds more. Usage: run.sh [--short] [SECONDS | --coverage]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"
if [[ ${1-} == --short ]]; then shift && short=yes; fi

readonly fuzz_packages=(
  "${build_packages[@]}" clang libclang-rt-14-dev llvm python3-grpcio python3-numpy python3-protobuf)
readonly fuzz_targets=(
  batches chunks contacts cost duration fit models partial ranges scene_input sweep_files tables wire)

# The code that a fuzz target names, which its corpus must cover.
fuzzed_code() {
  case $1 in
    batches) find core/rows core/types/check_rows.cc core/types/grid.cc -name '*.cc' ;;
    chunks) echo client/chunk_checker.cc client/tally_checker.cc proto/wire/chunk_seal.cc proto/wire/crc32c.cc ;;
    contacts) find core/multi core/contact/multi_reduction.cc core/scene/validate_multi.cc -name '*.cc' ;;
    cost)
      find core/cost -name '*cost*.cc' -o -name '*_methods.cc' -o -name 'reference_velocity.cc' \
        -o -name 'stopwatch.cc'
      ;;
    duration) find core/models/finite_duration core/contact/finite_forces.cc -name '*.cc' ;;
    fit) find core/fit -name '*.cc' ;;
    models)
      find core/engine/local_solver.cc core/answer core/contact core/models core/plan/scene_problem.cc core/scene \
        core/audit/audit.cc core/audit/audit_parts.cc core/audit/audit_scene.cc core/audit/coulomb_path.cc \
        -name '*.cc' ! -path '*/finite_duration/*' ! -name 'finite_*.cc' ! -name interval_reduction.cc \
        ! -name scene_enclosure.cc ! -name '*_lanes.cc'
      ;;
    partial)
      echo client/cli/io/partial_file.cc client/cli/sweep/sweep_output.cc client/cli/sweep/shard.cc \
        client/cli/sweep/shard_coverage.cc client/cli/merge.cc
      ;;
    ranges)
      echo core/answer/scene_enclosure.cc core/contact/interval_reduction.cc core/bounds/enclosure.cc \
        core/bounds/one_regime_ends.cc core/bounds/pendulum_ends.cc core/bounds/planar_ends.cc
      ;;
    scene_input) echo client/cli/input/scene_input.cc client/cli/text/number_input.cc ;;
    sweep_files)
      echo client/cli/sweep/sweep_file.cc client/cli/sweep/sweep_rows.cc client/cli/sweep/npy_reader.cc \
        client/cli/sweep/netcdf_table.cc client/cli/sweep/sweep_json.cc
      ;;
    tables) echo client/cli/io/csv_table.cc client/cli/input/audit_data.cc ;;
    wire) find proto/wire -name '*.cc' ! -name chunk_seal.cc ! -name crc32c.cc ;;
  esac
}

build_fuzz() {
  local preset=$1
  install_missing "${fuzz_packages[@]}"
  say "Building: preset $preset, the core and the targets by clang"
  cmake --preset "$preset" --log-level=WARNING
  cmake --build --preset "$preset" --target "${fuzz_targets[@]/#/ricochet_fuzz_}"
  mkdir -p "build/$preset/runs"
}

# Runs a target of a preset in build/PRESET/runs, where what it finds, and any profile, is kept.
run_fuzz_target() {
  local runs=build/$1/runs program=build/$1/tests/fuzz/ricochet_fuzz_$2 target=$2
  shift 2
  LLVM_PROFILE_FILE=$runs/$target.profraw UBSAN_OPTIONS=print_stacktrace=1 "$program" -rss_limit_mb=4096 -timeout=60 \
    -artifact_prefix="$runs/$target-" -print_final_stats=1 "$@" &>"$runs/$target.log"
}

# Runs a target on its corpus and what it has found before, and for so many seconds more.
run_fuzz_for() {
  local target=$1 seconds=$2 corpora=("build/fuzz/runs/$1" "tests/fuzz/corpus/$1") start=$SECONDS
  mkdir -p "${corpora[0]}"
  run_fuzz_target fuzz "$target" -runs=0 "${corpora[@]}" &&
    run_fuzz_target fuzz "$target" -max_total_time=$((seconds + SECONDS - start)) "${corpora[@]}"
}

# Inputs beyond the corpus that a target is given in the short form: about five seconds of work.
short_inputs() {
  case $1 in
    chunks | scene_input | wire) echo 30000 ;;
    duration | ranges | tables) echo 5000 ;;
    batches | cost | sweep_files) echo 1000 ;;
    contacts | fit | models | partial) echo 200 ;;
  esac
}

# CI gives the same inputs each time, so that it fails because of a change and not by chance. Comparisons are not
# traced, because the addresses in that table differ from run to run.
run_short_fuzz() {
  local target=$1 corpus=tests/fuzz/corpus/$1 found inputs
  found=$(mktemp -d)
  inputs=$(($(find "$corpus" -type f | wc -l) + $(short_inputs "$target")))
  run_fuzz_target fuzz "$target" -seed=1 -use_cmp=0 "-runs=$inputs" "$found" "$corpus"
}

run_fuzz() {
  if is_short; then run_short_fuzz "$1"; else run_fuzz_for "$@"; fi
}

fuzz_messages() {
  local seconds=$1
  say "Fuzzing the messages that the Python package reads: $seconds s"
  build_for_tests ricochet_python
  show env PYTHONPATH=build/dev/python/package /usr/bin/python3 tests/fuzz/python_messages.py --seconds "$seconds"
}

fuzz_all() {
  local seconds=$1 target verdict failed=0
  if is_short; then say "Fuzzing: the same inputs each time"; else say "Fuzzing: $seconds s a target"; fi
  printf '%-12s %10s %8s %8s %8s  %s\n' target inputs per_s edges corpus finding
  for target in "${fuzz_targets[@]}"; do
    verdict=none
    run_fuzz "$target" "$seconds" ||
      verdict=$(sed -n 's/^.*Test unit written to //p' "build/fuzz/runs/$target.log" | tail -n 1)
    awk -v target="$target" -v verdict="${verdict:-see build/fuzz/runs/$target.log}" '
      $1 == "stat::number_of_executed_units:" { inputs = $2 }
      $1 == "stat::average_exec_per_sec:" { rate = $2 }
      $3 == "cov:" { edges = $4 }
      { for (i = 1; i < NF; ++i) if ($i == "corp:") corpus = $(i + 1) }
      END { printf "%-12s %10d %8d %8d %8s  %s\n", target, inputs, rate, edges, corpus, verdict }' \
      "build/fuzz/runs/$target.log"
    [[ $verdict == none ]] || failed=1
  done
  ((!failed)) ||
    die "there are findings: build/fuzz/runs/TARGET.log says what; ricochet_fuzz_TARGET FILE shows it again"
}

# The lines of the named code that each corpus goes through.
fuzz_coverage() {
  local target runs=build/fuzz-coverage/runs failed=0
  say "Lines covered by the seed corpora"
  printf '%-12s %-44s %8s %8s %8s\n' target file lines missed covered
  for target in "${fuzz_targets[@]}"; do
    run_fuzz_target fuzz-coverage "$target" -runs=0 "tests/fuzz/corpus/$target" || die "$target: see $runs/$target.log"
    llvm-profdata merge --sparse "$runs/$target.profraw" -o "$runs/$target.profdata"
    # A build by ccache names its sources by relative paths, on which filters of llvm-cov do not act.
    fuzzed_code "$target" | xargs -n 1 >"$runs/$target.code"
    llvm-cov report "build/fuzz-coverage/tests/fuzz/ricochet_fuzz_$target" --instr-profile="$runs/$target.profdata" \
      --show-region-summary=false --show-branch-summary=false |
      awk -v target="$target" '
        function row(file, lines, missed) {
          printf "%-12s %-44s %8d %8d %7.2f%%\n", target, file, lines, missed, 100 * (1 - missed / lines)
        }
        NR == FNR { named[$1]; next }
        { sub(/^.*\.\.\//, "", $1) }
        $1 in named { row($1, $5, $6); lines += $5; missed += $6; ++found }
        END {
          if (found) row("all " found " files", lines, missed)
          exit !found || missed > 0.1 * lines
        }' "$runs/$target.code" - || failed=1
  done
  ((!failed)) || die "a corpus covers less than 90 % of the lines of the code that its target names"
}

seconds=${1-60}
! is_short || seconds=5
[[ $seconds == --coverage || $seconds =~ ^[1-9][0-9]*$ ]] ||
  usage_error "fuzz takes a number of seconds or --coverage, not '$seconds'"
if [[ $seconds == --coverage ]]; then
  build_fuzz fuzz-coverage
  fuzz_coverage
else
  build_fuzz fuzz
  fuzz_messages "$seconds"
  fuzz_all "$seconds"
fi

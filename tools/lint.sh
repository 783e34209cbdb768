#!/usr/bin/env bash
# ./dev lint: clang-tidy, shellcheck and the compiler of Python. Usage: lint.sh [--scripts | --changed [COMMIT]]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/dev_lib.sh"

readonly script_packages=(python3 shellcheck)
readonly lint_packages=("${test_packages[@]}" "${script_packages[@]}" clang-tidy)

check_scripts() {
  say "shellcheck and Python's compiler"
  {
    printf '%s\0' dev .ci/run
    find deploy packaging tests tools \( -name '*.sh' -o -name '*.sbatch' \) -print0
  } | xargs -0 shellcheck
  temporary=$(mktemp -d)
  find python tests -name '*.py' -print0 | PYTHONPYCACHEPREFIX=$temporary xargs -0 /usr/bin/python3 -m py_compile
}

# The sources that differ from a commit, and those of the headers that do, as far as the preset dev compiles them.
changed_sources() {
  git diff --name-only --diff-filter=d "$1" -- core proto server client python tests | grep -E '\.(h|cc)$' |
    sed 's/\.h$/.cc/' | sort -u | while read -r file; do
    ! grep -qF "\"file\": \"$PWD/$file\"" build/dev/compile_commands.json || echo "$file"
  done
}

# The commit before the change that is checked: where its branch leaves the main one, or else the last but one.
base_of_change() {
  local base
  base=$(git merge-base HEAD origin/main 2>/dev/null) || base=
  [[ -n $base && $base != "$(git rev-parse HEAD)" ]] || base=$(git rev-parse --verify --quiet HEAD^) || base=HEAD
  echo "$base"
}

# clang-tidy of what a change touches, begun for no longer than LINT_SECONDS; what is left out is named.
lint_changed() {
  local base=${1:-$(base_of_change)} end=$((SECONDS + ${LINT_SECONDS:-360})) file files running=0 failed=0
  mapfile -t files < <(changed_sources "$base")
  say "clang-tidy of ${#files[@]} sources that differ from $(git rev-parse --short "$base")"
  for file in "${files[@]}"; do
    if ((SECONDS >= end)); then
      echo "left out for time: $file"
      continue
    fi
    if ((running == $(nproc))); then
      wait -n || failed=1
      running=$((running - 1))
    fi
    echo "$file"
    clang-tidy --quiet -p build/dev --extra-arg=-Wno-unknown-warning-option "$PWD/$file" 2>/dev/null &
    running=$((running + 1))
  done
  for ((; running > 0; --running)); do wait -n || failed=1; done
  ((!failed)) || die "clang-tidy has findings"
}

case ${1-} in
  "" | --changed) install_missing "${lint_packages[@]}" ;;
  --scripts) install_missing "${script_packages[@]}" ;;
  *) usage_error "lint takes --changed [COMMIT], --scripts or nothing, not '$1'" ;;
esac
[[ ${1-} == --changed ]] || check_scripts
if [[ ${1-} == --scripts ]]; then exit; fi
cmake --preset dev --log-level=WARNING
cmake --build --preset dev --target ricochet_proto
if [[ ${1-} == --changed ]]; then
  lint_changed "${2-}"
  exit
fi
say "clang-tidy"
run-clang-tidy -quiet -p build/dev -extra-arg=-Wno-unknown-warning-option -j "$(nproc)" \
  "^$PWD/(core|proto|server|client|python|tests)/.*\.cc$"

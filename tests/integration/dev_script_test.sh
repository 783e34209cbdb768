#!/usr/bin/env bash
# ./dev explains all of its commands and refuses everything else. usage: dev_script_test.sh DEV
set -euo pipefail
readonly dev=$1

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

# Runs ./dev and demands its exit code.
expect_code() {
  local wanted=$1 code=0
  shift
  "$dev" "$@" >/dev/null 2>&1 || code=$?
  ((code == wanted)) || fail "./dev $* ended with $code, not $wanted"
}

help=$("$dev" help)
commands=$(sed -n 's/^cmd_\([a-z]*\)() .*/\1/p' "$dev")
[[ -n $commands ]] || fail "no commands found in $dev"
known=$(sed -n '/^case .command in/,/^esac/p' "$dev")
for command in $commands; do
  grep -q "^  $command " <<<"$help" || fail "./dev help says nothing about $command"
  grep -qw "$command" <<<"$known" || fail "./dev refuses its own command $command"
done
expect_code 0 help
expect_code 0
expect_code 2 nonsense
expect_code 2 clean everything
expect_code 2 format --nonsense
expect_code 2 lint --nonsense

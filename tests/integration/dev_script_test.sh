#!/usr/bin/env bash
# ./dev explains all of its commands and refuses everything else, and CI runs of them what CONTRIBUTING.md says.
# usage: dev_script_test.sh DEV
set -euo pipefail
readonly dev=$1
root=$(dirname "$dev")
readonly root

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
# Commands are functions of ./dev, or scripts in its table.
commands=$(sed -n 's/^cmd_\([a-z]*\)() .*/\1/p; s/^  \[\([a-z]*\)\]=.*/\1/p' "$dev")
[[ -n $commands ]] || fail "no commands found in $dev"
for command in $commands; do
  grep -q "^  $command " <<<"$help" || fail "./dev help says nothing about $command"
done
while read -r script; do
  [[ -x $root/$script ]] || fail "./dev names $script, which is no program"
done < <(sed -n 's/^  \[[a-z]*\]=\([a-z_/.]*\))*$/\1/p' "$dev")
# The rooms that the short form of asan goes through have tests of these names.
read -ra rooms < <(sed -n 's/^readonly short_asan_tests=(\(.*\))/\1/p' "$dev")
((${#rooms[@]})) || fail "$dev names no short_asan_tests"
for room in "${rooms[@]}"; do
  grep -Eq "ricochet_core_test\($room( |\$)|add_executable\(ricochet_${room}_test " "$root/tests/core/CMakeLists.txt" ||
    fail "there is no test ricochet_${room}_test, which asan --short runs"
done
expect_code 0 help
expect_code 0
expect_code 2 nonsense
expect_code 2 clean everything
expect_code 2 format --nonsense
expect_code 2 lint --nonsense
expect_code 2 clean --short
expect_code 2 fuzz soon
expect_code 2 ulp 1 2
expect_code 2 soak --nonsense

# The row of a command in the table, and what it says about CI.
table=$(grep '^| `./dev ' "$root/CONTRIBUTING.md")
for command in $commands; do
  row=$(grep "^| \`./dev $command\` " <<<"$table") || fail "the table of CONTRIBUTING.md lacks $command"
  ci=$(sed 's/ *|$//; s/.*| //' <<<"$row")
  runs=$(grep -E "^step ./dev $command( |$)" "$root/.ci/run") || runs=
  case $ci in
    whole*)
      [[ -n $runs ]] || fail "CI does not run $command, which is to run whole"
      [[ $runs != *--short* ]] || fail "CI runs $command short, which is to run whole"
      ;;
    short:*)
      # lint has two short forms of its own.
      [[ $runs == *--short* || $command == lint && $runs == *--scripts* && $runs == *--changed* ]] ||
        fail "CI does not run $command short"
      ;;
    no:*) [[ -z $runs ]] || fail "CI runs $command, which the table denies" ;;
    *) fail "the table says neither whole, short: nor no: of $command, but '$ci'" ;;
  esac
done
# Commands that the table or CI names, one a line.
# shellcheck disable=SC2016  # The backquotes are those of Markdown.
named=$(sed -n 's/^| `\.\/dev \([a-z]*\)` .*/\1/p' <<<"$table"
  sed -n 's/^step \.\/dev \([a-z]*\).*/\1/p' "$root/.ci/run")
while read -r command; do
  grep -qx "$command" <<<"$commands" || fail "there is no command ./dev $command"
done <<<"$named"
# A short form that no machine runs would rot.
read -ra short_commands < <(sed -n "s/^readonly short_commands='\(.*\)'/\1/p" "$dev")
((${#short_commands[@]})) || fail "$dev names no short_commands"
for command in "${short_commands[@]}"; do
  grep -q "^step ./dev $command --short\$" "$root/.ci/run" || fail "CI does not run ./dev $command --short"
done

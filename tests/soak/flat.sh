#!/usr/bin/env bash
# ./dev flat: the memory of server and client while a long sweep is streamed. Usage: flat.sh [--short]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"
if [[ ${1-} == --short ]]; then shift && short=yes; fi

resident_kib() { awk '$1 == "VmRSS:" { print $2 }' "/proc/$1/status" 2>/dev/null || true; }

# Reports one process's growth; false if it reached 32 MiB.
report_growth() {
  awk -v who="$1" -v start="$2" -v most="$3" 'BEGIN {
    growth = (most - start) / 1024
    printf "%-10s start %7.1f MiB, most %7.1f MiB, growth %6.1f MiB\n", who, start / 1024, most / 1024, growth
    exit growth >= 32 }'
}

install_missing "${build_packages[@]}"
build_programs
mkdir -p build/flat
points=${FLAT_POINTS:-1000000000}
! is_short || points=100000000
axis=pendulum.b_m=lin:0.5:2
start_server build/flat
sweep=("$ricochet" sweep "${example[@]}" --column coefficients.newton --summary-only --server "$server_address")
say "Warming up: 100000 points"
"${sweep[@]}" --axis "$axis:100000"

say "Memory of a sweep of $points points, resident, in KiB"
client_start=0 client_most=0 samples=0
server_start=$(resident_kib "$server_pid")
server_most=$server_start
"${sweep[@]}" --axis "$axis:$points" >build/flat/summary 2>build/flat/errors &
client=$!
printf '%8s %12s %12s\n' second ricochetd ricochet
while sleep 0.2; do
  server_now=$(resident_kib "$server_pid")
  client_now=$(resident_kib "$client")
  [[ -n $server_now && -n $client_now ]] || break
  ((samples++)) || client_start=$client_now
  ((server_now <= server_most)) || server_most=$server_now
  ((client_now <= client_most)) || client_most=$client_now
  ((samples % 5 != 1)) || printf '%8d %12d %12d\n' $((samples / 5)) "$server_now" "$client_now"
done
if ! wait "$client"; then
  cat build/flat/errors >&2
  die "the sweep failed"
fi
((samples)) || die "the sweep ended before its memory was looked at; give FLAT_POINTS a larger number"
cat build/flat/summary
stop_server
echo
report_growth ricochetd "$server_start" "$server_most" || die "the server's memory is not flat"
report_growth ricochet "$client_start" "$client_most" || die "the client's memory is not flat"

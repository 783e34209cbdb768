#!/usr/bin/env bash
# ./dev demo: an impact solved here and through a server, and Figure 4 of the paper.
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/dev_lib.sh"

# Prints and runs a command, and keeps its output in the file named first.
show_and_keep() {
  local file=$1
  shift
  show_only "$@"
  "$@" | tee "$file"
}

# A command that has been asked both ways must have given the same bytes.
require_same() {
  cmp "build/demo/$1.embedded" "build/demo/$1.server" ||
    die "$1: the server's answer differs from the embedded one"
  echo "-> byte for byte the embedded answer"
}

install_missing "${demo_packages[@]}"
build_release
mkdir -p build/demo
mu=friction.kinetic_coefficient phi=pendulum.phi_rad
# Fig. 4: Newton's coefficient over the angle of the pin, elastic, for five coefficients of friction.
fig4=(sweep "${example[@]}" --axis "$mu=0.1,1/3,0.5,2/3,1"
  --axis "$phi=lin:0.01:1.5707963267948966:400" --column coefficients.newton)

say "1. An impact, solved in this process: a rigid pendulum strikes a rough surface elastically"
show_and_keep build/demo/solve.embedded "$ricochet" solve "${example[@]}"

say "2. The same question to a server"
start_server build/demo
echo "ricochetd listens on $server_address as process $server_pid"
show "$ricochet" health --server "$server_address"
show_and_keep build/demo/solve.server "$ricochet" solve "${example[@]}" --server "$server_address"
require_same solve

say "3. Which coefficients of restitution are possible at all"
show_and_keep build/demo/bounds.server "$ricochet" bounds "${example[@]}" --server "$server_address"
"$ricochet" bounds "${example[@]}" >build/demo/bounds.embedded
require_same bounds

say "4. 2000 impacts, streamed from the server: Fig. 4 of the paper"
show "$ricochet" "${fig4[@]}" --server "$server_address" --format csv -o build/demo/sweep.server \
  --plot build/demo/fig4.svg
"$ricochet" "${fig4[@]}" --format csv -o build/demo/sweep.embedded
head -n 4 build/demo/sweep.server
require_same sweep
echo "-> the picture: build/demo/fig4.svg"

say "5. SIGTERM: the server drains and leaves"
stop_server
echo "ricochetd ended with 0"

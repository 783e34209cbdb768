#!/usr/bin/env bash
# ./dev fresh: demo and test in a clone on a bare Debian 12.
set -euo pipefail
# shellcheck source=tools/debian_root.sh
source "$(dirname "${BASH_SOURCE[0]}")/debian_root.sh"

require_root fresh "it makes a root directory and enters it"
run_in_fresh_debian "./dev demo; ./dev test"
say "A fresh clone on a bare Debian 12 passes ./dev demo and ./dev test"

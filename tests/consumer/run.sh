#!/usr/bin/env bash
# ./dev consumer: the core alone and a program on it, then a client alone, each in a bare Debian 12.
# Usage: run.sh [--short]
set -euo pipefail
# shellcheck source=tools/debian_root.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/debian_root.sh"
if [[ ${1-} == --short ]]; then shift && short=yes; fi

require_root consumer "it makes a root directory and enters it"
unshare --mount --pid --fork true 2>/dev/null || cannot_run "consumer needs mounts, which this machine forbids"
launcher='' flags=-O2
packages=$(IFS=,; echo "${core_packages[*]}")
# The short form takes the objects of the preset dev, whose compiler and flags are the same and whose folder is as deep.
if is_short; then
  shared_cache=$(ccache --get-config cache_dir)
  launcher=ccache
  flags='-O2 -g1'
fi
run_in_fresh_debian "cmake -DSOURCE_DIR=/root/ricochet -DWORK_DIR=/root/ricochet/build/dev/tests/core_only \
  -DCORE_DIR=/root/ricochet/build/dev_core_only -DCXX_FLAGS='$flags' -DLAUNCHER=$launcher \
  -P tests/consumer/core_only_test.cmake" --include="$packages"
say "The core alone and a program on it build and run with no more than: $packages"
rm -rf --one-file-system "$temporary"

install_missing "${build_packages[@]}"
build_programs
temporary=$(mktemp -d /var/tmp/ricochet-client.XXXXXX)
root=$temporary/root
packages=$(IFS=,; echo "${client_packages[*]}")
make_debian "$root" --include="$packages"
cmake --install "${ricochet%/client/ricochet}" --component client --prefix "$root/root/client/prefix" >/dev/null
cp -r tests/consumer "$root/root"
in_root "$root" "cmake -DWORK_DIR=/root/client -DCXX_FLAGS=-O1 -DLAUNCHER= -P /root/consumer/client_only_test.cmake"
say "A client alone builds and runs with no more than: $packages"

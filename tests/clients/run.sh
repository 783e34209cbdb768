#!/usr/bin/env bash
# ./dev clients: clients of other makers ask a server by reflection alone.
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"

command -v npm >/dev/null || install_missing nodejs npm
install_missing "${build_packages[@]}"
build_release
mkdir -p build/clients
cp tests/clients/package.json build/clients/
npm install --prefix build/clients --no-audit --no-fund
show tests/clients/clients_test.sh "$PWD/$ricochetd" "$PWD/build/clients"

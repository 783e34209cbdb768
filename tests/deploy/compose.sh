#!/usr/bin/env bash
# ./dev compose: three servers, HAProxy and Prometheus by podman-compose.
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/dev_lib.sh"

require_root compose "it runs containers without a daemon"
install_missing "${build_packages[@]}" "${image_packages[@]}" podman-compose python3
build_release
buildah inspect --type image "$image" &>/dev/null || tests/deploy/image.sh
say "Three servers, HAProxy and Prometheus by podman-compose, with one server killed and one drained"
show /usr/bin/python3 tests/deploy/compose_test.py . "$ricochet" build/compose "$image"

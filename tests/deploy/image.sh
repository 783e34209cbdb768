#!/usr/bin/env bash
# ./dev image: the container image, built, looked into, run, asked and stopped.
set -euo pipefail
# shellcheck source=tools/debian_root.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../tools/debian_root.sh"

readonly base_image=docker.io/library/debian:bookworm-slim

make_base_image() {
  ! buildah inspect --type image "$base_image" &>/dev/null || return 0
  say "Making $base_image from Debian's packages, as no copy of it is here"
  # The public slim image leaves these out as well, and the package usrmerge, which would bring 30 MB of Perl.
  make_debian "$temporary/base.tar" --hook-dir=/usr/share/mmdebstrap/hooks/merged-usr --include=usr-is-merged \
    --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
    --dpkgopt='path-exclude=/usr/share/man/*'
  local scratch
  scratch=$(buildah from scratch)
  buildah add --quiet "$scratch" "$temporary/base.tar" / >/dev/null
  buildah commit --quiet --rm "$scratch" "$base_image" >/dev/null
}

require_root image "it builds and runs a container without a daemon"
install_missing "${image_packages[@]}"
temporary=$(mktemp -d)
make_base_image
show buildah bud --pull-never --layers --format docker --isolation chroot \
  --build-arg VERSION="$(sed -n 's/^project(ricochet VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)" \
  --build-arg COMMIT="$(git rev-parse HEAD)" --file deploy/Dockerfile --tag "$image" .
mkdir -p build/image
show /usr/bin/python3 tests/deploy/image_check.py "$image" "$(git rev-parse HEAD)" build/image/sbom.json

# runc and cgroupfs: what works without systemd. The ulimits spare podman a capability it may lack.
container=ricochet-image-test-$$
show podman run --detach --name "$container" --runtime runc --cgroup-manager cgroupfs --no-healthcheck \
  --ulimit nofile=1024:4096 --ulimit nproc=4096:4096 --read-only --cap-drop ALL \
  --memory 1g --cpus 2 "$image"
inside=(podman exec "$container" ricochet)
for _ in {1..50}; do
  "${inside[@]}" health --server 127.0.0.1:50051 &>/dev/null && break
  sleep 0.2
done
show "${inside[@]}" health --server 127.0.0.1:50051
show "${inside[@]}" solve "${example[@]}" --server 127.0.0.1:50051
show podman stop --time 60 "$container"
code=$(podman inspect --format '{{.State.ExitCode}}' "$container")
((code == 0)) || die "the container ended with $code, not 0"
echo "-> the container drained and ended with 0"
podman images "$image"

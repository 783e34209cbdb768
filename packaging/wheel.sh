#!/usr/bin/env bash
# ./dev wheel: the Python package as a wheel, in build/wheel.
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../tools/dev_lib.sh"

readonly wheel_packages=(
  libgrpc++-dev libprotobuf-dev protobuf-compiler protobuf-compiler-grpc python3-build python3-setuptools python3-wheel)
install_missing "${build_packages[@]}" "${wheel_packages[@]}"
say "Building: the Python package"
cmake --preset release --log-level=WARNING -DRICOCHET_TESTS=OFF -DRICOCHET_BENCHMARKS=OFF
cmake --build --preset release --target ricochet_python
rm -rf build/wheel
show /usr/bin/python3 -m build --wheel --no-isolation --outdir build/wheel build/release/python/package

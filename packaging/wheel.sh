#!/usr/bin/env bash
# ./dev wheel: the Python package as a wheel, in build/wheel, with the libraries that not every Linux has.
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../tools/dev_lib.sh"

readonly wheel_packages=(patchelf python3-build python3-numpy python3-setuptools python3-wheel)
readonly staged=build/release/python/package/ricochet

# Copies the libraries that the module needs to it, where it then finds them, and their licences; those of glibc and of
# GCC are everywhere.
bundle_libraries() {
  local module=$1 library package
  mkdir -p "$staged/libs/copyright"
  ldd "$module" | sed -n 's/.* => \(\/[^ ]*\) .*/\1/p' |
    grep -vE '/(lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+)\.so|ld-linux)' | while read -r library; do
    install -m 644 "$library" "$staged/libs/"
    # A path of dpkg may lack /usr.
    package=$(dpkg -S "*/$(basename "$(realpath "$library")")" | head -n 1 | cut -d: -f1)
    install -m 644 "/usr/share/doc/$package/copyright" "$staged/libs/copyright/$package"
  done
  # shellcheck disable=SC2016  # The loader replaces $ORIGIN.
  {
    patchelf --set-rpath '$ORIGIN' "$staged"/libs/*.so*
    patchelf --set-rpath '$ORIGIN/libs' "$module"
  }
}

install_missing "${build_packages[@]}" "${wheel_packages[@]}"
say "Building: the Python package"
# With its stamps and what setuptools keeps of an earlier wheel, so that all of it is made anew.
rm -rf build/wheel "${staged%/*}"
cmake --preset release --log-level=WARNING -DRICOCHET_TESTS=OFF -DRICOCHET_BENCHMARKS=OFF
cmake --build --preset release --target ricochet_python
strip --strip-unneeded "$staged"/_core*.so
bundle_libraries "$(echo "$staged"/_core*.so)"
show /usr/bin/python3 -m build --wheel --no-isolation --outdir build/wheel "${staged%/*}"
say "What the wheel holds computes with its own libraries"
temporary=$(mktemp -d)
/usr/bin/python3 -m zipfile -e build/wheel/*.whl "$temporary"
env -i PYTHONPATH="$temporary" /usr/bin/python3 - "$temporary" <<'PYTHON'
import pathlib, re, sys
import ricochet

outcome = ricochet.solve({
    "pendulum": {"inertia_kg_m2": 1, "a_m": 0.3, "b_m": 1, "omega_minus_rad_s": -1},
    "friction": {"kinetic_coefficient": 0.1}, "restitution": {"energetic": 1}})
assert abs(outcome.coefficients.newton - 0.5**0.5) < 1e-15, outcome
found = {line.split()[-1] for line in open("/proc/self/maps") if re.search(r"lib(grpc|protobuf|absl|flint)", line)}
assert found and all(path.startswith(sys.argv[1]) for path in found), found
licences = {path.name for path in pathlib.Path(sys.argv[1]).glob("ricochet/libs/copyright/*")}
assert any("flint" in name for name in licences), licences
print(f"{outcome!r}\n{len(found)} libraries of the wheel, {len(licences)} licences")
PYTHON

# ./dev and the scripts of its commands share this: the Debian packages, messages, builds, and a server that is started
# and stopped. A script sources this file first, and is then at the top of the repository.
# shellcheck shell=bash disable=SC2034  # The scripts read the variables.
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit

# core_packages build the core without its optional components; build_packages add these and the service.
readonly core_packages=(ccache cmake g++ libabsl-dev libboost-dev libeigen3-dev libhwy-dev libsleef-dev ninja-build)
readonly client_packages=(
  cmake g++ libabsl-dev libgrpc++-dev libisal-dev libprotobuf-dev libssl-dev ninja-build protobuf-compiler-grpc)
readonly build_packages=(
  "${core_packages[@]}" libflint-arb-dev libflint-dev libgmp-dev
  libcli11-dev libgrpc++-dev libisal-dev libnetcdf-dev libprotobuf-dev libpython3-dev libspdlog-dev libssl-dev
  libzip-dev nlohmann-json3-dev prometheus-cpp-dev libcivetweb-dev protobuf-compiler protobuf-compiler-grpc pybind11-dev
  python3)
readonly demo_packages=("${build_packages[@]}" gnuplot-nox)
readonly bench_packages=(
  "${build_packages[@]}" fonts-dejavu-core gnuplot-nox libsundials-dev python3-grpcio python3-numpy python3-protobuf
  valgrind)
readonly test_packages=(
  "${build_packages[@]}" bash-completion curl gnuplot-nox groff-base haproxy libgmock-dev libgtest-dev libmujoco-dev
  mandoc mypy nghttp2-client nginx openssl pkg-config prometheus python3-cryptography python3-grpcio python3-h2
  python3-jsonschema python3-mpmath python3-netcdf4 python3-numpy python3-pandas python3-protobuf python3-seccomp
  python3-xarray python3-yaml systemd valgrind zsh)
readonly image_packages=(
  aardvark-dns buildah catatonit conmon iptables mmdebstrap netavark podman runc)

# The programs that are shipped; the short form of a command takes those of the tests.
ricochet=build/release/client/ricochet
ricochetd=build/release/server/ricochetd
# The container image that `./dev image` makes.
readonly image=localhost/ricochet:dev
# The paper's elastic pendulum: the tip 0.3 m beside and 1 m below the pin, mu = 0.1.
readonly example=(--a 0.3 --b 1 --mu 0.1 --energetic 1)

# Objects are the same in every directory, so that ccache has them for a second build elsewhere.
export CCACHE_NOHASHDIR=1 CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD}

# The servers and pages of the tests are on this host, where no proxy is to be asked for them.
export no_proxy=${no_proxy:+$no_proxy,}127.0.0.1,localhost,::1

# Not empty if the command was asked for its short form.
short=

# The function cleanup ends or removes these, however the script ends.
server_pid=
temporary=
container=
cleanup() {
  if [[ -n $server_pid ]]; then kill "$server_pid" 2>/dev/null || true; fi
  if [[ -n $container ]]; then podman rm --force "$container" >/dev/null 2>&1 || true; fi
  if [[ -n $temporary ]]; then rm -rf --one-file-system "$temporary"; fi
}
trap cleanup EXIT

is_short() { [[ -n $short ]]; }
say() { printf '\n== %s\n' "$*"; }
die() {
  printf 'dev: %s\n' "$*" >&2
  exit 1
}

usage_error() {
  printf 'dev: %s\n\n' "$1" >&2
  ./dev help >&2
  exit 2
}

show_only() { printf '\n$ %s\n' "$*"; }

# Prints a command as one would type it, then runs it.
show() {
  show_only "$@"
  "$@"
}

as_root() {
  if ((EUID == 0)); then
    "$@"
  else
    sudo "$@"
  fi
}

# Ends a command that cannot run here. For its short form that is no failure.
cannot_run() {
  is_short || die "$1"
  say "skipped: $1"
  exit 0
}

require_root() {
  ((EUID == 0)) || cannot_run "$1 needs root: $2; run it by sudo"
}

# Installs the Debian packages among its arguments that are not there.
install_missing() {
  local missing=() package
  for package in "$@"; do
    if [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
      missing+=("$package")
    fi
  done
  ((${#missing[@]})) || return 0
  say "Installing what is missing, from Debian: ${missing[*]}"
  local apt=(as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0)
  # Package lists may be absent (a fresh root) or name files that the mirror has replaced since.
  if ! apt-get install --simulate --no-install-recommends "${missing[@]}" &>/dev/null; then
    "${apt[@]}" update
  fi
  if ! "${apt[@]}" install --no-install-recommends "${missing[@]}" >/dev/null; then
    "${apt[@]}" update
    "${apt[@]}" install --no-install-recommends "${missing[@]}" >/dev/null
  fi
}

configure_and_build() {
  local preset=$1
  shift
  say "Building: preset $preset"
  cmake --preset "$preset" --log-level=WARNING "$@"
  cmake --build --preset "$preset"
}

# Builds these targets as the tests have them.
build_for_tests() {
  say "Building: preset dev, $*"
  cmake --preset dev --log-level=WARNING
  cmake --build --preset dev --target "$@"
}

# Fails if a program that is shipped lacks what RICOCHET_HARDENING asks for.
check_hardened() {
  local program what
  for program in "$ricochet" "$ricochetd"; do
    what=$(readelf --wide --file-header --program-headers --dynamic --dyn-syms "$program")
    for property in 'Type: +DYN' GNU_RELRO BIND_NOW __stack_chk_fail \
      '__(mem|str|sn?printf|vsn?printf|fprintf|read).*_chk'; do
      grep -Eq "$property" <<<"$what" || die "$program is not hardened: readelf shows no $property"
    done
  done
}

build_release() {
  configure_and_build release -DRICOCHET_TESTS=OFF -DRICOCHET_BENCHMARKS=OFF
  check_hardened
}

# Builds the programs that a command tries: what is shipped, or for its short form what the tests try anyway.
build_programs() {
  if ! is_short; then
    build_release
    return
  fi
  build_for_tests ricochet ricochetd
  ricochet=build/dev/client/ricochet
  ricochetd=build/dev/server/ricochetd
}

build_benchmarks() {
  install_missing "${bench_packages[@]}"
  configure_and_build release -DRICOCHET_TESTS=OFF -DRICOCHET_BENCHMARKS=ON
}

run_benchmarks() {
  local bench
  for bench in build/release/tests/benchmark/ricochet_bench_*; do
    [[ -x $bench ]] || die "no benchmark was built"
    "$bench"
  done
}

# Starts the server on a free port of 127.0.0.1; sets server_pid and server_address.
start_server() {
  local directory=$1
  rm -f "$directory/port"
  "$ricochetd" --listen 127.0.0.1:0 --port-file "$directory/port" \
    >"$directory/server.log" 2>&1 &
  server_pid=$!
  for _ in {1..100}; do
    if [[ -s $directory/port ]]; then
      server_address=127.0.0.1:$(<"$directory/port")
      return
    fi
    kill -0 "$server_pid" 2>/dev/null || break
    sleep 0.1
  done
  cat "$directory/server.log" >&2
  die "ricochetd did not start"
}

# SIGTERM drains the server; anything but exit code 0 is a failure.
stop_server() {
  local pid=$server_pid
  server_pid=
  kill "$pid"
  wait "$pid" || die "ricochetd $pid ended with $?, not 0"
}

#!/usr/bin/env bash
# In a bare Debian 12: installs the packages, tries what each is for, removes them, and demands that nothing is left.
# usage: debs_test.sh DIRECTORY, as root. The directory has the packages, page.py and first_hour.md.
set -euo pipefail
readonly directory=$1
export DEBIAN_FRONTEND=noninteractive

fail() {
  printf 'debs_test: %s\n' "$*" >&2
  exit 1
}
say() { printf '\n-- %s\n' "$*"; }
apt() { apt-get -qq -o Dpkg::Use-Pty=0 "$@" >/dev/null; }

# Every file but what the package manager and a running system keep for themselves.
files() {
  find / -xdev \( -path /proc -o -path /sys -o -path /tmp -o -path /run -o -path /var/cache -o -path /var/log \
    -o -path /var/lib/apt -o -path /var/lib/dpkg -o -path "$directory" \
    -o -path '/etc/*shadow-' -o -path /etc/passwd- -o -path /etc/group- \) -prune -o -print | sort
}

say "A C++ client, where nothing of the engine and none of its libraries is"
apt update
apt install --no-install-recommends "$directory"/libricochet-client-dev_*.deb cmake g++ make
mkdir /tmp/client && cd /tmp/client
cat >main.cc <<'CXX'
#include <iostream>
#include "ricochet/client.h"
int main() {
  const auto client = ricochet::Client::Connect({.target = "127.0.0.1:1", .retry = {.max_attempts = 1}});
  std::cout << absl::StatusCodeToString(client->Solve({}).status().code()) << '\n';
}
CXX
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(client CXX)' 'set(CMAKE_CXX_STANDARD 20)' \
  'find_package(ricochet REQUIRED COMPONENTS client)' 'add_executable(client main.cc)' \
  'target_link_libraries(client ricochet::client)' >CMakeLists.txt
cmake -S . -B build >/dev/null
cmake --build build >/dev/null
[[ $(build/client) == UNAVAILABLE ]] || fail "the client says something else"
cd /
apt purge libricochet-client-dev

say "Installing what the packages depend on or recommend, and the packages"
# shellcheck disable=SC2016  # dpkg-deb replaces what begins with a dollar sign.
fields='${Depends}, ${Recommends}\n'
dependencies=$(for deb in "$directory"/*.deb; do dpkg-deb --showformat="$fields" --show "$deb"; done |
  sed 's/([^)]*)//g; s/|[^,]*//g' | tr ',' '\n' | tr -d ' ' | grep -Ev '^((lib)?ricochet.*|)$' | sort -u)
# shellcheck disable=SC2086  # A word is a package.
apt install --no-install-recommends $dependencies adduser cmake g++ make pkg-config python3-xarray
files >/tmp/before
apt install --no-install-recommends "$directory"/*.deb

say "The command line"
ricochet --version
ricochet solve --a 0.3 --b 1 --mu 0.1 --energetic 1 | grep -q 0.707107 || fail "ricochet solve gives another number"
ricochet solve --scene /usr/share/ricochet/examples/rod_contact.textproto >/dev/null
ricochet conformance show --format json | cmp - /usr/share/ricochet/conformance/impacts.json
for program in /usr/bin/ricochet /usr/bin/ricochetd; do
  ! grep -aqE '(RPATH|RUNPATH)' <(LC_ALL=C objdump -p "$program") || fail "$program has a path for libraries"
done
[[ -s /usr/share/man/man1/ricochet-solve.1.gz || -s /usr/share/man/man1/ricochet-solve.1 ]] || fail "no manual page"
[[ -s /usr/share/bash-completion/completions/ricochet ]] || fail "no completion"

say "The service, as its user, with the options that systemd gives it"
getent passwd ricochet >/dev/null || fail "the service has no user"
[[ $(readlink /etc/systemd/system/multi-user.target.wants/ricochetd.service) == */ricochetd.service ]] ||
  fail "the service is not enabled"
start=$(sed -n 's/^ExecStart=//p' /lib/systemd/system/ricochetd.service)
# shellcheck disable=SC2086  # The line is split as systemd does it.
setpriv --reuid ricochet --regid ricochet --clear-groups $start 2>/tmp/ricochetd.log &
server=$!
for _ in {1..100}; do
  ! ricochet health --server 127.0.0.1:50051 >/dev/null 2>&1 || break
  sleep 0.1
done
ricochet health --server 127.0.0.1:50051 || fail "$(</tmp/ricochetd.log)"
kill "$server"
wait "$server" || fail "ricochetd ended with $?"

say "Python"
cd /tmp
python3 - <<'PYTHON'
import ricochet

scene = {
    "pendulum": {"inertia_kg_m2": 1, "a_m": 0.3, "b_m": 1, "omega_minus_rad_s": -1},
    "friction": {"kinetic_coefficient": 0.1},
    "restitution": {"energetic": 1},
}
# Lubarda (2009): Newton's coefficient is sqrt((a - mu b)/(a + mu b)) if the energetic one is 1.
assert abs(ricochet.solve(scene).coefficients.newton - 0.5**0.5) < 1e-15
data = ricochet.sweep(scene, {"friction.kinetic_coefficient": [0.0, 0.1]}, ["coefficients.newton"])
print(data["coefficients.newton"].values)
assert abs(float(data["coefficients.newton"][1]) - 0.5**0.5) < 1e-15
assert ricochet.info().server_limits is None, "a server was asked"
PYTHON

say "The first hour of a new user"
mkdir /tmp/first_hour
cd /tmp/first_hour
python3 "$directory/page.py" "$directory/first_hour.md"
[[ $(head -c 5 friction.svg) == "<?xml" ]] || fail "no picture of the sweep"

say "A C++ program by CMake, and one by pkg-config"
mkdir /tmp/consumer && cd /tmp/consumer
cat >main.cc <<'CXX'
#include <cstdio>
#include "ricochet/solver.h"
int main() {
  ricochet::Scene scene;
  scene.system = ricochet::Pendulum{.inertia_kg_m2 = 1, .a_m = 0.3, .b_m = 1, .omega_minus_rad_s = -1};
  scene.friction.kinetic_coefficient = 0.1;
  scene.restitution = ricochet::EnergeticCoefficient{1};
  const auto answer = ricochet::LocalSolver().Solve({.scene = scene});
  std::printf("%.6f\n", answer->outcome.coefficients.newton);
}
CXX
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(consumer CXX)' 'set(CMAKE_CXX_STANDARD 20)' \
  'find_package(ricochet REQUIRED COMPONENTS core)' 'add_executable(consumer main.cc)' \
  'target_link_libraries(consumer ricochet::core)' >CMakeLists.txt
cmake -S . -B build >/dev/null
cmake --build build >/dev/null
[[ $(build/consumer) == 0.707107 ]] || fail "the program by CMake gives another number"
# shellcheck disable=SC2046  # pkg-config gives words.
g++ -std=c++20 main.cc -o by_pkg_config $(pkg-config --cflags --libs --static ricochet-core)
[[ $(./by_pkg_config) == 0.707107 ]] || fail "the program by pkg-config gives another number"

say "Removing, then purging"
cd /
apt remove ricochet libricochet-client-dev libricochet-dev ricochet-server python3-ricochet
[[ -s /etc/ricochet/ricochetd.toml ]] || fail "removing took the configuration, too"
dpkg --purge ricochet libricochet-client-dev libricochet-dev ricochet-server python3-ricochet
files >/tmp/after
diff /tmp/before /tmp/after || fail "these files are left"
! getent passwd ricochet >/dev/null || fail "the user is left"
echo "nothing is left"

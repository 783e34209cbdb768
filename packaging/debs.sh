#!/usr/bin/env bash
# ./dev debs: the Debian packages, in build/debs, tried in a bare Debian 12.
set -euo pipefail
# shellcheck source=tools/debian_root.sh
source "$(dirname "${BASH_SOURCE[0]}")/../tools/debian_root.sh"

readonly deb_packages=(dpkg-dev fakeroot file lintian mmdebstrap systemd)
require_root debs "it makes a root directory and enters it"
install_missing "${build_packages[@]}" "${deb_packages[@]}"
configure_and_build debian
rm -rf build/debs
cpack --config build/debian/CPackConfig.cmake -B "$PWD/build/debs"
rm -rf build/debs/_CPack_Packages
show lintian --fail-on error --tag-display-limit 0 build/debs/*.deb
temporary=$(mktemp -d /var/tmp/ricochet-debs.XXXXXX)
# The program that was built stands in for the one that is not installed here.
sed "s#/usr/bin/ricochetd#$PWD/build/debian/server/ricochetd#" packaging/debian/ricochetd.service \
  >"$temporary/ricochetd.service"
show systemd-analyze verify --man=no --recursive-errors=no "$temporary/ricochetd.service"
show systemd-analyze security --offline=true --threshold=15 --no-pager "$temporary/ricochetd.service"
root=$temporary/root
say "A bare Debian 12 in $root"
make_debian "$root"
mkdir "$root/debs"
cp build/debs/*.deb tests/packaging/debs_test.sh tests/integration/page.py docs/first_hour.md "$root/debs"
in_root "$root" "/debs/debs_test.sh /debs"
echo "-> build/debs"

#!/usr/bin/env bash
# ./dev pages: the pages of "ricochet cost --html" and of "ricochet explore" in a headless browser.
# Usage: pages.sh [--short]
set -euo pipefail
# shellcheck source=tools/dev_lib.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../../tools/dev_lib.sh"
if [[ ${1-} == --short ]]; then shift && short=yes; fi

readonly browser_packages=("${demo_packages[@]}" chromium chromium-driver fonts-dejavu-core python3)
install_missing "${browser_packages[@]}"
build_programs
mkdir -p build/pages
scenes=(sphere_20 turning_contact)
! is_short || scenes=()
for name in "${scenes[@]}"; do
  show "$ricochet" cost --scene "tests/data/scenes/$name.textproto" --time-limit 5s -o build/pages/text.txt \
    --html "build/pages/$name.html"
done
show "$ricochet" cost "${example[@]}" --time-limit 5s -o build/pages/text.txt --html build/pages/pendulum.html
say "Headless Chromium, 1280 and 400 pixels wide, by day and by night"
for name in pendulum "${scenes[@]}"; do
  show /usr/bin/python3 tests/client/cli/page_screenshots.py "build/pages/$name.html" build/pages
done
say "The page of ricochet explore, used by mouse and keys"
show /usr/bin/python3 tests/client/cli/explore_page.py "$ricochet" build/pages
echo "-> the screenshots: build/pages/*.png"

#!/bin/bash
# What a newcomer does, on a system that has nothing (./dev test --full runs it on a bare Debian): the
# first command, the tutorial to the letter, the package and with it the example mission and the
# tutorial once more.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scratch=$(mktemp -d)

./dev run
tests/system/tutorial.sh "$PWD/build/release/bin/vigia" docs/tutorial.md "$PWD/config" "$scratch/built"

./dev package
packages=(build/release/packages/vigia_*.deb)
apt-get -q -y install --no-install-recommends "$PWD/${packages[0]}" >"$scratch/apt.log" 2>&1 ||
  { tail -n 20 "$scratch/apt.log" >&2; exit 1; }
mv build/release build/not-used  # what is installed needs none of it
(cd "$scratch" && vigia run /usr/share/vigia/config/missions/armingol-room.yaml --out example)
[ -s "$scratch/example/report.html" ]
tests/system/tutorial.sh /usr/bin/vigia docs/tutorial.md /usr/share/vigia/config "$scratch/installed"

#!/bin/bash
# Missions of several eyes, exported and read by npm's own MCAP reader.
# export_in_node.sh VIGIA MISSIONS FOLDER; 77 (skipped) where npm gives no packages.
set -euo pipefail
vigia=$1
missions=$2
folder=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

mkdir -p "$folder"
cd "$folder"
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  echo "no node and npm here: apt-get install nodejs npm"
  exit 77
fi
if ! [ -d node_modules/@mcap/core ] || ! [ -d node_modules/@foxglove/schemas ]; then
  timeout 120 npm install --no-audit --no-fund @mcap/core@2.2.2 @foxglove/schemas@2.1.0 >npm.log 2>&1 ||
    { echo "npm gives no @mcap/core and @foxglove/schemas here"; exit 77; }
fi

for mission in armingol-room tag-room mirosot soccer ceiling-hall ramp-gallery; do
  rm -rf run
  "$vigia" run "$missions/$mission.yaml" --no-pictures --quiet --set timeout_s=8 --out run >/dev/null || [ $? = 1 ]
  "$vigia" export run --mcap drive.mcap >/dev/null || { echo "$mission: not exported"; exit 1; }
  echo -n "$mission: "
  node "$here/read_mcap.mjs" drive.mcap run
done

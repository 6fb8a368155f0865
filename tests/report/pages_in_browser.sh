#!/bin/bash
# Opens the pages of missions of every kind of eye, a comparison and a campaign in Chromium and asks
# them what they show (page_probe.js). pages_in_browser.sh VIGIA CONFIG FOLDER; 77 (skipped) where
# there is no Chromium.
set -euo pipefail
vigia=$1
config=$2
folder=$3
here=$(dirname "${BASH_SOURCE[0]}")
browser=$(command -v chromium || true)
[ -n "$browser" ] || { echo "no Chromium here: apt-get install chromium"; exit 77; }

fail() { echo "pages_in_browser: $*" >&2; exit 1; }

common=(--headless --no-sandbox --disable-gpu --no-first-run --user-data-dir="$folder/profile")

# asked PAGE EXPECTED: the page with what it is to show and the questions in it, as PAGE.asked.html.
asked() {
  {
    cat "$1"
    printf '<script type="application/json" id="expected">%s</script>\n' "${2//</\\u003c}"
    printf '<script>\n'
    cat "$here/page_probe.js"
    printf '</script>\n'
  } >"$1.asked.html"
}

# ask NAME PAGE EXPECTED [WIDTH]: in real time, since frames are counted; the console has the answer.
ask() {
  local name=$1 page=$2 log=$folder/$1.log answer=
  asked "$page" "$3"
  "$browser" "${common[@]}" --enable-logging=stderr --remote-debugging-port=0 \
    --window-size="${4:-1400},1000" "file://$page.asked.html#t=3.21" >/dev/null 2>"$log" &
  local process=$!
  for _ in $(seq 300); do
    answer=$(grep -o 'PROBE .*' "$log" | head -n 1) && break
    sleep 0.2
  done
  kill "$process" 2>/dev/null || true
  wait "$process" 2>/dev/null || true
  echo "$name: $(stat -c %s "$page") bytes, ${answer%, source:*}"
  grep -q '^PROBE PASSED' <<<"$answer" || fail "$name: ${answer:-no answer; see $log}"
  ! grep CONSOLE "$log" | grep -v 'PROBE ' || fail "$name: the page complains"
}

# picture NAME PAGE: a screenshot, which is not blank.
picture() {
  timeout 120 "$browser" "${common[@]}" --virtual-time-budget=5000 --window-size=1400,1600 \
    --screenshot="$folder/$1.png" "file://$2#t=3.21" >/dev/null 2>&1
  local bytes
  bytes=$(stat -c %s "$folder/$1.png")
  [ "$bytes" -gt 40000 ] || fail "$1: the screenshot is blank ($bytes bytes)"
}

# drive NAME MISSION [ARGS…]: a run folder.
drive() {
  local name=$1 mission=$2 status=0
  shift 2
  "$vigia" run "$config/missions/$mission.yaml" --quiet --out "$folder/$name" "$@" >/dev/null || status=$?
  [ "$status" -le 1 ] || fail "$name: the mission failed"
  local bytes
  bytes=$(stat -c %s "$folder/$name/report.html")
  [ "$bytes" -le 4000000 ] || fail "$name: the page has $bytes bytes"
}

# of_run NAME [MORE]: what the page of a run is to show.
of_run() { printf '{"summaries": [%s], "pictures": true%s}' "$(cat "$folder/$1/summary.json")" "${2:-}"; }

rm -rf "$folder"
mkdir -p "$folder"
for mission in armingol-room quixote-room mirosot soccer ceiling-hall; do
  # The whole of a drive of one camera on a head; of the others as much as a page needs.
  more=()
  [[ $mission == *room ]] || more=(--set timeout_s=15)
  drive "$mission" "$mission" "${more[@]}"
  ask "$mission" "$folder/$mission/report.html" "$(of_run "$mission")"
  picture "$mission" "$folder/$mission/report.html"
done
ask narrow "$folder/armingol-room/report.html" "$(of_run armingol-room)" 500

drive kidnapped armingol-room --seed 3 --set disturbances.kidnapping=realistic
ask kidnapped "$folder/kidnapped/report.html" "$(of_run kidnapped ', "jumps": 1')"

"$vigia" report "$folder/armingol-room" "$folder/kidnapped" -o "$folder/comparison.html" >/dev/null
ask comparison "$folder/comparison.html" "{\"pictures\": true, \"summaries\": [
  $(cat "$folder/armingol-room/summary.json"), $(cat "$folder/kidnapped/summary.json")]}"
picture comparison "$folder/comparison.html"

cat >"$folder/campaign.yaml" <<YAML
version: 1
name: pages
mission: $(realpath "$config")/missions/armingol-room-qvga.yaml
policies: [nearest, fuzzy, random]
disturbances: [none, all]
seeds: {count: 8}
YAML
status=0
"$vigia" evaluate "$folder/campaign.yaml" --quiet --out "$folder/campaign" >/dev/null || status=$?
[ "$status" -le 1 ] || fail "the campaign failed"
of_campaign="{\"campaign\": true, \"summaries\": [$(cat "$folder/campaign/summary.json")]}"
ask campaign "$folder/campaign/report.html" "$of_campaign"
ask campaign_narrow "$folder/campaign/report.html" "$of_campaign" 500
picture campaign "$folder/campaign/report.html"

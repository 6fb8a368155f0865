#!/bin/bash
# Opens the replay page of a mission in Chromium and asks it what it shows.
# page_in_browser.sh VIGIA MISSION FOLDER; 77 (skipped) where there is no Chromium.
set -euo pipefail
vigia=$1
mission=$2
folder=$3
browser=$(command -v chromium || true)
[ -n "$browser" ] || { echo "no Chromium here: apt-get install chromium"; exit 77; }

fail() { echo "page_in_browser: $*" >&2; exit 1; }

mkdir -p "$folder"
"$vigia" run "$mission" --quiet --out "$folder/run" >/dev/null || fail "the mission failed"
page=$folder/run/report.html
bytes=$(stat -c %s "$page")
[ "$bytes" -le 4000000 ] || fail "the page has $bytes bytes"

# The page asks itself once it is ready: keys move the clock, and a moment is drawn in time.
cp "$page" "$folder/asked.html"
cat >>"$folder/asked.html" <<'PAGE'
<script>
  const press = (key) => document.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  const clock = () => document.getElementById("clock").textContent;
  const answers = { opened: clock() };
  press("End"); answers.end = clock();
  press("Home"); answers.home = clock();
  press("]"); press("]"); press("]"); answers.event = clock();
  const begun = performance.now();
  for (let i = 0; i < 100; ++i) press(".");
  answers.moment_ms = (performance.now() - begun) / 100;
  const pixels = document.getElementById("map").getContext("2d").getImageData(0, 0, 400, 300).data;
  answers.inks = new Set(new Uint32Array(pixels.buffer)).size;
  const pre = document.createElement("pre");
  pre.textContent = "ANSWERS " + JSON.stringify(answers);
  document.body.append(pre);
</script>
PAGE
timeout 180 "$browser" --headless --no-sandbox --disable-gpu --enable-logging=stderr \
  --user-data-dir="$folder/profile" --virtual-time-budget=5000 --window-size=1400,1000 \
  --dump-dom "file://$folder/asked.html#t=12.34" >"$folder/dom.html" 2>"$folder/browser.log"

! grep CONSOLE "$folder/browser.log" || fail "the page complains"
grep -q 'data-ready="yes"' "$folder/dom.html" || fail "the page did not get ready"
answers=$(grep -o 'ANSWERS {[^}]*}' "$folder/dom.html") || fail "the page gave no answer"
echo "$bytes bytes, $answers"
grep -q '"opened":"12.34 s"' <<<"$answers" || fail "the link's moment is not shown"
grep -q '"home":"0.00 s"' <<<"$answers" || fail "Home does not lead to the beginning"
! grep -q '"end":"0.00 s"' <<<"$answers" || fail "End does not lead to the end"
! grep -q '"event":"0.00 s"' <<<"$answers" || fail "] does not lead to an event"
! grep -qE '"inks":[1-4][,}]' <<<"$answers" || fail "the map is blank"

# The table's figures are those of summary.json.
value() { grep -oE "\"$1\": [0-9.e-]+" "$folder/run/summary.json" | head -n 1 | cut -d' ' -f2; }
outcome_s=$(LC_ALL=C printf '%.1f s' "$(value sim_s)")
grep -q "after $outcome_s" "$folder/dom.html" || fail "the time of arrival is not $outcome_s"
greatest_cm=$(LC_ALL=C awk -v m="$(value position_max_m)" 'BEGIN { printf m < 0.1 ? "%.2f" : "%.1f", 100 * m }')
grep -q "<td>$greatest_cm</td>" "$folder/dom.html" || fail "the greatest error is not $greatest_cm cm"

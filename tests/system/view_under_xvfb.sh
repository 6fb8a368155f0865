#!/bin/bash
# The live window of missions, on a display in memory: it shows the cameras and a map, a mission is no
# other for it, and --view keeps to real time. view_under_xvfb.sh VIGIA MISSIONS FOLDER; 77 (skipped)
# where there is no Xvfb.
set -euo pipefail
vigia=$1
missions=$2
folder=$3
{ command -v Xvfb && command -v python3; } >/dev/null || { echo "no Xvfb and python3 here: apt-get install xvfb python3"; exit 77; }

fail() { echo "view_under_xvfb: $*" >&2; exit 1; }

mkdir -p "$folder"
cd "$folder"
rm -f display Xvfb_screen0
Xvfb -displayfd 3 -screen 0 1400x600x24 -fbdir . -nolisten tcp 3>display 2>xvfb.log &
server=$!
trap 'kill $server 2>/dev/null || true' EXIT
for _ in $(seq 100); do [ -s display ] && break; sleep 0.1; done
[ -s display ] || fail "Xvfb does not start"
DISPLAY=:$(cat display)
export DISPLAY

# The frame buffer as xwd writes it: size of the head, width and height, bytes a line, entries of the
# colour map, each of 12 bytes; then the pixels. Says how many colours the window's two halves show.
inks() {
  cp Xvfb_screen0 "$1.xwd"
  python3 - "$1.xwd" <<'PYTHON'
import struct, sys
data = open(sys.argv[1], "rb").read()
head = struct.unpack(">25I", data[:100])
begin, (width, height, line) = head[0] + 12 * head[19], (head[4], head[5], head[12])
rows = [data[begin + v * line : begin + v * line + 4 * width] for v in range(height)]
def colours(first, last):
    return len({row[4 * u : 4 * u + 3] for row in rows[:480] for u in range(first, last)})
print(colours(0, 640), colours(700, 1200))
PYTHON
}

for mission in armingol-room ceiling-hall; do
  "$vigia" run "$missions/$mission.yaml" --view --no-pictures --quiet --set timeout_s=6 --out "viewed-$mission" >/dev/null 2>"$mission.log" &
  run=$!
  sleep 4
  read -r camera map < <(inks "$mission")
  echo "$mission: $camera colours of the camera, $map of the map"
  wait $run || [ $? = 1 ] || fail "$mission: the mission failed"
  ! grep -q 'no X display' "$mission.log" || fail "$mission: no window was opened"
  [ "$camera" -gt 50 ] || fail "$mission: the camera's picture is blank"
  [ "$map" -gt 5 ] || fail "$mission: the map is blank"
done

began=$(date +%s%N)
"$vigia" run "$missions/armingol-room.yaml" --view=fast --no-pictures --quiet --set timeout_s=6 --out fast >/dev/null || [ $? = 1 ]
took_ms=$((($(date +%s%N) - began) / 1000000))
echo "6 s of a mission in $took_ms ms with --view=fast"
cmp fast/ticks.csv viewed-armingol-room/ticks.csv || fail "the pace changes the mission"

"$vigia" run "$missions/armingol-room.yaml" --view --no-pictures --quiet --set timeout_s=6 --out orphaned >/dev/null 2>orphaned.log &
run=$!
sleep 3
kill -9 $server
wait $run || [ $? = 1 ] || fail "the mission fails with its display"
grep -q 'the window is gone' orphaned.log || fail "nothing is said of the lost display"
cmp orphaned/ticks.csv viewed-armingol-room/ticks.csv || fail "the lost display changes the mission"

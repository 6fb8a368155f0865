#!/bin/bash
# Makes mission.webp, the moving picture of a drive: map and camera of its replay page at even moments.
# docs/images/mission.sh VIGIA [MISSION]; needs Debian's chromium and ffmpeg.
set -euo pipefail
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
vigia=$(realpath "$1")
mission=${2:-$here/../../config/missions/armingol-room.yaml}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$vigia" run "$mission" --quiet --out "$work/run" >/dev/null
cp "$work/run/report.html" "$work/page.html"
cat >>"$work/page.html" <<'PAGE'
<script>
  (async () => {
    const steps = 70, scrub = vigia.$("scrub"), picture = document.createElement("canvas"), pen = picture.getContext("2d");
    const map = vigia.$("map"), camera = document.querySelector("#cameras canvas"), out = document.createElement("pre");
    const height = 330, wide = Math.round(height * map.width / map.height), side = 300, tall = side * camera.height / camera.width;
    picture.width = wide + side;
    picture.height = height;
    for (let i = 0; i <= steps; ++i) {
      scrub.value = scrub.max * i / steps;
      scrub.dispatchEvent(new Event("input"));
      await new Promise((resolve) => setTimeout(resolve, 60));
      pen.fillStyle = "#ffffff";
      pen.fillRect(0, 0, picture.width, height);
      pen.drawImage(map, 0, 0, wide, height);
      pen.drawImage(camera, wide, 0, side, tall);
      pen.fillStyle = "#1c1c1c";
      pen.font = "16px DejaVu Sans, sans-serif";
      pen.fillText(vigia.$("clock").textContent, wide + 8, tall + 26);
      const event = document.querySelector("#events .now button");
      if (event) pen.fillText(event.children[1].textContent, wide + 8, tall + 50);
      out.append("FRAME " + picture.toDataURL("image/png").split(",")[1] + "\n");
    }
    document.body.append(out);
  })();
</script>
PAGE
chromium --headless --no-sandbox --disable-gpu --no-first-run --user-data-dir="$work/profile" --window-size=1400,1000 \
  --virtual-time-budget=20000 --dump-dom "file://$work/page.html" 2>/dev/null >"$work/dom.html"
n=0
grep -oE 'FRAME [A-Za-z0-9+/=]{100,}' "$work/dom.html" | cut -d' ' -f2 | while read -r frame; do
  base64 -d <<<"$frame" >"$work/$(printf %03d $n).png"
  n=$((n + 1))
done
ffmpeg -loglevel error -y -framerate 8 -i "$work/%03d.png" -c:v libwebp_anim -lossless 0 -quality 60 -loop 0 "$here/mission.webp"
stat -c '%n: %s bytes' "$here/mission.webp"

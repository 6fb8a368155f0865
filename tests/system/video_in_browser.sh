#!/bin/bash
# Chromium plays the video of a mission. video_in_browser.sh VIGIA MISSION FOLDER; 77 (skipped) where
# there is no Chromium.
set -euo pipefail
vigia=$1
mission=$2
folder=$3
browser=$(command -v chromium || true)
[ -n "$browser" ] || { echo "no Chromium here: apt-get install chromium"; exit 77; }

fail() { echo "video_in_browser: $*" >&2; exit 1; }

mkdir -p "$folder"
"$vigia" run "$mission" --video --no-pictures --quiet --set timeout_s=4 --out "$folder/run" >/dev/null || [ $? = 1 ]
cat >"$folder/run/play.html" <<'PAGE'
<video id="v" src="camera.mp4" muted></video><pre id="answer"></pre>
<script>
  const video = document.getElementById("v");
  const answer = (text) => { document.getElementById("answer").textContent = "ANSWER " + text; };
  video.onerror = () => answer("error " + video.error.message);
  video.onseeked = () => {
    answer(JSON.stringify({ duration: video.duration, ready: video.readyState, at: video.currentTime,
                            width: video.videoWidth, decoded: video.getVideoPlaybackQuality().totalVideoFrames }));
  };
  video.onloadeddata = () => { video.currentTime = video.duration / 2; };
</script>
PAGE
timeout 120 "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$folder/profile" \
  --virtual-time-budget=10000 --dump-dom "file://$folder/run/play.html" >"$folder/dom.html" 2>"$folder/browser.log"
answer=$(grep -o 'ANSWER {[^}]*}' "$folder/dom.html") || fail "the video is not played: $(grep -o 'ANSWER.*' "$folder/dom.html")"
echo "$answer"
grep -q '"duration":4[,.}]' <<<"$answer" || fail "the video does not last the mission's 4 s"
grep -qE '"ready":[234]' <<<"$answer" || fail "the video is not ready"
grep -q '"width":640' <<<"$answer" || fail "the video is not 640 wide"

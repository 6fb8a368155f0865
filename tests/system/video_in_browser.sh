#!/bin/bash
# Chromium plays the video of a mission. video_in_browser.sh VIGIA MISSION FOLDER; 77 (skipped) where
# there is no Chromium or no Python, whose server holds the page's loading until the video has answered:
# under Chromium's virtual time nothing plays, and without it the page is read once it has loaded.
set -euo pipefail
vigia=$1
mission=$2
folder=$3
browser=$(command -v chromium || true)
[ -n "$browser" ] || { echo "no Chromium here: apt-get install chromium"; exit 77; }
command -v python3 >/dev/null || { echo "no Python here: apt-get install python3"; exit 77; }

fail() { echo "video_in_browser: $*" >&2; exit 1; }

mkdir -p "$folder"
"$vigia" run "$mission" --video --no-pictures --quiet --set timeout_s=4 --out "$folder/run" >/dev/null || [ $? = 1 ]
cat >"$folder/run/play.html" <<'PAGE'
<video id="v" src="camera.mp4" muted></video><pre id="answer"></pre>
<script>
  const video = document.getElementById("v");
  const answer = (text) => {
    document.getElementById("answer").textContent = "ANSWER " + text;
    fetch("/answered");
  };
  video.onerror = () => answer("error " + video.error.message);
  video.onended = () => {
    answer(JSON.stringify({ duration: video.duration, ready: video.readyState, width: video.videoWidth,
                            decoded: video.getVideoPlaybackQuality().totalVideoFrames }));
  };
  video.play();
</script>
<img src="/when-answered" alt="">
PAGE
cat >"$folder/serve.py" <<'PYTHON'
import http.server
import threading

answered = threading.Event()


class Pages(http.server.SimpleHTTPRequestHandler):
    def do_GET(self):
        if self.path == "/answered":
            answered.set()
        if self.path in ("/answered", "/when-answered"):
            answered.wait(60)
            self.send_error(404)
        else:
            super().do_GET()

    def log_message(self, *args):
        pass


server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Pages)
print(server.server_port, flush=True)
server.serve_forever()
PYTHON
(cd "$folder/run" && exec python3 ../serve.py) >"$folder/port" &
trap 'kill %1' EXIT
for _ in {1..100}; do [ ! -s "$folder/port" ] || break; sleep 0.1; done
timeout 120 "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$folder/profile" \
  --dump-dom "http://127.0.0.1:$(cat "$folder/port")/play.html" >"$folder/dom.html" 2>"$folder/browser.log"
answer=$(grep -o 'ANSWER {[^}]*}' "$folder/dom.html") || fail "the video is not played: $(grep -o 'ANSWER.*' "$folder/dom.html")"
echo "$answer"
grep -q '"duration":4[,.}]' <<<"$answer" || fail "the video does not last the mission's 4 s"
grep -qE '"ready":[234]' <<<"$answer" || fail "the video is not ready"
grep -q '"width":640' <<<"$answer" || fail "the video is not 640 wide"

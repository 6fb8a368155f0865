"use strict";
(() => {
  const { $, element, readColours, data } = vigia;
  const runs = data.runs;
  const end = Math.max(...runs.map((run) => run.t[run.t.length - 1] || 0));

  // ---- what there is to draw -------------------------------------------------------------------

  const dashes = [[], [8, 4], [3, 3], [10, 3, 2, 3], [1, 3], [14, 4]];
  const tracks = [];  // one for each localizer of each run
  runs.forEach((run, r) => {
    const several = runs.length > 1;
    run.localizers.forEach((localizer) => {
      tracks.push({
        run, localizer, index: tracks.length,
        label: several ? `#${r + 1} ${localizer.name}` : localizer.name,
        shown: !several || localizer.primary,
      });
    });
  });
  let colours = {};
  const trackColour = (track) => colours["c" + (track.index % 6)];
  const trackDash = (track) => dashes[Math.floor(track.index / 6 + track.index) % dashes.length];

  /// Index of the last of ascending stamps that is not after t; -1 before the first.
  function indexAt(stamps, t) {
    let low = -1, high = stamps.length;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (stamps[middle] <= t + 1e-9) low = middle; else high = middle;
    }
    return low;
  }
  const tickAt = (run, t) => Math.max(0, indexAt(run.t, t));
  /// The ticks before which the robot was put elsewhere.
  for (const run of runs)
    run.jumps = new Set(run.events.filter((event) => event.kind === "kidnapped").map((event) => tickAt(run, event.t) + 1)
      .filter((i) => i < run.t.length));
  const centimetres = (m) => (100 * m).toFixed(m < 0.1 ? 2 : 1);

  // ---- time ------------------------------------------------------------------------------------

  let now = 0, playing = false, lastFrame = 0, drawn = { frames: 0, since: 0 };
  const listeners = [];
  function show(t, fromAddress) {
    now = Math.min(end, Math.max(0, t));
    $("scrub").value = now;
    $("clock").textContent = now.toFixed(2) + " s";
    for (const listener of listeners) listener(now);
    if (!playing && !fromAddress) writeAddress();
  }
  function writeAddress() {
    try { history.replaceState(null, "", "#t=" + now.toFixed(2)); } catch (error) { /* from disk */ }
  }
  function readAddress() {
    const match = /(?:^#|&)t=([0-9.]+)/.exec(location.hash);
    const t = match ? parseFloat(match[1]) : NaN;
    if (Number.isFinite(t)) show(t, true);
  }
  function play(on) {
    playing = on && end > 0;
    if (playing && now >= end) now = 0;
    $("play").textContent = playing ? "⏸" : "▶";
    $("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    lastFrame = performance.now();
    drawn = { frames: 0, since: lastFrame };
    if (playing) requestAnimationFrame(advance); else writeAddress();
  }
  function advance(stamp) {
    if (!playing) return;
    const step = Math.max(0, stamp - lastFrame) / 1000 * parseFloat($("speed").value);
    lastFrame = stamp;
    drawn.frames += 1;
    show(now + step);
    if (now >= end) play(false); else requestAnimationFrame(advance);
  }
  /// Frames a second of the present replay.
  window.vigiaFrameRate = () => 1000 * drawn.frames / Math.max(1, performance.now() - drawn.since);

  // ---- map -------------------------------------------------------------------------------------

  const map = $("map"), pen = map.getContext("2d");
  const view = { x: 0, y: 0, scale: 50, follow: false };  // centre in metres, pixels a metre
  const layers = { landmarks: true, planned: true, truth: true, ellipses: true, view: true };
  let backdrop = null;  // what does not move, drawn once a view

  function bounds() {
    let box = [Infinity, Infinity, -Infinity, -Infinity];
    const take = (x, y) => {
      box = [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)];
    };
    for (const run of runs) {
      run.world.outline.forEach((p) => take(p[0], p[1]));
      run.truth.x.forEach((x, i) => take(x, run.truth.y[i]));
    }
    return box[0] <= box[2] ? box : [-1, -1, 1, 1];
  }
  function showAll() {
    const [x0, y0, x1, y1] = bounds();
    view.x = (x0 + x1) / 2;
    view.y = (y0 + y1) / 2;
    view.scale = 0.94 * Math.min(map.clientWidth / Math.max(0.5, x1 - x0), map.clientHeight / Math.max(0.5, y1 - y0));
    redrawMap();
  }
  const toX = (x) => map.clientWidth / 2 + (x - view.x) * view.scale;
  const toY = (y) => map.clientHeight / 2 - (y - view.y) * view.scale;

  function polygon(to, points, close) {
    to.beginPath();
    points.forEach((p, i) => i ? to.lineTo(toX(p[0]), toY(p[1])) : to.moveTo(toX(p[0]), toY(p[1])));
    if (close) to.closePath();
  }
  /// A line that leaves out the steps for which cut(i) says that nothing was driven between i - 1 and i.
  function curve(to, xs, ys, until, cut) {
    to.beginPath();
    for (let i = 0; i <= until; ++i) {
      const x = toX(xs[i]), y = toY(ys[i]);
      if (i === 0 || cut(i)) to.moveTo(x, y);
      else to.lineTo(x, y);
    }
    to.stroke();
  }
  /// The true path, dashed where the robot was put elsewhere.
  function drawTruth(to, run, until) {
    const { x, y } = run.truth;
    curve(to, x, y, until, (i) => run.jumps.has(i));
    to.strokeStyle = colours.mark;
    to.setLineDash([3, 5]);
    for (const i of run.jumps) {
      if (i > until) continue;
      polygon(to, [[x[i - 1], y[i - 1]], [x[i], y[i]]], false);
      to.stroke();
    }
    to.setLineDash([]);
  }
  function drawField(to, field) {
    to.fillStyle = colours.field;
    polygon(to, field.carpet, true);
    to.fill();
    to.strokeStyle = colours.line;
    for (const line of field.lines) {
      to.lineWidth = Math.max(1, line.width * view.scale);
      polygon(to, line.points, false);
      to.stroke();
    }
    to.lineWidth = 1;
    for (const goal of field.goals) {
      to.fillStyle = goal.colour === "yellow" ? "#e0b400" : goal.colour === "blue" ? "#3a6fd8" : colours.solid;
      polygon(to, goal.points, true);
      to.fill();
      to.strokeStyle = colours.wall;
      to.stroke();
    }
    for (const post of field.posts) {
      to.fillStyle = post.colour === "yellow" ? "#e0b400" : "#3a6fd8";
      to.beginPath();
      to.arc(toX(post.x), toY(post.y), Math.max(3, post.radius * view.scale), 0, 2 * Math.PI);
      to.fill();
    }
  }
  function drawWorld(to, world) {
    if (world.field) drawField(to, world.field);
    to.strokeStyle = colours.wall;
    to.lineWidth = 2;
    polygon(to, world.outline, true);
    to.stroke();
    for (const obstacle of world.obstacles) {
      to.fillStyle = colours.solid;
      polygon(to, obstacle, true);
      to.fill();
      to.lineWidth = 1;
      to.stroke();
    }
    to.lineWidth = 3;
    for (const wall of world.walls) {
      polygon(to, [[wall[0], wall[1]], [wall[2], wall[3]]], false);
      to.stroke();
    }
  }
  function drawLandmark(to, mark, watched) {
    const x = toX(mark.x), y = toY(mark.y);
    to.fillStyle = watched ? colours.mark : colours.ink;
    to.strokeStyle = colours.paper;
    to.lineWidth = 1.5;
    to.beginPath();
    const size = watched ? 7 : 5;
    if (mark.kind === "disc") to.arc(x, y, size, 0, 2 * Math.PI);
    else if (mark.kind === "pattern") { to.moveTo(x, y - size); to.lineTo(x + size, y); to.lineTo(x, y + size); to.lineTo(x - size, y); to.closePath(); }
    else to.rect(x - size, y - size, 2 * size, 2 * size);
    to.fill();
    to.stroke();
    to.font = (watched ? "bold " : "") + "12px system-ui, sans-serif";
    to.lineWidth = 3;
    const tx = x + 12 * mark.nx, ty = y - 12 * mark.ny;
    to.textAlign = "center";
    to.textBaseline = "middle";
    to.strokeText(mark.id, tx, ty);
    to.fillText(mark.id, tx, ty);
  }
  function drawScale(to) {
    const wish = 90 / view.scale;
    const decade = Math.pow(10, Math.floor(Math.log10(wish)));
    const length = [5, 2, 1].map((n) => n * decade).find((n) => n <= wish) || decade;
    const x = 14, y = map.clientHeight - 14;
    to.strokeStyle = to.fillStyle = colours.muted;
    to.lineWidth = 2;
    to.beginPath();
    to.moveTo(x, y - 4); to.lineTo(x, y); to.lineTo(x + length * view.scale, y); to.lineTo(x + length * view.scale, y - 4);
    to.stroke();
    to.textAlign = "left";
    to.textBaseline = "bottom";
    to.font = "12px system-ui, sans-serif";
    to.fillText(length >= 1 ? length + " m" : Math.round(100 * length) + " cm", x + 6, y - 3);
  }
  function redrawMap() {
    const ratio = window.devicePixelRatio || 1;
    map.width = Math.round(map.clientWidth * ratio);
    map.height = Math.round(map.clientHeight * ratio);
    backdrop = document.createElement("canvas");
    backdrop.width = map.width;
    backdrop.height = map.height;
    const to = backdrop.getContext("2d");
    to.scale(ratio, ratio);
    to.lineJoin = "round";
    const seen = new Set();
    for (const run of runs) {
      const key = JSON.stringify(run.world);
      if (!seen.has(key)) drawWorld(to, run.world);
      seen.add(key);
      if (layers.planned && run.planned.length) {
        to.strokeStyle = colours.planned;
        to.lineWidth = 1.5;
        to.setLineDash([2, 4]);
        polygon(to, run.planned, false);
        to.stroke();
        to.setLineDash([]);
      }
      if (layers.truth) {
        to.strokeStyle = colours.truth;
        to.globalAlpha = 0.35;
        to.lineWidth = 1.5;
        drawTruth(to, run, run.t.length - 1);
        to.globalAlpha = 1;
      }
      for (const event of run.events) drawEvent(to, run, event);
    }
    if (layers.landmarks) for (const mark of runs[0].world.landmarks) drawLandmark(to, mark, false);
    drawScale(to);
    drawMoment();
  }
  const grave = new Set(["lost", "ambiguous", "kidnapped", "collided", "stuck", "still_lost", "timeout", "target_lost", "blocked"]);
  function drawEvent(to, run, event) {
    const sign = { lost: "?", ambiguous: "≈", recovered: "✓", settled: "✓", kidnapped: "⇝", collided: "✕", stuck: "✕", still_lost: "✕", timeout: "✕", stop: "■" }[event.kind];
    if (!sign) return;
    const i = tickAt(run, event.t);
    to.fillStyle = grave.has(event.kind) ? colours.mark : colours.muted;
    to.font = event.kind === "stop" ? "9px system-ui, sans-serif" : "bold 16px system-ui, sans-serif";
    to.textAlign = "center";
    to.textBaseline = "middle";
    to.fillText(sign, toX(run.truth.x[i]), toY(run.truth.y[i]));
  }
  /// The 95 % ellipse of a Gaussian position, or nothing where the covariance is none.
  function ellipse(x, y, vx, vy, cxy) {
    const mean = (vx + vy) / 2, apart = Math.hypot((vx - vy) / 2, cxy);
    if (!(mean - apart >= 0)) return;
    const k = Math.sqrt(5.991) * view.scale;
    pen.beginPath();
    pen.ellipse(toX(x), toY(y), Math.max(2, k * Math.sqrt(mean + apart)), Math.max(2, k * Math.sqrt(Math.max(0, mean - apart))),
                -0.5 * Math.atan2(2 * cxy, vx - vy), 0, 2 * Math.PI);
    pen.stroke();
  }
  function drawRobot(run, i) {
    const x = run.truth.x[i], y = run.truth.y[i], th = run.truth.th[i];
    if (layers.view) {
      for (const camera of run.cameras) {
        if (!camera.left.length) continue;
        const left = th + camera.left[i], right = th + camera.right[i];
        const reach = 2.5 * view.scale;
        pen.fillStyle = colours.view;
        pen.beginPath();
        pen.moveTo(toX(x), toY(y));
        pen.arc(toX(x), toY(y), reach, -left, -right, false);
        pen.closePath();
        pen.fill();
      }
      const target = run.target[i] === null ? null : run.world.landmarks.find((mark) => mark.id === run.target[i]);
      if (target) {
        pen.strokeStyle = colours.mark;
        pen.lineWidth = 1;
        pen.setLineDash([5, 4]);
        pen.beginPath();
        pen.moveTo(toX(x), toY(y));
        pen.lineTo(toX(target.x), toY(target.y));
        pen.stroke();
        pen.setLineDash([]);
        drawLandmark(pen, target, true);
      }
    }
    pen.fillStyle = colours.truth;
    pen.strokeStyle = colours.ink;
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.arc(toX(x), toY(y), Math.max(5, run.radius * view.scale), 0, 2 * Math.PI);
    pen.globalAlpha = 0.5;
    pen.fill();
    pen.globalAlpha = 1;
    pen.stroke();
    const nose = Math.max(9, 1.4 * run.radius * view.scale);
    pen.beginPath();
    pen.moveTo(toX(x), toY(y));
    pen.lineTo(toX(x) + nose * Math.cos(th), toY(y) - nose * Math.sin(th));
    pen.stroke();
  }
  function drawTrack(track, i) {
    const { localizer } = track;
    const x = localizer.x[i], y = localizer.y[i];
    pen.strokeStyle = trackColour(track);
    pen.lineWidth = 2;
    pen.setLineDash(trackDash(track));
    // Half a metre between two ticks is an estimate that was set anew.
    curve(pen, localizer.x, localizer.y, i,
          (k) => Math.hypot(localizer.x[k] - localizer.x[k - 1], localizer.y[k] - localizer.y[k - 1]) > 0.5);
    pen.setLineDash([]);
    if (layers.ellipses) {
      ellipse(x, y, localizer.vx[i], localizer.vy[i], localizer.cxy[i]);
      const k = indexAt(localizer.hypotheses.map((entry) => entry[0]), i);
      if (k >= 0 && localizer.hypotheses[k][0] === i)
        for (const [hx, hy, , weight] of localizer.hypotheses[k][1]) {
          pen.globalAlpha = 0.25 + 0.75 * weight;
          pen.beginPath();
          pen.arc(toX(hx), toY(hy), 6, 0, 2 * Math.PI);
          pen.stroke();
          pen.globalAlpha = 1;
        }
    }
    const size = 6;
    pen.beginPath();
    pen.moveTo(toX(x) - size, toY(y)); pen.lineTo(toX(x) + size, toY(y));
    pen.moveTo(toX(x), toY(y) - size); pen.lineTo(toX(x), toY(y) + size);
    pen.stroke();
  }
  function drawMoment() {
    if (!backdrop) return;
    const ratio = window.devicePixelRatio || 1;
    if (view.follow) {
      const i = tickAt(runs[0], now);
      const moved = Math.hypot(view.x - runs[0].truth.x[i], view.y - runs[0].truth.y[i]);
      if (moved > 1e-4) {
        view.x = runs[0].truth.x[i];
        view.y = runs[0].truth.y[i];
        redrawMap();
        return;
      }
    }
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, map.width, map.height);
    pen.drawImage(backdrop, 0, 0);
    pen.scale(ratio, ratio);
    pen.lineJoin = "round";
    for (const run of runs) {
      const i = tickAt(run, now);
      if (layers.truth) {
        pen.strokeStyle = colours.truth;
        pen.lineWidth = 2.5;
        drawTruth(pen, run, i);
      }
      drawRobot(run, i);
    }
    for (const track of tracks) if (track.shown) drawTrack(track, tickAt(track.run, now));
  }
  listeners.push(drawMoment);

  function zoomBy(factor, px, py) {
    const x = view.x + (px - map.clientWidth / 2) / view.scale;
    const y = view.y - (py - map.clientHeight / 2) / view.scale;
    view.scale = Math.min(20000, Math.max(0.5, view.scale * factor));
    view.x = x - (px - map.clientWidth / 2) / view.scale;
    view.y = y + (py - map.clientHeight / 2) / view.scale;
    redrawMap();
  }
  const zoomMiddle = (factor) => zoomBy(factor, map.clientWidth / 2, map.clientHeight / 2);
  function setFollow(on) {
    view.follow = on;
    $("follow").setAttribute("aria-pressed", on);
    drawMoment();
  }
  const pointers = new Map();
  map.addEventListener("pointerdown", (event) => {
    map.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
  });
  map.addEventListener("pointermove", (event) => {
    const was = pointers.get(event.pointerId);
    if (!was) return;
    const is = [event.offsetX, event.offsetY];
    if (pointers.size === 1) {
      setFollow(false);
      view.x -= (is[0] - was[0]) / view.scale;
      view.y += (is[1] - was[1]) / view.scale;
      redrawMap();
    } else if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
      const before = Math.hypot(was[0] - other[0], was[1] - other[1]);
      const after = Math.hypot(is[0] - other[0], is[1] - other[1]);
      if (before > 0) zoomBy(after / before, (is[0] + other[0]) / 2, (is[1] + other[1]) / 2);
    }
    pointers.set(event.pointerId, is);
  });
  for (const name of ["pointerup", "pointercancel"])
    map.addEventListener(name, (event) => pointers.delete(event.pointerId));
  map.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoomBy(Math.exp(-event.deltaY / 500), event.offsetX, event.offsetY);
  }, { passive: false });
  $("zoom-in").onclick = () => zoomMiddle(1.4);
  $("zoom-out").onclick = () => zoomMiddle(1 / 1.4);
  $("zoom-all").onclick = () => { setFollow(false); showAll(); };
  $("follow").onclick = () => setFollow(!view.follow);

  function layerButton(label, shown, toggle, colour) {
    const button = element("button", { type: "button", "aria-pressed": shown }, label);
    if (colour) button.style.setProperty("--swatch", `var(${colour})`);
    button.onclick = () => {
      const on = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", on);
      toggle(on);
      redrawMap();
    };
    $("layers").append(button);
  }
  function makeLayers() {
    for (const track of tracks)
      layerButton(track.label, track.shown, (on) => { track.shown = on; }, "--c" + (track.index % 6));
    for (const name of Object.keys(layers))
      layerButton(name, true, (on) => { layers[name] = on; }, name === "truth" ? "--truth" : null);
  }

  // ---- cameras ---------------------------------------------------------------------------------

  const strokes = (to, path, colour, width, dash) => {
    to.setLineDash(dash || []);
    for (const [style, thick] of [["#000", width + 2], [colour, width]]) {
      to.strokeStyle = style;
      to.lineWidth = thick;
      to.beginPath();
      path();
      to.stroke();
    }
    to.setLineDash([]);
  };
  function drawOverlay(to, overlay, k) {
    const at = (p) => [(p[0] + 0.5) * k, (p[1] + 0.5) * k];
    const outline = (e) => () => to.ellipse(...at(e), e[2] * k, e[3] * k, e[4], 0, 2 * Math.PI);
    const cross = (p, size) => () => {
      const [x, y] = at(p);
      to.moveTo(x - size, y); to.lineTo(x + size, y);
      to.moveTo(x, y - size); to.lineTo(x, y + size);
    };
    if (overlay.principal) strokes(to, cross(overlay.principal, 8), "#ffffff", 1);
    if (overlay.predicted) strokes(to, outline(overlay.predicted), "#e69f00", 1.5, [5, 4]);
    if (overlay.measured) {
      strokes(to, outline(overlay.measured), "#56b4e9", 2);
      strokes(to, cross(overlay.measured, 4), "#56b4e9", 1.5);
    }
    for (const point of overlay.points) strokes(to, cross(point, 3), "#56b4e9", 1.2);
  }
  const pictures = [];
  function makeCameras() {
    runs.forEach((run, r) => run.cameras.forEach((camera) => {
      if (!camera.images.length) return;
      const canvas = element("canvas", { width: 480, height: Math.round(480 * camera.height / camera.width), role: "img",
                                         "aria-label": "Picture of " + camera.name });
      const caption = element("figcaption");
      $("cameras").append(element("figure", {}, canvas, caption));
      const stamps = camera.images.map((image) => image.t);
      const decoded = new Map();
      const decode = (i) => {
        if (i < 0 || i >= stamps.length || decoded.has(i)) return decoded.get(i);
        const image = new Image();
        image.src = "data:image/jpeg;base64," + camera.images[i].jpeg;
        decoded.set(i, image);
        return image;
      };
      const picture = { shown: -2 };
      picture.draw = (t) => {
        const i = Math.max(0, indexAt(stamps, t)); // before the first, that
        if (i === picture.shown) return;
        for (let ahead = 1; ahead <= 8; ++ahead) decode(i + ahead);
        const image = decode(i);
        if (!image.complete) { image.onload = () => { if (picture.wanted === i) picture.draw(now); }; picture.wanted = i; return; }
        picture.shown = i;
        const to = canvas.getContext("2d");
        to.drawImage(image, 0, 0, canvas.width, canvas.height);
        drawOverlay(to, camera.images[i].overlay, canvas.width / camera.width);
        const lines = [`t = ${camera.images[i].t.toFixed(2)} s`, ...camera.images[i].overlay.lines];
        caption.textContent = (runs.length > 1 ? `#${r + 1} ${run.name}, ` : "") + camera.name + " · " + lines.join(" · ");
      };
      pictures.push(picture);
      listeners.push(picture.draw);
    }));
  }

  // ---- figures and events ----------------------------------------------------------------------

  function makeFigures() {
    const head = ["localizer", "final cm", "rms cm", "max cm", "limit cm", "final °", "rms °", "NEES/3", "lost s"];
    const body = element("tbody");
    for (const track of tracks) {
      const score = track.run.summary && track.run.summary.localizers && track.run.summary.localizers[track.localizer.name];
      if (!score) continue;
      const swatch = element("span", { class: "swatch" });
      swatch.style.borderColor = `var(--c${track.index % 6})`;
      const degrees = (rad) => (rad * 180 / Math.PI).toFixed(2);
      const row = element("tr", {}, element("td", {}, swatch, track.label));
      for (const value of [centimetres(score.position_final_m), centimetres(score.position_rmse_m), centimetres(score.position_max_m),
                           centimetres(score.pcrlb_position_rms_m), degrees(score.heading_final_rad), degrees(score.heading_rmse_rad),
                           (score.nees_mean / 3).toFixed(2), score.lost_s.toFixed(1)])
        row.append(element("td", {}, value));
      body.append(row);
    }
    const table = element("table", {}, element("thead", {}, element("tr", {}, ...head.map((h) => element("th", {}, h)))), body);
    $("figures").append(element("div", { class: "scroll" }, table));
  }
  const story = [];
  function makeEvents() {
    runs.forEach((run, r) => run.events.forEach((event) => story.push({ ...event, run: r })));
    story.sort((a, b) => a.t - b.t);
    for (const event of story) {
      const what = event.kind.replaceAll("_", " ");
      const button = element("button", { type: "button", onclick: () => show(event.t) },
                             element("span", {}, event.t.toFixed(2) + " s"),
                             element("span", {}, runs.length > 1 ? `#${event.run + 1} ${what}` : what), element("span", {}, event.text));
      event.item = element("li", { class: grave.has(event.kind) ? "grave" : "" }, button);
      $("events").append(event.item);
    }
    const stamps = story.map((event) => event.t);
    let current = -1;
    listeners.push((t) => {
      const i = indexAt(stamps, t);
      if (i === current) return;
      if (current >= 0) { story[current].item.classList.remove("now"); story[current].item.removeAttribute("aria-current"); }
      current = i;
      if (i < 0) return;
      const item = story[i].item, list = $("events");
      item.classList.add("now");
      item.setAttribute("aria-current", "true");
      list.scrollTop = item.offsetTop - list.offsetTop - list.clientHeight / 2;
    });
  }
  const nextEvent = () => { const event = story.find((e) => e.t > now + 1e-6); if (event) show(event.t); };
  const previousEvent = () => { const before = story.filter((e) => e.t < now - 1e-6); if (before.length) show(before[before.length - 1].t); };

  // ---- timelines -------------------------------------------------------------------------------

  const plots = [];
  const spansOf = (run, from, until) => {
    const spans = [];
    let open = null;
    for (const event of run.events) {
      if (from.includes(event.kind)) open = event.t;
      else if (open !== null && until.includes(event.kind)) { spans.push([open, event.t]); open = null; }
    }
    if (open !== null) spans.push([open, end]);
    return spans;
  };
  function shadeSpans(plot) {
    if (runs.length > 1) return;
    const to = plot.ctx;
    const shade = (spans, colour, alpha) => {
      to.fillStyle = colour;
      to.globalAlpha = alpha;
      for (const [from, until] of spans) {
        const x0 = plot.valToPos(from, "x", true), x1 = plot.valToPos(until, "x", true);
        to.fillRect(x0, plot.bbox.top, Math.max(1, x1 - x0), plot.bbox.height);
      }
      to.globalAlpha = 1;
    };
    to.save();
    shade(spansOf(runs[0], ["look"], ["released", "dropped", "expired", "target_lost"]), colours.accent, 0.08);
    shade(spansOf(runs[0], ["stop"], ["restart"]), colours.muted, 0.25);
    shade(spansOf(runs[0], ["lost", "ambiguous"], ["recovered", "settled"]), colours.mark, 0.18);
    to.restore();
  }
  function drawCursor(plot) {
    const x = plot.valToPos(now, "x", true);
    if (x < plot.bbox.left || x > plot.bbox.left + plot.bbox.width) return;
    const to = plot.ctx;
    to.save();
    to.setLineDash([]);
    to.strokeStyle = colours.mark;
    to.lineWidth = window.devicePixelRatio || 1;
    to.beginPath();
    to.moveTo(x, plot.bbox.top);
    to.lineTo(x, plot.bbox.top + plot.bbox.height);
    to.stroke();
    to.restore();
  }
  /// One chart. series: {label, t, values, colour (a name), dash, fill, width}; all have a time axis of their own.
  function chart(title, note, unit, series, options) {
    const holder = element("div", { class: "chart" }, element("h2", {}, unit ? title + ", " + unit : title), element("p", {}, note));
    $("charts").append(holder);
    const joined = uPlot.join(series.map((s) => [s.t, s.values]));
    const make = () => {
      const axis = { stroke: colours.muted, grid: { stroke: colours.rule, width: 1 }, ticks: { stroke: colours.rule, width: 1 } };
      return new uPlot({
        width: Math.max(240, holder.clientWidth), height: options && options.height || 170,
        cursor: { sync: { key: "vigia" }, drag: { x: true, y: false } },
        scales: { x: { time: false }, y: Object.assign({ range: options && options.range }, {}) },
        axes: [{ ...axis, values: (u, splits) => splits.map((s) => s + " s") }, { ...axis, size: 58, ...(options && options.axis) }],
        series: [{ label: "t", value: (u, v) => v === null ? "–" : v.toFixed(2) + " s" }, ...series.map((s) => ({
          label: s.label, stroke: () => colours[s.colour], width: s.width || 1.6, dash: s.dash, spanGaps: !s.gaps, points: { show: false },
          fill: s.fill ? () => colours.view : undefined, value: s.value || ((u, v) => v === null || v === undefined ? "–" : v.toPrecision(3) + " " + unit),
        }))],
        hooks: { drawAxes: [options && options.paint || shadeSpans], draw: [drawCursor] },
      }, joined, holder);
    };
    const entry = { plot: null };
    /// The cursor's line, and what each series has there: of several drives' times none has all.
    entry.follow = () => {
      const { plot } = entry, nearest = plot.valToIdx(now);
      const last = (values) => { let i = nearest; while (i > 0 && values[i] == null && nearest - i < 9) --i; return i; };
      plot.redraw(false);
      plot.setLegend({ idxs: plot.data.map(last) });
    };
    /// Once every chart has its place, since a plot does not grow or shrink by itself.
    entry.again = () => {
      if (entry.plot) entry.plot.destroy();
      entry.plot = make();
      queueMicrotask(entry.follow); // after the plot's own first drawing, which empties its legend
      entry.plot.over.addEventListener("click", () => {
        const left = entry.plot.cursor.left;
        if (left >= 0) show(entry.plot.posToVal(left, "x"));
      });
    };
    plots.push(entry);
  }
  let redraw = 0;
  listeners.push(() => {
    // The cursor's line may lag the map by a frame or two: five plots a frame cost a slow machine its rate.
    const entry = plots[redraw++ % Math.max(1, plots.length)];
    if (!playing) plots.forEach((p) => p.follow());
    else if (entry) entry.follow();
  });
  /// A row for each landmark, darker where it suits better, and a line at the landmark of the look.
  function suitabilityChart(run, suffix) {
    const { t, landmarks } = run.suitability;
    if (!landmarks.length) return;
    // Of more than fit, those that the robot looked at longest, in the map's order.
    const most = 40, looks = new Map();
    for (const id of run.target) looks.set(id, (looks.get(id) || 0) + 1);
    const wanted = new Set([...landmarks].sort((a, b) => (looks.get(b.id) || 0) - (looks.get(a.id) || 0)).slice(0, most));
    const rows = landmarks.filter((mark) => wanted.has(mark)), count = rows.length, row = new Map(rows.map((mark, k) => [mark.id, count - k]));
    const part = count < landmarks.length ? `; ${count} of ${landmarks.length} landmarks, those looked at longest` : "";
    // What stays the same for some time is one rectangle.
    const levels = 12, spans = [];
    rows.forEach((mark, k) => {
      let from = 0;
      const level = (i) => i >= t.length || mark.values[i] === null ? -1 : Math.round(levels * mark.values[i]);
      for (let i = 1; i <= t.length; ++i) {
        if (i < t.length && level(i) === level(from)) continue;
        if (level(from) >= 0) spans.push([t[from], i < t.length ? t[i] : end, count - k, level(from) / levels]);
        from = i;
      }
    });
    const paint = (plot) => {
      const to = plot.ctx, { left, top, width, height } = plot.bbox;
      to.save();
      to.beginPath();
      to.rect(left, top, width, height);
      to.clip();
      to.fillStyle = colours.accent;
      const thick = 0.84 * height / count;
      for (const [from, until, at, value] of spans) {
        const x = plot.valToPos(from, "x", true);
        to.globalAlpha = 0.06 + 0.84 * value;
        to.fillRect(x, plot.valToPos(at, "y", true) - thick / 2, plot.valToPos(until, "x", true) - x, thick);
      }
      to.restore();
    };
    const judged = (time, id) => { const mark = rows.find((one) => one.id === id), i = indexAt(t, time); return mark && i >= 0 ? mark.values[i] : null; };
    const watched = run.target.map((id) => row.has(id) ? row.get(id) : null);
    chart("Suitability of each landmark" + suffix, "by the planner’s fuzzy rules, from where the robot believed to be: the darker the better, blank where it could not be looked at; line: the landmark of the look" + part,
          "", [{ label: "look at", t: run.t, values: watched, colour: "mark", width: 3, gaps: true,
                 value: (u, v, s, i) => { if (v === null || v === undefined) return "–"; const id = rows[count - v].id, fit = judged(u.data[0][i], id); return `L${id}` + (fit === null ? "" : `, ${fit.toFixed(2)}`); } }],
          { range: () => [0.4, count + 0.6], paint, height: Math.max(170, 70 + 15 * count),
            axis: { splits: () => rows.map((mark, k) => count - k), values: (u, splits) => splits.map((s) => "L" + rows[count - s].id), grid: { show: false } } });
  }
  const toDegrees = (values) => values.map((v) => v === null ? null : v * 180 / Math.PI);
  function makeCharts() {
    const colour = (track) => "c" + (track.index % 6);
    const primary = tracks.filter((track) => track.localizer.primary);
    const common = (track) => ({ t: track.run.t, colour: colour(track), dash: trackDash(track) });
    const limitLine = (label, value, dash) => ({ label, t: [0, end], values: [100 * value, 100 * value], colour: "muted", dash, width: 1 });
    const errors = (tracks_) => tracks_.map((track) => ({ label: track.label, values: track.localizer.error.map((v) => 100 * v), ...common(track) }));
    const top = (values) => { const sorted = values.filter((v) => v !== null && isFinite(v)).sort((a, b) => a - b); return sorted.length ? sorted[sorted.length - 1] : 1; };
    const bands = runs.length > 1 ? [] : primary.map((track) => ({
      label: "3σ of " + track.localizer.name, t: track.run.t, values: track.localizer.sigma.map((v) => 300 * v), colour: "muted", fill: true, width: 0.8 }));
    const boundOf = primary.map((track) => ({ label: runs.length > 1 ? "limit of " + track.label : "limit (√PCRLB)", t: track.run.t,
      values: track.localizer.bound.map((v) => 100 * v), colour: runs.length > 1 ? colour(track) : "c2", dash: [2, 3], width: 1.4 }));
    const shown = errors(primary);
    const highest = 1.1 * Math.max(3 * top(boundOf.flatMap((s) => s.values)), top(shown.flatMap((s) => s.values)));
    chart("Position error", "what the driving localizer is off by" + (runs.length > 1 ? " and" : ", its own 3σ, and") + " the root of the posterior Cramér–Rao bound’s trace" + (runs.length > 1 ? "" : "; shaded: looks, stops, lost"),
          "cm", [...bands, ...shown, ...boundOf], { range: (u, low, high) => [0, Math.min(high, highest) || 1] });
    if (tracks.length > primary.length)
      chart("Position error, every localizer", "", "cm", errors(tracks), { range: (u, low, high) => [0, 1.05 * high || 1] });
    const limited = runs.filter((run) => run.limits), alike = limited.every((run) => run.limits.join() === limited[0].limits.join());
    const limits = (alike ? limited.slice(0, 1) : limited).flatMap((run) => [1, 2].map((which) =>
      limitLine(`limit ${which}` + (alike ? "" : ` of #${runs.indexOf(run) + 1}`), run.limits[which - 1], which === 1 ? [6, 4] : [2, 3])));
    chart("Uncertainty", "√λ of the position's covariance, and the limits at which the robot looks and stops", "cm",
          [...primary.map((track) => ({ label: track.label, values: track.localizer.sigma.map((v) => 100 * v), ...common(track) })), ...limits],
          { range: (u, low, high) => [0, 1.05 * high || 1] });
    chart("Heading error", "", "°", primary.map((track) => ({ label: track.label, values: toDegrees(track.localizer.turn), ...common(track) })), {});
    chart("Probability of being lost", "by the localizer's own evidence", "", primary.map((track) => ({ label: track.label, values: track.localizer.lost, ...common(track) })),
          { range: () => [0, 1] });
    runs.forEach((run, r) => {
      const suffix = runs.length > 1 ? ` #${r + 1}` : "";
      suitabilityChart(run, suffix);
      if (run.zoom.length)
        chart("Zoom" + suffix, "", "mm", [{ label: "zoom", t: run.t, values: run.zoom, colour: "c0" }], {});
      if (run.pan.length)
        chart("Head" + suffix, "", "°", [{ label: "pan", t: run.t, values: toDegrees(run.pan), colour: "c0" },
                                         { label: "tilt", t: run.t, values: toDegrees(run.tilt), colour: "c1", dash: [8, 4] }], {});
      chart("Speed" + suffix, "", "m/s", [{ label: "speed", t: run.t, values: run.speed, colour: "c0" }], {});
    });
  }

  // ---- the page --------------------------------------------------------------------------------

  function makeHeader() {
    const footer = $("footer");
    for (const run of runs) {
      const number = runs.length > 1 ? `#${runs.indexOf(run) + 1} ` : "";
      const line = element("p", {}, `${number}${run.name}, seed ${run.seed}, vigia ${run.version}: `, element("code", {}, run.command));
      footer.append(line);
      if (run.note) footer.append(element("p", {}, run.note));
    }
    footer.append(element("p", {}, "Keys: space play · ← → a second · , . a tick · [ ] events · Home End · + − 0 map · f follow. "
      + "On the map: ⇝ kidnapped, ? lost, ≈ ambiguous, ✓ recovered or settled, ✕ the end of a drive that did not arrive, ■ stop; "
      + "a dashed line of that colour was not driven. Click a timeline or an event to go there; drag over a timeline to enlarge it, double-click for all of it. Ellipses hold 95 %."));
  }
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const onControl = /^(SELECT|INPUT)$/.test(event.target.tagName);
    const onButton = event.target.tagName === "BUTTON";
    const tick = runs[0].t.length > 1 ? runs[0].t[1] - runs[0].t[0] : 0.04;
    const pan = (x, y) => { setFollow(false); view.x += x * 40 / view.scale; view.y += y * 40 / view.scale; redrawMap(); };
    const onMap = event.target === map;
    const actions = {
      " ": onControl || onButton ? null : () => play(!playing),
      ArrowLeft: onControl ? null : onMap && event.shiftKey ? () => pan(-1, 0) : () => show(now - 1),
      ArrowRight: onControl ? null : onMap && event.shiftKey ? () => pan(1, 0) : () => show(now + 1),
      ArrowUp: onMap ? () => pan(0, 1) : null, ArrowDown: onMap ? () => pan(0, -1) : null,
      ",": () => show(now - tick), ".": () => show(now + tick),
      "[": previousEvent, "]": nextEvent, Home: onControl ? null : () => show(0), End: onControl ? null : () => show(end),
      "+": () => zoomMiddle(1.4), "=": () => zoomMiddle(1.4), "-": () => zoomMiddle(1 / 1.4), "0": () => { setFollow(false); showAll(); },
      f: () => setFollow(!view.follow),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
  $("play").onclick = () => play(!playing);
  $("next").onclick = nextEvent;
  $("previous").onclick = previousEvent;
  $("scrub").max = end;
  $("scrub").addEventListener("input", () => { play(false); show(parseFloat($("scrub").value)); });
  window.addEventListener("hashchange", readAddress);
  let resizing = 0;
  const layOut = () => { colours = readColours(); showAll(); plots.forEach((p) => p.again()); };
  window.addEventListener("resize", () => { clearTimeout(resizing); resizing = setTimeout(layOut, 120); });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", layOut);
  // Paper is white whatever the screen is; what is drawn does not know of it by itself.
  const onPaper = (is) => { document.documentElement.classList.toggle("printed", is); layOut(); };
  window.addEventListener("beforeprint", () => onPaper(true));
  window.addEventListener("afterprint", () => onPaper(false));

  colours = readColours();
  makeHeader();
  makeLayers();
  makeCameras();
  makeFigures();
  makeEvents();
  makeCharts();
  plots.forEach((p) => p.again());
  showAll();
  show(0, true);
  readAddress();
  vigia.ready();
})();

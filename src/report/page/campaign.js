"use strict";
(() => {
  const { $, data, element, drawing } = vigia;
  const summary = data.summary;
  const list = (value) => Array.isArray(value) ? value : [];
  const object = (value) => value !== null && typeof value === "object" ? value : {};
  const number = (value) => typeof value === "number" && isFinite(value) ? value : null;
  const text = (value) => typeof value === "string" || typeof value === "number" ? String(value) : "–";

  // ---- the arms, as summary.json and results.csv have them --------------------------------------

  const shapes = ["circle", "square", "triangle", "diamond", "cross"];
  const dashes = ["", "8 4", "3 3", "10 3 2 3", "1 3"];
  const arms = list(summary.arms).map(object).map((arm, i) => ({
    name: text(arm.name), figures: arm, primary: object(object(arm.localizers)[arm.localizer]),
    results: list(data.results).find((one) => one.name === arm.name) || { outcomes: [], boxes: {}, points: [] },
    band: data.bands[String(arm.runs)] || null,
    colour: `var(--c${i % 6})`, shape: shapes[i % 5], dash: dashes[Math.floor(i / 6 + i) % 5],
  }));
  const known = {
    position_rmse_m: ["path RMS", "cm", 100, 2], position_max_m: ["path max", "cm", 100, 1],
    position_final_m: ["final", "cm", 100, 2], heading_final_rad: ["final", "°", 180 / Math.PI, 3],
    looks: ["looks", "", 1, 1], stops: ["stops", "", 1, 2], stopped_s: ["stopped", "s", 1, 2], lost_s: ["lost", "s", 1, 2],
    sim_s: ["drive", "s", 1, 1], pan_travel_rad: ["pan turns", "", 1 / (2 * Math.PI), 1],
  };
  const metric = (key) => known[key] || [key, "", 1, 3];
  const metricName = (key) => metric(key)[0] + (metric(key)[1] ? " " + metric(key)[1] : "");
  const estimate = (value, factor) => {
    const e = object(value);
    return number(e.value) === null ? null
      : { value: factor * e.value, low: factor * (number(e.low) ?? e.value), high: factor * (number(e.high) ?? e.value) };
  };
  const mean = (arm, key) => estimate(object(arm.figures.means)[key], metric(key)[2]);
  const share = (value) => {
    const s = object(value);
    if (number(s.count) === null || !(s.of > 0)) return null;
    return { value: 100 * s.count / s.of, low: 100 * (number(s.low) ?? 0), high: 100 * (number(s.high) ?? 1), count: s.count, of: s.of };
  };
  const metricKeys = [...new Set(arms.flatMap((arm) => Object.keys(object(arm.figures.means))))];

  // ---- the table --------------------------------------------------------------------------------

  const withInterval = (e, digits) => e && [e.value.toFixed(digits) + " ", element("small", {}, `[${e.low.toFixed(digits)}, ${e.high.toFixed(digits)}]`)];
  const ofAll = (s) => s && [`${s.count}/${s.of} `, element("small", {}, `[${s.low.toFixed(1)}, ${s.high.toFixed(1)}] %`)];
  const plain = (value, digits) => number(value) === null ? null : [value.toFixed(digits)];
  /// Each: its name, the value that it is sorted by, and what its cell holds.
  const columns = [
    ["arm", (arm) => arm.name, (arm) => [arm.name]],
    ["arrived", (arm) => share(arm.figures.arrived)?.value, (arm) => ofAll(share(arm.figures.arrived))],
    ["collided", (arm) => share(arm.figures.collided)?.value, (arm) => ofAll(share(arm.figures.collided))],
    ...metricKeys.map((key) => [metricName(key), (arm) => mean(arm, key)?.value, (arm) => withInterval(mean(arm, key), metric(key)[3])]),
    ["PCRLB ratio", (arm) => estimate(arm.primary.pcrlb_ratio, 1)?.value, (arm) => withInterval(estimate(arm.primary.pcrlb_ratio, 1), 3)],
    ["NEES/dof", (arm) => number(arm.primary.nees_per_dof), (arm) => plain(arm.primary.nees_per_dof, 3)],
    ["ANEES in band", (arm) => number(arm.primary.anees_in_band),
     (arm) => number(arm.primary.anees_in_band) === null ? null : [`${(100 * arm.primary.anees_in_band).toFixed(0)} % of ${text(arm.primary.anees_looks)}`]],
    ["losses", (arm) => number(object(arm.figures.lost).losses), (arm) => plain(object(arm.figures.lost).losses, 0)],
    ["said before 50 cm", (arm) => share(object(arm.figures.lost).announced)?.value, (arm) => ofAll(share(object(arm.figures.lost).announced))],
    ["false alarms", (arm) => number(object(arm.figures.lost).false_alarms), (arm) => plain(object(arm.figures.lost).false_alarms, 0)],
    ["per km", (arm) => estimate(object(arm.figures.lost).false_alarms_per_km, 1)?.value,
     (arm) => withInterval(estimate(object(arm.figures.lost).false_alarms_per_km, 1), 1)],
  ];
  function makeTable() {
    const body = element("tbody");
    const heads = columns.map(([name], c) => element("th", { scope: "col" },
      element("button", { type: "button", title: "sort by " + name, onclick: () => sortBy(c) }, name)));
    let sorted = -1, up = true;
    const row = (arm) => element("tr", {}, ...columns.map(([, , cell], c) =>
      element("td", c === 0 ? { title: arm.name } : {}, ...(cell(arm) || ["–"]))));
    function sortBy(c) {
      up = sorted === c ? !up : true;
      sorted = c;
      const key = columns[c][1];
      const order = [...arms].sort((a, b) => {
        const x = key(a) ?? null, y = key(b) ?? null;
        if (x === null || y === null) return (x === null) - (y === null);
        return (up ? 1 : -1) * (typeof x === "string" ? x.localeCompare(y) : x - y);
      });
      heads.forEach((head, i) => { if (i === c) head.setAttribute("aria-sort", up ? "ascending" : "descending"); else head.removeAttribute("aria-sort"); });
      body.replaceChildren(...order.map(row));
    }
    body.append(...arms.map(row));
    const several = arms.length > 1 ? " A column's name sorts by it." : "";
    $("arms").append(element("h2", {}, "Arms"), element("p", { class: "note" }, "Means over the missions with 95 % intervals." + several),
      element("div", { class: "scroll" }, element("table", {}, element("thead", {}, element("tr", {}, ...heads)), body)));
  }

  // ---- charts -----------------------------------------------------------------------------------

  const drawn = [];  // what is drawn again when the page's width changes
  function chart(into, title, note, draw) {
    const holder = element("div", { class: "chart" }, element("h2", {}, title), element("p", {}, note));
    const figure = element("div");
    holder.append(figure);
    into.append(holder);
    drawn.push(() => figure.replaceChildren(draw(Math.max(260, figure.clientWidth || holder.clientWidth))));
    return holder;
  }
  const label = (attributes, words, title) => drawing("text", attributes, words, ...(title ? [drawing("title", {}, title)] : []));
  const line = (x1, y1, x2, y2, attributes) => drawing("line", { x1, y1, x2, y2, ...attributes });
  const figures = (value) => Math.abs(value) >= 1000 ? value.toExponential(0) : String(+value.toPrecision(3));
  /// Round places on an axis.
  function ticks(low, high, count, log) {
    const places = [];
    if (log) {
      const few = Math.log10(high / low) > 2;
      for (let decade = Math.floor(Math.log10(low)); decade <= Math.ceil(Math.log10(high)); ++decade)
        for (const k of few ? [1] : [1, 2, 5]) places.push(k * Math.pow(10, decade));
    } else {
      const rough = (high - low) / count, power = Math.pow(10, Math.floor(Math.log10(rough)));
      const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough);
      for (let k = Math.ceil(low / step); k * step <= high * (1 + 1e-9) && places.length < 50; ++k) places.push(k * step);
    }
    return places.filter((v) => v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9));
  }
  /// An axis over the values: logarithmic where the greatest is more than `span` times the least, otherwise from nothing,
  /// or from near the least where `tight`.
  function axisOf(values, from, to, span, tight) {
    const all = values.filter((v) => number(v) !== null), positive = all.filter((v) => v > 0);
    let low = 0, high = all.length ? 1.06 * Math.max(...all) : 1;
    if (!(high > 0)) high = 1;
    const log = span > 0 && positive.length > 0 && positive.length === all.length && Math.max(...positive) / Math.min(...positive) > span;
    if (!log && tight && positive.length === all.length && all.length) low = Math.max(0, Math.min(...all) - 0.15 * (Math.max(...all) - Math.min(...all)));
    if (log) { low = Math.min(...positive) / 1.2; high = Math.max(...positive) * 1.2; }
    const at = (v) => from + (to - from) * (log ? Math.log(Math.max(v, low) / low) / Math.log(high / low) : (v - low) / (high - low));
    return { at, log, ticks: ticks(low, high, Math.abs(to - from) / 70, log) };
  }
  const boundsOf = (values) => values.flat();

  /// A row for each arm: draw(arm, y, x) gives what stands in it, notes(arm) the words at its right.
  function rowChart(into, title, note, unit, values, span, draw, words) {
    chart(into, title, note, (width) => {
      const row = 24, top = 4, right = words ? 92 : 8;
      const left = Math.min(0.36 * width, 12 + 7 * Math.max(3, ...arms.map((arm) => arm.name.length)));
      const bottom = top + row * arms.length, axis = axisOf(values, left, width - right, span);
      const svg = drawing("svg", { viewBox: `0 0 ${width} ${bottom + 36}`, role: "img", "aria-label": title });
      for (const tick of axis.ticks) {
        svg.append(line(axis.at(tick), top, axis.at(tick), bottom, { class: "grid-line" }),
                   label({ x: axis.at(tick), y: bottom + 15, "text-anchor": "middle", class: "quiet" }, figures(tick)));
      }
      svg.append(label({ x: (left + width - right) / 2, y: bottom + 31, "text-anchor": "middle", class: "quiet" }, unit));
      arms.forEach((arm, i) => {
        const y = top + row * (i + 0.5), letters = Math.max(3, Math.floor((left - 12) / 7));
        const name = arm.name.length > letters ? arm.name.slice(0, letters - 1) + "…" : arm.name;
        svg.append(label({ x: left - 8, y: y + 4, "text-anchor": "end" }, name, arm.name));
        svg.append(...draw(arm, y, axis.at));
        const beside = words && words(arm);
        if (beside) svg.append(label({ x: width - right + 8, y: y + 4, class: "quiet" }, beside));
      });
      return svg;
    });
  }
  const tip = (words) => drawing("title", {}, words);
  const interval = (e, arm, y, x, words) => drawing("g", { stroke: arm.colour, "stroke-width": 2 },
    line(x(e.low), y, x(e.high), y, {}), line(x(e.low), y - 4, x(e.low), y + 4, {}), line(x(e.high), y - 4, x(e.high), y + 4, {}),
    drawing("circle", { cx: x(e.value), cy: y, r: 4, fill: arm.colour }), tip(words));
  /// A count of all with its interval, a row an arm; nothing where no arm has it.
  function shareChart(into, title, note, of) {
    const shares = arms.map(of);
    if (!shares.some((s) => s)) return false;
    rowChart(into, title, note, "%", [100 / 1.06], 0, (arm, y, x) => {
      const s = of(arm);
      return s ? [interval(s, arm, y, x, `${arm.name}: ${s.count} of ${s.of}, ${s.value.toFixed(1)} % [${s.low.toFixed(1)}, ${s.high.toFixed(1)}]`)] : [];
    }, (arm) => { const s = of(arm); return s ? `${s.count} of ${s.of}` : "–"; });
    return true;
  }
  function makeOutcomes() {
    const into = $("outcomes");
    const kinds = ["arrived", ...new Set(arms.flatMap((arm) => list(arm.results.outcomes).map((o) => o.name)).filter((name) => name !== "arrived"))];
    const outcome = (arm, kind) => share(list(arm.results.outcomes).find((o) => o.name === kind)) || share(arm.figures[kind]);
    for (const kind of kinds)
      shareChart(into, `Outcome: ${kind}`, "of all missions, with Clopper–Pearson’s 95 % interval", (arm) => outcome(arm, kind));
  }
  function makeBoxes() {
    for (const key of ["position_rmse_m", "position_max_m", "position_final_m"]) {
      const [name, unit, factor, digits] = metric(key);
      const boxes = arms.map((arm) => arm.results.boxes[key]).filter((box) => box);
      if (!boxes.length) continue;
      rowChart($("charts"), `${name} of each mission, driving localizer`, "box: the middle half and the median; whiskers: 5 and 95 %; ring: the worst",
               unit, boundsOf(boxes.map((box) => [box.low * factor, box.max * factor])), 30, (arm, y, x) => {
        const box = arm.results.boxes[key];
        if (!box) return [];
        const at = (value) => x(factor * value);
        const f = (value) => (factor * value).toFixed(digits);
        return [drawing("g", { stroke: arm.colour, "stroke-width": 1.8, fill: "none" },
          line(at(box.low), y, at(box.q1), y, {}), line(at(box.q3), y, at(box.high), y, {}),
          line(at(box.low), y - 4, at(box.low), y + 4, {}), line(at(box.high), y - 4, at(box.high), y + 4, {}),
          drawing("rect", { x: at(box.q1), y: y - 7, width: Math.max(1, at(box.q3) - at(box.q1)), height: 14, fill: "var(--panel)" }),
          line(at(box.median), y - 7, at(box.median), y + 7, { "stroke-width": 3 }),
          drawing("circle", { cx: at(box.max), cy: y, r: 3.5 }),
          tip(`${arm.name}: median ${f(box.median)}, half within ${f(box.q1)} … ${f(box.q3)}, nine tenths within ${f(box.low)} … ${f(box.high)}, worst ${f(box.max)} ${unit}`))];
      });
    }
  }

  function marker(shape, x, y, size, attributes) {
    const path = { circle: null, square: `M${x - size} ${y - size}h${2 * size}v${2 * size}h${-2 * size}z`,
                   triangle: `M${x} ${y - size}L${x + size} ${y + size}H${x - size}z`, diamond: `M${x} ${y - 1.3 * size}L${x + 1.3 * size} ${y}L${x} ${y + 1.3 * size}L${x - 1.3 * size} ${y}z`,
                   cross: `M${x - size} ${y - size}L${x + size} ${y + size}M${x - size} ${y + size}L${x + size} ${y - size}` }[shape];
    return path ? drawing("path", { d: path, ...attributes }) : drawing("circle", { cx: x, cy: y, r: size, ...attributes });
  }
  function legend(swatch) {
    return element("ul", { class: "legend" }, ...arms.map((arm) => element("li", { title: arm.name }, drawing("svg", { viewBox: "0 0 26 14" }, ...swatch(arm)), arm.name)));
  }
  /// A plane with two axes; draw(svg, x, y, frame) fills it.
  function plane(width, height, title, xs, ys, xName, yName, options, draw) {
    const frame = { left: 52, top: 6, right: width - 10, bottom: height - 40 };
    const x = axisOf(xs, frame.left, frame.right, options.xLog, options.tight), y = axisOf(ys, frame.bottom, frame.top, options.yLog);
    const svg = drawing("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title });
    for (const tick of x.ticks)
      svg.append(line(x.at(tick), frame.top, x.at(tick), frame.bottom, { class: "grid-line" }),
                 label({ x: x.at(tick), y: frame.bottom + 15, "text-anchor": "middle", class: "quiet" }, figures(tick)));
    for (const tick of y.ticks)
      svg.append(line(frame.left, y.at(tick), frame.right, y.at(tick), { class: "grid-line" }),
                 label({ x: frame.left - 6, y: y.at(tick) + 4, "text-anchor": "end", class: "quiet" }, figures(tick)));
    svg.append(label({ x: (frame.left + frame.right) / 2, y: height - 6, "text-anchor": "middle", class: "quiet" }, xName),
               label({ x: 0, y: 0, "text-anchor": "middle", class: "quiet", transform: `translate(12 ${(frame.top + frame.bottom) / 2}) rotate(-90)` }, yName));
    draw(svg, x.at, y.at, frame);
    return svg;
  }
  function makeErrorAgainstBound() {
    const points = arms.map((arm) => list(arm.results.points).map(([bound, error]) => [100 * bound, 100 * error]).filter(([b, e]) => b > 0 && e > 0));
    const all = points.flat();
    if (!all.length) return;
    const values = all.flat();
    const holder = chart($("charts"), "Error against bound", "path RMS of each mission over the root of the posterior Cramér–Rao bound’s trace; on the line an error is what the bound allows", (width) =>
      plane(width, 340, "Error against bound", values, values, "bound, cm", "path RMS, cm", { xLog: 4, yLog: 4 }, (svg, x, y) => {
        const low = Math.min(...values), high = Math.max(...values);
        svg.append(line(x(low), y(low), x(high), y(high), { class: "diagonal" }));
        arms.forEach((arm, i) => {
          const group = drawing("g", { fill: arm.shape === "cross" ? "none" : arm.colour, stroke: arm.colour, opacity: 0.6 });
          for (const [bound, error] of points[i]) group.append(marker(arm.shape, x(bound), y(error), 2.6, {}));
          svg.append(group);
        });
      }));
    holder.append(legend((arm) => [marker(arm.shape, 13, 7, 4, { fill: arm.shape === "cross" ? "none" : arm.colour, stroke: arm.colour })]));
  }
  function makeAnees() {
    const looks = arms.map((arm) => list(arm.primary.anees_per_dof).map(number));
    const longest = Math.max(0, ...looks.map((values) => values.length));
    if (!longest) return;
    const bands = [...new Map(arms.filter((arm) => arm.band).map((arm) => [arm.figures.runs, arm.band])).values()];
    const said = arms.filter((arm) => number(arm.primary.anees_in_band) !== null)
      .map((arm) => `${arms.length > 1 ? arm.name + ": " : ""}${(100 * arm.primary.anees_in_band).toFixed(0)} % of the looks within`).slice(0, 8).join(", ");
    const holder = chart($("charts"), "ANEES at each look", `average NEES over the missions, a degree of freedom, at the end of each look that all made, and its 95 % band. ${said}`, (width) =>
      plane(width, 300, "ANEES over the looks", [1, longest], boundsOf([...looks, ...bands.map((b) => [b.low, b.high])]), "look", "ANEES per dof", { yLog: 10 }, (svg, x, y, frame) => {
        for (const band of bands) svg.append(drawing("rect", { class: "band", x: frame.left, width: frame.right - frame.left, y: y(band.high), height: Math.max(1, y(band.low) - y(band.high)) }, tip(`95 % band: ${band.low.toFixed(3)} … ${band.high.toFixed(3)}`)));
        svg.append(line(frame.left, y(1), frame.right, y(1), { class: "diagonal" }));
        arms.forEach((arm, i) => {
          const at = looks[i].map((v, k) => v === null ? null : [x(k + 1), y(v)]).filter((p) => p);
          svg.append(drawing("polyline", { points: at.map((p) => p.join(",")).join(" "), fill: "none", stroke: arm.colour, "stroke-width": 1.8, "stroke-dasharray": arm.dash }));
          looks[i].forEach((v, k) => { if (v !== null) svg.append(drawing("g", {}, marker(arm.shape, x(k + 1), y(v), 3, { fill: arm.shape === "cross" ? "none" : arm.colour, stroke: arm.colour }), tip(`${arm.name}, look ${k + 1}: ${v.toFixed(3)}`))); });
        });
      }));
    holder.append(legend((arm) => [line(1, 7, 25, 7, { stroke: arm.colour, "stroke-width": 2, "stroke-dasharray": arm.dash }), marker(arm.shape, 13, 7, 3, { fill: arm.shape === "cross" ? "none" : arm.colour, stroke: arm.colour })]));
  }

  // ---- error against cost -----------------------------------------------------------------------

  /// Finds a label a place beside its point that no other has; nothing where there is none.
  function placer(width) {
    const taken = [];
    return (x, y, words) => {
      for (const dy of [-8, 16, -22, 30, 4])
        for (const side of [1, -1]) {
          const long = 7 * words.length, left = side > 0 ? x + 9 : x - 9 - long, box = [left, y + dy - 11, left + long, y + dy + 3];
          if (box[0] < 56 || box[2] > width || taken.some((b) => box[0] < b[2] && b[0] < box[2] && box[1] < b[3] && b[1] < box[3])) continue;
          taken.push(box);
          return { x: side > 0 ? x + 9 : x - 9, y: y + dy, "text-anchor": side > 0 ? "start" : "end" };
        }
      return null;
    };
  }
  /// Those that no other arm beats in both, in order of x.
  function front(points) {
    return points.filter((p) => !points.some((q) => q.x.value <= p.x.value && q.y.value <= p.y.value && (q.x.value < p.x.value || q.y.value < p.y.value)))
      .sort((a, b) => a.x.value - b.x.value);
  }
  function makePareto() {
    const costs = ["sim_s", "stops", "looks", "stopped_s", "pan_travel_rad"].filter((key) => metricKeys.includes(key));
    const errors = ["position_rmse_m", "position_max_m", "position_final_m", "heading_final_rad"].filter((key) => metricKeys.includes(key));
    if (!costs.length || !errors.length) return;
    const choice = (keys, name) => element("select", { "aria-label": name, onchange: () => redraw() }, ...keys.map((key) => element("option", { value: key }, metricName(key))));
    const cost = choice(costs, "cost"), error = choice(errors, "error");
    const holder = chart($("pareto"), "Error against cost", "means over the missions with 95 % intervals; the line joins the arms that no other beats in both", (width) => {
      const points = arms.map((arm) => ({ arm, x: mean(arm, cost.value), y: mean(arm, error.value) })).filter((p) => p.x && p.y);
      return plane(width, 360, "Error against cost", boundsOf(points.map((p) => [p.x.low, p.x.high])), boundsOf(points.map((p) => [p.y.low, p.y.high])),
                   metricName(cost.value), metricName(error.value), { yLog: 30, tight: true }, (svg, x, y) => {
        const place = placer(width);
        svg.append(drawing("polyline", { class: "diagonal", points: front(points).map((p) => `${x(p.x.value)},${y(p.y.value)}`).join(" ") }));
        points.forEach(({ arm, x: a, y: b }) => {
          svg.append(drawing("g", { stroke: arm.colour, "stroke-width": 1.6 }, line(x(a.low), y(b.value), x(a.high), y(b.value), {}), line(x(a.value), y(b.low), x(a.value), y(b.high), {}),
                             marker(arm.shape, x(a.value), y(b.value), 5, { fill: arm.shape === "cross" ? "none" : arm.colour }), tip(`${arm.name}: ${a.value.toFixed(2)}, ${b.value.toFixed(2)}`)));
          const words = arm.name.length > 40 ? arm.name.slice(0, 39) + "…" : arm.name, at = place(x(a.value), y(b.value), words);
          if (at) svg.append(label(at, words));
        });
      });
    });
    holder.insertBefore(element("p", {}, element("label", {}, "error ", error), " ", element("label", {}, "over ", cost)), holder.lastChild);
  }

  // ---- losses and worst missions ----------------------------------------------------------------

  function makeLosses() {
    const into = $("losses"), lost = (arm) => object(arm.figures.lost);
    const any = shareChart(into, "Losses said before 50 cm", "of the losses whose error passed half a metre or the claim; 95 %", (arm) => share(lost(arm).announced));
    shareChart(into, "Missions without a false alarm", "a loss that was said and was none, beside the losses; 95 %", (arm) => share(lost(arm).drives_without_false_alarm));
    shareChart(into, "Recoveries that were right", "judged by the truth; 95 %", (arm) => share(arm.primary.right_recoveries));
    if (!any && arms.some((arm) => number(lost(arm).losses) === 0))
      into.prepend(element("p", {}, "No mission lost its place."));
  }
  function command(words) {
    const button = element("button", { type: "button", onclick: async () => {
      try { await navigator.clipboard.writeText(words); button.textContent = "copied"; } catch (error) { getSelection().selectAllChildren(code); }
    } }, "copy");
    const code = element("code", {}, words);
    return element("div", { class: "command" }, code, button);
  }
  function makeWorst() {
    const into = $("worst"), worst = list(summary.worst).map(object);
    into.append(element("h2", {}, "The worst missions"));
    if (!worst.length) { into.append(element("p", {}, "This folder’s summary.json names none.")); return; }
    into.append(element("p", { class: "note" }, "Those that did not arrive first, then by the greatest error. The commands are for a shell in this page’s folder."));
    into.append(element("ol", {}, ...worst.map((mission) => {
      const again = text(mission.command), folder = "replays/" + `${text(mission.arm)}-${text(mission.seed)}`.replace(/[^A-Za-z0-9_.-]+/g, "-");
      const error = number(mission.position_max_m) === null ? "" : `, greatest error ${(100 * mission.position_max_m).toFixed(1)} cm`;
      return element("li", {}, `${text(mission.arm)}, seed ${text(mission.seed)}: ${text(mission.outcome)}${error}`,
        element("div", {}, "its figures"), command(again + " --no-pictures --json"), element("div", {}, `its replay, ${folder}/report.html`), command(again + " --out " + folder));
    })));
  }

  // ---- the page ---------------------------------------------------------------------------------

  for (const note of list(data.notes)) $("notes").append(element("li", {}, text(note)));
  makeTable();
  makeOutcomes();
  makeBoxes();
  makeErrorAgainstBound();
  makeAnees();
  makePareto();
  makeLosses();
  makeWorst();
  $("footer").append(element("p", {}, `vigia ${text(summary.version)}: `, element("code", {}, text(summary.command))),
                     element("p", {}, "Figures are those of summary.json and results.csv of this folder. Move the pointer over a mark for its values."));
  const redraw = () => drawn.forEach((draw) => draw());
  let resizing = 0;
  window.addEventListener("resize", () => { clearTimeout(resizing); resizing = setTimeout(redraw, 120); });
  redraw();
  const linked = $(location.hash.slice(1));
  if (linked) linked.scrollIntoView();
  vigia.ready();
})();

// Asks a page, in the browser that shows it, what it shows. `expected` is what its folder's files say.
(async () => {
  const expected = JSON.parse(document.getElementById("expected").textContent);
  const failures = [], measured = {};
  const expect = (holds, what) => { if (!holds) failures.push(what); };
  const get = (id) => document.getElementById(id);
  const press = (key) => document.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
  const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
  const cells = (into) => [...get(into).querySelectorAll("tbody tr")].map((row) => [...row.children].map((cell) => cell.textContent));
  const inks = (canvas) => {
    const copy = new OffscreenCanvas(canvas.width, canvas.height), pen = copy.getContext("2d", { willReadFrequently: true });
    pen.drawImage(canvas, 0, 0);
    const pixels = new Uint32Array(pen.getImageData(0, 0, copy.width, copy.height).data.buffer);
    return { count: new Set(pixels).size, sum: pixels.reduce((sum, pixel, i) => (sum * 31 + pixel + i) % 4294967291, 7) };
  };

  function askFigures() {
    const rows = cells("figures"), degrees = (rad) => (180 * rad / Math.PI).toFixed(2);
    const cm = (m) => m < 0.1 ? (100 * m).toFixed(2) : (100 * m).toFixed(1);
    const wanted = expected.summaries.flatMap((summary) => Object.values(summary.localizers).map((l) =>
      [cm(l.position_final_m), cm(l.position_rmse_m), cm(l.position_max_m), cm(l.pcrlb_position_rms_m), degrees(l.heading_final_rad),
       degrees(l.heading_rmse_rad), (l.nees_mean / 3).toFixed(2), l.lost_s.toFixed(1)].join()));
    const shown = rows.map((row) => row.slice(1).join());
    expect(shown.length === wanted.length, `${shown.length} localizers are shown of ${wanted.length}`);
    for (const figures of wanted) expect(shown.includes(figures), `no row shows ${figures}`);
    if (expected.summaries.length === 1)
      expect(get("subtitle").textContent === `${expected.summaries[0].outcome} after ${expected.summaries[0].sim_s.toFixed(1)} s`, `the outcome is ${get("subtitle").textContent}`);
  }
  async function askKeys() {
    const clock = () => get("clock").textContent;
    expect(clock() === "3.21 s", `the link's moment is not shown, but ${clock()}`);
    press("End");
    const end = clock();
    press("Home");
    expect(clock() === "0.00 s" && end !== clock(), "Home and End do not lead there");
    press("]");
    press("]");
    expect(clock() !== "0.00 s", "] does not lead to an event");
    const map = get("map"), there = inks(map);
    expect(there.count > 4, "the map is blank");
    const over = document.querySelector(".u-over"), box = over.getBoundingClientRect();
    const at = { clientX: box.left + box.width / 2, clientY: box.top + box.height / 2, movementX: 1, movementY: 1, bubbles: true };
    for (const kind of ["mouseenter", "mousemove", "mousedown", "mouseup", "click"]) {
      over.dispatchEvent(new MouseEvent(kind, at));
      await frame();
      await frame();  // a plot moves its cursor in the next one
    }
    const half = parseFloat(end) / 2;
    expect(Math.abs(parseFloat(clock()) - half) < 0.1 * half, `a click on a timeline's middle leads to ${clock()} of ${end}`);
    expect(inks(map).sum !== there.sum, "the map did not move with the cursor");
    const begun = performance.now();
    for (let i = 0; i < 100; ++i) press(".");
    measured.moment_ms = ((performance.now() - begun) / 100).toFixed(2);
  }
  async function askRate() {
    press("Home");
    get("speed").value = "2";
    get("play").click();
    await pause(1500);
    const rate = window.vigiaFrameRate();
    get("play").click();
    measured.frames_a_second = rate.toFixed(1);
    expect(rate >= 30, `the replay has ${rate.toFixed(1)} frames a second`);
    if (expected.pictures) {
      await pause(300);
      const camera = document.querySelector("#cameras canvas");
      expect(camera && inks(camera).count > 4, "the camera's picture is blank");
    }
  }

  function askArms() {
    const summary = expected.summaries[0], first = () => cells("arms").map((row) => row[0]);
    const arm = summary.arms[0], row = cells("arms")[0];
    const names = [...get("arms").querySelectorAll("th")].map((head) => head.textContent);
    const rmse = arm.means.position_rmse_m, f = (m) => (100 * m).toFixed(2);
    expect(row[0] === arm.name, "the first arm is not the first row");
    expect(row[1].startsWith(`${arm.arrived.count}/${arm.arrived.of} `), `arrived is ${row[1]}`);
    expect(row[names.indexOf("path RMS cm")] === `${f(rmse.value)} [${f(rmse.low)}, ${f(rmse.high)}]`, `path RMS is ${row[names.indexOf("path RMS cm")]}`);
    expect(row[names.indexOf("NEES/dof")] === arm.localizers[arm.localizer].nees_per_dof.toFixed(3), "NEES/dof is another");
    const button = get("arms").querySelectorAll("th button")[names.indexOf("path RMS cm")];
    const order = [...summary.arms].sort((a, b) => a.means.position_rmse_m.value - b.means.position_rmse_m.value).map((each) => each.name);
    button.focus();
    expect(document.activeElement === button, "a column's name takes no focus");
    button.click();
    expect(first().join() === order.join(), `sorted by path RMS: ${first()}`);
    expect(button.parentElement.getAttribute("aria-sort") === "ascending", "the order is not said");
    button.click();
    expect(first().join() === order.reverse().join(), `sorted the other way: ${first()}`);
  }
  function askCharts() {
    const charts = [...document.querySelectorAll(".chart")].map((chart) => chart.querySelector("h2").textContent);
    for (const title of ["Outcome: arrived", "path RMS of each mission, driving localizer", "Error against bound", "ANEES at each look", "Error against cost"])
      expect(charts.includes(title), `no chart "${title}" among ${charts}`);
    for (const svg of document.querySelectorAll(".chart svg")) expect(!/NaN|Infinity|undefined/.test(svg.outerHTML), "a chart has a place that is none");
    const commands = [...get("worst").querySelectorAll("code")].map((code) => code.textContent);
    for (const worst of expected.summaries[0].worst)
      expect(commands.some((words) => words === `${worst.command} --no-pictures --json`), `no command ${worst.command}`);
    measured.charts = charts.length;
  }

  await pause(200);
  const paint = performance.getEntriesByName("first-contentful-paint")[0];
  measured.first_paint_ms = paint ? paint.startTime.toFixed(0) : "?";
  expect(document.documentElement.dataset.ready === "yes", "the page did not get ready");
  expect(document.documentElement.scrollWidth <= window.innerWidth, `the page is ${document.documentElement.scrollWidth} px wide`);
  if (expected.campaign) { askArms(); askCharts(); } else { askFigures(); await askKeys(); await askRate(); }
  if (expected.jumps !== undefined)
    expect(vigia.data.runs[0].jumps.size === expected.jumps, `${vigia.data.runs[0].jumps.size} jumps`);
  console.log("PROBE " + (failures.length ? "FAILED: " + failures.join("; ") : "PASSED " + JSON.stringify(measured)));
})().catch((error) => console.log("PROBE FAILED: " + error.stack));

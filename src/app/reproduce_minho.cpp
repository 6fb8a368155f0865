#include "papers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/field_map.hpp"
#include "vigia/evaluation/field_drive.hpp"
#include "vigia/evaluation/field_study.hpp"
#include "vigia/report/curve_chart.hpp"
#include "vigia/report/heat_map.hpp"

namespace vigia::app {
namespace {

using evaluation::FieldDrive;
using evaluation::FieldDriveErrors;
using evaluation::FieldDriveParams;
using evaluation::FieldFrameParams;
using evaluation::FieldLocalizer;
using evaluation::FrameErrors;
using evaluation::FrameMethod;
using evaluation::FrameStudy;
using evaluation::PaperRow;

constexpr std::uint64_t kFirstSeed = 1;
constexpr int kFrames = 1000;
constexpr int kDriveSeeds = 5;
constexpr int kKidnapTrials = 500;
constexpr int kKidnapAt = 30;
constexpr int kRecovery = 25;  // frames
constexpr int kTriBotsDrives = 20;
constexpr int kFoxDrives = 20;
constexpr int kFoxFrames = 3000;
constexpr double kFoxTeleportsPerM = 0.005;

const std::vector<FrameMethod> kAllMethods{
    FrameMethod::printed, FrameMethod::as_published, FrameMethod::corrected, FrameMethod::tracked,
    FrameMethod::cold,    FrameMethod::murea,        FrameMethod::murea_fine};
const std::vector<std::pair<FieldLocalizer, const char*>> kTrackers{
    {FieldLocalizer::field_grid, "field_grid"},
    {FieldLocalizer::mcl, "mcl"},
    {FieldLocalizer::murea, "murea"}};

std::vector<FieldLocalizer> all_trackers() {
  std::vector<FieldLocalizer> all;
  all.reserve(kTrackers.size());
  for (const auto& tracker : kTrackers) all.push_back(tracker.first);
  return all;
}

struct MinhoRun {
  const PaperOptions& options;
  evaluation::PaperTable& table;

  /// As many frames as there are seeds asked for, drives and kidnappings in proportion.
  int trials(int own) const {
    return options.seeds > 0 ? std::max(1, own * options.seeds / kFrames) : own;
  }
  FieldMap field(const std::string& name) const {
    MapReader reader(load_config(options.config / "fields" / (name + ".yaml")), name);
    FieldMap map = read_field_map(reader.map("field"));
    reader.finish();
    return map;
  }
  void add(std::string quantity, std::string unit, std::optional<double> published,
           std::optional<double> as_published, std::optional<double> best,
           std::optional<double> limit, int n) const {
    PaperRow row{std::move(quantity), std::move(unit)};
    row.published = published;
    row.as_published = as_published;
    row.best = best;
    row.limit = limit;
    row.n = n;
    table.rows.push_back(row);
  }
  void add_best(std::string quantity, std::string unit, double best, int n) const {
    add(std::move(quantity), std::move(unit), {}, {}, best, {}, n);
  }
  void add_share(std::string quantity, int successes, int trials) const {
    PaperRow row{std::move(quantity), "%"};
    row.best = 100.0 * successes / trials;
    const evaluation::Interval share = evaluation::clopper_pearson(successes, trials);
    row.best_95 = evaluation::Interval{100.0 * share.low, 100.0 * share.high};
    row.n = trials;
    table.rows.push_back(row);
  }
};

constexpr double kCm = 100.0;

void add_frame_rows(const MinhoRun& run, const FrameStudy& study) {
  const auto of = [&](FrameMethod method) { return evaluation::frame_errors(study, method); };
  const FrameErrors published = of(FrameMethod::as_published);
  const FrameErrors best = of(FrameMethod::cold);
  const evaluation::FrameBound bound = evaluation::frame_bound(study);
  const int n = published.frames;
  run.add("one frame: position, mean", "cm", 100.0, kCm * published.mean_m, kCm * best.mean_m,
          kCm * bound.mean_m, n);
  run.add("one frame: position, rms", "cm", {}, kCm * published.rms_m, kCm * best.rms_m,
          kCm * bound.rms_m, n);
  run.add("one frame: position, greatest", "cm", 100.0, kCm * published.max_m, kCm * best.max_m, {},
          n);
  run.add("one frame: heading, mean", "°", {}, to_deg(published.heading_mean),
          to_deg(best.heading_mean), to_deg(bound.heading_mean), n);
  const FrameErrors printed = of(FrameMethod::printed);
  run.add("eq. 2 without a sign: position, mean", "cm", {}, kCm * printed.mean_m, {}, {}, n);
  run.add("eq. 2 without a sign: heading, mean", "°", {}, to_deg(printed.heading_mean), {}, {}, n);
  const FrameErrors corrected = of(FrameMethod::corrected);
  run.add_best("errata mended (grid match): position, mean", "cm", kCm * corrected.mean_m, n);
  run.add_best("errata mended (grid match): position, greatest", "cm", kCm * corrected.max_m, n);
  for (const auto& [method, name] : {std::pair{FrameMethod::murea, "MUREA, 5 cm cells"},
                                     std::pair{FrameMethod::murea_fine, "MUREA, 2.5 cm cells"}}) {
    const FrameErrors errors = of(method);
    run.add(fmt::format("{}: position, mean", name), "cm", 10.0, {}, kCm * errors.mean_m,
            kCm * bound.mean_m, n);
    run.add(fmt::format("{}: heading, mean", name), "°", 1.0, {}, to_deg(errors.heading_mean),
            to_deg(bound.heading_mean), n);
  }
}

std::string clutter_name(const FieldFrameParams& params) {
  if (params.clutter_share == 0.0) return "no clutter";
  return fmt::format("{:.0f} % {}", 100.0 * params.clutter_share,
                     params.clutter == FieldFrameParams::Clutter::uniform ? "uniform" : "straight");
}

/// Every share and kind of clutter.
std::vector<FieldFrameParams> clutters() {
  std::vector<FieldFrameParams> all(1);
  for (const auto kind : {FieldFrameParams::Clutter::uniform, FieldFrameParams::Clutter::straight})
    for (const double share : {0.25, 0.40, 0.55}) {
      FieldFrameParams params;
      params.clutter = kind;
      params.clutter_share = share;
      all.push_back(params);
    }
  return all;
}

/// Wrong but unflagged against right but flagged, cold single frames.
report::Curve flag_line(const FrameStudy& study, const std::string& name) {
  report::Curve line{name, {}};
  const auto n = static_cast<double>(study.truths.size());
  for (const auto& count : evaluation::flag_curve(
           study, FrameMethod::cold, {0.0, 0.5, 0.7, 0.9, 0.95, 0.99, 0.999, 0.9999, 0.999999}))
    line.points.emplace_back(100.0 * count.right_flagged / n, 100.0 * count.wrong_unflagged / n);
  return line;
}

void sweep_clutter(const MinhoRun& run, const FieldMap& map) {
  report::CurveChart chart{"Cold single frames, thresholds on the answer's weight",
                           "right but flagged, % of frames",
                           "wrong but not flagged, % of frames",
                           {}};
  const int n = run.trials(kFrames);
  for (const FieldFrameParams& params : clutters()) {
    const FrameStudy study = evaluation::study_frames(
        map, params, {FrameMethod::tracked, FrameMethod::cold}, kFirstSeed, n, run.options.threads);
    const std::string name = clutter_name(params);
    const FrameErrors tracked = evaluation::frame_errors(study, FrameMethod::tracked);
    const evaluation::FrameBound bound = evaluation::frame_bound(study);
    run.add(fmt::format("refined, {}: position, mean", name), "cm", {}, {}, kCm * tracked.mean_m,
            kCm * bound.mean_m, n);
    run.add_best(fmt::format("refined, {}: position, p95", name), "cm", kCm * tracked.p95_m, n);
    run.add_best(fmt::format("refined, {}: position, greatest", name), "cm", kCm * tracked.max_m,
                 n);
    run.add_best(fmt::format("refined, {}: rms by the inliers' bound", name), "1",
                 tracked.bound_ratio, n);
    run.add_best(fmt::format("refined, {}: NEES a degree of freedom", name), "1", tracked.nees, n);
    const auto flags = evaluation::flag_curve(study, FrameMethod::cold, {0.95}).front();
    const FrameErrors cold = evaluation::frame_errors(study, FrameMethod::cold);
    run.add_best(fmt::format("cold, {}: wrong", name), "frames", cold.wrong, n);
    run.add_best(fmt::format("cold, {}: wrong, not flagged", name), "frames", flags.wrong_unflagged,
                 n);
    run.add_best(fmt::format("cold, {}: right, flagged", name), "frames", flags.right_flagged, n);
    if (params.clutter_share >= 0.4) chart.curves.push_back(flag_line(study, name));
  }
  write_curve_chart(run.options.out / "flags.png", chart);
}

void sweep_mirror(const MinhoRun& run, const FieldMap& map) {
  report::CurveChart chart{"Scale error of the mirror's distance function",
                           "measured range over true range",
                           "mean position error, cm",
                           {{"errata mended", {}}, {"refined", {}}, {"MUREA, 5 cm", {}}}};
  const std::vector<FrameMethod> methods{FrameMethod::corrected, FrameMethod::tracked,
                                         FrameMethod::murea};
  const int n = run.trials(kFrames / 2);
  for (const double scale : {0.95, 0.97, 0.98, 0.99, 1.0, 1.01, 1.02, 1.03, 1.05}) {
    FieldFrameParams params;
    params.range_scale = scale;
    const FrameStudy study =
        evaluation::study_frames(map, params, methods, kFirstSeed, n, run.options.threads);
    for (std::size_t i = 0; i < methods.size(); ++i)
      chart.curves[i].points.emplace_back(scale,
                                          kCm * evaluation::frame_errors(study, methods[i]).mean_m);
    if (scale != 0.98 && scale != 1.02 && scale != 1.05) continue;
    run.add_best(fmt::format("mirror's scale {:+.0f} %: refined, mean", 100.0 * (scale - 1.0)),
                 "cm", chart.curves[1].points.back().y(), n);
  }
  write_curve_chart(run.options.out / "mirror-scale.png", chart);
}

/// Where on the field a method is how good.
void draw_heat_map(const MinhoRun& run, const FieldMap& map, const FrameStudy& study,
                   FrameMethod method, const std::string& name, double top_cm) {
  report::HeatMap heat;
  heat.title = "Mean position error: " + name;
  heat.unit = "cm";
  heat.max_m = {0.5 * map.length_m, 0.5 * map.width_m};
  heat.min_m = -heat.max_m;
  heat.columns = static_cast<int>(map.length_m);
  heat.rows = static_cast<int>(map.width_m);
  heat.top = top_cm;
  const int all = heat.columns * heat.rows;
  const auto cells = static_cast<std::size_t>(all);
  std::vector<double> sums(cells, 0.0);
  std::vector<int> counts(cells, 0);
  for (std::size_t i = 0; i < study.truths.size(); ++i) {
    const auto& out = study.outcomes.at(method)[i];
    if (!out.answered) continue;
    const Eigen::Vector2d at = study.truths[i].position() - heat.min_m;
    const int index = static_cast<int>(at.y()) * heat.columns + static_cast<int>(at.x());
    const auto cell = static_cast<std::size_t>(index);
    sums[cell] += kCm * out.position_m();
    ++counts[cell];
  }
  for (std::size_t i = 0; i < cells; ++i)
    heat.values.push_back(counts[i] > 0 ? sums[i] / counts[i]
                                        : std::numeric_limits<double>::quiet_NaN());
  for (const FieldLine& line : map.lines) {
    heat.lines.emplace_back();
    for (int i = 0; i <= 40; ++i) heat.lines.back().push_back(line.at(line.length_m() * i / 40.0));
  }
  write_heat_map(run.options.out / ("heat-" + name + ".png"), heat);
}

void add_drive_rows(const MinhoRun& run, const std::string& name,
                    const std::vector<FieldDrive>& drives) {
  for (const auto& tracker : kTrackers) {
    const FieldLocalizer localizer = tracker.first;
    const FieldDriveErrors errors = evaluation::drive_errors(drives, localizer);
    const auto row = [&](const char* what) {
      return fmt::format("{}: {}, {}", name, tracker.second, what);
    };
    run.add_best(row("position, mean"), "cm", kCm * errors.mean_m, errors.frames);
    run.add_best(row("position, greatest"), "cm", kCm * errors.max_m, errors.frames);
    PaperRow ratio{row("rms by the PCRLB"), "1"};
    ratio.best = errors.pcrlb_ratio.value;
    ratio.best_95 = errors.pcrlb_ratio.interval;
    ratio.n = static_cast<int>(drives.size());
    run.table.rows.push_back(ratio);
    run.add_best(row("NEES a degree of freedom"), "1", errors.nees, errors.frames);
    run.add_best(row("wrong, not flagged"), "frames", errors.wrong_unflagged, errors.frames);
    run.add_best(row("right, flagged"), "%",
                 errors.right > 0 ? 100.0 * errors.right_flagged / errors.right : 100.0,
                 errors.right);
  }
}

void add_drives(const MinhoRun& run, const FieldMap& map) {
  const std::vector<FieldLocalizer> localizers = all_trackers();
  for (const FieldFrameParams& frames : clutters()) {
    FieldDriveParams params;
    params.frames = frames;
    const int count = run.trials(kDriveSeeds);
    const auto drives = evaluation::drive_field_seeds(map, params, localizers, kFirstSeed, count,
                                                      run.options.threads);
    add_drive_rows(run, "drive, " + clutter_name(frames), drives);
  }
}

/// 16 × 10 m, 30 s at 1.5 m/s.
void add_tribots(const MinhoRun& run) {
  FieldDriveParams params;
  params.count = 750;
  const int count = run.trials(kTriBotsDrives);
  const auto drives = evaluation::drive_field_seeds(
      run.field("16x10"), params,
      {FieldLocalizer::odometry, FieldLocalizer::mcl, FieldLocalizer::mcl_described}, kFirstSeed,
      count, run.options.threads);
  const auto best = evaluation::drive_errors(drives, FieldLocalizer::mcl);
  const auto described = evaluation::drive_errors(drives, FieldLocalizer::mcl_described);
  const auto odometry = evaluation::drive_errors(drives, FieldLocalizer::odometry);
  run.add("TriBots' drive, 16×10 m: MCL, mean", "cm", 20.0, kCm * described.mean_m,
          kCm * best.mean_m, {}, best.frames);
  run.add("TriBots' drive, 16×10 m: MCL, greatest", "cm", 50.0, kCm * described.max_m,
          kCm * best.max_m, {}, best.frames);
  run.add("TriBots' drive, 16×10 m: odometry alone, greatest", "cm", {}, kCm * odometry.max_m, {},
          {}, odometry.frames);
}

void add_kidnapped(const MinhoRun& run) {
  const std::vector<FieldLocalizer> localizers = all_trackers();
  const int count = run.trials(kKidnapTrials);
  for (const auto& [name, symmetric] : {std::pair{"12x8", false}, std::pair{"msl-22x14", true}}) {
    FieldDriveParams params;
    params.kidnap_at = kKidnapAt;
    params.count = kKidnapAt + kRecovery + 1;
    params.frames.goals = !symmetric;
    const auto drives = evaluation::drive_field_seeds(run.field(name), params, localizers,
                                                      kFirstSeed, count, run.options.threads);
    for (const auto& [localizer, label] : kTrackers) {
      const auto found = evaluation::count_kidnapped(drives, localizer, kKidnapAt, kRecovery);
      const std::string row = fmt::format("kidnapped, {}: {}", name, label);
      if (symmetric)
        run.add_share(row + ", both halves within 25 frames", found.both, found.trials);
      else
        run.add_share(row + ", recovered within 25 frames", found.recovered, found.trials);
      run.add_best(row + ", confident and wrong after 25", "trials", found.confident_wrong,
                   found.trials);
      run.add_best(row + ", until flagged or right, mean", "frames", found.mean_unflagged,
                   found.trials);
    }
  }
}

/// Fox's protocol: teleports at 0.005 per metre, recovered when below 45 cm for 10 s.
void add_teleported(const MinhoRun& run, const FieldMap& map) {
  FieldDriveParams params;
  params.teleports_per_m = kFoxTeleportsPerM;
  params.count = kFoxFrames;
  const auto drives = evaluation::drive_field_seeds(map, params, all_trackers(), kFirstSeed,
                                                    run.trials(kFoxDrives), run.options.threads);
  for (const auto& [localizer, label] : kTrackers) {
    const auto count = evaluation::count_teleports(drives, localizer, params.period_s);
    const std::string row = fmt::format("teleported: {}", label);
    if (count.judged > 0) run.add_share(row + ", recovered", count.recovered, count.judged);
    run.add_best(row + ", until within 45 cm for good, greatest", "s", count.greatest_s,
                 count.recovered);
    run.add_best(row + ", farther off than 45 cm", "frames", count.far, count.frames);
    run.add_best(row + ", of them not flagged", "frames", count.far_unflagged, count.frames);
  }
}

}  // namespace

evaluation::PaperTable reproduce_minho(const PaperOptions& options) {
  evaluation::PaperTable table{"minho", {}, {}, {}};
  const MinhoRun run{options, table};
  const FieldMap map = run.field("12x8");
  const FieldFrameParams frames;
  table.noise = {{"points", static_cast<double>(frames.points)},
                 {"sight_m", frames.sight_m},
                 {"bearing_sigma_deg", frames.bearing_sigma_deg},
                 {"range_sigma_m", frames.range_floor_m},
                 {"range_sigma_by_range", frames.range_share},
                 {"goal_range_sigma_by_range", frames.goal_range_share}};
  const FrameStudy study = evaluation::study_frames(map, frames, kAllMethods, kFirstSeed,
                                                    run.trials(kFrames), options.threads);
  add_frame_rows(run, study);
  draw_heat_map(run, map, study, FrameMethod::as_published, "as-published", 300.0);
  draw_heat_map(run, map, study, FrameMethod::corrected, "corrected", 6.0);
  draw_heat_map(run, map, study, FrameMethod::cold, "refined", 6.0);
  draw_heat_map(run, map, study, FrameMethod::murea, "murea", 6.0);
  sweep_clutter(run, map);
  sweep_mirror(run, map);
  add_drives(run, map);
  add_tribots(run);
  add_kidnapped(run);
  add_teleported(run, map);
  table.remarks = {
      "measurements are drawn on the floor, not rendered: each row's noise is the table's",
      "published: the paper's \"error less than 1 m\", MUREA's < 10 cm and ~1°, TriBots' 20 and "
      "50 cm, each on its own robot",
      "one frame: best is the global match from the frame alone; limit by the frame's Cramér–Rao "
      "bound, with clutter that of the true points",
      "wrong: off by more than 50 cm"};
  return table;
}

}  // namespace vigia::app

#include "papers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "vigia/core/angle.hpp"
#include "vigia/evaluation/corner_trials.hpp"
#include "vigia/report/curve_chart.hpp"

namespace vigia::app {
namespace {

using evaluation::BoundRatio;
using evaluation::CornerDrive;
using evaluation::CornerSetting;
using evaluation::CornerTrial;
using evaluation::ErrorSpread;
using evaluation::PaperRow;
using localization::StationFixStatus;

constexpr std::uint64_t kCornerSeed = 1;
constexpr int kTrials = 2000;
constexpr int kSweepTrials = 1000;
constexpr int kCornerDrives = 500;
constexpr double kToCm = 100.0;
constexpr double kBias = 0.05;              // of every range: fits both of the paper's range tables
constexpr double kOdometrySigma_m = 0.005;  // of each displacement of a drive, per axis
constexpr double kOdometryTurnSigma = from_deg(0.5);
const localization::StereoErrors kCalibrationSigma{0.01, from_deg(0.1), 0.005};

/// Mean, standard deviation, least and greatest of one quantity of Tables 1–4.
struct PublishedSpread {
  const char* name;
  const char* unit;
  std::array<double, 4> figures;
};

/// The tables of one resolution: x, y, θ; range, range by range; fixes of 500 trials.
struct PublishedTables {
  const char* name;
  int columns;
  std::array<PublishedSpread, 3> pose;
  std::array<PublishedSpread, 2> range;
  double fixes;
};

const std::array<PublishedTables, 2> kTables{
    PublishedTables{"QVGA",
                    320,
                    {{{"|δx|", "cm", {10.03, 9.98, 0.02, 44.48}},
                      {"|δy|", "cm", {16.91, 15.59, 0.002, 68.94}},
                      {"|δθ|", "°", {14.60, 11.76, 0.001, 66.52}}}},
                    {{{"range", "cm", {4.89, 4.23, 0.001, 30.81}},
                      {"range by range", "%", {5.74, 4.28, 0.001, 35.91}}}},
                    176.0},
    PublishedTables{"VGA",
                    640,
                    {{{"|δx|", "cm", {8.85, 6.26, 0.03, 29.32}},
                      {"|δy|", "cm", {12.74, 10.49, 0.08, 57.30}},
                      {"|δθ|", "°", {12.26, 7.63, 0.08, 36.98}}}},
                    {{{"range", "cm", {4.50, 2.83, 0.12, 20.74}},
                      {"range by range", "%", {5.07, 2.07, 0.10, 13.94}}}},
                    381.0}};

/// Noise of the columns, and what ranges are wrong by.
struct ImageKind {
  const char* name;
  CornerSetting::Columns columns;
  double bias;
};
const std::array<ImageKind, 3> kImages{
    ImageKind{"whole pixels", CornerSetting::Columns::whole_pixels, 0.0},
    ImageKind{"whole pixels, ranges +5 %", CornerSetting::Columns::whole_pixels, kBias},
    ImageKind{"0.1 px", CornerSetting::Columns::noisy, 0.0}};

CornerSetting setting_of(int columns, const ImageKind& image) {
  CornerSetting setting;
  setting.columns = columns;
  setting.image = image.columns;
  // Ranges are (1 + bias) times too great where the true baseline is so much shorter.
  setting.calibration.baseline = 1.0 / (1.0 + image.bias) - 1.0;
  return setting;
}

struct BaisRun {
  const PaperOptions& options;
  evaluation::PaperTable& table;

  int count(int own) const { return options.seeds > 0 ? options.seeds : own; }
  std::vector<CornerTrial> trials(const CornerSetting& setting, int own) const {
    return evaluation::study_corner_trials(setting, kCornerSeed, count(own), options.threads);
  }
  PaperRow& add(std::string quantity, std::string unit, int n) const {
    table.rows.push_back({std::move(quantity), std::move(unit)});
    table.rows.back().n = n;
    return table.rows.back();
  }
  void add_best(std::string quantity, std::string unit, double best, int n) const {
    add(std::move(quantity), std::move(unit), n).best = best;
  }
};

/// The same number of each trial, where there is one.
std::vector<double> numbers_of(const std::vector<CornerTrial>& trials,
                               const std::function<std::optional<double>(const CornerTrial&)>& of) {
  std::vector<double> numbers;
  for (const CornerTrial& trial : trials)
    if (const auto number = of(trial)) numbers.push_back(*number);
  return numbers;
}

double unit_factor(std::size_t i) {
  return i == 2 ? to_deg(1.0) : kToCm;
}

std::vector<double> published_errors(const std::vector<CornerTrial>& trials, std::size_t i) {
  return numbers_of(trials, [i](const CornerTrial& t) -> std::optional<double> {
    if (!t.published) return std::nullopt;
    return unit_factor(i) * (*t.published)(static_cast<Eigen::Index>(i));
  });
}

std::vector<double> likeliest_errors(const std::vector<CornerTrial>& trials, std::size_t i) {
  return numbers_of(trials, [i](const CornerTrial& t) -> std::optional<double> {
    if (!t.likeliest) return std::nullopt;
    return unit_factor(i) * (*t.likeliest)(static_cast<Eigen::Index>(i));
  });
}

/// Stereo ranges at both points, cm or %.
std::vector<double> range_errors(const std::vector<CornerTrial>& trials, bool by_range) {
  std::vector<double> errors;
  for (const CornerTrial& trial : trials)
    for (std::size_t k = 0; k < trial.ranges_m.size(); ++k)
      errors.push_back(100.0 * trial.range_errors_m[k] / (by_range ? trial.ranges_m[k] : 1.0));
  return errors;
}

std::vector<double> likeliest_ranges(const std::vector<CornerTrial>& trials, bool by_range) {
  return numbers_of(trials, [by_range](const CornerTrial& t) -> std::optional<double> {
    if (!t.likeliest || t.ranges_m.size() < 2) return std::nullopt;
    return 100.0 * t.likeliest_range_error_m / (by_range ? t.ranges_m[1] : 1.0);
  });
}

/// Of a normal error with this σ.
double mean_of_sigmas(const std::vector<double>& sigmas) {
  return std::sqrt(2.0 / kPi) * evaluation::spread_of(sigmas).mean;
}

void add_spread(const BaisRun& run, const std::string& where, const PublishedSpread& published,
                const ErrorSpread& theirs, const ErrorSpread& ours, double limit) {
  const std::array<double, 4> theirs4{theirs.mean, theirs.deviation, theirs.least, theirs.greatest};
  const std::array<double, 4> ours4{ours.mean, ours.deviation, ours.least, ours.greatest};
  constexpr std::array<const char*, 4> kNames{"mean", "std", "least", "greatest"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    PaperRow& row = run.add(fmt::format("{}: {} {}", where, published.name, kNames.at(i)),
                            published.unit, theirs.n);
    row.published = published.figures.at(i);
    row.as_published = theirs4.at(i);
    row.best = ours4.at(i);
    if (i == 0) row.limit = limit;
  }
}

void add_table_rows(const BaisRun& run, const PublishedTables& tables, const std::string& where,
                    const std::vector<CornerTrial>& trials) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto sigmas = numbers_of(trials, [i](const CornerTrial& t) -> std::optional<double> {
      const auto k = static_cast<Eigen::Index>(i);
      if (!t.bound) return std::nullopt;
      return unit_factor(i) * std::sqrt((*t.bound)(k, k));
    });
    add_spread(run, where, tables.pose.at(i), evaluation::spread_of(published_errors(trials, i)),
               evaluation::spread_of(likeliest_errors(trials, i)), mean_of_sigmas(sigmas));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const auto sigmas = numbers_of(trials, [i](const CornerTrial& t) -> std::optional<double> {
      if (!t.bound || t.ranges_m.size() < 2) return std::nullopt;
      return 100.0 * t.range_bound_m / (i == 1 ? t.ranges_m[1] : 1.0);
    });
    add_spread(run, where, tables.range.at(i), evaluation::spread_of(range_errors(trials, i == 1)),
               evaluation::spread_of(likeliest_ranges(trials, i == 1)), mean_of_sigmas(sigmas));
  }
}

/// How many trials end with what.
void add_yield_rows(const BaisRun& run, const PublishedTables& tables, const std::string& where,
                    const std::vector<CornerTrial>& trials) {
  const int n = static_cast<int>(trials.size());
  const auto share = [&](const auto& holds) {
    const auto successes = static_cast<int>(std::count_if(trials.begin(), trials.end(), holds));
    const evaluation::Interval interval = evaluation::clopper_pearson(successes, n);
    return std::pair{100.0 * successes / n,
                     evaluation::Interval{100.0 * interval.low, 100.0 * interval.high}};
  };
  PaperRow& fixes = run.add(where + ": trials with a fix", "%", n);
  fixes.published = tables.fixes / 5.0;
  std::tie(fixes.as_published, fixes.as_published_95) =
      share([](const CornerTrial& t) { return t.published.has_value(); });
  std::tie(fixes.best, fixes.best_95) =
      share([](const CornerTrial& t) { return t.likeliest_status == StationFixStatus::found; });
  PaperRow& gated = run.add(where + ": |sin γ| below 0.3, degenerate", "%", n);
  std::tie(gated.best, gated.best_95) = share(
      [](const CornerTrial& t) { return t.likeliest_status == StationFixStatus::degenerate; });
  PaperRow& both = run.add(where + ": two poses left, ambiguous", "%", n);
  std::tie(both.best, both.best_95) =
      share([](const CornerTrial& t) { return t.likeliest_status == StationFixStatus::ambiguous; });
  PaperRow& resolved = run.add(where + ": circles, one candidate left by a prior of 20 cm", "%", n);
  std::tie(resolved.best, resolved.best_95) = share([](const CornerTrial& t) {
    return t.resolved_status == localization::RunningFixStatus::found;
  });
  PaperRow& wrong = run.add(where + ": of all trials, the wrong one", "%", n);
  std::tie(wrong.best, wrong.best_95) =
      share([](const CornerTrial& t) { return t.resolved_wrongly; });
}

/// Maximum likelihood against its bound.
void add_likeliest_rows(const BaisRun& run, const std::string& where,
                        const std::vector<CornerTrial>& trials) {
  for (const bool all : {true, false}) {
    const BoundRatio judged = evaluation::likeliest_ratio(trials, all);
    const std::string name =
        where + (all ? ", maximum likelihood" : ", maximum likelihood, |sin γ| ≥ 0.3");
    PaperRow& mean = run.add(name + ": position, mean", "cm", judged.n);
    mean.best = kToCm * judged.mean_m;
    mean.limit = kToCm * judged.bound_mean_m;
    run.add_best(name + ": position, greatest", "cm", kToCm * judged.greatest_m, judged.n);
    PaperRow& ratio = run.add(name + ": rms by the bound", "1", judged.n);
    ratio.best = judged.ratio.value;
    ratio.best_95 = judged.ratio.interval;
    run.add_best(name + ": NEES a degree of freedom", "1", judged.nees, judged.n);
  }
}

/// Counts in 40 bins as a stair.
report::Curve stair(const std::string& name, const std::vector<double>& errors, double top,
                    double factor) {
  constexpr int kBins = 40;
  std::array<int, kBins> counts{};
  for (const double e : errors) {
    const int bin = static_cast<int>(factor * std::abs(e) / top * kBins);
    if (bin < kBins) ++counts.at(static_cast<std::size_t>(bin));
  }
  report::Curve curve{name, {}};
  for (int i = 0; i < kBins; ++i) {
    const double height = counts.at(static_cast<std::size_t>(i));
    curve.points.emplace_back(top * i / kBins, height);
    curve.points.emplace_back(top * (i + 1) / kBins, height);
  }
  return curve;
}

/// Figs. 8–11: the trials of one resolution, by image.
void draw_histograms(const BaisRun& run, const PublishedTables& tables,
                     const std::array<std::vector<CornerTrial>, 3>& by_image) {
  struct Histogram {
    const char* file;
    const char* label;
    double top;
    double factor;
    std::function<std::vector<double>(const std::vector<CornerTrial>&)> theirs;
    std::function<std::vector<double>(const std::vector<CornerTrial>&)> ours;
  };
  std::vector<Histogram> all;
  using Trials = std::vector<CornerTrial>;
  for (const bool by_range : {false, true})
    all.push_back({by_range ? "range-share" : "range",
                   by_range ? "range error, %" : "range error, mm", by_range ? 20.0 : 200.0,
                   by_range ? 1.0 : 10.0,
                   [by_range](const Trials& t) { return range_errors(t, by_range); },
                   [by_range](const Trials& t) { return likeliest_ranges(t, by_range); }});
  const std::array<std::pair<const char*, const char*>, 3> names{
      {{"dx", "|δx|, mm"}, {"dy", "|δy|, mm"}, {"dtheta", "|δθ|, °"}}};
  for (std::size_t i = 0; i < 3; ++i)
    all.push_back({names.at(i).first, names.at(i).second, i == 2 ? 40.0 : 400.0,
                   i == 2 ? 1.0 : 10.0, [i](const Trials& t) { return published_errors(t, i); },
                   [i](const Trials& t) { return likeliest_errors(t, i); }});
  const std::string resolution = tables.columns == 320 ? "qvga" : "vga";
  for (const Histogram& h : all) {
    report::CurveChart chart{
        fmt::format("{}, {} trials", tables.name, by_image[0].size()), h.label, "count", {}};
    chart.curves = {
        stair("as published", h.theirs(by_image[0]), h.top, h.factor),
        stair("ranges +5 %", h.theirs(by_image[1]), h.top, h.factor),
        stair("maximum likelihood, whole pixels", h.ours(by_image[0]), h.top, h.factor)};
    write_curve_chart(run.options.out / fmt::format("histogram-{}-{}.png", h.file, resolution),
                      chart);
  }
}

void add_tables(const BaisRun& run) {
  for (const PublishedTables& tables : kTables) {
    std::array<std::vector<CornerTrial>, 3> by_image;
    for (std::size_t i = 0; i < kImages.size(); ++i) {
      by_image.at(i) = run.trials(setting_of(tables.columns, kImages.at(i)), kTrials);
      const std::string where = fmt::format("{}, {}", tables.name, kImages.at(i).name);
      add_table_rows(run, tables, where, by_image.at(i));
      add_yield_rows(run, tables, where, by_image.at(i));
      if (kImages.at(i).bias == 0.0) add_likeliest_rows(run, where, by_image.at(i));
    }
    draw_histograms(run, tables, by_image);
  }
}

/// One thing varied, at VGA.
struct Sweep {
  const char* file;
  const char* label;
  std::string (*name)(double value);
  void (*set)(CornerSetting& setting, double value);
  std::vector<double> values;
};

std::vector<Sweep> sweeps() {
  return {{"displacement",
           "displacement between the two points, m",
           [](double v) { return fmt::format("displacement {:.2f} m", v); },
           [](CornerSetting& setting, double v) { setting.displacement_m = v; },
           {0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}},
          {"heading",
           "σ of the heading that puts the displacement into world axes, °",
           [](double v) { return fmt::format("heading of the displacement, σ {} °", v); },
           [](CornerSetting& setting, double v) { setting.heading_sigma = from_deg(v); },
           {0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0}},
          {"baseline",
           "baseline, cm",
           [](double v) { return fmt::format("baseline {} cm", v); },
           [](CornerSetting& setting, double v) { setting.baseline_m = 0.01 * v; },
           {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0}},
          {"landmark",
           "σ of the corner's place in the map, cm an axis",
           [](double v) { return fmt::format("corner's place, σ {} cm", v); },
           [](CornerSetting& setting, double v) { setting.landmark_sigma_m = 0.01 * v; },
           {0.0, 0.25, 0.5, 1.0, 2.0, 3.0, 5.0}}};
}

double published_position_cm(const std::vector<CornerTrial>& trials) {
  return evaluation::spread_of(numbers_of(trials,
                                          [](const CornerTrial& t) -> std::optional<double> {
                                            if (!t.published) return std::nullopt;
                                            return kToCm * t.published->head<2>().norm();
                                          }))
      .mean;
}

void add_sweep(const BaisRun& run, const Sweep& sweep) {
  report::CurveChart chart{"VGA, one corner from two points",
                           sweep.label,
                           "mean position error, cm",
                           {{"as published, whole pixels", {}},
                            {"ML, whole pixels", {}},
                            {"ML, 0.1 px", {}},
                            {"limit, 0.1 px", {}, report::Curve::Look::dashed}}};
  chart.decades = true;
  for (const double value : sweep.values) {
    CornerSetting whole = setting_of(640, kImages[0]);
    CornerSetting fine = setting_of(640, kImages[2]);
    sweep.set(whole, value);
    sweep.set(fine, value);
    const auto by_whole = run.trials(whole, kSweepTrials);
    const auto by_fine = run.trials(fine, kSweepTrials);
    const BoundRatio at_whole = evaluation::likeliest_ratio(by_whole, true);
    const BoundRatio at_fine = evaluation::likeliest_ratio(by_fine, true);
    const std::array<double, 4> means_cm{published_position_cm(by_whole), kToCm * at_whole.mean_m,
                                         kToCm * at_fine.mean_m, kToCm * at_fine.bound_mean_m};
    for (std::size_t i = 0; i < means_cm.size(); ++i)  // of few trials none may have a fix
      if (means_cm.at(i) > 0.0) chart.curves[i].points.emplace_back(value, means_cm.at(i));
    PaperRow& row =
        run.add(fmt::format("VGA, 0.1 px, {}: position, mean", sweep.name(value)), "cm", at_fine.n);
    row.as_published = published_position_cm(by_fine);
    row.best = kToCm * at_fine.mean_m;
    row.limit = kToCm * at_fine.bound_mean_m;
  }
  write_curve_chart(run.options.out / fmt::format("sweep-{}.png", sweep.file), chart);
}

/// Mean position error of poses that took the calibration for exact: all, or those that are `found`
/// with the calibration estimated.
double uncorrected_cm(const std::vector<CornerDrive>& drives, bool all) {
  std::vector<double> off;
  for (const CornerDrive& drive : drives)
    if (drive.uncorrected && (all || drive.status == StationFixStatus::found))
      off.push_back(kToCm * drive.uncorrected->head<2>().norm());
  return evaluation::spread_of(off).mean;
}

/// Rows of drives under one image; their errors by number of points.
struct CalibrationCurves {
  report::Curve blind;
  report::Curve aware;
};

void add_drives(const BaisRun& run, const CornerSetting& setting, const std::string& where,
                int points, int own, CalibrationCurves& curves) {
  const auto drives = evaluation::study_corner_drives(setting, points, kCornerSeed, run.count(own),
                                                      run.options.threads);
  const BoundRatio judged = evaluation::drive_ratio(drives);
  const double uncorrected = uncorrected_cm(drives, false);
  curves.blind.points.emplace_back(points, uncorrected);
  curves.aware.points.emplace_back(points, kToCm * judged.mean_m);
  run.add_best(where + ", taken for exact, ungated: position, mean", "cm",
               uncorrected_cm(drives, true), static_cast<int>(drives.size()));
  run.add_best(where + ", taken for exact: position, mean", "cm", uncorrected, judged.n);
  PaperRow& row = run.add(where + ", estimated: position, mean", "cm", judged.n);
  row.best = kToCm * judged.mean_m;
  row.limit = kToCm * judged.bound_mean_m;
  run.add_best(where + ", estimated: position, greatest", "cm", kToCm * judged.greatest_m,
               judged.n);
  PaperRow& ratio = run.add(where + ", estimated: rms by the bound", "1", judged.n);
  ratio.best = judged.ratio.value;
  ratio.best_95 = judged.ratio.interval;
  run.add_best(where + ", estimated: NEES a degree of freedom", "1", judged.nees, judged.n);
}

/// Errors of calibration, taken for none and carried as states, from two points and over drives of
/// more and more points whose displacements and turns are off as well.
void add_calibration(const BaisRun& run) {
  report::CurveChart chart{"VGA: baseline off by 1 %, vergence by 0.1°, focal length by 0.5 % (σ)",
                           "points of the drive",
                           "mean position error at the last, cm",
                           {}};
  for (const ImageKind& image : {kImages[0], kImages[2]}) {
    const char* short_name =
        image.columns == CornerSetting::Columns::noisy ? image.name : "whole px";
    CalibrationCurves curves{
        {fmt::format("uncorrected, {}", short_name), {}},
        {fmt::format("estimated, {}", short_name), {}, report::Curve::Look::dashed}};
    CornerSetting setting = setting_of(640, image);
    setting.calibration_sigma = kCalibrationSigma;
    CalibrationCurves two;
    add_drives(run, setting, fmt::format("VGA, {}, calibration off, two points", image.name), 2,
               kTrials, two);
    setting.displacement_sigma_m = kOdometrySigma_m;
    setting.turn_sigma = kOdometryTurnSigma;
    for (const int points : {3, 5, 10, 20, 40})
      add_drives(
          run, setting,
          fmt::format("VGA, {}, calibration and odometry off, {} points", image.name, points),
          points, kCornerDrives, curves);
    chart.curves.push_back(curves.blind);
    chart.curves.push_back(curves.aware);
  }
  write_curve_chart(run.options.out / "calibration.png", chart);
}

}  // namespace

evaluation::PaperTable reproduce_bais(const PaperOptions& options) {
  evaluation::PaperTable table{"bais", {}, {}, {}};
  const BaisRun run{options, table};
  const CornerSetting setting;
  table.noise = {{"field_of_view_deg", to_deg(setting.field_of_view)},
                 {"baseline_m", setting.baseline_m},
                 {"whole_pixel_sigma_px", evaluation::column_sigma_px(setting)},
                 {"turn_step_deg", to_deg(setting.turn_step)}};
  add_tables(run);
  for (const Sweep& sweep : sweeps()) add_sweep(run, sweep);
  add_calibration(run);
  table.remarks = {
      "columns of a pinhole pair's images are drawn, not found in pictures; displacements are "
      "exact "
      "and in world axes where the row does not say otherwise",
      "as published: eqs. 4-8, of the two candidates the one nearer the truth; best: maximum "
      "likelihood of range and bearing at both points; trials below the gate of sin γ included",
      "limit: mean error by the Cramér-Rao bound of range and bearing; for whole pixels that of "
      "normal noise of 1/√12 px, which rounding errors are not",
      "both points uniform in the field, the robot turns until it sees a corner, and the same from "
      "the second"};
  return table;
}

}  // namespace vigia::app

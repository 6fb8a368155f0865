#include "papers.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"
#include "vigia/evaluation/ceiling_bursts.hpp"
#include "vigia/evaluation/ceiling_study.hpp"
#include "vigia/evaluation/metrics.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/perception/ceiling_calibration.hpp"
#include "vigia/report/curve_chart.hpp"

namespace vigia::app {
namespace {

using evaluation::CeilingDrive;
using evaluation::CeilingErrorSummary;
using evaluation::CeilingEstimate;
using evaluation::CeilingFault;
using evaluation::CeilingFrame;
using evaluation::CeilingMotion;
using evaluation::CeilingSetting;

constexpr int kPositions = 100;
constexpr int kLines = 30;
constexpr double kSpeed_mps = 0.1;
constexpr double kPeriod_s = 0.04;
constexpr double kCmPerMetre = 100.0;
const double kLine_m = std::hypot(5.0, 2.5);

struct ChonbukRun {
  const PaperOptions& options;
  evaluation::PaperTable& table;

  /// As many lines as seeds are asked for, the dear ones in proportion.
  int lines(int own) const {
    return options.seeds > 0 ? std::max(2, own * options.seeds / kLines) : own;
  }
  void add(std::string quantity, std::string unit, std::optional<double> published,
           std::optional<double> as_published, std::optional<double> best,
           std::optional<double> limit, int n) const {
    evaluation::PaperRow row{std::move(quantity), std::move(unit)};
    row.published = published;
    row.as_published = as_published;
    row.best = best;
    row.limit = limit;
    row.n = n;
    table.rows.push_back(row);
  }
};

/// Mounting, height and placement as the paper's robot may have had them.
CeilingSetting disturbed(std::uint64_t seed) {
  CeilingSetting setting;
  setting.seed = setting.ceiling.seed = seed;
  setting.tilt = from_deg(1.0);
  setting.tilt_axis = RandomStream(seed, "tilt axis").uniform(-kPi, kPi);
  setting.height_error = 0.02;
  setting.ceiling.grid.placement_m = 0.005;
  setting.ceiling.grid.placement_turn = from_deg(1.3);
  return setting;
}

CeilingSetting ideal(std::uint64_t seed) {
  CeilingSetting setting;
  setting.seed = setting.ceiling.seed = seed;
  return setting;
}

CeilingSetting plain(std::uint64_t seed) {
  CeilingSetting setting = ideal(seed);
  setting.contrast = 0.0;
  return setting;
}

/// The paper's line (0, 0) to (5, 2.5) m, turned and moved anywhere; the first seed's as it stands.
std::vector<Pose2> line_of(std::uint64_t seed, double step_m) {
  RandomStream random(seed, "line");
  Eigen::Vector2d from(0.0, 0.0);
  Eigen::Vector2d way(5.0, 2.5);
  if (seed > 1) {
    from = {random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0)};
    way = Eigen::Rotation2Dd(random.uniform(-kPi, kPi)) * way;
  }
  return evaluation::straight_poses(from, from + way, step_m);
}

std::vector<CeilingDrive> drives_of(CeilingSetting (*setting)(std::uint64_t), int count,
                                    double step_m) {
  std::vector<CeilingDrive> drives;
  for (int i = 1; i <= count; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    drives.push_back({setting(seed), line_of(seed, step_m)});
  }
  return drives;
}

void append(std::vector<CeilingEstimate>& all, const std::vector<CeilingEstimate>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void add_position_rows(const ChonbukRun& run, const std::string& name,
                       const CeilingErrorSummary& published, const CeilingErrorSummary& best,
                       std::optional<double> printed_cm, std::optional<double> printed_deg) {
  const int n = best.frames;
  run.add(name + ": position, mean", "cm", {}, kCmPerMetre * published.mean_m,
          kCmPerMetre * best.mean_m, kCmPerMetre * best.bound_mean_m, n);
  run.add(name + ": position, p95", "cm", {}, kCmPerMetre * published.p95_m,
          kCmPerMetre * best.p95_m, {}, n);
  run.add(name + ": position, greatest", "cm", printed_cm, kCmPerMetre * published.max_m,
          kCmPerMetre * best.max_m, {}, n);
  run.add(name + ": heading, mean", "°", {}, to_deg(published.heading_mean),
          to_deg(best.heading_mean), to_deg(best.bound_heading), n);
  run.add(name + ": heading, p95", "°", {}, to_deg(published.heading_p95), to_deg(best.heading_p95),
          {}, n);
  run.add(name + ": heading, greatest", "°", printed_deg, to_deg(published.heading_max),
          to_deg(best.heading_max), {}, n);
  run.add(name + ": NEES a degree of freedom", "1", {}, {}, best.nees, 1.0, n);
}

void draw_errors(const ChonbukRun& run, const std::string& file, const std::string& title,
                 const std::vector<CeilingEstimate>& published,
                 const std::vector<CeilingEstimate>& best) {
  report::CurveChart chart;
  chart.title = title;
  chart.x_label = "position";
  chart.y_label = "error (cm)";
  for (const auto& [name, estimates] :
       {std::pair{"nearest patch, as published", &published}, {"all patches", &best}}) {
    report::Curve curve{name, {}};
    for (std::size_t i = 0; i < estimates->size(); ++i)
      curve.points.emplace_back(
          static_cast<double>(i),
          kCmPerMetre *
              difference((*estimates)[i].estimate, (*estimates)[i].truth).head<2>().norm());
    chart.curves.push_back(curve);
  }
  report::write_curve_chart(run.options.out / file, chart);
}

/// A hundred positions on each line, frame by frame.
void study_ideal_camera(const ChonbukRun& run, const std::string& name,
                        CeilingSetting (*setting_of)(std::uint64_t)) {
  const auto drives = drives_of(setting_of, run.lines(kLines), kLine_m / (kPositions - 1));
  const auto frames = evaluation::read_ceiling_drives(drives, {}, run.options.threads);
  std::vector<CeilingEstimate> nearest;
  std::vector<CeilingEstimate> joint;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const CeilingSetting& setting = drives[i].setting;
    append(nearest, follow_published(setting, setting.known_camera(), frames[i]));
    append(joint, fix_jointly(setting, {}, frames[i]));
  }
  add_position_rows(run, name, summarise_errors(nearest), summarise_errors(joint), {}, {});
}

void study_positions(const ChonbukRun& run) {
  const int count = run.lines(kLines);
  const double step = kLine_m / (kPositions - 1);
  const double period_s = step / kSpeed_mps;
  study_ideal_camera(run, "ideal camera, plain ceiling, one frame", &plain);
  study_ideal_camera(run, "ideal camera, one frame", &ideal);

  const auto drives = drives_of(&disturbed, count, step);
  const auto frames = evaluation::read_ceiling_drives(drives, {}, run.options.threads);
  localization::CeilingFilterParams params;
  params.tilt_sigma = from_deg(1.0);
  params.height_sigma = 0.02;
  std::vector<CeilingEstimate> tilted;
  std::vector<CeilingEstimate> calibrated;
  std::vector<CeilingEstimate> followed;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const CeilingSetting& setting = drives[i].setting;
    const auto errors = calibrate_ceiling(setting, frames[i], period_s).errors;
    append(tilted, follow_published(setting, setting.known_camera(), frames[i]));
    append(calibrated,
           follow_published(setting, corrected(setting.known_camera(), errors), frames[i]));
    append(followed, follow_jointly(setting, params, frames[i], CeilingMotion::unknown, period_s));
    if (i == 0)
      draw_errors(run, "positions.png", "A hundred positions: 1° tilt, 2 % height, 5 mm, 1.3°",
                  tilted, followed);
  }
  const CeilingErrorSummary best = summarise_errors(followed);
  add_position_rows(run, "1° tilt, 2 % height, 5 mm and 1.3° placement", summarise_errors(tilted),
                    best, 5.0, 4.0);
  const CeilingErrorSummary after = summarise_errors(calibrated);
  run.add("the same, tilt and height calibrated from the patches: position, mean", "cm", {},
          kCmPerMetre * after.mean_m, {}, {}, after.frames);
  run.add("the same, tilt and height calibrated from the patches: position, p95", "cm", {},
          kCmPerMetre * after.p95_m, {}, {}, after.frames);
}

/// Tilts and distance as drawn from what the filter is told of them: about either axis, relative.
CeilingSetting drawn_mounting(std::uint64_t seed, double tilt_sigma, double height_sigma) {
  CeilingSetting setting = ideal(seed);
  RandomStream random(seed, "mounting");
  const Eigen::Vector2d tilt(tilt_sigma * random.normal(), tilt_sigma * random.normal());
  setting.tilt = tilt.norm();
  setting.tilt_axis = std::atan2(tilt.y(), tilt.x());
  setting.height_error = height_sigma * random.normal();
  setting.ceiling.grid.placement_m = 0.005;
  setting.ceiling.grid.placement_turn = from_deg(1.3);
  return setting;
}

/// The filter beside its posterior bound where what is constant is drawn anew for each drive.
void study_mountings(const ChonbukRun& run, double tilt_sigma, double height_sigma) {
  constexpr int kMountings = 100;
  constexpr std::uint64_t kMountingSeed = 3000;
  const double step = kLine_m / kPositions;
  std::vector<CeilingDrive> drives;
  for (int i = 0; i < run.lines(kMountings); ++i) {
    const std::uint64_t seed = kMountingSeed + static_cast<std::uint64_t>(i);
    drives.push_back({drawn_mounting(seed, tilt_sigma, height_sigma), line_of(seed, step)});
  }
  const auto frames = evaluation::read_ceiling_drives(drives, {}, run.options.threads);
  localization::CeilingFilterParams params;
  params.tilt_sigma = tilt_sigma;
  params.height_sigma = height_sigma;
  std::vector<CeilingEstimate> all;
  std::vector<std::vector<double>> nees(drives.size());
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const auto drive = follow_jointly(drives[i].setting, params, frames[i], CeilingMotion::unknown,
                                      step / kSpeed_mps);
    for (const CeilingEstimate& one : drive)
      nees[i].push_back(evaluation::nees({one.truth, one.estimate, *one.covariance}));
    append(all, drive);
  }
  const CeilingErrorSummary summary = summarise_errors(all);
  const std::string name = fmt::format("mounting drawn, {:.1f}° about either axis, {:.1f} % height",
                                       to_deg(tilt_sigma), 100.0 * height_sigma);
  const int n = static_cast<int>(drives.size());
  run.add(name + ": position, rms", "cm", {}, {}, kCmPerMetre * summary.rms_m,
          kCmPerMetre * summary.bound_m, n);
  run.add(name + ": position, greatest", "cm", {}, {}, kCmPerMetre * summary.max_m, {}, n);
  run.add(name + ": NEES a degree of freedom", "1", {}, {}, summary.nees, 1.0, n);
  run.add(name + ": instants with ANEES in its 95 % band", "%", {}, {},
          100.0 * evaluation::anees(nees, 3).inside_band, {}, n);
}

double end_error_m(const std::vector<CeilingEstimate>& estimates) {
  return difference(estimates.back().estimate, estimates.back().truth).head<2>().norm();
}

report::Curve path_of(const std::string& name, const std::vector<CeilingEstimate>& estimates,
                      bool truth) {
  report::Curve curve{name, {}};
  if (truth) curve.look = report::Curve::Look::dashed;
  for (const CeilingEstimate& one : estimates)
    curve.points.push_back(truth ? one.truth.position() : one.estimate.position());
  return curve;
}

/// Distance from the truth (cm) over the distance travelled (m).
report::Curve error_of(const std::string& name, const std::vector<CeilingEstimate>& estimates) {
  report::Curve curve{name, {}};
  double travelled_m = 0.0;
  Eigen::Vector2d before = estimates.front().truth.position();
  for (const CeilingEstimate& one : estimates) {
    travelled_m += (one.truth.position() - before).norm();
    before = one.truth.position();
    const double error_m = (one.estimate.position() - before).norm();
    curve.points.emplace_back(travelled_m, kCmPerMetre * error_m);
  }
  return curve;
}

report::Curve heading_of(const std::string& name, const std::vector<CeilingEstimate>& estimates,
                         bool truth) {
  report::Curve curve{name, {}};
  if (truth) curve.look = report::Curve::Look::dashed;
  double turned = 0.0;
  Pose2 before = estimates.front().truth;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const Pose2& now = truth ? estimates[i].truth : estimates[i].estimate;
    turned += wrap_angle(now.theta - before.theta);
    before = now;
    curve.points.emplace_back(static_cast<double>(i), to_deg(turned));
  }
  return curve;
}

/// Lines by optical flow alone, and the paper's turn of half a circle.
std::vector<std::vector<CeilingFrame>> study_flow(const ChonbukRun& run,
                                                  const std::vector<CeilingDrive>& drives) {
  auto frames = evaluation::read_ceiling_drives(drives, {true, true}, run.options.threads);
  double published = 0.0;
  double best = 0.0;
  double published_worst = 0.0;
  double best_worst = 0.0;
  const auto n = static_cast<double>(drives.size());
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const auto as_published =
        follow_flow(drives[i].setting, frames[i], CeilingMotion::published_flow);
    const auto by_keys = follow_flow(drives[i].setting, frames[i], CeilingMotion::key_frame_flow);
    const double share = 100.0 / kLine_m;
    published += share * end_error_m(as_published) / n;
    best += share * end_error_m(by_keys) / n;
    published_worst = std::max(published_worst, share * end_error_m(as_published));
    best_worst = std::max(best_worst, share * end_error_m(by_keys));
    if (i != 0) continue;
    report::CurveChart chart;
    chart.title = "Optical flow alone, (0, 0) to (5, 2.5) m at 0.1 m/s, 25 Hz";
    chart.x_label = "x (m)";
    chart.y_label = "y (m)";
    chart.equal_scales = true;
    chart.curves = {path_of("truth", as_published, true),
                    path_of("whole pixels, frame to frame", as_published, false),
                    path_of("sub-pixel, key frames", by_keys, false)};
    report::write_curve_chart(run.options.out / "flow-line.png", chart);
    report::CurveChart errors;
    errors.title = "Optical flow alone, the same line: distance from the truth";
    errors.x_label = "distance travelled (m)";
    errors.y_label = "error (cm)";
    errors.curves = {error_of("whole pixels, frame to frame", as_published),
                     error_of("sub-pixel, key frames", by_keys)};
    report::write_curve_chart(run.options.out / "flow-error.png", errors);
  }
  const int lines = static_cast<int>(drives.size());
  run.add("flow alone, 5.6 m: error at the end, mean", "% of the path", {}, published, best, {},
          lines);
  run.add("flow alone, 5.6 m: error at the end, greatest", "% of the path", {}, published_worst,
          best_worst, {}, lines);
  return frames;
}

void study_turn(const ChonbukRun& run) {
  constexpr int kTurnFrames = 360;
  CeilingDrive drive{ideal(1), {}};
  for (int i = 0; i <= kTurnFrames; ++i) drive.poses.push_back({0.3, 0.2, kPi * i / kTurnFrames});
  const auto frames = evaluation::read_ceiling_drives({drive}, {true, true}, 1).front();
  const auto published = follow_flow(drive.setting, frames, CeilingMotion::published_flow);
  const auto best = follow_flow(drive.setting, frames, CeilingMotion::key_frame_flow);
  const auto end = [](const std::vector<CeilingEstimate>& all) {
    return std::abs(to_deg(difference(all.back().estimate, all.back().truth).z()));
  };
  run.add("flow alone, turn of 180°: heading error at the end", "°", {}, end(published), end(best),
          {}, kTurnFrames);
  report::CurveChart chart;
  chart.title = "Optical flow alone, a turn of 180°";
  chart.x_label = "frame";
  chart.y_label = "heading (°)";
  chart.curves = {heading_of("truth", published, true),
                  heading_of("whole steps, frame to frame", published, false),
                  heading_of("sub-pixel, key frames", best, false)};
  report::write_curve_chart(run.options.out / "flow-turn.png", chart);
}

/// The ceiling's distance is known and right; pipes hang 10 cm below it.
void study_pipes(const ChonbukRun& run) {
  constexpr double kPipePitch_m = 1.5;
  auto drives = drives_of(&ideal, run.lines(kLines), kSpeed_mps * kPeriod_s);
  for (CeilingDrive& drive : drives) drive.setting.ceiling.pipe_pitch_m = kPipePitch_m;
  const auto frames = evaluation::read_ceiling_drives(drives, {false, true}, run.options.threads);
  double mean = 0.0;
  double worst = 0.0;
  std::vector<CeilingEstimate> filtered;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const auto flow = follow_flow(drives[i].setting, frames[i], CeilingMotion::key_frame_flow);
    const double share = 100.0 / kLine_m * end_error_m(flow);
    mean += share / static_cast<double>(drives.size());
    worst = std::max(worst, share);
    append(filtered, follow_jointly(drives[i].setting, {}, frames[i], CeilingMotion::key_frame_flow,
                                    kPeriod_s));
  }
  const int lines = static_cast<int>(drives.size());
  const std::string name = "pipes 10 cm below the ceiling, every 1.5 m";
  run.add(name + ", flow alone: error at the end, mean", "% of the path", {}, {}, mean, {}, lines);
  run.add(name + ", flow alone: error at the end, greatest", "% of the path", {}, {}, worst, {},
          lines);
  const CeilingErrorSummary summary = summarise_errors(filtered);
  run.add(name + ", filter with flow: position, mean", "cm", {}, {}, kCmPerMetre * summary.mean_m,
          kCmPerMetre * summary.bound_mean_m, summary.frames);
  run.add(name + ", filter with flow: position, greatest", "cm", {}, {},
          kCmPerMetre * summary.max_m, {}, summary.frames);
}

/// A drive whose camera is mounted and hung as drawn, as `vigia calibrate ceiling` reads it.
struct CalibrationTrial {
  Eigen::Vector3d error;  ///< tilts, degrees, and the distance, cm
  Eigen::Vector3d sigma;  ///< stated
};

CalibrationTrial try_calibration(std::uint64_t seed) {
  constexpr int kPictures = 80;
  constexpr double kTiltSigma = from_deg(1.0);
  constexpr double kHeightSigma = 0.03;
  RandomStream random(seed, "calibration");
  CeilingSetting setting = ideal(seed);
  setting.ceiling.spurious = 0.02;
  setting.ceiling.grid.placement_m = 0.005;
  setting.ceiling.grid.placement_turn = from_deg(1.3);
  const Eigen::Vector2d tilt(kTiltSigma * random.normal(), kTiltSigma * random.normal());
  setting.tilt = tilt.norm();
  setting.tilt_axis = std::atan2(tilt.y(), tilt.x());
  setting.height_error = kHeightSigma * std::clamp(random.normal(), -3.0, 3.0);
  const evaluation::CeilingHall hall(setting);
  perception::CeilingView view;
  view.camera = setting.camera;
  view.rise_m = setting.known_camera().rise_m();
  view.grid = setting.ceiling.grid;
  view.tilt_sigma = kTiltSigma;
  view.height_sigma = kHeightSigma;
  perception::CeilingCalibration calibration(view);
  Pose2 pose{random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0), random.uniform(-kPi, kPi)};
  for (int i = 0; i < kPictures; ++i) {
    calibration.next(imaging::grey_image(*hall.expose(pose, i)),
                     Stamp::from_seconds(kPeriod_s * i));
    pose = compose(pose, {0.05, 0.0, 0.02});
  }
  const Eigen::Vector3d unit(to_deg(1.0), to_deg(1.0), kCmPerMetre * view.rise_m);
  const auto result = calibration.result();
  const Eigen::Vector3d found = result.errors.vector();
  const Eigen::Vector3d sigma = result.covariance.diagonal().cwiseSqrt();
  return {unit.cwiseProduct(found - setting.true_errors().vector()), unit.cwiseProduct(sigma)};
}

void study_calibration(const ChonbukRun& run) {
  constexpr int kDrives = 30;
  constexpr std::uint64_t kCalibrationSeed = 2000;
  const int drives = run.lines(kDrives);
  double tilt = 0.0;
  double tilt_worst = 0.0;
  double rise = 0.0;
  double rise_worst = 0.0;
  Eigen::Vector3d nees = Eigen::Vector3d::Zero();
  for (int i = 0; i < drives; ++i) {
    const auto trial = try_calibration(kCalibrationSeed + static_cast<std::uint64_t>(i));
    tilt += trial.error.head<2>().squaredNorm() / (2.0 * drives);
    tilt_worst = std::max(tilt_worst, trial.error.head<2>().cwiseAbs().maxCoeff());
    rise += trial.error.z() * trial.error.z() / drives;
    rise_worst = std::max(rise_worst, std::abs(trial.error.z()));
    nees += trial.error.cwiseQuotient(trial.sigma).cwiseAbs2() / drives;
  }
  const std::string name = "calibrated by 80 pictures: ";
  run.add(name + "tilt about an axis, rms", "°", {}, {}, std::sqrt(tilt), {}, 2 * drives);
  run.add(name + "tilt about an axis, greatest error", "°", {}, {}, tilt_worst, {}, 2 * drives);
  run.add(name + "tilt, NEES a degree of freedom", "1", {}, {}, 0.5 * (nees[0] + nees[1]), 1.0,
          2 * drives);
  run.add(name + "distance, rms", "cm", {}, {}, std::sqrt(rise), {}, drives);
  run.add(name + "distance, greatest error", "cm", {}, {}, rise_worst, {}, drives);
  run.add(name + "distance, NEES a degree of freedom", "1", {}, {}, nees[2], 1.0, drives);
}

/// What a fusion makes of bursts: frames in which it is off by more than 10 cm two seconds after.
struct BurstTally {
  int bursts = 0;
  int lost = 0;
  int unflagged = 0;  ///< of the lost
  double mean_m = 0.0;
};
constexpr int kBurstEvery = 200;
constexpr int kAfterBurst = 50;
constexpr double kLostLock_m = 0.1;

std::vector<evaluation::CeilingBurst> bursts_of(std::size_t frames, int length) {
  std::vector<evaluation::CeilingBurst> bursts;
  for (int at = kBurstEvery / 2; at + length + kAfterBurst < static_cast<int>(frames);
       at += kBurstEvery)
    bursts.push_back({at, length});
  return bursts;
}

void tally_bursts(const std::vector<CeilingEstimate>& estimates,
                  const std::vector<evaluation::CeilingBurst>& bursts, BurstTally& tally) {
  for (const CeilingEstimate& one : estimates)
    tally.mean_m += difference(one.estimate, one.truth).head<2>().norm() /
                    static_cast<double>(estimates.size());
  for (const auto& burst : bursts) {
    const int then = burst.first + burst.frames + kAfterBurst;
    const CeilingEstimate& after = estimates[static_cast<std::size_t>(then)];
    const bool lost = difference(after.estimate, after.truth).head<2>().norm() > kLostLock_m;
    ++tally.bursts;
    tally.lost += lost ? 1 : 0;
    tally.unflagged += lost && after.status == BeliefStatus::tracking ? 1 : 0;
  }
}

/// The paper's fusion by its threshold beside the filter, on the same frames with bursts in them.
void study_fusion(const ChonbukRun& run, const std::vector<CeilingDrive>& drives,
                  const std::vector<std::vector<CeilingFrame>>& frames, CeilingFault fault,
                  int length, const std::vector<double>& thresholds) {
  const std::string what =
      fmt::format("bursts of {} {} frames", length,
                  fault == CeilingFault::unseen ? "unseen" : "misread (up to 20 cm)");
  std::vector<BurstTally> published(thresholds.size());
  BurstTally best;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const CeilingSetting& setting = drives[i].setting;
    const auto bursts = bursts_of(frames[i].size(), length);
    const auto hit = with_bursts(setting, frames[i], fault, bursts, setting.seed);
    for (std::size_t k = 0; k < thresholds.size(); ++k)
      tally_bursts(follow_published(setting, setting.known_camera(), hit, thresholds[k]), bursts,
                   published[k]);
    tally_bursts(follow_jointly(setting, {}, hit, CeilingMotion::key_frame_flow, kPeriod_s), bursts,
                 best);
  }
  const auto lines = static_cast<double>(drives.size());
  for (std::size_t k = 0; k < thresholds.size(); ++k) {
    const std::string row = fmt::format("{}, Th {:g} cm", what, kCmPerMetre * thresholds[k]);
    run.add(row + ": lock lost", "% of bursts", {},
            100.0 * published[k].lost / std::max(1, published[k].bursts), {}, {},
            published[k].bursts);
    run.add(row + ": position, mean", "cm", {}, kCmPerMetre * published[k].mean_m / lines, {}, {},
            published[k].bursts);
  }
  run.add(what + ", filter: lock lost", "% of bursts", {}, {},
          100.0 * best.lost / std::max(1, best.bursts), {}, best.bursts);
  run.add(what + ", filter: lost and not flagged", "bursts", {}, {}, best.unflagged, {},
          best.bursts);
  run.add(what + ", filter: position, mean", "cm", {}, {}, kCmPerMetre * best.mean_m / lines, {},
          best.bursts);
}

/// Whether a robot can know its cell after an outage: it cannot have gone half a pitch, or has
/// odometry whose σ is then well below.
bool can_know_cell(const evaluation::CeilingCondition& condition, double blind_m,
                   const evaluation::CeilingOutageParams& params) {
  constexpr double kHalfPitch_m = 0.5;
  constexpr double kOdometryReach_m = 2.0;
  if (condition.odometry) return blind_m <= kOdometryReach_m;
  const double next = condition.speed_mps / condition.rate_hz;
  return params.max_over_speed * (blind_m + next) < kHalfPitch_m;
}

struct OutageTally {
  int trials = 0;
  int wrong = 0;  ///< trials with a wrong instant that is not flagged
  int right = 0;  ///< instants after outages after which the cell can be known
  int flagged = 0;
  int known = 0;  ///< such trials
  int recovered = 0;
  double recovery_s = 0.0;
  double error_m = 0.0;  ///< greatest at the end, of those
};

using OutageGroups = std::vector<std::pair<std::string, OutageTally>>;

OutageTally& tally_of(OutageGroups& groups, const evaluation::CeilingCondition& condition) {
  const std::string name = fmt::format("{}, {} and {}", to_string(condition.outage),
                                       condition.odometry ? "odometry" : "no odometry",
                                       condition.flow ? "flow" : "no flow");
  for (auto& [other, tally] : groups)
    if (other == name) return tally;
  return groups.emplace_back(name, OutageTally{}).second;
}

void add_outage(OutageTally& tally, const evaluation::CeilingOutageTrial& trial, bool knowable) {
  ++tally.trials;
  tally.wrong += trial.wrong_unflagged > 0 ? 1 : 0;
  if (!knowable) return;
  ++tally.known;
  tally.right += trial.right_after;
  tally.flagged += trial.right_flagged;
  tally.recovered += trial.recovered ? 1 : 0;
  tally.recovery_s += trial.recovered ? trial.recovery_s : 0.0;
  tally.error_m = std::max(tally.error_m, trial.last_error_m);
}

void add_outage_rows(const ChonbukRun& run, const std::string& name, const OutageTally& tally) {
  run.add(name + ": in a wrong cell or turned, and sure of it", "outages", {}, {}, tally.wrong, {},
          tally.trials);
  if (tally.known == 0) return;
  const std::string known = name + ", where the cell can be known: ";
  run.add(known + "right but flagged", "% of the frames after", {}, {},
          100.0 * tally.flagged / std::max(1, tally.right), {}, tally.right);
  run.add(known + "recovered", "%", {}, {}, 100.0 * tally.recovered / tally.known, {}, tally.known);
  run.add(known + "time until then, mean", "s", {}, {},
          tally.recovery_s / std::max(1, tally.recovered), {}, tally.recovered);
  run.add(known + "greatest error at the end", "cm", {}, {}, kCmPerMetre * tally.error_m, {},
          tally.known);
}

constexpr std::uint64_t kOutageSeed = 10000;
constexpr const char* kOutageRemark =
    "outages: at 0.1, 0.3 and 1 m/s, 25 and 5 Hz, 5 % spurious and 2 % missing patches, 5 mm and "
    "1.3° "
    "of placement; odometry of 5 cm and 1.1° per √m; the cell can be known where the robot, which "
    "is "
    "at most 1.2 times as fast, cannot have gone half a pitch, or has odometry and was blind for "
    "at "
    "most 2 m";

/// Patches that are gone for a while, by what the robot has besides.
void study_outages(const ChonbukRun& run) {
  constexpr int kEach = 14;
  constexpr std::size_t kFewStride = 5;  // conditions, where few lines are asked for
  const evaluation::CeilingOutageParams params;
  const int each = kEach * run.lines(kLines) / kLines;
  auto conditions = evaluation::ceiling_conditions();
  if (each == 0) {
    std::vector<evaluation::CeilingCondition> few;
    for (std::size_t i = 0; i < conditions.size(); i += kFewStride) few.push_back(conditions[i]);
    conditions = few;
  }
  const int trials_each = std::max(1, each);
  const auto trials =
      evaluation::try_outages(conditions, trials_each, params, kOutageSeed, run.options.threads);
  OutageGroups groups;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto& condition = conditions[i / static_cast<std::size_t>(trials_each)];
    add_outage(tally_of(groups, condition), trials[i],
               can_know_cell(condition, trials[i].blind_m, params));
  }
  for (const auto& [name, tally] : groups) add_outage_rows(run, name, tally);
}

void study_kidnappings(const ChonbukRun& run) {
  constexpr int kKidnappings = 200;
  const int count = std::max(4, kKidnappings * run.lines(kLines) / kLines);
  int unsaid = 0;
  int flagged = 0;
  double in_cell = 0.0;
  double heading = 0.0;
  for (const auto& one : evaluation::try_kidnappings(count, {}, kOutageSeed, run.options.threads)) {
    unsaid = std::max(unsaid, one.wrong_unflagged);
    flagged += one.flagged ? 1 : 0;
    in_cell = std::max(in_cell, one.in_cell_m);
    heading = std::max(heading, one.heading_error);
  }
  run.add("kidnapped: flagged after two seconds", "%", {}, {}, 100.0 * flagged / count, {}, count);
  run.add("kidnapped: frames until it is flagged, greatest", "frames", {}, {}, unsaid, {}, count);
  run.add("kidnapped: error within the cell after two seconds, greatest", "cm", {}, {},
          kCmPerMetre * in_cell, {}, count);
  run.add("kidnapped: heading after two seconds, greatest error", "°", {}, {}, to_deg(heading), {},
          count);
}

/// Where the map has gaps, and where a grid goes on for ever.
void study_settling(const ChonbukRun& run) {
  constexpr int kSettlings = 60;
  const int count = std::max(4, kSettlings * run.lines(kLines) / kLines);
  for (const bool gaps : {true, false}) {
    int settled = 0;
    int right = 0;
    int wrong = 0;
    double way_m = 0.0;
    for (const auto& one :
         evaluation::try_settlings(count, gaps, {}, kOutageSeed, run.options.threads)) {
      settled += one.settled ? 1 : 0;
      right += one.right ? 1 : 0;
      wrong += one.wrong_unflagged > 0 ? 1 : 0;
      way_m += one.settled ? one.way_m : 0.0;
    }
    const std::string name = gaps ? "0.6 m unseen, mapped gaps: " : "0.6 m unseen, endless grid: ";
    run.add(name + "settled on the true cell within 6 m", "%", {}, {}, 100.0 * right / count, {},
            count);
    run.add(name + "sure of another cell at any time", "drives", {}, {}, wrong, {}, count);
    if (settled > 0)
      run.add(name + "way until then, mean", "m", {}, {}, way_m / settled, {}, settled);
  }
}

}  // namespace

evaluation::PaperTable reproduce_chonbuk(const PaperOptions& options) {
  evaluation::PaperTable table{"chonbuk", {}, {}, {}};
  const ChonbukRun run{options, table};
  const CeilingSetting setting;
  table.noise = {{"ceiling_above_camera_m", setting.known_camera().rise_m()},
                 {"field_of_view_deg", 60.0},
                 {"pixel_noise_grey", setting.imaging.noise_sigma},
                 {"blur_px", setting.imaging.blur_px},
                 {"patch_contrast_grey", 190.0 - setting.ceiling.patch_grey},
                 {"speed_mps", kSpeed_mps},
                 {"period_s", kPeriod_s}};
  study_positions(run);
  const auto drives = drives_of(&ideal, run.lines(kLines), kSpeed_mps * kPeriod_s);
  study_mountings(run, from_deg(0.2), 0.005);
  study_mountings(run, from_deg(0.7), 0.02);
  const auto frames = study_flow(run, drives);
  study_turn(run);
  study_pipes(run);
  study_calibration(run);
  study_fusion(run, drives, frames, CeilingFault::misread, 10,
               {0.01, 0.02, 0.03, 0.05, 0.08, 0.15});
  study_fusion(run, drives, frames, CeilingFault::unseen, 10, {0.03, 0.05});
  study_fusion(run, drives, frames, CeilingFault::unseen, 30, {0.03, 0.05});
  study_outages(run);
  study_kidnappings(run);
  study_settling(run);
  auto& remarks = table.remarks;
  remarks.emplace_back(
      "every figure is from rendered pixels; published: the paper's \"less than 5 cm, less than "
      "4°\" on its own robot");
  remarks.emplace_back(
      "one frame: as published the patch nearest the middle, best all patches, limit the frame's "
      "Cramér–Rao bound by the covariances that the patches' images have");
  remarks.emplace_back(
      "with tilt, height and placement errors best and limit are the filter, which carries them as "
      "constants, and its posterior bound, without odometry or flow");
  remarks.emplace_back("lock lost: off by more than 10 cm two seconds after the burst");
  remarks.emplace_back(kOutageRemark);
  return table;
}

}  // namespace vigia::app

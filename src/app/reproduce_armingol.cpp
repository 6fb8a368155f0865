#include "campaign_progress.hpp"
#include "drive_picture.hpp"
#include "papers.hpp"
#include "plan_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "vigia/core/angle.hpp"
#include "vigia/evaluation/armingol_table.hpp"
#include "vigia/evaluation/seed_runs.hpp"
#include "vigia/evaluation/seed_statistics.hpp"
#include "vigia/mission/mission.hpp"

namespace vigia::app {
namespace {

using evaluation::DriveScore;
using evaluation::Estimate;
using evaluation::LocalizerScore;
using evaluation::PaperRow;

constexpr int kSeeds = 100;
constexpr double kRing_m = 0.25;

// As printed: the ends of the experiments of Figs. 8 and 9.
constexpr double kOdometryPosition_m = 0.22;
constexpr double kOdometryHeading = from_deg(3.5);
constexpr double kRelocalisedPosition_m = 0.02;
constexpr double kRelocalisedHeading = from_deg(0.5);

/// The same drives, relocalised as the paper does it and as well as we can.
struct Drives {
  std::vector<DriveScore> as_published;
  std::vector<DriveScore> best;
};

using Part = double LocalizerScore::*;

Estimate mean_of(const std::vector<DriveScore>& scores, const std::string& localizer, Part part) {
  std::vector<double> values;
  values.reserve(scores.size());
  for (const auto& score : scores) values.push_back(score.localizers.at(localizer).*part);
  return evaluation::paired_difference(values, std::vector<double>(values.size(), 0.0));
}

/// A quantity of a localizer, in a unit of @p factor.
struct DriveQuantity {
  std::string name;
  std::string localizer;
  std::string unit;
  double factor;
  Part part;
  Part bound;
};

PaperRow row_of(const Drives& drives, const DriveQuantity& q, std::optional<double> published) {
  const auto scaled = [&](const evaluation::Interval& interval) {
    return evaluation::Interval{q.factor * interval.low, q.factor * interval.high};
  };
  const Estimate theirs = mean_of(drives.as_published, q.localizer, q.part);
  const Estimate ours = mean_of(drives.best, q.localizer, q.part);
  PaperRow row{q.name, q.unit};
  if (published) row.published = q.factor * *published;
  row.as_published = q.factor * theirs.value;
  row.as_published_95 = scaled(theirs.interval);
  row.best = q.factor * ours.value;
  row.best_95 = scaled(ours.interval);
  row.limit = q.factor * mean_of(drives.best, q.localizer, q.bound).value;
  row.n = static_cast<int>(drives.best.size());
  return row;
}

std::vector<PaperRow> rows_of(const Drives& drives) {
  constexpr Part kPosition = &LocalizerScore::position_final_m;
  constexpr Part kHeading = &LocalizerScore::heading_final_rad;
  constexpr Part kPositionBound = &LocalizerScore::pcrlb_position_final_m;
  constexpr Part kHeadingBound = &LocalizerScore::pcrlb_heading_final_rad;
  const double degrees = to_deg(1.0);
  return {
      row_of(drives,
             {"odometry alone, final position", "odometry", "cm", 100, kPosition, kPositionBound},
             kOdometryPosition_m),
      row_of(drives,
             {"odometry alone, final heading", "odometry", "°", degrees, kHeading, kHeadingBound},
             kOdometryHeading),
      row_of(drives, {"relocalised, final position", "ekf", "cm", 100, kPosition, kPositionBound},
             kRelocalisedPosition_m),
      row_of(drives, {"relocalised, final heading", "ekf", "°", degrees, kHeading, kHeadingBound},
             kRelocalisedHeading),
      row_of(drives,
             {"relocalised, path RMS", "ekf", "cm", 100, &LocalizerScore::position_rmse_m,
              &LocalizerScore::pcrlb_position_rms_m},
             std::nullopt)};
}

std::vector<std::pair<std::string, double>> noise_of(const mission::MissionSetup& setup) {
  const auto& robot = setup.robot.robot;
  return {{"look_angle_deg", to_deg(robot.sensor.look_angle)},
          {"look_focal", robot.sensor.look_focal},
          {"reading_angle_deg", to_deg(robot.sensor.reading_angle)},
          {"odometry_trans_per_sqrt_m", robot.odometry.trans_per_sqrt_m},
          {"odometry_rot_per_sqrt_m_deg", to_deg(robot.odometry.rot_per_sqrt_m)},
          {"odometry_rot_per_sqrt_rad_deg", to_deg(robot.odometry.rot_per_sqrt_rad)},
          {"pixel_noise", setup.robot.cameras.front().imaging.noise_sigma},
          {"blur_px", setup.robot.cameras.front().imaging.blur_px},
          {"start_m", setup.start_sigma_m},
          {"start_deg", to_deg(setup.start_sigma_rad)}};
}

/// The drive whose odometry ends most like the paper's.
const DriveScore& nearest_to_the_paper(const std::vector<DriveScore>& scores) {
  const auto off = [](const DriveScore& score) {
    const auto& odometry = score.localizers.at("odometry");
    return std::hypot(odometry.position_final_m / kOdometryPosition_m - 1.0,
                      odometry.heading_final_rad / kOdometryHeading - 1.0);
  };
  return *std::min_element(scores.begin(), scores.end(),
                           [&](const auto& a, const auto& b) { return off(a) < off(b); });
}

std::string ending(const DriveScore& score, const std::string& localizer) {
  const auto& s = score.localizers.at(localizer);
  return fmt::format("ends {:.1f} cm and {:.2f}° off", 100 * s.position_final_m,
                     to_deg(s.heading_final_rad));
}

void draw_figures(const mission::MissionSetup& setup, const DriveScore& score, int seeds,
                  const std::filesystem::path& folder) {
  DrivePicture picture;
  mission::run_mission(setup, score.seed, {&picture});
  const std::string which =
      fmt::format("{}, seed {}: of {} seeds the one whose odometry ends most like the paper's",
                  setup.name, score.seed, seeds);
  report::MapDrive odometry = picture.drive(score);
  odometry.title = "As Fig. 8: odometry alone " + ending(score, "odometry");
  odometry.subtitle = which + "; printed: 22 cm and 3.5°";
  odometry.estimate.clear();
  odometry.looks.clear();
  report::draw_map(odometry, folder / "fig8.png");
  report::MapDrive relocalised = picture.drive(score);
  relocalised.title = "As Fig. 9: with relocalisation it " + ending(score, "ekf");
  relocalised.subtitle = which + "; printed: 2 cm and 0.5°";
  relocalised.odometry.clear();
  relocalised.look_ring_m = kRing_m;
  report::draw_map(relocalised, folder / "fig9.png");
}

/// Table 1: the fuzzy planner's control areas.
std::vector<PaperRow> plan_rows(const PaperOptions& options) {
  const auto setup = mission::load_mission(options.config / "missions/armingol-room-fuzzy.yaml");
  const PlanTable table = make_plan(setup, "fuzzy");
  draw_plan(table, setup, options.out / "plan.png");
  std::vector<evaluation::PlanArea> areas;
  for (const PlanRow& row : table.rows)
    if (row.chosen)
      areas.push_back(
          {static_cast<int>(row.area), row.visible, *row.chosen, 100 * row.suitability});
  return evaluation::table_1_rows(areas);
}

}  // namespace

evaluation::PaperTable reproduce_armingol(const PaperOptions& options) {
  const auto file = options.config / "missions/armingol-room.yaml";
  const auto best = mission::load_mission(file);
  const auto pan_tilt = mission::load_mission(file, {"localization.ekf.use_size=false"});
  const int n = options.seeds > 0 ? options.seeds : kSeeds;
  CampaignLine line(options.quiet);
  evaluation::CampaignProgress progress{2 * static_cast<std::size_t>(n)};
  line(progress);
  const auto run = [&](const mission::MissionSetup& setup) {
    return evaluation::run_seeds(setup, 1, n, options.threads, [&](const auto&) {
      ++progress.done;
      line(progress);
    });
  };
  const Drives drives{run(pan_tilt), run(best)};
  line.finish(options.threads);
  draw_figures(best, nearest_to_the_paper(drives.best), n, options.out);
  std::vector<PaperRow> rows = rows_of(drives);
  for (const PaperRow& row : plan_rows(options)) rows.push_back(row);
  return {
      "armingol",
      noise_of(best),
      rows,
      {"Means over seeds [95 %]; the limit is what the mean would be at the posterior "
       "Cramér–Rao bound along the best method's looks.",
       "as published: the filter learns from the landmark's direction only (ekf.use_size = "
       "false); best: from its "
       "apparent size. Looks: policy " +
           best.look.policy + ". Table 1 is a fit: its rule base was searched for this column."}};
}

}  // namespace vigia::app

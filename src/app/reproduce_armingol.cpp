#include "papers.hpp"

#include "vigia/core/angle.hpp"
#include "vigia/evaluation/seed_runs.hpp"
#include "vigia/evaluation/seed_statistics.hpp"

namespace vigia::app {
namespace {

constexpr int kSeeds = 100;

std::optional<evaluation::Interval> scaled(const evaluation::Interval& interval, double factor) {
  return evaluation::Interval{factor * interval.low, factor * interval.high};
}

/// What the two variants of a run gave for one quantity.
struct Measured {
  std::string quantity;
  std::string unit;
  double factor;  ///< from metres or radians to the unit
  std::optional<double> published;
  evaluation::Estimate as_published;
  evaluation::Estimate best;
  std::optional<double> limit;
};

evaluation::PaperRow row(const Measured& m, int n) {
  evaluation::PaperRow row{m.quantity, m.unit, m.published};
  row.as_published = m.factor * m.as_published.value;
  row.as_published_95 = scaled(m.as_published.interval, m.factor);
  row.best = m.factor * m.best.value;
  row.best_95 = scaled(m.best.interval, m.factor);
  if (m.limit) row.limit = m.factor * *m.limit;
  row.n = n;
  return row;
}

}  // namespace

evaluation::PaperTable reproduce_armingol(const PaperOptions& options) {
  const auto file = options.config / "missions/armingol-room.yaml";
  const int n = options.seeds > 0 ? options.seeds : kSeeds;
  const auto best = mission::load_mission(file);
  const auto pan_tilt = mission::load_mission(file, {"localization.ekf.use_size=false"});
  const auto a = evaluation::summarise(evaluation::run_seeds(pan_tilt, 1, n, options.threads));
  const auto b = evaluation::summarise(evaluation::run_seeds(best, 1, n, options.threads));
  const auto& ours = b.localizers.at("ekf");
  const auto& theirs = a.localizers.at("ekf");
  const auto& odometry = b.localizers.at("odometry");
  const auto& odometry_theirs = a.localizers.at("odometry");

  evaluation::PaperTable table{"armingol", {}, {}, {}};
  const auto& noise = best.robot.robot;
  table.noise = {{"look_angle_deg", to_deg(noise.sensor.look_angle)},
                 {"look_focal", noise.sensor.look_focal},
                 {"reading_angle_deg", to_deg(noise.sensor.reading_angle)},
                 {"odometry_trans_per_sqrt_m", noise.odometry.trans_per_sqrt_m},
                 {"odometry_rot_per_sqrt_m_deg", to_deg(noise.odometry.rot_per_sqrt_m)},
                 {"odometry_rot_per_sqrt_rad_deg", to_deg(noise.odometry.rot_per_sqrt_rad)}};
  table.rows = {row({"odometry alone, final position",
                     "cm",
                     100,
                     22.0,
                     odometry_theirs.position_final,
                     odometry.position_final,
                     {}},
                    n),
                row({"odometry alone, final heading",
                     "°",
                     to_deg(1.0),
                     3.5,
                     odometry_theirs.heading_final,
                     odometry.heading_final,
                     {}},
                    n),
                row({"relocalised, final position",
                     "cm",
                     100,
                     2.0,
                     theirs.position_final,
                     ours.position_final,
                     {}},
                    n),
                row({"relocalised, final heading",
                     "°",
                     to_deg(1.0),
                     0.5,
                     theirs.heading_final,
                     ours.heading_final,
                     {}},
                    n),
                row({"relocalised, path RMS",
                     "cm",
                     100,
                     {},
                     theirs.position_rmse,
                     ours.position_rmse,
                     ours.bound_rms},
                    n)};
  return table;
}

}  // namespace vigia::app

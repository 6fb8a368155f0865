#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "vigia/core/camera.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/evaluation/corner_trials.hpp"

namespace vigia::evaluation {
namespace {

using localization::StationMotion;
using localization::StereoErrors;

/// The true pair.
struct TruePair {
  Intrinsics camera;
  Eigen::Isometry3d rMleft;
  Eigen::Isometry3d rMright;
};

TruePair true_pair(const CornerSetting& setting, const StereoErrors& errors) {
  const localization::StereoPair calibrated = stereo_pair(setting);
  TruePair pair;
  pair.camera.width = setting.columns;
  pair.camera.height = setting.columns * 3 / 4;
  pair.camera.px = pair.camera.py = calibrated.focal_px * (1.0 + errors.focal);
  pair.camera.u0 = calibrated.u0;
  pair.camera.v0 = 0.5 * (pair.camera.height - 1.0);
  const double baseline = setting.baseline_m * (1.0 + errors.baseline);
  Eigen::Matrix3d rRc;  // forward, right, down
  rRc << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  const auto camera_at = [&](double side) {
    Eigen::Isometry3d rMc = Eigen::Isometry3d::Identity();
    rMc.translation().y() = 0.5 * side * baseline;
    rMc.linear() = Eigen::AngleAxisd(-0.5 * side * errors.vergence, Eigen::Vector3d::UnitZ()) * rRc;
    return rMc;
  };
  pair.rMleft = camera_at(1.0);
  pair.rMright = camera_at(-1.0);
  return pair;
}

/// True columns of a corner in both images, where both show it.
std::optional<Eigen::Vector2d> seen_from(const TruePair& pair, const Pose2& robot,
                                         const Eigen::Vector2d& corner) {
  const Eigen::Vector3d p_w(corner.x(), corner.y(), 0.0);
  const Eigen::Vector3d p_r = to_isometry(robot).inverse() * p_w;
  const auto left = project(pair.camera, pair.rMleft.inverse() * p_r);
  const auto right = project(pair.camera, pair.rMright.inverse() * p_r);
  if (!left || !right || !in_image(pair.camera, *left) || !in_image(pair.camera, *right))
    return std::nullopt;
  return Eigen::Vector2d(left->x(), right->x());
}

/// The corner nearest the images' middle, of all or of one.
struct SeenCorner {
  std::size_t corner = 0;
  Eigen::Vector2d columns = Eigen::Vector2d::Zero();
};

std::optional<SeenCorner> middle_corner(const CornerSetting& setting, const TruePair& pair,
                                        const Pose2& robot, std::optional<std::size_t> wanted) {
  const std::vector<Eigen::Vector2d> corners = goal_corners(setting);
  std::optional<SeenCorner> nearest;
  double off = INFINITY;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (wanted && *wanted != i) continue;
    const auto columns = seen_from(pair, robot, corners[i]);
    if (!columns || std::abs(columns->mean() - pair.camera.u0) >= off) continue;
    nearest = SeenCorner{i, *columns};
    off = std::abs(columns->mean() - pair.camera.u0);
  }
  return nearest;
}

Pose2 random_place(const CornerSetting& setting, RandomStream& random) {
  const double half = 0.5 * setting.width_m - setting.margin_m;
  const double x = random.uniform(setting.margin_m, setting.length_m - setting.margin_m);
  const double y = random.uniform(-half, half);
  return {x, y, random.uniform(-kPi, kPi)};
}

bool in_field(const CornerSetting& setting, const Eigen::Vector2d& p) {
  return p.x() >= setting.margin_m && p.x() <= setting.length_m - setting.margin_m &&
         std::abs(p.y()) <= 0.5 * setting.width_m - setting.margin_m;
}

/// Anywhere, or at the setting's distance where the field has room for it.
Pose2 next_place(const CornerSetting& setting, const Pose2& from, RandomStream& random) {
  if (!setting.displacement_m) return random_place(setting, random);
  for (;;) {
    const Eigen::Vector2d p =
        from.position() + *setting.displacement_m * unit_vector(random.uniform(-kPi, kPi));
    const double heading = random.uniform(-kPi, kPi);
    if (in_field(setting, p)) return {p.x(), p.y(), heading};
  }
}

/// The noise of a run: drawn as standard normals whatever the setting, so that places stay the
/// same.
StereoErrors drawn_calibration(const CornerSetting& setting, RandomStream& random) {
  const Eigen::Vector3d white(random.normal(), random.normal(), random.normal());
  const Eigen::Vector3d e =
      setting.calibration.vector() + setting.calibration_sigma.vector().cwiseProduct(white);
  return {e.x(), e.y(), e.z()};
}

double measured_column(const CornerSetting& setting, double truth, RandomStream& random) {
  const double white = random.normal();
  return setting.image == CornerSetting::Columns::whole_pixels ? std::round(truth)
                                                               : truth + setting.noise_px * white;
}

/// A way between two points as measured, and as it was, with the same covariance.
struct DrawnMotion {
  StationMotion measured;
  StationMotion exact;
};

DrawnMotion draw_motion(const CornerSetting& setting, const Pose2& from, const Pose2& to,
                        double heading_error, RandomStream& random) {
  DrawnMotion motion;
  motion.exact.displacement_m = to.position() - from.position();
  motion.exact.turn = wrap_angle(to.theta - from.theta);
  const Eigen::Vector2d& d = motion.exact.displacement_m;
  const Eigen::Vector2d across(-d.y(), d.x());
  motion.exact.covariance.topLeftCorner<2, 2>() =
      setting.heading_sigma * setting.heading_sigma * across * across.transpose();
  motion.exact.covariance.diagonal() +=
      Eigen::Vector3d(setting.displacement_sigma_m, setting.displacement_sigma_m,
                      setting.turn_sigma)
          .cwiseAbs2();
  motion.measured = motion.exact;
  motion.measured.displacement_m = Eigen::Rotation2Dd(heading_error) * d;
  const Eigen::Vector2d white(random.normal(), random.normal());
  motion.measured.displacement_m += setting.displacement_sigma_m * white;
  motion.measured.turn += setting.turn_sigma * random.normal();
  return motion;
}

void draw_map(const CornerSetting& setting, CornerRun& run, RandomStream& random) {
  const double sigma = setting.landmark_sigma_m;
  for (const Eigen::Vector2d& corner : goal_corners(setting)) {
    const Eigen::Matrix2d covariance = sigma * sigma * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d white(random.normal(), random.normal());
    run.exact.landmarks.push_back({corner, covariance});
    run.measured.landmarks.push_back({corner + sigma * white, covariance});
  }
}

}  // namespace

localization::StereoPair stereo_pair(const CornerSetting& setting) {
  return {0.5 * setting.columns / std::tan(0.5 * setting.field_of_view),
          0.5 * (setting.columns - 1.0), setting.baseline_m};
}

double column_sigma_px(const CornerSetting& setting) {
  return setting.image == CornerSetting::Columns::whole_pixels ? std::sqrt(1.0 / 12.0)
                                                               : setting.noise_px;
}

std::vector<Eigen::Vector2d> goal_corners(const CornerSetting& setting) {
  const double half = 0.5 * setting.goal_m;
  return {{0.0, -half}, {0.0, half}, {setting.length_m, half}, {setting.length_m, -half}};
}

CornerRun draw_corner_run(const CornerSetting& setting, int points, bool same_corner,
                          RandomStream& random) {
  const Eigen::Vector2d room(setting.length_m - 2.0 * setting.margin_m,
                             setting.width_m - 2.0 * setting.margin_m);
  if (setting.displacement_m && *setting.displacement_m > 0.5 * room.norm())
    throw std::invalid_argument("from the middle of the field nothing in it is so far");
  CornerRun run;
  run.errors = drawn_calibration(setting, random);
  const double heading_error = setting.heading_sigma * random.normal();
  draw_map(setting, run, random);
  const TruePair pair = true_pair(setting, run.errors);
  run.measured.pair = run.exact.pair = stereo_pair(setting);
  std::optional<std::size_t> wanted;
  while (static_cast<int>(run.truths.size()) < points) {
    Pose2 robot = run.truths.empty() ? random_place(setting, random)
                                     : next_place(setting, run.truths.back(), random);
    auto seen = middle_corner(setting, pair, robot, wanted);
    const int steps = static_cast<int>(std::ceil(2.0 * kPi / setting.turn_step));
    for (int i = 0; i < steps && !seen; ++i) {
      robot.theta = wrap_angle(robot.theta + setting.turn_step);
      seen = middle_corner(setting, pair, robot, wanted);
    }
    if (!seen) continue;  // so near a corner that the images do not both show it
    if (same_corner) wanted = seen->corner;
    if (!run.truths.empty()) {
      const DrawnMotion motion =
          draw_motion(setting, run.truths.back(), robot, heading_error, random);
      run.measured.motions.push_back(motion.measured);
      run.exact.motions.push_back(motion.exact);
    }
    run.truths.push_back(robot);
    const double sigma = column_sigma_px(setting);
    run.exact.sightings.push_back({seen->corner, {seen->columns.x(), seen->columns.y()}, sigma});
    const double left = measured_column(setting, seen->columns.x(), random);
    const double right = measured_column(setting, seen->columns.y(), random);
    run.measured.sightings.push_back({seen->corner, {left, right}, sigma});
  }
  return run;
}

}  // namespace vigia::evaluation

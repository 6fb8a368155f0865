#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vigia/core/field_map.hpp"
#include "vigia/core/field_scan.hpp"
#include "vigia/core/pose.hpp"
#include "vigia/core/random.hpp"

namespace vigia::evaluation {

/// The noise of a mirror camera's measurements on the floor, and what is false among them.
struct FieldFrameParams {
  int points = 50;                 ///< of a frame, false ones among them
  double ray_step_deg = 3.0;       ///< the radial scan's
  double sight_m = 8.0;            ///< no line farther off is seen
  double bearing_sigma_deg = 0.3;  ///< of points, goals and posts
  double range_floor_m = 0.02;     ///< σ of a range: this …
  double range_share = 0.02;       ///< … plus this times the range
  double goal_range_share = 0.03;  ///< σ of a goal's range by its range
  bool goals = true;               ///< whether they are seen at all
  double range_scale = 1.0;        ///< error of the mirror's calibration: measured by true range
  /// What false points lie on: the floor, uniformly, or straight false lines.
  enum class Clutter { uniform, straight };
  Clutter clutter = Clutter::uniform;
  double clutter_share = 0.0;
  int false_lines = 2;
};

/// A straight false line: the points of a frame with clutter lie where rays cross it.
struct FalseLine {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

/// One image's measurements, and what they truly show.
struct FieldFrame {
  Pose2 truth;
  FieldScan scan;
  /// Bound on the covariance of (x, y, θ) from the points that lie on lines, each known to lie on
  /// its own: the Cramér–Rao bound of a frame without prior.
  Eigen::Matrix3d bound = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the points
  Eigen::Matrix3d goal_information =
      Eigen::Matrix3d::Zero();  ///< of the goals' bearings and ranges
  int true_points = 0;
};

/// A pose anywhere between the lines, @p margin_m off them.
Pose2 random_field_pose(const FieldMap& map, double margin_m, RandomStream& random);
std::vector<FalseLine> random_false_lines(const FieldMap& map, int count, RandomStream& random);

/// A frame at @p truth. @p false_lines: those to use; drawn anew when empty.
FieldFrame draw_field_frame(const FieldMap& map, const FieldFrameParams& params, const Pose2& truth,
                            RandomStream& random, const std::vector<FalseLine>& false_lines = {});

}  // namespace vigia::evaluation

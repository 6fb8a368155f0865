#pragma once

#include <cstdint>
#include <vector>

#include "vigia/core/field_map.hpp"
#include "vigia/core/field_scan.hpp"
#include "vigia/core/pose.hpp"

namespace vigia::localization {

/// How a scan becomes a pose by matching points with a grid of the field (Ribeiro et al., Minho).
enum class FieldGridMethod {
  printed,       ///< direction by eq. 2 as it stands, without a sign
  as_published,  ///< eq. 2 as kindly as it can be read
  corrected,     ///< direction from both goals' places, anchors dilated by 3σ of the goal's range
};

struct FieldGridParams {
  double cell_m = 0.05;
};

enum class FieldGridStatus {
  found,
  one_goal,  ///< the direction needs both
  no_goal,
  no_points,
};

struct FieldGridFix {
  FieldGridStatus status = FieldGridStatus::no_goal;
  Pose2 pose;
  int on_lines = 0;  ///< points that fall on lines there
};

/// Minho §III: the field as a matrix of 5 cm cells of line and goal; direction from the goals
/// (step 3), rotation of the points (eq. 3), and of all places that put the nearer goal on its
/// cells the one at which most points fall on lines (step 5). Corrected, places that tie or nearly
/// do are averaged. Needs goals of two colours.
class FieldGrid {
 public:
  explicit FieldGrid(const FieldMap& map, const FieldGridParams& params = {});

  FieldGridFix locate(const FieldScan& scan, FieldGridMethod method) const;

 private:
  int count_on_lines(const std::vector<Eigen::Vector2d>& turned, const Eigen::Vector2d& at) const;
  FieldGridFix best_of_anchors(const std::vector<Eigen::Vector2d>& turned,
                               const std::vector<Eigen::Vector2d>& places, double heading,
                               bool average) const;

  FieldMap map_;
  double cell_m_;
  Eigen::Vector2d corner_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint8_t> line_;  ///< 1 where a cell's middle is painted
};

/// Direction by eq. 1 and 2: 180° is to the angle between the goals as the direction is to the
/// angle of the goal nearest to the picture's middle. As printed, without a sign and with the
/// goals' distance in the panorama; or as kindly as it can be read (@p kind): signed, and between
/// the goals on the side to which the robot looks.
double direction_by_proportion(const FieldMap& map, const ColourSighting& yellow,
                               const ColourSighting& blue, bool kind);
/// Direction from the places of both goals: −arg(ρ₂u(β₂) − ρ₁u(β₁)) against the axis of the map.
double direction_by_places(const FieldMap& map, const ColourSighting& yellow,
                           const ColourSighting& blue);

}  // namespace vigia::localization

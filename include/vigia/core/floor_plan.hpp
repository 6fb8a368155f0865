#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace vigia {

/// A vertical face: the segment from a to b in the floor plane, from the floor up to height_m.
struct Wall {
  Eigen::Vector2d a;
  Eigen::Vector2d b;
  double height_m = 2.8;
};

/// A solid on the floor: a simple polygon (either orientation) extruded to height_m.
struct Obstacle {
  std::vector<Eigen::Vector2d> polygon;
  double height_m = 1.0;
};

/// Where a planar ray meets a face.
struct RayHit {
  double distance_m = 0.0;  ///< from the ray's origin, in units of its unit direction
  std::size_t wall = 0;     ///< index into FloorPlan::faces()
  double along_m = 0.0;     ///< from the face's point a towards b
};

/// The building as the robot knows it: the room's outline, partition walls and obstacles. All
/// faces are vertical. Coordinates are metres in the world frame.
class FloorPlan {
 public:
  FloorPlan() = default;
  /// @p outline is the room's simple polygon; @p partitions are thin walls inside it. Throws
  /// std::invalid_argument for a polygon of fewer than three corners and for a face without length
  /// or height.
  FloorPlan(std::vector<Eigen::Vector2d> outline, double ceiling_m, std::vector<Wall> partitions,
            std::vector<Obstacle> obstacles);

  const std::vector<Eigen::Vector2d>& outline() const { return outline_; }
  const std::vector<Wall>& partitions() const { return partitions_; }
  const std::vector<Obstacle>& obstacles() const { return obstacles_; }
  double ceiling_m() const { return ceiling_m_; }

  /// Every vertical face: the outline's sides, the partitions, the obstacles' sides, in this order.
  const std::vector<Wall>& faces() const { return faces_; }

  /// The nearest face that the ray from @p origin along the unit vector @p direction meets within
  /// @p max_m and that is higher than @p above_m.
  std::optional<RayHit> cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                             double max_m, double above_m = 0.0) const;

  /// Whether the straight segment between two points of the world meets no face. A point that lies
  /// on a face (a landmark on its wall, to within a millimetre) is not hidden by that face.
  bool line_of_sight(const Eigen::Vector3d& p_w, const Eigen::Vector3d& q_w) const;

  /// Distance to the nearest face, negative inside an obstacle or outside the outline; infinite
  /// without any face.
  double clearance(const Eigen::Vector2d& p) const;

  /// Corners of the axis-aligned box around the outline.
  Eigen::Vector2d min_corner() const;
  Eigen::Vector2d max_corner() const;

 private:
  std::vector<Eigen::Vector2d> outline_;
  double ceiling_m_ = 2.8;
  std::vector<Wall> partitions_;
  std::vector<Obstacle> obstacles_;
  std::vector<Wall> faces_;
};

}  // namespace vigia

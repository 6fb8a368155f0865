#pragma once

#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "vigia/core/colour_pattern.hpp"

namespace vigia {

using LandmarkId = int;

/// A solid dark disc on a light ground (Armingol §4).
struct DiscShape {
  double radius_m = 0.1;
};

/// An AprilTag of the family 36h11 on a square white sheet.
struct TagShape {
  int tag = 0;          ///< 0–586, the number that the tag shows
  double side_m = 0.2;  ///< of the black square's outer edge

  /// The tag is eight fields wide; two more on each side stay white.
  double sheet_half_width_m() const { return 0.75 * side_m; }
};

inline constexpr int kTags = 587;

/// A landmark of the map. Frame l lies in the landmark's centre: z is the outward normal (towards
/// the viewer), y points up, x to the viewer's right: (x, y) is the picture as a viewer sees it.
struct Landmark {
  LandmarkId id = 0;
  Eigen::Isometry3d wMl = Eigen::Isometry3d::Identity();
  std::variant<DiscShape, PatternShape, TagShape> shape;

  Eigen::Vector3d centre_w() const { return wMl.translation(); }
  Eigen::Vector3d normal_w() const { return wMl.linear().col(2); }
};

/// wMl of a landmark on a vertical wall: centre and the direction of the outward normal in the
/// floor plane (radians from the world's x axis).
Eigen::Isometry3d wall_mount(const Eigen::Vector3d& centre_w, double normal_yaw);

/// Half the width that a landmark takes on its wall: a disc's radius, half the side of a pattern's
/// or a tag's upright square sheet.
double half_width(const Landmark& landmark);

/// The radius of a disc landmark, or nothing for another shape.
std::optional<double> disc_radius(const Landmark& landmark);

/// Radius of the circle round the landmark's centre that holds all of its features, m: the disc's
/// edge, the outer ring's dots, the tag's corners.
double extent_radius(const Landmark& landmark);

/// The landmarks that the robot knows, with unique ids, in ascending order of id.
class LandmarkMap {
 public:
  LandmarkMap() = default;
  /// Throws std::invalid_argument when an id occurs twice.
  explicit LandmarkMap(std::vector<Landmark> landmarks);

  const std::vector<Landmark>& all() const { return landmarks_; }
  /// The landmark of that id, or nullptr.
  const Landmark* find(LandmarkId id) const;

 private:
  std::vector<Landmark> landmarks_;
};

}  // namespace vigia

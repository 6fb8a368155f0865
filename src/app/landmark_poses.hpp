#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vigia/core/camera.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/localization/disc_pose.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::app {

/// A pose in which a landmark looks as it was seen.
struct LandmarkPose {
  int solution = 1;  ///< 1, and 2 for its twin
  std::string status;
  Eigen::Isometry3d cMl = Eigen::Isometry3d::Identity();
  localization::PoseMatrix covariance;  ///< of (v, ω), see localization::moved()
};

/// How large landmarks are, so that their images give poses.
struct LandmarkSizes {
  double size_m = 0.0;  ///< a disc's diameter, a tag's side, a pattern's sheet; 0: as in the map
  LandmarkMap map;      ///< landmarks by their codes, and at most one radius of discs
};

/// Turns images of landmarks into poses cMl in the frame of one camera.
class LandmarkPoses {
 public:
  /// Throws InputError when the map has discs of several radii.
  LandmarkPoses(const Intrinsics& camera, LandmarkSizes sizes);

  const Intrinsics& camera() const { return camera_; }
  /// The poses of a disc that is found. Empty when its size is unknown.
  std::vector<LandmarkPose> of(const tracking::EllipseFeature& feature) const;
  /// The poses of a landmark of points that is found, with the twin where that is about as good.
  std::vector<LandmarkPose> of(const tracking::PointsFeature& feature) const;

 private:
  std::optional<Landmark> landmark_of(const tracking::LandmarkCode& code) const;

  Intrinsics camera_;
  LandmarkSizes sizes_;
  double disc_radius_m_ = 0.0;
};

/// The columns of one pose and their names: solution, status, the place of the landmark in the
/// camera's frame (m), its turn as a rotation vector (rad), and the upper triangle of the
/// covariance of (x, y, z, ω_x, ω_y, ω_z), row by row (m, rad).
std::string pose_csv_header();
std::string pose_csv_fields(const LandmarkPose& pose);

}  // namespace vigia::app

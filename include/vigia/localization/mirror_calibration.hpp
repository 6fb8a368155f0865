#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/field_map.hpp"
#include "vigia/core/pose.hpp"

namespace vigia::localization {

/// Where a ray in a mirror camera's picture crosses a painted line: the pixels of its two edges.
struct MirrorPoint {
  Eigen::Vector2d inner_uv = Eigen::Vector2d::Zero();
  Eigen::Vector2d outer_uv = Eigen::Vector2d::Zero();
  double sigma_px = 0.1;  ///< of their middle, along the ray
};

struct MirrorPicture {
  std::vector<MirrorPoint> points;
  /// Where the robot stood, about. Without it the points are matched with the whole field.
  std::optional<Pose2> near;
};

/// A mirror camera over the floor z = 0 of the robot's frame.
struct MirrorMount {
  UnifiedOmni mirror;
  Eigen::Isometry3d rMc = Eigen::Isometry3d::Identity();
};

/// What is calibrated, each as its change from the start: the focal length relatively, the
/// principal point in px, the tilt in rad, rMc = rMc_start Rx(tilt_x) Ry(tilt_y), ξ, and the height
/// of the mirror in m. A turn about the mirror's axis cannot be told from the robot's heading.
enum class MirrorParameter { focal, u0, v0, tilt_x, tilt_y, xi, height };
constexpr std::size_t kMirrorParameters = 7;
std::string_view to_string(MirrorParameter parameter);

using MirrorVector = Eigen::Matrix<double, kMirrorParameters, 1>;
using MirrorMatrix = Eigen::Matrix<double, kMirrorParameters, kMirrorParameters>;

/// The mount whose parameters differ from @p start by @p change.
MirrorMount changed(const MirrorMount& start, const MirrorVector& change);

struct MirrorCalibrationParams {
  /// σ of each parameter about its start; 0: known.
  std::array<double, kMirrorParameters> prior_sigma{0.1,           20.0, 20.0, from_deg(5.0),
                                                    from_deg(5.0), 0.0,  0.0};
  double gate = 4.0;       ///< σ off a line, beyond which a point is none of it
  int min_points = 12;     ///< on lines, in a picture that counts
  double min_share = 0.4;  ///< of a picture's points that lie on lines, else it is left out
};

enum class MirrorCalibrationStatus { converged, not_converged, no_picture };

/// What became of a picture's points.
struct MirrorPictureFit {
  bool used = false;     ///< enough of its points lie on lines
  Pose2 pose;            ///< of the robot
  std::vector<bool> on;  ///< for each point, whether it counts as one of a line
  int points_on() const;
  double rms_px = 0.0;  ///< of the points on lines, along their rays
};

struct MirrorCalibration {
  MirrorCalibrationStatus status = MirrorCalibrationStatus::no_picture;
  MirrorMount mount;
  MirrorVector change = MirrorVector::Zero();      ///< from the start
  MirrorMatrix covariance = MirrorMatrix::Zero();  ///< of it; the poses are marginalised
  std::vector<MirrorPictureFit> pictures;          ///< as they were given
  double misfit = 0.0;  ///< χ² per degree of freedom; above 1 it widens the covariance
  double rms_px = 0.0;

  double sigma(MirrorParameter parameter) const;
};

/// Calibrates a mirror on a field's lines, or on a target of rings or stripes that is described as
/// a field: the parameters and the pose of each picture by Gauss and Newton's method on the offsets
/// of the points' edges from the lines,
///
///   r_i = ½ (d(p_inner) + d(p_outer)) / (σ_i |∂½(d_inner + d_outer)/∂ρ|),
///
/// d the signed offset from the nearest line's middle, ρ the way along the ray. Points beyond the
/// gate, which closes with the residuals' median, take no part. Half a turn of a pose on a
/// symmetric field changes nothing.
MirrorCalibration calibrate_mirror(const FieldMap& field, const MirrorMount& start,
                                   const std::vector<MirrorPicture>& pictures,
                                   const MirrorCalibrationParams& params = {});

/// The mirror's distance function (Minho §III): how far from the foot of a level mirror what is
/// seen radius_px from the middle lies on the floor, and the σ that the calibration leaves. Nothing
/// at or above the horizon.
struct FloorDistance {
  double distance_m = 0.0;
  double sigma_m = 0.0;
};
std::optional<FloorDistance> floor_distance(const MirrorCalibration& calibration, double radius_px);

}  // namespace vigia::localization

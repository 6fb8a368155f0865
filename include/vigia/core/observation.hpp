#pragma once

#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/field_scan.hpp"
#include "vigia/core/goal_corner.hpp"
#include "vigia/core/image_shift.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/patch_image.hpp"
#include "vigia/core/shot.hpp"

namespace vigia {

/// An ellipse in pixels. psi is the angle of the semi-axis a ≥ b from the u axis towards v, in
/// (-π/2, π/2].
struct Ellipse {
  double u = 0.0;
  double v = 0.0;
  double a = 0.0;
  double b = 0.0;
  double psi = 0.0;
};

/// The image of one disc.
struct EllipseObservation {
  Shot shot;
  /// The landmark that was asked for. Discs look all alike, so this is an expectation, not an
  /// identity: the localizer associates.
  std::optional<LandmarkId> expected;
  Ellipse ellipse;
  /// Of (u, v, a, b, psi).
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Identity();
};

/// One point of a landmark, known by its label, in the image.
struct LabelledPoint {
  int label = 0;
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< px²
};

/// The image of a landmark that says who it is: the dots of a colour pattern (labels as
/// PatternDot, uv the centre of the dot's ellipse), the corners of a tag (0 lower left, 1 lower
/// right, 2 upper right, 3 upper left, as the tag's reader sees them).
struct PointsObservation {
  Shot shot;
  std::optional<LandmarkId> expected;  ///< asked for
  LandmarkId landmark = 0;             ///< read from the image, and of the map
  std::vector<LabelledPoint> points;
  double confidence = 1.0;  ///< of the identity, in [0, 1]
};

/// What one image of a mirror camera shows of a field of play, already on the floor in the robot's
/// frame: a line point is the middle between two edges on the floor, which in the image it is not.
struct FieldObservation {
  Shot shot;
  FieldScan scan;  ///< at the shot's stamp
};

/// What one image of a camera that looks up shows of a patched ceiling.
struct PatchesObservation {
  Shot shot;
  std::vector<PatchImage> patches;
};

/// What the two images of a stereo pair, exposed together, show of the goals' corners.
struct StereoObservation {
  Shot shot;   ///< of the left camera
  Shot right;  ///< of the right camera
  std::vector<StereoCorner> corners;
};

/// How a camera moved over the plane that it faces, between two of its frames.
struct FlowObservation {
  Shot shot;   ///< of the later frame
  Stamp from;  ///< exposure of the earlier one
  ImageShift shift;
};

/// What eyes hand to localization: closed by the geometry of the feature.
using Observation = std::variant<EllipseObservation, PointsObservation, FieldObservation,
                                 PatchesObservation, StereoObservation, FlowObservation>;

/// The image of one landmark of the map; the observation that it points into outlives it.
using LandmarkImage = std::variant<const EllipseObservation*, const PointsObservation*>;
/// Nothing where an observation is no image of a landmark.
std::optional<LandmarkImage> landmark_image(const Observation& observation);

/// Where a landmark lies in the image and how wide it is.
struct ImageExtent {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius_px = 0.0;  ///< of extent_radius(): the longer semi-axis of a slanted landmark
};

/// The extent that an observation shows, empty where it shows no landmark.
/// A pattern of which one ring alone is seen is scaled up to the whole by @p landmark, where it is
/// known.
ImageExtent image_extent(const Observation& observation, const Landmark* landmark = nullptr);

/// Whether it is the image of a landmark of the map.
bool shows_landmark(const Observation& observation);

/// The shot that shows it.
const Shot& shot_of(const Observation& observation);

}  // namespace vigia

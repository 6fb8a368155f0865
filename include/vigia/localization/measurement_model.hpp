#pragma once

#include <array>
#include <optional>
#include <variant>

#include "vigia/core/floor_plan.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/disc_measurement.hpp"
#include "vigia/localization/points_measurement.hpp"

namespace vigia::localization {

/// How well images are measured, and when one counts as that of a landmark.
struct MeasurementParams {
  SensorNoise sensor;  ///< of the head's and the zoom's readings
  /// Share of right measurements that a χ² gate lets pass.
  double gate_probability = 0.999;
  /// An observation is ambiguous unless the best landmark is so many times likelier than the next.
  double ambiguity_ratio = 20.0;
  /// σ of what the landmark's model leaves out, white per frame, added to the tracker's covariance:
  /// a disc's centre or a point in px, and a disc's relative size.
  double centre_floor_px = 0.0;
  double size_floor = 0.0;
  /// Whether a disc's apparent size teaches anything. Without it only the direction does, as in
  /// Armingol: pan and tilt. It tells discs apart either way.
  bool use_size = true;
};

/// A matched image of any kind.
using Match = std::variant<DiscMatch, PointsMatch>;
using Association = AssociationOf<Match>;

/// The shot that shows it.
const Shot& shot_of(const Match& match);

/// What predicted images hang on – map, walls, rig, ground and noise – and the one measurement
/// model of filter, smoother, bound, planner and search. Each kind of observation has a file with
/// the same functions (disc_measurement.hpp, points_measurement.hpp); the members here visit the
/// kinds exhaustively: a new alternative of Observation without its functions does not compile. A
/// scan of a field is no landmark's image; its model is FieldModel.
class MeasurementModel {
 public:
  /// @p plan, when given, rules out landmarks behind walls.
  MeasurementModel(LandmarkMap map, const RigOnGround& on_ground, const MeasurementParams& params,
                   std::optional<FloorPlan> plan = std::nullopt);

  /// Which landmark the image shows, given a Gaussian of the state that carries the biases of the
  /// image's look.
  Association associate(const Observation& observation, const LookState& state) const;
  /// The observation as the image of a landmark that is known; nothing when it can be none of it.
  std::optional<Match> match(const Observation& observation, const Landmark& landmark) const;
  /// Hands what the match says about @p at, a Linearised<3> or Linearised<6>, to @p use. False, and
  /// nothing handed on, where the landmark has no image.
  template <typename Use>
  bool linearise(const Match& match, const Vector6& at, Use&& use) const;
  /// ln of the density of what was measured given the pose, the look's biases marginalised. Nothing
  /// where no landmark has an image.
  std::optional<double> log_likelihood(const Observation& observation, const Pose2& pose) const;

  const LandmarkMap& map() const { return map_; }
  const RigOnGround& on_ground() const { return on_ground_; }
  const MeasurementParams& params() const { return params_; }
  /// Which errors the camera's images of one look share, 1 or 0 each: pan and tilt of one on a
  /// head, the focal length of one there that zooms. H is zero in the columns of the others.
  Eigen::Array3d look_biases(CameraId camera) const;
  bool has_look_biases(CameraId camera) const { return look_biases(camera).any(); }
  /// Whether a wall stands between the two points.
  bool hides(const Eigen::Vector3d& from_w, const Eigen::Vector3d& to_w) const;
  /// The χ² that a right measurement stays below with params().gate_probability.
  double gate(int dof) const;

 private:
  static constexpr int kTabledDof = 34;  // two for each dot of a pattern

  LandmarkMap map_;
  RigOnGround on_ground_;
  MeasurementParams params_;
  std::optional<FloorPlan> plan_;
  std::array<double, kTabledDof + 1> gates_{};
};

template <typename Use>
bool MeasurementModel::linearise(const Match& match, const Vector6& at, Use&& use) const {
  return std::visit(
      [&](const auto& one) {
        const auto seen = localization::linearise(*this, one, at);
        if (seen) use(*seen);
        return seen.has_value();
      },
      match);
}

}  // namespace vigia::localization

#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/ceiling_grid.hpp"
#include "vigia/core/field_map.hpp"
#include "vigia/core/stamp.hpp"
#include "vigia/evaluation/pcrlb.hpp"
#include "vigia/localization/ceiling_filter.hpp"
#include "vigia/localization/corner_filter.hpp"
#include "vigia/localization/field_model.hpp"
#include "vigia/mission/estimator_tick.hpp"

namespace vigia::evaluation {

/// What a drive's estimators are scored with.
struct EstimatorSetup {
  LandmarkMap landmarks;
  RigOnGround on_ground;
  OdometryNoise odometry;  ///< of the wheels, as it truly is
  SensorNoise sensor;      ///< of the head's and the zoom's readings, as it truly is
  Eigen::Matrix3d prior_covariance = Eigen::Matrix3d::Zero();  ///< of (x, y, θ) at the start
  bool prior =
      true;  ///< whether the localizer was told; if not, its errors count from the first fix
  std::optional<FieldMap> field = std::nullopt;
  /// A patched ceiling and the camera that looks up at it.
  struct Ceiling {
    localization::CeilingCamera camera;
    CeilingGrid grid;
    localization::CeilingFilterParams params;  ///< what is believed of tilt, height and flow
    bool flow = false;  ///< whether the localizer is moved on by the ceiling's flow
  };
  std::optional<Ceiling> ceiling = std::nullopt;
  /// A stereo pair on a field with goals, and what its calibration may miss.
  std::optional<localization::CornerFilterParams> corners = std::nullopt;
  Duration longest_delay = {};  ///< from an exposure to when its image is observed, at most
};

/// The posterior Cramér–Rao bound along a drive by what one localizer fused, whatever kind of
/// observations those are; linearised at the true state and with the true association. An image
/// teaches what it says of the pose at its exposure, from its delivery on: the motions since then
/// go over it again. Where the localizer follows a ceiling's flow, a motion waits for it, as there.
class DriveBound {
 public:
  explicit DriveBound(const EstimatorSetup& setup);

  /// The robot truly went by @p u from @p before.
  void move(const Pose2& before, const OdometryIncrement& u);
  /// What an observation that was fused taught at best, whatever the localizer took it for.
  void learn(const Observation& observation, const mission::ExposureTruth& truth);
  /// Of (x, y, θ), at the end of the last motion.
  Eigen::Matrix3d covariance() const;

 private:
  /// By odometry, or between two frames of a flow by both.
  struct Move {
    Pose2 before;
    OdometryIncrement u;
    std::vector<OdometryIncrement> parts;  ///< of a flow's
    std::optional<ImageShift> flow;
  };
  /// One of them bounds: with a ceiling its placement errors are states, with a stereo pair the
  /// errors of its calibration.
  struct States {
    PosteriorBound looks;
    std::optional<localization::CeilingFilter> ceiling;
    std::optional<localization::CornerFilter> corners;
    bool by_landmarks = false;  ///< their images have been learned from
    localization::FlowTrust trust;

    void move(const Move& move, const EstimatorSetup& setup);
    void move_looks_and_corners(const Move& move, const OdometryNoise& odometry);
    void follow(Move move, const EstimatorSetup& setup);
    Eigen::Matrix3d covariance() const;
  };
  struct Image {
    Stamp stamp;  ///< of its exposure
    std::function<void(States&)> teach;
  };
  using Step = std::variant<Move, Image>;

  bool follows_flow() const { return setup_.ceiling && setup_.ceiling->flow; }
  void join(const FlowObservation& flow);
  std::function<void(States&)> lesson(const Observation& observation,
                                      const mission::ExposureTruth& truth) const;
  void insert(Image image);
  bool is_settled(const Step& step) const;
  void settle();
  void apply(const Step& step, States& states) const;

  EstimatorSetup setup_;
  std::optional<localization::FieldModel> field_;
  Stamp now_;
  States states_;           ///< before the steps
  std::deque<Step> steps_;  ///< that a late image or a flow may still come into, in order of time
};

}  // namespace vigia::evaluation

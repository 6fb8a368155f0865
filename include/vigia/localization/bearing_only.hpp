#pragma once

#include <deque>
#include <set>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/odometry.hpp"
#include "vigia/localization/image_span.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/localization/mean_speed.hpp"
#include "vigia/localization/measurement_model.hpp"

namespace vigia::localization {

struct BearingOnlyParams {
  OdometryNoise odometry;
  SensorNoise sensor;
  /// σ of what a bearing leaves out, white per image, rad: of a disc's image more is uncertain than
  /// its centre, and a look's images share their error.
  double bearing_floor = from_deg(0.05);
  double gate_probability = 0.999;  ///< of the association's gate and of the bearing's own
  double ambiguity_ratio = 20.0;    ///< see EkfParams
  double history_s = 1.0;           ///< how late an observation may be

  double lost_sigma_m = 0.6;  ///< lost while √λ_max of the position covariance is above this
  int lost_rejections = 10;   ///< lost after so many unexplained images in a row …
  int lost_looks = 2;         ///< … in at least so many looks

  int search_looks = 12;       ///< a lost robot remembers the bearings of so many looks …
  int min_looks = 10;          ///< … and needs so many that one pose explains
  double found_weight = 0.99;  ///< found when one pose has at least this share of the weight
  double clutter_cost = 8.0;   ///< −ln of how likely a look is at no landmark of the map
  double max_range_m = 15.0;   ///< to a landmark that a lost robot may see
  int max_tries = 20000;       ///< triples of landmarks that a search tries at most
};

/// Learns from horizontal directions alone: state (x, y, θ) and the pan error of the present look.
///
/// The residual is no angle but the distance d = (p_l − e) × u of the landmark from the line of
/// sight, e the optical centre and u the direction seen: bilinear in position and direction,
/// without the singularity that an angle has at the landmark. Its noise is that of the direction
/// times the range, whose own uncertainty counts, and the terms of second order, cov(δe·u, δφ) in
/// the mean and P_uu P_φφ + P_uφ² in the variance, are taken in: for a bilinear residual the
/// moments are then exact. Which landmark is seen says the measurement model's association.
///
/// Lost, or started without a prior, it remembers the directions of the last looks, carried on by
/// odometry. Three directions to three landmarks give a pose in closed form: with z = (cos θ, sin
/// θ, q), q the world's origin in the robot's frame, each line of sight is linear in z, and cos² +
/// sin² = 1 does the rest. Poses are weighed by how well they explain the other looks; several
/// leave the belief `ambiguous`, with hypotheses.
class BearingOnlyLocalizer final : public Localizer {
 public:
  BearingOnlyLocalizer(const LandmarkMap& map, const RigOnGround& on_ground,
                       const BearingOnlyParams& params,
                       std::optional<FloorPlan> plan = std::nullopt);

  std::string_view name() const override { return "bearing_only"; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;

 private:
  /// A direction in the robot's present frame, carried there by odometry.
  struct Sightline {
    ImageSpan span;
    std::optional<LandmarkId> landmark;  ///< where the landmark says who it is
    Eigen::Vector2d eye_r;
    double height_m = 0.0;           ///< of the eye above the ground
    double bearing = 0.0;            ///< rad, from the robot's x axis
    double variance = 0.0;           ///< of the bearing, rad²
    double position_variance = 0.0;  ///< of the eye, each way, m²
  };
  /// A pose that explains the looks.
  struct Candidate {
    Prior pose;
    double log_weight = 0.0;
    int explained = 0;
  };
  /// A landmark beside a line of sight: the residual d, ∂d/∂(x, y, θ) and d's variance.
  struct Sighted {
    LandmarkId landmark;
    double d;
    Eigen::RowVector3d H;
    double R;
  };
  /// Moments of the residual d of a landmark, linearised at the state.
  struct Residual {
    double d = 0.0;
    Eigen::RowVector4d H;  ///< ∂d/∂(x, y, θ, pan error)
    double variance = 0.0;
  };

  void start(const Prior& prior);
  std::optional<Sightline> sightline(const Observation& observation) const;
  UpdateResult fuse(const Observation& observation, const Sightline& seen);
  Residual residual(const Sightline& seen, const Landmark& landmark) const;
  LookState look_state(const Shot& shot) const;
  void begin_look(LookId look);
  void monitor(const UpdateResult& result, const ImageSpan& span);
  void remember(const Sightline& seen);
  void search();
  std::vector<Pose2> seeds() const;
  std::optional<Sighted> nearest(const Sightline& seen, const Pose2& pose,
                                 const Eigen::Matrix3d& P) const;
  Eigen::Vector2d in_plan(const Landmark& landmark) const;
  std::vector<const Landmark*> candidates_for(const Sightline& seen) const;
  std::optional<Candidate> explain(const Pose2& pose) const;
  bool in_sight(const Landmark& landmark, const Pose2& pose, const Sightline& seen) const;
  void refresh_belief();

  MeasurementModel model_;
  BearingOnlyParams params_;
  MeanSpeed mean_speed_;
  Stamp stamp_;
  Eigen::Vector4d mean_ = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Zero();
  LookId look_ = 0;
  std::deque<OdometryIncrement> history_;
  bool lost_ = true;
  int rejections_ = 0;
  std::set<ImageSpan> rejected_spans_;
  std::deque<Sightline> remembered_;
  Belief belief_;
};

}  // namespace vigia::localization

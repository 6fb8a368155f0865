#pragma once

#include <array>
#include <deque>
#include <optional>
#include <set>
#include <variant>
#include <vector>

#include "vigia/core/floor_plan.hpp"
#include "vigia/localization/ekf_state.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/localization/mean_speed.hpp"

namespace vigia::localization {

struct EkfParams {
  OdometryNoise odometry;  ///< of the increments
  SensorNoise sensor;      ///< of the head's and the zoom's readings

  /// Share of right measurements that the χ² gate (3 degrees of freedom) lets pass.
  double gate_probability = 0.999;
  /// An observation is ambiguous unless the best landmark is so many times likelier than the next.
  double ambiguity_ratio = 20.0;
  /// σ of what the landmark's model leaves out, white per frame, added to the tracker's covariance:
  /// a disc's centre or a point in px, and a disc's relative size.
  double centre_floor_px = 0.002;
  double size_floor = 5e-5;
  /// Whether the disc's apparent size teaches the filter. Without it only the direction does, as in
  /// Armingol: pan and tilt. It tells discs apart either way.
  bool use_size = true;
  /// Gauss–Newton steps of an update, at most: near a landmark one step is not enough.
  int iterations = 4;
  /// A step that moves the look by less (m, rad) is the last: what is left is of second order,
  /// below 1e-3 px at a metre from a landmark.
  double converged = 1e-3;
  /// How many images of a look are linearised anew at each update, at most. Of more only every
  /// second, fourth, … is used: they say the same.
  int look_images = 40;
  /// How late an observation may be, s.
  double history_s = 1.0;

  /// Lost while √λ_max of the position covariance is above this, m.
  double lost_sigma_m = 0.6;
  /// Lost until the next reset after so many unexplained frames in a row …
  int lost_rejections = 10;
  /// … in at least so many looks,
  int lost_looks = 2;
  /// or when the NIS of the first frames of the last nis_looks looks add up to more than chance
  /// allows with probability nis_probability.
  int nis_looks = 5;
  double nis_probability = 1e-5;
};

/// Extended Kalman filter on planar pose and per-look reading errors (see EkfState), after Armingol
/// §5 with the errata's motion and measurement models: predict, predict the measurement of every
/// landmark, match by likelihood within a gate, iterated update in Joseph's form.
///
/// Observations may be late: the filter goes back to the exposure (splitting an increment where
/// needed), updates, and repeats what came after. An observation ahead of the odometry is fused at
/// a state extrapolated at the last rates, and again when the odometry has arrived.
///
/// Discs look all alike: the landmark that a look expects has no privilege over any other. Patterns
/// and tags say who they are: their points are gated against that landmark alone. What is gated,
/// ambiguous or otherwise not fused is counted.
class EkfLocalizer final : public Localizer {
 public:
  /// @p plan, when given, rules out landmarks behind walls.
  EkfLocalizer(LandmarkMap map, const RigOnGround& on_ground, const EkfParams& params,
               std::optional<FloorPlan> plan = std::nullopt);

  std::string_view name() const override { return "ekf"; }
  void reset(Stamp stamp, const Prior& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;

  /// How many updates ended with this status since the construction.
  int count(UpdateStatus status) const { return counts_[static_cast<std::size_t>(status)]; }
  /// The whole state, biases included, at the belief's stamp.
  const EkfState& state() const { return events_.empty() ? base_ : events_.back().after; }

 private:
  /// The last events, from a state on: those of the present look, linearised anew together.
  struct Window {
    EkfState start;
    std::size_t events = 0;  ///< 0: no look is under way
    int images = 0;
    Stamp last_image;
    std::vector<Vector6> trajectory;  ///< the smoothed mean before each event, as of last_image
  };
  /// Values never change once appended: what comes of an observation depends on the sequence of
  /// inputs up to it alone, not on the order in which they arrived.
  struct Event {
    EkfInput input;
    bool extrapolated = false;
    EkfState after;
    Window window;
  };

  /// What an image turned out to be, and how it is fused.
  struct Match {
    UpdateResult result;
    std::optional<EkfInput> fix;
  };

  UpdateResult take_in(const Observation& observation);
  Match match(const EllipseObservation& observation, const EkfState& at) const;
  Match match(const PointsObservation& observation, const EkfState& at) const;
  void append(const EkfInput& input, bool extrapolated = false);
  void move_by(const Motion& motion, Event& event) const;
  void fuse(const Shot& shot, Event& event) const;
  std::vector<const EkfInput*> inputs_of_look(const Event& event) const;
  std::vector<Vector6> guess_of_look(const Event& event) const;
  EkfState with_look(const EkfState& state, LookId look) const;
  std::vector<Event> roll_back(Stamp stamp);
  void extrapolate(Stamp stamp);
  std::vector<EkfInput> drop_extrapolated();
  void forget_old();
  void watch_innovations(const UpdateResult& result, LookId look, bool first_of_look);
  bool innovations_are_unlikely() const;
  void refresh_belief();
  Eigen::Matrix3d measurement_covariance(const EllipseObservation& observation) const;

  LandmarkMap map_;
  RigOnGround on_ground_;
  EkfParams params_;
  std::optional<FloorPlan> plan_;
  double gate_;
  std::vector<double> nis_limits_;  ///< by the degrees of freedom of the sum

  MeanSpeed mean_speed_;
  EkfState base_;             ///< before the first of events_
  std::deque<Event> events_;  ///< in order of time
  Stamp horizon_;             ///< what is older comes too late
  Belief belief_;

  std::array<int, 6> counts_{};
  int rejections_ = 0;
  std::set<LookId> rejected_looks_;
  std::deque<UpdateResult> first_of_looks_;  ///< the first fused image of each of the last looks
  bool said_lost_ = false;
};

}  // namespace vigia::localization

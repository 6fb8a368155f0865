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

namespace vigia::localization {

struct EkfParams {
  OdometryNoise odometry;  ///< of the increments
  SensorNoise sensor;      ///< of the head's and the zoom's readings

  /// Share of right measurements that the χ² gate (3 degrees of freedom) lets pass.
  double gate_probability = 0.999;
  /// An observation is ambiguous unless the best landmark is so many times likelier than the next.
  double ambiguity_ratio = 20.0;
  /// σ of what the disc's model leaves out, white per frame, added to the tracker's covariance:
  /// centre in px, and relative size.
  double centre_floor_px = 0.02;
  double size_floor = 5e-4;
  /// Gauss–Newton steps of the iterated update: near a landmark one step is not enough.
  int iterations = 3;
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
/// Discs look all alike: the landmark that a look expects has no privilege over any other. What is
/// gated, ambiguous or otherwise not fused is counted.
class EkfLocalizer final : public Localizer {
 public:
  /// @p plan, when given, rules out landmarks behind walls.
  EkfLocalizer(LandmarkMap map, const HeadGeometry& geometry, const EkfParams& params,
               std::optional<FloorPlan> plan = std::nullopt);

  std::string_view name() const override { return "ekf"; }
  void reset(Stamp stamp, const Prior& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }

  /// How many updates ended with this status since the construction.
  int count(UpdateStatus status) const { return counts_[static_cast<std::size_t>(status)]; }
  /// The whole state, biases included, at the belief's stamp.
  const EkfState& state() const { return events_.empty() ? base_ : events_.back().after; }

 private:
  struct Fix {
    EllipseObservation observation;
    LandmarkId landmark;
  };
  struct Event {
    std::variant<OdometryIncrement, Fix> input;
    bool extrapolated = false;
    EkfState after;
  };

  UpdateResult update_disc(const EllipseObservation& observation);
  UpdateResult match(const EllipseObservation& observation, const EkfState& at) const;
  void append(const std::variant<OdometryIncrement, Fix>& input, bool extrapolated = false);
  EkfState fuse(const EkfState& before, const Fix& fix) const;
  EkfState with_look(const EkfState& state, LookId look) const;
  std::vector<Event> roll_back(Stamp stamp);
  void extrapolate(Stamp stamp);
  std::vector<Fix> drop_extrapolated();
  void forget_old();
  void watch_innovations(const UpdateResult& result, LookId look, bool first_of_look);
  void refresh_belief();
  Eigen::Matrix3d measurement_covariance(const EllipseObservation& observation) const;

  LandmarkMap map_;
  HeadGeometry geometry_;
  EkfParams params_;
  std::optional<FloorPlan> plan_;
  double gate_;
  double nis_limit_;

  EkfState base_;             ///< before the first of events_
  std::deque<Event> events_;  ///< in order of time
  Belief belief_;

  std::array<int, 6> counts_{};
  int rejections_ = 0;
  std::set<LookId> rejected_looks_;
  std::deque<double> first_nis_;
  bool innovations_say_lost_ = false;
};

}  // namespace vigia::localization

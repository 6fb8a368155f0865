#pragma once

#include <array>
#include <deque>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "vigia/core/floor_plan.hpp"
#include "vigia/localization/image_span.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/localization/look_input.hpp"
#include "vigia/localization/mean_speed.hpp"
#include "vigia/localization/measurement_model.hpp"

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
  /// … in at least so many looks (of a fixed camera: seconds, see ImageSpan),
  int lost_looks = 2;
  /// or when the NIS of the first frames of the last nis_looks looks add up to more than chance
  /// allows with probability nis_probability.
  int nis_looks = 5;
  double nis_probability = 1e-5;
};

/// Extended Kalman filter on planar pose and per-look reading errors (see LookState), after
/// Armingol §5 with the errata's motion and measurement models: predict, predict the measurement of
/// every landmark, match by likelihood within a gate, iterated update in Joseph's form.
///
/// Observations may be late: the filter goes back to the exposure (splitting an increment where
/// needed), updates, and repeats what came after. An observation ahead of the odometry is fused at
/// a state extrapolated at the last rates, and again when the odometry has arrived.
///
/// Discs look all alike: the landmark that a look expects has no privilege over any other. Patterns
/// and tags say who they are: their points are gated against that landmark alone. What is gated,
/// ambiguous or otherwise not fused is counted.
///
/// It cannot start without a prior. Belief::lost_probability joins three pieces of evidence, each
/// taken for independent: that a Gaussian error of the claimed σ exceeds half a metre; the
/// unexplained images in a row, even odds where lost_rejections is reached; and the NIS of the last
/// looks' first images, α / (α + q) with q its tail probability and α = nis_probability. Once it
/// has said that it is lost the probability is 0.99.
class EkfLocalizer final : public Localizer {
 public:
  /// @p plan, when given, rules out landmarks behind walls.
  EkfLocalizer(LandmarkMap map, const RigOnGround& on_ground, const EkfParams& params,
               std::optional<FloorPlan> plan = std::nullopt);

  std::string_view name() const override { return "ekf"; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override;
  void predict(const OdometryIncrement& increment) override;
  UpdateResult update(const Observation& observation) override;
  const Belief& belief() const override { return belief_; }
  void lose() override;

  /// How many updates ended with this status since the construction.
  int count(UpdateStatus status) const { return counts_[static_cast<std::size_t>(status)]; }
  /// The whole state, biases included, at the belief's stamp.
  const LookState& state() const { return events_.empty() ? base_ : events_.back().after; }

 private:
  /// The last events, from a state on: those of the present look, linearised anew together.
  struct Window {
    LookState start;
    std::size_t events = 0;  ///< 0: no look is under way
    int images = 0;
    bool fixed_camera = false;  ///< some of them are of a camera that no look directs
    Stamp last_image;
    std::vector<Vector6> trajectory;  ///< the smoothed mean before each event, as of last_image
  };
  /// Values never change once appended: what comes of an observation depends on the sequence of
  /// inputs up to it alone, not on the order in which they arrived.
  struct Event {
    LookInput input;
    bool extrapolated = false;
    LookState after;
    Window window;
  };

  UpdateResult process(const Observation& observation);
  void append(const LookInput& input, bool extrapolated = false);
  void move_by(const Motion& motion, Event& event) const;
  void fuse(const Shot& shot, Event& event) const;
  std::vector<const LookInput*> inputs_of_look(const Event& event) const;
  std::vector<Vector6> guess_of_look(const Event& event) const;
  LookState with_look(const LookState& state, const Shot& shot) const;
  std::vector<Event> roll_back(Stamp stamp);
  void extrapolate(Stamp stamp);
  std::vector<LookInput> drop_extrapolated();
  void forget_old();
  /// Whether it is of the head, and no image of its look has been fused.
  bool begins_look(const Shot& shot) const;
  void monitor_innovations(const UpdateResult& result, const ImageSpan& span, bool first_of_look);
  /// Σ NIS of the first images of the last looks and its degrees of freedom.
  std::pair<double, int> innovations_of_looks() const;
  void refresh_belief();

  EkfParams params_;
  MeasurementModel model_;
  std::vector<double> nis_limits_;  ///< by the degrees of freedom of the sum

  MeanSpeed mean_speed_;
  LookState base_;            ///< before the first of events_
  std::deque<Event> events_;  ///< in order of time
  Stamp horizon_;             ///< what is older comes too late
  Belief belief_;

  std::array<int, kUpdateStatuses> counts_{};
  int rejections_ = 0;
  std::set<ImageSpan> rejected_spans_;
  std::deque<UpdateResult> first_of_looks_;  ///< the first fused image of each of the last looks
  double innovation_evidence_ = 0.0;         ///< that it is lost, by those
  bool has_prior_ = false;
  bool said_lost_ = false;
};

}  // namespace vigia::localization

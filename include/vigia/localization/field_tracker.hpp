#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/localization/field_match.hpp"
#include "vigia/localization/field_model.hpp"
#include "vigia/localization/field_refine.hpp"

namespace vigia::localization {

struct FieldTrackerParams {
  OdometryNoise odometry;
  /// Updates between two global matches while the best hypothesis agrees with the images.
  int check_every = 10;
  /// Prior probability of a kidnapping between two checks.
  double kidnapped = 1e-6;
  /// Prior probability that by then the robot is beside where a hypothesis has it, by more than its
  /// covariance says: errors that all points of a scan share, or a push.
  double beside = 0.01;
  double beside_m = 0.3;  ///< σ of it
  double beside_rad = 0.1;
  /// A hypothesis is believed alone from this weight on.
  double sure = 0.99;
  int hypotheses = 10;  ///< kept, at most
  double lost_sigma_m = 0.6;
};

/// Refined matches followed in time: Gaussian hypotheses with weights. Odometry moves each, a scan
/// refines each with its prediction as prior and weighs it by its evidence; a global match of the
/// present image, now and then and at once when the evidence falls, adds hypotheses. Their prior is
/// uniform but for a share about the hypotheses at hand. Where half a turn changes no line, points
/// never tell a pose from its twin: a hypothesis stands for both, with a probability that only
/// goals and posts change. Weights are what Bayes' rule gives, so that a belief can say how sure it
/// is.
class FieldTracker {
 public:
  FieldTracker(const FieldModel& model, const FieldTrackerParams& params);

  /// Without a prior: nothing is known, status `lost`.
  void reset(Stamp stamp, const std::optional<Prior>& prior);
  void predict(const OdometryIncrement& increment);
  void update(const FieldScan& scan);
  const Belief& belief() const { return belief_; }
  /// Weight of all poses but the best.
  double doubt() const;
  /// Whether the last update matched globally.
  bool checked() const { return since_check_ == 0; }

 private:
  struct Hypothesis {
    Pose2 pose;
    Eigen::Matrix3d covariance;
    double log_weight = 0.0;  ///< of the pose and its twin together
    double turned = 0.0;      ///< probability that the robot is half a turn away instead

    double own_weight() const { return (1.0 - turned) * std::exp(log_weight); }
    void half_turn();
  };
  using Matches = std::vector<FieldMatcher::Suggestion>;
  void refine_all(const FieldScan& scan, const std::vector<StraightGroup>& groups,
                  const Matches& matches);
  double prior_density(const Pose2& pose, const std::vector<Hypothesis>& predicted) const;
  double weigh_sightings(const FieldScan& scan, Hypothesis& hypothesis) const;
  void add_matches(const FieldScan& scan, const std::vector<StraightGroup>& groups,
                   const Matches& matches, const std::vector<Hypothesis>& predicted);
  bool evidence_has_fallen() const;
  void merge_and_prune();
  Hypothesis* known_place(const Pose2& pose);
  void refresh_belief();

  const FieldModel* model_;
  FieldTrackerParams params_;
  FieldMatcher matcher_;
  std::vector<Hypothesis> hypotheses_;  ///< the best first
  double clutter_;
  std::optional<double> usual_;  ///< long-term mean of the best hypothesis' log-likelihood a point
  double last_ = 0.0;
  int since_check_ = 0;
  Belief belief_;
};

}  // namespace vigia::localization

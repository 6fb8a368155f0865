#pragma once

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
  /// A hypothesis is believed alone from this weight on.
  double sure = 0.99;
  int hypotheses = 10;  ///< kept, at most
  double lost_sigma_m = 0.6;
};

/// Refined matches followed in time: Gaussian hypotheses with weights. Odometry moves each, a scan
/// refines each with its prediction as prior and weighs it by its evidence; a global match of the
/// present image, now and then and at once when the evidence falls, adds hypotheses whose prior is
/// uniform. Weights are what Bayes' rule gives, so that a belief can say how sure it is.
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
    double log_weight = 0.0;
  };
  using Matches = std::vector<FieldMatcher::Suggestion>;
  void refine_all(const FieldScan& scan, const std::vector<StraightGroup>& groups,
                  const Matches& matches);
  void add_matches(const FieldScan& scan, const std::vector<StraightGroup>& groups,
                   const Matches& matches);
  bool evidence_has_fallen() const;
  void merge_and_prune();
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

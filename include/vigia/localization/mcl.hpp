#pragma once

#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/odometry.hpp"
#include "vigia/core/random.hpp"
#include "vigia/localization/field_match.hpp"
#include "vigia/localization/field_model.hpp"

namespace vigia::localization {

struct MclParams {
  enum class Method {
    as_described,  ///< kind and angle of transitions alone, a fixed number of particles, uniform
                   ///< start, no injection (Minho §II.A)
    best,
  };
  Method method = Method::best;
  OdometryNoise odometry;
  int min_particles = 500;
  int max_particles = 3000;
  /// KLD sampling (Fox 2003): with probability 0.99 the sampled distribution is within kld_error of
  /// the one over bins of these sizes.
  double kld_error = 0.03;
  double bin_m = 0.1;
  double bin_rad = 0.05;
  /// Resampled when the effective number of particles is below this share of them.
  double resample_share = 0.5;
  /// Share of a cluster's spread that its particles are given anew when resampled: copies of one
  /// particle would stay together in the directions in which odometry has no noise.
  double kernel = 0.4;
  /// Updates between two in which the present image may suggest poses of its own, fewer when the
  /// likelihood has fallen below its long-term mean …
  int check_every = 10;
  /// … to so many particles, for which this is the prior probability of a kidnapping.
  int injected = 200;
  double kidnapped = 1e-6;
  /// Share of the way of the likelihood's short- and long-term means to each new value.
  double fast = 0.4;
  double slow = 0.02;
  /// A hypothesis is believed alone from this weight on.
  double sure = 0.95;
  double lost_sigma_m = 0.6;
};

struct Particle {
  Pose2 pose;
  double weight = 0.0;
  double twin = 0.0;  ///< probability that the robot is half a turn from the pose instead
};

/// Monte Carlo localization (Dellaert, Fox, Burgard, Thrun 1999; Minho §II.A): move the particles
/// by odometry and its noise, drawn with the image in view (Grisetti, Stachniss, Burgard 2007),
/// weigh them by the likelihood of the observation, resample (low variance, size by KLD). Poses
/// that the present image suggests are injected as samples of a mixture prior – mostly the
/// particles', a little uniform – weighed by the same likelihood, FieldModel::line_evidence().
///
/// Where half a turn changes no line, points never tell a pose from its twin: a particle stands for
/// both, with the probability of each beside it (Rao–Blackwellised), which goals and posts move.
class Mcl {
 public:
  Mcl(const FieldModel& model, const MclParams& params, std::uint64_t seed);

  /// Without a prior: uniform over the field.
  void reset(Stamp stamp, const std::optional<Prior>& prior);
  void predict(const OdometryIncrement& increment);
  void update(const FieldScan& scan);
  const Belief& belief() const { return belief_; }
  const std::vector<Particle>& particles() const { return particles_; }

 private:
  struct Spread {
    Pose2 mean;
    Eigen::Matrix3d covariance;
  };
  void sample_uniform(int count);
  Spread spread_of_all() const;
  /// Log-likelihood of the scan; moves the particle's odds of being half a turn away.
  double log_weight(const FieldScan& scan, Particle& particle) const;
  double log_weight_of_sightings(const FieldScan& scan, Particle& particle) const;
  /// Log weights of the noise's densities over the proposals'.
  std::vector<double> draw_motion_noise(const FieldScan& scan);
  /// Before the scan: what is known, and a robot that may be anywhere.
  struct MixturePrior {
    std::vector<PoseHypothesis> known;
    double anywhere = 0.0;  ///< density of a pose, per m² rad
    double density(const Pose2& pose) const;
  };
  std::vector<PoseHypothesis> predicted_hypotheses() const;
  void inject(const FieldScan& scan, std::vector<PoseHypothesis> expected);
  void inject_about(const FieldFix& fix, int count, const MixturePrior& prior,
                    const FieldScan& scan);
  void fold_twins();
  void resample();
  void spread_copies();
  void widen_depleted(const FieldScan& scan);
  std::vector<PoseHypothesis> hypotheses() const;
  void refresh_belief();
  void watch_likelihood(const FieldScan& scan);

  const FieldModel* model_;
  MclParams params_;
  FieldMatcher matcher_;
  RandomStream random_;
  std::vector<Particle> particles_;
  std::vector<double> log_likelihoods_;
  std::vector<StraightGroup> groups_;  ///< of the present scan
  /// Of the moves since the last image, not yet drawn: covariance in the particle's own frame.
  Eigen::Matrix3d motion_noise_ = Eigen::Matrix3d::Zero();
  bool given_prior_ = false;
  double clutter_;
  std::optional<double> fast_;
  std::optional<double> slow_;
  int since_check_ = 0;
  Belief belief_;
};

}  // namespace vigia::localization

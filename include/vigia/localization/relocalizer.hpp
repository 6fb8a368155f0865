#pragma once

#include <optional>
#include <set>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/measurement_model.hpp"

namespace vigia::localization {

struct RelocalizerParams {
  SensorNoise sensor;  ///< of the head's and the zoom's readings
  /// Share of right measurements that the χ² gate of a single sighting lets pass.
  double gate_probability = 0.999;
  /// σ of what the disc's model leaves out: centre in px, and relative size.
  double centre_floor_px = 0.1;
  double size_floor = 2e-3;
  /// Tolerance of the axes' ratio b/a, which serves as a check only.
  double aspect_tolerance = 0.08;
  /// Found when the best hypothesis has at least this share of the weight.
  double found_weight = 0.99;
  /// … and explains at least this share of the sightings.
  double explained_share = 0.5;
  /// −ln of how likely a disc-like sighting is no landmark, beside a sighting explained perfectly.
  double clutter_cost = 10.0;
  /// Probability that a landmark that the sweep covered is detected, within these limits.
  double detection_probability = 0.9;
  double max_range_m = 7.0;
  double max_view_angle_deg = 60.0;
  double min_radius_px = 7.0;
  /// The robot keeps this clear of every face, m.
  double min_clearance_m = 0.1;
};

/// What a robot that stands still saw while it turned its head.
struct Sweep {
  /// The discs, at most a few per landmark. The biases of readings are drawn anew for each look.
  std::vector<EllipseObservation> sightings;
  /// Every direction that was searched, with a find or without one.
  std::vector<Shot> views;
};

/// What is known of the robot's place before a sweep: weighted Gaussians. What their weights lack
/// to one lies evenly over the building and all headings.
struct PlacePrior {
  std::vector<PoseHypothesis> components;
};

enum class RelocalizationStatus {
  found,      ///< one pose explains the sweep far better than any other
  ambiguous,  ///< several do
  not_found,  ///< none does
};

struct Relocalization {
  RelocalizationStatus status = RelocalizationStatus::not_found;
  std::vector<PoseHypothesis> hypotheses;  ///< best first, weights add up to one
};

/// Finds the robot anew, without an idea of where it is, from the discs it sees around it: every
/// pair of sightings with every pair of landmarks gives a pose in closed form (bearings, and ranges
/// from the apparent sizes); Gauss–Newton refines it on all sightings that it explains; what it
/// leaves unexplained, and landmarks that the sweep should have shown, count against it. Walls hide
/// landmarks, and discs have a front.
class Relocalizer {
 public:
  Relocalizer(LandmarkMap map, FloorPlan plan, const RigOnGround& on_ground,
              const RelocalizerParams& params);

  /// Every pose that explains sightings of at least two different landmarks, weighed by what it
  /// explains and by @p place, which holds no pose impossible.
  Relocalization solve(const Sweep& sweep, const PlacePrior& place = {}) const;
  /// Whether the sweep bears out @p prior: one sighting is enough, landmarks that it should have
  /// shown and did not must be fewer than those it shows. It says nothing about other poses.
  Relocalization confirm(const Sweep& sweep, const Prior& prior) const;

 private:
  struct Sighting {
    const EllipseObservation* sighting;
    const Landmark* landmark;
  };
  struct Fit {
    Pose2 pose;
    Eigen::Matrix3d covariance;
    double chi2 = 0.0;
  };
  struct Hypothesis {
    Fit fit;
    std::vector<Sighting> matches;
    int missed = 0;  ///< landmarks that the sweep should have shown
    double log_weight = 0.0;
  };

  std::vector<Hypothesis> hypotheses(const Sweep& sweep,
                                     const std::vector<EllipseObservation>& sightings,
                                     const std::vector<Pose2>& seeds,
                                     const std::optional<Prior>& prior) const;
  Relocalization weighed(std::vector<Hypothesis> found, std::size_t sightings) const;
  /// Density of a pose with a fit's covariance, beside that of a place of which nothing is known.
  double relative_density(const Fit& fit, const PlacePrior& place) const;
  std::vector<Pose2> seeds(const std::vector<EllipseObservation>& all) const;
  /// Where a sighting stands in the base frame if it is that landmark.
  struct DiscPlace {
    std::size_t sighting;
    Eigen::Vector2d p_r;
    Eigen::Vector2d landmark_w;
  };
  std::vector<DiscPlace> possible_places(const std::vector<EllipseObservation>& sightings) const;
  std::vector<Pose2> best_supported(std::vector<Pose2> poses,
                                    const std::vector<EllipseObservation>& sightings) const;
  /// How many sightings stand about where a landmark is, by the order of @p places.
  static int supporters(const Pose2& pose, const std::vector<DiscPlace>& places);
  std::optional<Fit> refine(const Pose2& start, const std::vector<Sighting>& matches,
                            const std::optional<Prior>& prior) const;
  std::vector<Sighting> explain(const Fit& fit,
                                const std::vector<EllipseObservation>& sightings) const;
  std::optional<Hypothesis> hypothesis(const Pose2& seed, const Sweep& sweep,
                                       const std::vector<EllipseObservation>& sightings,
                                       const std::optional<Prior>& prior) const;
  static std::set<LandmarkId> landmarks_of(const std::vector<Sighting>& matches);
  bool plausible(const Sighting& match, const Pose2& pose) const;
  int missed(const Hypothesis& hypothesis, const Sweep& sweep) const;
  bool should_be_seen(const Landmark& landmark, const Pose2& pose, const Shot& view) const;
  std::optional<Linearised<3>> linearised(const Sighting& match, const Pose2& pose) const;

  RelocalizerParams params_;
  MeasurementModel model_;
  FloorPlan plan_;
  Eigen::Matrix3d biases_;  ///< covariance of a look's biases
};

}  // namespace vigia::localization

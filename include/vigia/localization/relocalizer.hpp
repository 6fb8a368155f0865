#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "vigia/core/belief.hpp"
#include "vigia/core/floor_plan.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/localization/measurement_model.hpp"
#include "vigia/localization/place_candidates.hpp"

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
  /// The same of a pattern or tag that says who it is.
  double misread_cost = 20.0;
  /// Probability that a landmark that the sweep covered is detected, within these limits.
  double detection_probability = 0.9;
  double max_range_m = 7.0;
  double max_view_angle_deg = 60.0;
  double min_radius_px = 7.0;        ///< of a disc
  double min_code_radius_px = 25.0;  ///< of a pattern or tag
  /// The robot keeps this clear of every face, m.
  double min_clearance_m = 0.1;
  /// Budget: pairs of landmarks looked up for pairs of sightings, and poses fitted to a sweep.
  long max_pairs = 400000;
  int max_fits = 10000;
  /// What they take in modelled time.
  double pair_us = 1.0;
  double fit_us = 50.0;
};

/// What a robot that stands still saw while it turned its head.
struct Sweep {
  /// Discs, patterns and tags, at most a few per landmark. The biases of readings are drawn anew
  /// for each look.
  std::vector<Observation> sightings;
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
  /// What was done, and the time that it takes by the stated cost of a candidate: no clock's.
  long pairs = 0;
  int fits = 0;
  double modelled_s = 0.0;
  /// Whether nothing that might have weighed was left out by the budget.
  bool complete = true;
};

/// Finds the robot anew, without an idea of where it is, from what it sees around it: discs,
/// patterns and tags in any mixture. Pairs of sightings give poses in closed form
/// (PlaceCandidates), and so does a landmark that says who it is. Gauss–Newton fits the best
/// supported, first to the pair, then to all that the pose explains; what it leaves unexplained,
/// and landmarks that the sweep should have shown, count against it. A candidate that could not
/// weigh a millionth of the best is not fitted. Walls hide landmarks, and landmarks have a front.
/// Where the budget ends before the candidates that may weigh, no pose counts as found.
class Relocalizer {
 public:
  Relocalizer(LandmarkMap map, FloorPlan plan, const RigOnGround& on_ground,
              const RelocalizerParams& params);

  /// Every pose that explains sightings of at least two different landmarks, or one that says who
  /// it is, weighed by what it explains and by @p place, which holds no pose impossible.
  Relocalization solve(const Sweep& sweep, const PlacePrior& place = {}) const;
  /// Whether the sweep bears out @p prior: one sighting is enough, landmarks that it should have
  /// shown and did not must be fewer than those it shows. It says nothing about other poses.
  Relocalization confirm(const Sweep& sweep, const Prior& prior) const;

 private:
  /// A sighting taken for a landmark.
  struct Explained {
    Identification as;
    Match match;
  };
  struct Fit {
    Pose2 pose;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    double chi2 = 0.0;
    double dof = 0.0;
  };
  struct Hypothesis {
    Fit fit;
    std::vector<Explained> explained;
    double log_weight = 0.0;
    int missed = 0;  ///< landmarks that the sweep should have shown
  };
  /// Where a fit begins: by the sightings of a candidate, or by a pose that is known so well.
  struct Start {
    Pose2 pose;
    std::vector<Identification> by;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };
  /// One sweep, being solved.
  struct Task {
    const Sweep& sweep;
    std::vector<Observation> sightings;  ///< of the sweep, each landmark of a look once
    std::vector<Clue> clues;
    PlacePrior place;
    std::optional<Prior> prior;
    std::vector<Hypothesis> found;
    int fits = 0;
  };

  Task task(const Sweep& sweep) const;
  void try_all(Task& task, const CandidatePoses& candidates, Relocalization& result) const;
  void take(Task& task, Hypothesis hypothesis) const;
  std::optional<Hypothesis> fitted(const Start& start, const Task& task) const;
  std::optional<Fit> first_fit(const Start& start, const Task& task) const;
  /// The most that a pose weighs which leaves sightings of that cost unexplained.
  bool may_weigh(double unexplained_cost, const Pose2& pose, const Task& task) const;
  static bool is_known(const CandidatePose& candidate, const std::vector<Hypothesis>& found);
  double cost_of(const Clue& clue) const;
  double unexplained_cost(const std::vector<Explained>& explained, const Task& task) const;
  Relocalization weighed(Task task, Relocalization result) const;
  /// Density of a pose with a fit's covariance, beside that of a place of which nothing is known.
  double relative_density(const Fit& fit, const PlacePrior& place) const;
  std::optional<Explained> explained_as(const Identification& as, const Task& task) const;
  std::optional<Fit> refine(const Pose2& start, const std::vector<Explained>& explained,
                            const std::optional<Prior>& prior) const;
  std::vector<Explained> explain(const Fit& fit, const Task& task) const;
  /// NIS of the sighting as that landmark, should it be inside its gate.
  std::optional<double> inside_gate(const Explained& explained, const Fit& fit) const;
  static std::size_t landmarks_of(const std::vector<Explained>& explained);
  bool plausible(const Explained& explained, const Clue& clue, const Pose2& pose) const;
  int missed(const Hypothesis& hypothesis, const Sweep& sweep) const;
  bool should_be_seen(const Landmark& landmark, const Pose2& pose, const Shot& view) const;

  RelocalizerParams params_;
  MeasurementModel model_;
  FloorPlan plan_;
  PlaceCandidates candidates_;
  Eigen::Matrix3d biases_;  ///< covariance of a look's biases
};

}  // namespace vigia::localization

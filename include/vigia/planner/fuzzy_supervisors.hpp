#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"
#include "vigia/planner/fuzzy_engine.hpp"

namespace vigia::planner {

/// The text of a rule base and the name that stands for its file in messages.
struct FuzzyText {
  std::string text;
  std::string name;
};

/// The rule bases of the fuzzy planner. The defaults are those of config/fuzzy/, built in.
struct FuzzyRules {
  FuzzyText suitability = default_suitability();
  FuzzyText points = default_points();
  FuzzyText zoom_groups = default_zoom_groups();
  FuzzyText choice = default_choice();

  static FuzzyText default_suitability();
  static FuzzyText default_points();
  static FuzzyText default_zoom_groups();
  static FuzzyText default_choice();
};

/// The two supervisors of Armingol et al. and the grouping by distance. Like its engines, not to be
/// shared between threads; a copy is its own.
class FuzzySupervisors {
 public:
  /// Throws InputError for a rule base that can't be read or has other inputs than these.
  explicit FuzzySupervisors(const FuzzyRules& rules);

  /// First supervisor (§2.2): suitability, in [0, 1], of a disc at a distance (m) under a view
  /// angle (rad).
  double suitability(double distance_m, double view_angle);

  /// The same of a pattern or tag, of which feature_width() is @p feature_px.
  double points_suitability(double distance_m, double view_angle, double feature_px);

  /// That of any landmark, by its kind, at a focal length.
  double suitability(const Landmark& landmark, double distance_m, double view_angle,
                     double focal_px);

  std::size_t zoom_group_count() const { return groups_.term_names(0).size(); }
  std::string zoom_group_name(std::size_t group) const { return groups_.term_names(0).at(group); }
  /// Degree to which a distance belongs to each zoom group (§2.3).
  std::vector<double> zoom_membership(double distance_m) const {
    return groups_.membership(0, distance_m);
  }
  /// The distance, m, for which a group's zoom is set: the output where the distance belongs wholly
  /// to the group.
  double zoom_distance(std::size_t group) const { return zoom_distances_.at(group); }

  /// Second supervisor (§3.1): suitability, in [0, 1], of a look along @p sight_r for a position
  /// with that covariance (m²), both in the axes of the robot (x ahead, y left).
  double choice(const Eigen::Vector2d& sight_r, const Eigen::Matrix2d& covariance);

 private:
  FuzzyEngine suitability_;
  FuzzyEngine points_;
  FuzzyEngine groups_;
  FuzzyEngine choice_;
  std::vector<double> zoom_distances_;
};

}  // namespace vigia::planner

#include "vigia/planner/fuzzy_supervisors.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/error.hpp"
#include "vigia/planner/apparent_size.hpp"

namespace vigia::planner {
namespace {

FuzzyEngine read(const FuzzyText& rules, const std::vector<std::string>& inputs) {
  FuzzyEngine engine = FuzzyEngine::read(rules.text, rules.name);
  if (engine.input_names() == inputs) return engine;
  std::string wanted;
  for (const auto& input : inputs) wanted += (wanted.empty() ? "" : ", ") + input;
  throw InputError({rules.name, 1, 1}, "the inputs must be " + wanted + ", in this order");
}

/// The middle of where an input is most of all the term @p group.
double core_of(const FuzzyEngine& engine, std::size_t group) {
  constexpr int kSteps = 1200;
  constexpr double kSpan = 12.0;
  double best = -1.0;
  double first = 0.0;
  double last = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = kSpan * i / kSteps;
    const double degree = engine.membership(0, x)[group];
    if (degree > best + 1e-9) first = x;
    if (degree >= best - 1e-9) last = x;
    best = std::max(best, degree);
  }
  return 0.5 * (first + last);
}

}  // namespace

FuzzySupervisors::FuzzySupervisors(const FuzzyRules& rules)
    : suitability_(read(rules.suitability, {"distance_m", "view_angle_deg"})),
      points_(read(rules.points, {"distance_m", "view_angle_deg", "feature_px"})),
      groups_(read(rules.zoom_groups, {"distance_m"})),
      choice_(read(rules.choice, {"bearing_deg", "sigma_along_cm", "sigma_across_cm"})) {
  for (std::size_t group = 0; group < zoom_group_count(); ++group)
    zoom_distances_.push_back(std::max(groups_.evaluate({core_of(groups_, group)}), 0.1));
}

double FuzzySupervisors::suitability(double distance_m, double view_angle) {
  return std::clamp(suitability_.evaluate({distance_m, to_deg(view_angle)}), 0.0, 1.0);
}

double FuzzySupervisors::points_suitability(double distance_m, double view_angle,
                                            double feature_px) {
  return std::clamp(points_.evaluate({distance_m, to_deg(view_angle), feature_px}), 0.0, 1.0);
}

double FuzzySupervisors::suitability(const Landmark& landmark, double distance_m, double view_angle,
                                     double focal_px) {
  const auto feature = feature_width(landmark, distance_m, view_angle, focal_px);
  return feature ? points_suitability(distance_m, view_angle, *feature)
                 : suitability(distance_m, view_angle);
}

double FuzzySupervisors::choice(const Eigen::Vector2d& sight_r, const Eigen::Matrix2d& covariance) {
  const double folded = std::atan2(std::abs(sight_r.y()), sight_r.x());
  const double sigma_along = std::sqrt(std::max(covariance(0, 0), 0.0));
  const double sigma_across = std::sqrt(std::max(covariance(1, 1), 0.0));
  return std::clamp(choice_.evaluate({to_deg(folded), 100.0 * sigma_along, 100.0 * sigma_across}),
                    0.0, 1.0);
}

}  // namespace vigia::planner

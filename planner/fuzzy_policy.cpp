#include "fuzzy_policy.hpp"

#include "head_travel.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "vigia/planner/apparent_size.hpp"

namespace vigia::planner {
namespace {

/// A landmark judged where the robot will be when head and zoom have arrived.
struct Judged {
  const Landmark* landmark = nullptr;
  std::optional<double> zoom_mm;
  double suitability = 0.0;      ///< first supervisor, at the arrival
  double value = 0.0;            ///< what is compared
  Eigen::Vector2d sight_w = {};  ///< from the robot to the landmark
  double zoom_misfit = 0.0;      ///< |ln| of the size at the best zoom over the wanted size
};

bool along_x(const Eigen::Vector2d& sight_w) {
  return std::abs(sight_w.x()) >= std::abs(sight_w.y());
}

class FuzzyPolicy final : public LookPolicy {
 public:
  explicit FuzzyPolicy(const LookPolicyParts& parts) : parts_(parts), supervisors_(parts.rules) {}

  std::string_view name() const override { return "fuzzy"; }

  void follow(const Path& path) override {
    plan_ = plan_perception(path, parts_.landmarks, parts_.visibility, parts_.head, supervisors_,
                            parts_.perception);
  }

  bool prepares() const override { return true; }

  std::optional<LookChoice> choose(const LookContext& context) override {
    if (context.standing) return choose_standing(context);
    last_along_x_.reset();
    const auto preselected = best_preselected(context);
    const auto visible = best_visible(context);
    if (preselected &&
        (!visible || preselected->value >= parts_.perception.min_value * visible->value))
      return choice(*preselected, "preselected for the control area, at its zoom");
    if (!visible) return std::nullopt;
    return choice(*visible, preselected
                                ? "visible, and suits the uncertainty better than the plan's"
                                : "visible; no preselected landmark is usable here");
  }

 private:
  std::optional<Judged> judge(const Landmark& landmark, std::optional<double> zoom_mm,
                              const LookContext& context) {
    const Arrival arrival = foresee(landmark, zoom_mm, context);
    if (!can_be_held(landmark, arrival, context)) return std::nullopt;
    Judged judged;
    judged.landmark = &landmark;
    judged.zoom_mm = zoom_mm;
    const double range = context.visibility.range(landmark, arrival.pose);
    const double best_zoom = zoom_for(landmark, range, parts_.head);
    judged.suitability = supervisors_.suitability(
        landmark, range, context.visibility.view_angle(landmark, arrival.pose),
        parts_.head.zoom.at(zoom_mm.value_or(best_zoom)).px);
    // A disc gives its direction from anywhere; points that cannot be read, or are seen frontally,
    // are QUIXOTE's rejected patterns.
    if (!disc_radius(landmark) && judged.suitability < parts_.perception.reject)
      return std::nullopt;
    judged.sight_w =
        parts_.head.ground.in_plan(landmark.centre_w()).head<2>() - arrival.pose.position();
    // The supervisor speaks of the robot's own axes.
    const Eigen::Matrix2d turned = Eigen::Rotation2Dd(-arrival.pose.theta).toRotationMatrix();
    judged.value = judged.suitability *
                   supervisors_.choice(turned * judged.sight_w,
                                       turned * context.belief.covariance.topLeftCorner<2, 2>() *
                                           turned.transpose());
    const double focal = parts_.head.zoom.at(best_zoom).px;
    const double wanted = wanted_radius(landmark, parts_.head) * range / extent_radius(landmark);
    judged.zoom_misfit = std::abs(std::log(focal / wanted));
    return judged;
  }

  static std::optional<Judged> best_of(const std::vector<Judged>& all) {
    const auto best = std::max_element(
        all.begin(), all.end(), [](const Judged& a, const Judged& b) { return a.value < b.value; });
    return best == all.end() ? std::nullopt : std::optional(*best);
  }

  static LookChoice choice(const Judged& judged, const std::string& reason) {
    return {judged.landmark->id, judged.zoom_mm, judged.suitability, reason};
  }

  std::optional<Judged> best_preselected(const LookContext& context) {
    const AreaPlan* area = plan_.at(context.station_m);
    if (area == nullptr) return std::nullopt;
    std::vector<Judged> usable;
    for (const LandmarkId id : area->preselected) {
      const Landmark* landmark = context.landmarks.find(id);
      const auto judged = judge(*landmark, area->zoom_mm, context);
      if (judged && judged->suitability >= parts_.perception.reject) usable.push_back(*judged);
    }
    return best_of(usable);
  }

  std::optional<Judged> best_visible(const LookContext& context) {
    std::vector<Judged> usable;
    for (const Landmark& landmark : context.landmarks.all())
      if (const auto judged = judge(landmark, std::nullopt, context)) usable.push_back(*judged);
    return best_of(usable);
  }

  std::optional<LookChoice> choose_standing(const LookContext& context) {
    std::vector<Judged> usable;
    for (const Landmark& landmark : context.landmarks.all())
      if (const auto judged = judge(landmark, std::nullopt, context)) usable.push_back(*judged);
    if (usable.empty()) return std::nullopt;
    std::string reason = "standing: allows the best zoom";
    const double limit = parts_.perception.both_uncertain_m;
    const auto& covariance = context.belief.covariance;
    const bool both = covariance(0, 0) > limit * limit && covariance(1, 1) > limit * limit;
    if (last_along_x_ && both) {
      const bool wanted = !*last_along_x_;
      const auto other = std::stable_partition(
          usable.begin(), usable.end(),
          [wanted](const Judged& each) { return along_x(each.sight_w) == wanted; });
      if (other != usable.begin()) {
        usable.erase(other, usable.end());
        reason += ", along the other axis";
      }
    }
    const auto best =
        std::min_element(usable.begin(), usable.end(), [](const Judged& a, const Judged& b) {
          return std::pair(a.zoom_misfit, -a.suitability) <
                 std::pair(b.zoom_misfit, -b.suitability);
        });
    last_along_x_ = along_x(best->sight_w);
    return choice(*best, reason);
  }

  LookPolicyParts parts_;
  FuzzySupervisors supervisors_;
  PerceptionPlan plan_;
  std::optional<bool> last_along_x_;  ///< of the last look of this stop
};

}  // namespace

std::unique_ptr<LookPolicy> make_fuzzy_policy(const LookPolicyParts& parts) {
  return std::make_unique<FuzzyPolicy>(parts);
}

}  // namespace vigia::planner

#include "vigia/planner/perception_plan.hpp"

#include "zoom_classes.hpp"
#include "zoom_schedule.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/planner/apparent_size.hpp"

namespace vigia::planner {
namespace {

constexpr double kSample_m = 0.02;

/// Studies one landmark from the control areas of a path.
class Study {
 public:
  Study(const Path& path, const Visibility& visibility, const HeadModel& head,
        FuzzySupervisors& supervisors, const PerceptionParams& params)
      : path_(path),
        visibility_(visibility),
        head_(head),
        supervisors_(supervisors),
        params_(params) {}

  LandmarkStudy of(const Landmark& landmark, const ControlArea& area) {
    LandmarkStudy study;
    study.id = landmark.id;
    study.visible_share = seen_share(landmark, area.from_m, area.to_m);
    study.nearest_m = 1e9;
    study.kept = !area.positions.empty();
    std::vector<double> membership(supervisors_.zoom_group_count(), 0.0);
    Eigen::Vector2d sight = Eigen::Vector2d::Zero();
    for (const ControlPosition& position : area.positions) {
      const double distance = visibility_.range(landmark, position.pose);
      const Eigen::Vector2d towards =
          head_.ground.in_plan(landmark.centre_w()).head<2>() - position.pose.position();
      sight += towards.normalized();
      if (usable(landmark, position)) {
        study.suitability += supervisors_.suitability(
            landmark, distance, visibility_.view_angle(landmark, position.pose),
            head_.zoom.at(zoom_for(landmark, distance, head_)).px);
      } else {
        study.kept = false;
      }
      if (visibility_.sight(landmark, position.pose) != Sight::visible) continue;
      study.nearest_m = std::min(study.nearest_m, distance);
      study.farthest_m = std::max(study.farthest_m, distance);
      study.max_view_angle =
          std::max(study.max_view_angle, visibility_.view_angle(landmark, position.pose));
      const auto degrees = supervisors_.zoom_membership(distance);
      for (std::size_t g = 0; g < degrees.size(); ++g) membership[g] += degrees[g];
    }
    if (!area.positions.empty()) study.suitability /= static_cast<double>(area.positions.size());
    study.nearest_m = std::min(study.nearest_m, study.farthest_m);
    study.group = static_cast<std::size_t>(std::max_element(membership.begin(), membership.end()) -
                                           membership.begin());
    if (sight.norm() > 0.0) study.sight_w = sight.normalized();
    return study;
  }

 private:
  double seen_share(const Landmark& landmark, double from, double to) const {
    const int count = std::max(1, static_cast<int>(std::lround((to - from) / kSample_m)));
    int seen = 0;
    for (int i = 0; i < count; ++i) {
      const double s = from + (to - from) * (i + 0.5) / count;
      if (visibility_.sight(landmark, pose_on_path(path_, s)) == Sight::visible) ++seen;
    }
    return static_cast<double>(seen) / count;
  }

  bool usable(const Landmark& landmark, const ControlPosition& position) const {
    const double radius = params_.path.radius_m;
    return seen_share(landmark, std::max(position.station_m - radius, 0.0),
                      std::min(position.station_m + radius, path_.length())) >=
           params_.usable_share;
  }

  const Path& path_;
  const Visibility& visibility_;
  const HeadModel& head_;
  FuzzySupervisors& supervisors_;
  const PerceptionParams& params_;
};

/// Zoom groups of an area's landmarks that are suitable, each with its best landmark.
std::vector<ZoomOption> zoom_options(const AreaPlan& plan, const std::vector<double>& zooms,
                                     double reject) {
  std::vector<ZoomOption> options;
  for (std::size_t group = 0; group < zooms.size(); ++group) {
    double best = -1.0;
    for (const LandmarkStudy& study : plan.visible)
      if (study.group == group && study.suitability >= reject)
        best = std::max(best, study.suitability);
    if (best >= 0.0) options.push_back({group, zooms[group], best});
  }
  return options;
}

/// Whether the landmark has a fair size over the whole area at the area's zoom.
bool within_margin(const Landmark& landmark, const LandmarkStudy& study, const ZoomClass& of,
                   double zoom_mm, const HeadModel& head, const PerceptionParams& params) {
  if (study.farthest_m <= 0.0) return false;
  const double focal = head.zoom.at(zoom_mm).px;
  const double largest = focal * of.radius_m / study.nearest_m;
  if (const auto feature = feature_width(landmark, study.farthest_m, study.max_view_angle, focal))
    return *feature >= params.min_feature_px && largest <= wanted_radius(landmark, head);
  return focal * of.radius_m / study.farthest_m >= params.min_radius_px &&
         largest <= params.max_radius_px;
}

void preselect(AreaPlan& plan, const LandmarkMap& landmarks, const ZoomClasses& classes,
               const HeadModel& head, const PerceptionParams& params) {
  const auto add = [&plan](LandmarkId id) {
    auto& ids = plan.preselected;
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  };
  const LandmarkStudy* chosen = nullptr;
  for (const LandmarkStudy& study : plan.visible) {
    if (study.group != *plan.group || study.suitability < params.reject) continue;
    if (chosen == nullptr || study.suitability > chosen->suitability) chosen = &study;
  }
  plan.chosen = chosen->id;
  add(chosen->id);
  for (const Eigen::Index axis : {0, 1}) {
    const LandmarkStudy* best = nullptr;
    double most = 0.0;
    for (const LandmarkStudy& study : plan.visible) {
      if (!study.kept || study.suitability < params.reject ||
          !within_margin(*landmarks.find(study.id), study, classes.of(study.id), plan.zoom_mm, head,
                         params))
        continue;
      const double geometric = study.suitability * std::abs(study.sight_w(axis));
      if (geometric > most) {
        most = geometric;
        best = &study;
      }
    }
    if (best != nullptr) add(best->id);
  }
}

}  // namespace

const LandmarkStudy* AreaPlan::find(LandmarkId id) const {
  const auto at = std::find_if(visible.begin(), visible.end(),
                               [id](const LandmarkStudy& study) { return study.id == id; });
  return at == visible.end() ? nullptr : &*at;
}

const AreaPlan* PerceptionPlan::at(double station_m) const {
  for (const AreaPlan& plan : areas)
    if (station_m < plan.area.to_m) return &plan;
  return areas.empty() ? nullptr : &areas.back();
}

PerceptionPlan plan_perception(const Path& path, const LandmarkMap& landmarks,
                               const Visibility& visibility, const HeadModel& head,
                               FuzzySupervisors& supervisors, const PerceptionParams& params) {
  const ZoomClasses classes(landmarks, head, params.path.distance_ratio);
  const std::size_t distances = supervisors.zoom_group_count();
  std::vector<double> zooms;
  for (const ZoomClass& each : classes.all())
    for (std::size_t group = 0; group < distances; ++group)
      zooms.push_back(each.zoom_for(supervisors.zoom_distance(group), head));

  const PathModel model = model_path(path, landmarks, visibility, params.path);
  PerceptionPlan plan;
  plan.turn_points = model.turn_points;
  std::vector<std::vector<ZoomOption>> options;
  Study study(path, visibility, head, supervisors, params);
  for (const ControlArea& area : model.areas) {
    AreaPlan area_plan;
    area_plan.area = area;
    for (const Landmark& landmark : landmarks.all()) {
      LandmarkStudy of = study.of(landmark, area);
      of.group += classes.index_of(landmark.id) * distances;
      if (of.visible_share >= params.visible_share) area_plan.visible.push_back(of);
    }
    options.push_back(zoom_options(area_plan, zooms, params.reject));
    plan.areas.push_back(std::move(area_plan));
  }
  const double cost_per_mm = params.zoom_cost_per_s / head.limits.zoom_rate_mm_s;
  const auto taken = schedule_zoom(options, cost_per_mm);
  for (std::size_t i = 0; i < plan.areas.size(); ++i) {
    if (!taken[i]) continue;
    plan.areas[i].group = options[i][*taken[i]].group;
    plan.areas[i].zoom_mm = options[i][*taken[i]].zoom_mm;
    preselect(plan.areas[i], landmarks, classes, head, params);
  }
  return plan;
}

}  // namespace vigia::planner

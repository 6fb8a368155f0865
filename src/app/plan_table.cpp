#include "plan_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "vigia/core/error.hpp"
#include "vigia/mission/planning_parts.hpp"
#include "vigia/planner/look_policy.hpp"
#include "vigia/planner/tight_place.hpp"
#include "vigia/report/plan_picture.hpp"

namespace vigia::app {
namespace {

/// What a policy is asked with, at a control position.
class PolicyAtPositions {
 public:
  PolicyAtPositions(const mission::MissionSetup& setup, const planner::Visibility& visibility,
                    const planner::HeadModel& head, const std::string& policy)
      : setup_(setup),
        visibility_(visibility),
        head_(head),
        information_(mission::landmark_information(setup)),
        policy_(planner::make_look_policy(
            policy,
            {setup.look.fixed_landmark, RandomStream(setup.seed, "look policy"),
             setup.world.landmarks, visibility, head, setup.look.rules, setup.look.perception})) {
    policy_->follow(setup.path);
  }

  std::optional<LandmarkId> ask(const planner::ControlPosition& position) {
    Belief belief;
    belief.pose = position.pose;
    const double variance = setup_.look.trigger.limit_1_m * setup_.look.trigger.limit_1_m;
    belief.covariance =
        Eigen::Vector3d(variance, variance, from_deg(1.0) * from_deg(1.0)).asDiagonal();
    const HeadReading head;
    const std::vector<LandmarkId> excluded;
    const auto choice = policy_->choose({Stamp{}, belief, head, position.station_m, setup_.path,
                                         setup_.world.landmarks, visibility_, information_,
                                         excluded, head_, 0.0, false, setup_.noise.odometry});
    return choice ? std::optional(choice->landmark) : std::nullopt;
  }

 private:
  const mission::MissionSetup& setup_;
  const planner::Visibility& visibility_;
  const planner::HeadModel& head_;
  localization::LandmarkInformation information_;
  std::unique_ptr<planner::LookPolicy> policy_;
};

void take_choices(PolicyAtPositions& policy, const planner::AreaPlan& area, PlanRow& row) {
  row.chosen.reset();
  row.zoom_mm.reset();
  row.preselected.clear();
  row.suitability = 0.0;
  std::map<LandmarkId, int> votes;
  for (const auto& position : area.area.positions)
    if (const auto id = policy.ask(position)) ++votes[*id];
  for (const auto& vote : votes) {
    row.preselected.push_back(vote.first);
    if (!row.chosen || vote.second > votes[*row.chosen]) row.chosen = vote.first;
  }
  if (!row.chosen) return;
  const planner::LandmarkStudy* study = area.find(*row.chosen);
  if (study != nullptr) row.suitability = study->suitability;
}

PlanRow row_of(std::size_t index, const planner::AreaPlan& area) {
  PlanRow row;
  row.area = index;
  row.from_m = area.area.from_m;
  row.to_m = area.area.to_m;
  for (const auto& position : area.area.positions)
    row.positions.push_back(position.pose.position());
  for (const auto& study : area.visible) row.visible.push_back(study.id);
  row.chosen = area.chosen;
  row.preselected = area.preselected;
  if (area.chosen) row.suitability = area.find(*area.chosen)->suitability;
  if (area.group) row.zoom_mm = area.zoom_mm;
  return row;
}

}  // namespace

PlanTable make_plan(const mission::MissionSetup& setup, const std::string& policy) {
  if (policy == "fixed" && !setup.look.fixed_landmark)
    throw InputError("--policy fixed: the mission needs the key planner.fixed_landmark");
  if (setup.robot.directed_camera() == nullptr)
    throw InputError("a perception plan is for a camera that the head turns, and the robot '" +
                     setup.robot.name + "' has none");
  const planner::Visibility visibility = mission::visibility(setup);
  const planner::HeadModel head = mission::head_model(setup);
  planner::FuzzySupervisors supervisors(setup.look.rules);
  const auto plan = planner::plan_perception(setup.path, setup.world.landmarks, visibility, head,
                                             supervisors, setup.look.perception);
  PlanTable table{setup.name, policy, plan.turn_points, {}};
  PolicyAtPositions other(setup, visibility, head, policy);
  for (std::size_t i = 0; i < plan.areas.size(); ++i) {
    table.rows.push_back(row_of(i, plan.areas[i]));
    if (policy != "fuzzy") take_choices(other, plan.areas[i], table.rows.back());
  }
  return table;
}

std::string tightest_text(const mission::MissionSetup& setup) {
  const auto place =
      planner::tightest_place(setup.world.plan, setup.path, setup.robot.robot.radius_m);
  if (!std::isfinite(place.beside_m)) return "";
  return fmt::format("tightest place: {:.3f} m beside the robot at [{:.2f}, {:.2f}], {:.1f} m on",
                     place.beside_m, place.at.x(), place.at.y(), place.station_m);
}

void draw_plan(const PlanTable& table, const mission::MissionSetup& setup,
               const std::filesystem::path& file) {
  report::PlanPicture picture{setup.world};
  picture.title = fmt::format("{}: perception plan, policy {}", table.mission, table.policy);
  picture.subtitle = fmt::format("{:.1f} m in {} control areas; area: landmark and its suitability",
                                 setup.path.length(), table.rows.size());
  picture.path = setup.path;
  picture.turn_points = table.turn_points;
  picture.position_radius_m = setup.look.perception.path.radius_m;
  for (const PlanRow& row : table.rows)
    picture.areas.push_back(
        {row.from_m, row.to_m, row.positions, row.chosen,
         row.chosen ? fmt::format("{}: L{}  {:.0f} %", row.area, *row.chosen, 100 * row.suitability)
                    : fmt::format("{}: none", row.area)});
  report::draw_plan(picture, file);
}

std::string plan_json(const std::vector<PlanTable>& tables) {
  using nlohmann::ordered_json;
  ordered_json plans = ordered_json::array();
  for (const PlanTable& table : tables) {
    ordered_json areas = ordered_json::array();
    for (const PlanRow& row : table.rows)
      areas.push_back({{"area", row.area},
                       {"from_m", row.from_m},
                       {"to_m", row.to_m},
                       {"visible", row.visible},
                       {"landmark", row.chosen ? ordered_json(*row.chosen) : ordered_json()},
                       {"suitability", row.suitability},
                       {"zoom_mm", row.zoom_mm ? ordered_json(*row.zoom_mm) : ordered_json()},
                       {"preselected", row.preselected}});
    plans.push_back({{"mission", table.mission},
                     {"policy", table.policy},
                     {"turn_points_m", table.turn_points},
                     {"areas", areas}});
  }
  return plans.dump(2) + "\n";
}

}  // namespace vigia::app

#include "vigia/evaluation/campaign_plan.hpp"

#include "checked_line.hpp"
#include "provenance_json.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"
#include "vigia/evaluation/descriptor.hpp"

namespace vigia::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlan = "plan.json";

Json arm_plan(const Arm& arm) {
  Json json{{"name", arm.name},
            {"disturbance", arm.disturbance},
            {"variant", arm.variant},
            {"overrides", arm.overrides},
            {"mission", fingerprint(arm.setup.resolved_yaml)},
            {"route_m", Json::array()}};
  for (const auto& p : arm.setup.path.points()) json["route_m"].push_back({p.x(), p.y()});
  return json;
}

std::string plan_text(const Campaign& campaign, const CampaignPlan& plan) {
  Json json = provenance_json(plan.provenance);
  json["shards"] = plan.shards;
  json["missions"] = plan.missions;
  json["seeds"] = {{"first", campaign.first_seed}, {"count", campaign.seeds}};
  json["baseline"] = campaign.baseline;
  json["arms"] = Json::array();
  for (const Arm& arm : campaign.arms) json["arms"].push_back(arm_plan(arm));
  return checked_line(json.dump());
}

Json read_plan_json(const fs::path& folder) {
  const std::string text = read_bytes(folder / kPlan);
  if (text.empty())
    throw InputError(
        fmt::format("{} has no {}; `vigia campaign plan` makes one", folder.string(), kPlan));
  const auto object = unchecked(std::string_view(text).substr(0, text.size() - 1));
  if (!object)
    throw InputError((folder / kPlan).string() +
                     " is damaged; make it anew with `vigia campaign plan --restart`");
  return Json::parse(*object);
}

CampaignPlan plan_from(const Json& json) {
  return {provenance_from(json), json.at("shards").get<int>(),
          json.at("missions").get<std::size_t>()};
}

Arm planned_arm(const fs::path& folder, const Json& json, std::size_t number) {
  const fs::path file = folder / mission_file(number);
  std::vector<Eigen::Vector2d> points;
  for (const auto& p : json.at("route_m")) points.emplace_back(p.at(0), p.at(1));
  Arm arm{json.at("name"),
          json.at("disturbance"),
          json.at("variant"),
          json.at("overrides").get<std::vector<std::string>>(),
          {}};
  if (fingerprint(read_bytes(file)) != json.at("mission"))
    throw InputError(file.string() + " is missing or not the mission that was planned");
  arm.setup = mission::load_planned_mission(file, Path(points));
  if (fingerprint(arm.setup.resolved_yaml) != json.at("mission"))
    throw InputError(file.string() + " means something else to this version of the program");
  return arm;
}

/// What @p read makes of the folder's plan. Throws InputError when the plan is of another form.
template <typename Read>
auto read_as(const fs::path& folder, Read read) {
  const Json json = read_plan_json(folder);
  try {
    return read(json);
  } catch (const Json::exception&) {
    throw InputError((folder / kPlan).string() +
                     " is not of the form that this version of the program reads");
  }
}

/// Whether nothing but beginnings of a plan stands in the folder.
bool may_hold_a_plan(const fs::path& folder) {
  if (fs::exists(folder / kPlan)) return true;
  const auto begun = [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return name == "missions" || name.rfind(std::string(kPlan) + ".part-", 0) == 0;
  };
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(), begun);
}

void check_plan(const fs::path& folder, const CampaignPlan& plan) {
  const CampaignPlan there = read_plan(folder);
  const std::string differs = difference(there.provenance, plan.provenance, false);
  const std::string advice = "; choose another --out, or plan anew with --restart";
  if (!differs.empty())
    throw InputError(folder.string() + " holds another plan: of the new one, " + differs + advice);
  if (there.shards != plan.shards)
    throw InputError(fmt::format("{} holds a plan of {} shards, now there are {}{}",
                                 folder.string(), there.shards, plan.shards, advice));
}

}  // namespace

CampaignPlan::Missions CampaignPlan::of_shard(int shard) const {
  const auto n = static_cast<std::size_t>(shards);
  const auto k = static_cast<std::size_t>(shard);
  return {(k - 1) * missions / n, k * missions / n};
}

CampaignPlan plan_of(const Campaign& campaign, int shards) {
  if (shards < 1 || static_cast<std::size_t>(shards) > campaign.missions())
    throw InputError(fmt::format("found --shards {}, must be 1 … {}: so many missions there are",
                                 shards, campaign.missions()));
  return {provenance_of(campaign), shards, campaign.missions()};
}

CampaignPlan write_plan(const fs::path& folder, const Campaign& campaign, int shards,
                        bool restart) {
  CampaignPlan plan = plan_of(campaign, shards);
  try {
    fs::create_directories(folder);
    if (!may_hold_a_plan(folder))
      throw InputError(
          fmt::format("the folder {} holds no {}, so it is not one of ours; choose "
                      "another --out",
                      folder.string(), kPlan));
    const Descriptor lock = lock_folder(folder);
    if (fs::exists(folder / kPlan) && !restart) {
      check_plan(folder, plan);
      return plan;
    }
    for (const char* name : {"missions", "shards", "logs"}) fs::create_directories(folder / name);
    for (std::size_t i = 0; i < campaign.arms.size(); ++i)
      write_shared_file(folder / mission_file(i), campaign.arms[i].setup.resolved_yaml);
    write_shared_file(folder / kPlan, plan_text(campaign, plan));
  } catch (const fs::filesystem_error& error) {
    throw InputError("cannot use the folder " + folder.string() + ": " + error.code().message());
  }
  return plan;
}

CampaignPlan read_plan(const fs::path& folder) {
  return read_as(folder, plan_from);
}

Campaign planned_campaign(const fs::path& folder) {
  return read_as(folder, [&](const Json& json) {
    Campaign campaign;
    campaign.name = json.at("campaign");
    campaign.command = json.at("command");
    campaign.first_seed = json.at("seeds").at("first");
    campaign.seeds = json.at("seeds").at("count");
    campaign.baseline = json.at("baseline");
    for (const Json& arm : json.at("arms"))
      campaign.arms.push_back(planned_arm(folder, arm, campaign.arms.size()));
    return campaign;
  });
}

void require_same_program(const CampaignPlan& plan) {
  const Provenance& p = plan.provenance;
  if (p.version == VIGIA_VERSION && p.build == build_fingerprint()) return;
  throw InputError(fmt::format(
      "the campaign was planned by version {} (build {}), this is {} (build {}); --any-version "
      "mixes them",
      p.version, p.build, VIGIA_VERSION, build_fingerprint()));
}

}  // namespace vigia::evaluation

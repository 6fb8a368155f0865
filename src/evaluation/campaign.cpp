#include "vigia/evaluation/campaign.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "vigia/core/config.hpp"

namespace vigia::evaluation {
namespace {

/// One value of one list of the campaign, and what it sets in the mission.
struct Choice {
  std::string name;
  std::vector<std::string> overrides;
};

/// A list of the campaign. Without choices it leaves the mission as it is.
struct Dimension {
  SourceLocation where;
  std::vector<Choice> choices;
};

void reject_twins(const MapReader& reader, const std::string& key,
                  const std::vector<Choice>& choices) {
  for (auto it = choices.begin(); it != choices.end(); ++it)
    if (std::any_of(choices.begin(), it, [&](const Choice& c) { return c.name == it->name; }))
      throw reader.error(key, fmt::format("\"{}\" stands in the list twice", it->name));
}

/// A list of names, each of which becomes assignments by @p overrides.
template <typename Overrides>
Dimension read_names(MapReader& reader, const std::string& key, Overrides overrides) {
  Dimension dimension{reader.where(key), {}};
  if (!reader.has(key)) return dimension;
  for (const auto& name : reader.texts(key)) dimension.choices.push_back({name, overrides(name)});
  if (dimension.choices.empty()) throw reader.error(key, "the list is empty; leave the key out");
  reject_twins(reader, key, dimension.choices);
  return dimension;
}

/// Names end up in tables and CSV files.
void check_name(const MapReader& variant, const std::string& name) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), plain))
    throw variant.error("name",
                        fmt::format("found \"{}\"; letters, digits and _ - . make a name", name));
}

Dimension read_variants(MapReader& reader) {
  Dimension dimension{reader.where("variants"), {}};
  for (MapReader& variant : reader.maps("variants")) {
    const std::string name = variant.text("name");
    check_name(variant, name);
    dimension.choices.push_back(
        {name, variant.has("set") ? variant.texts("set") : std::vector<std::string>{}});
    variant.finish();
  }
  reject_twins(reader, "variants", dimension.choices);
  return dimension;
}

std::vector<std::string> disturbance_overrides(const std::string& name) {
  if (name == "none") return {"disturbances={}"};
  return {fmt::format("disturbances={{{}: realistic}}", name)};
}

/// The list of the campaign that brought a mission's mistake in; null when the mission has it of
/// itself.
const Dimension* origin(const std::string& message, const std::vector<Dimension>& dimensions) {
  for (const auto& dimension : dimensions)
    for (const auto& choice : dimension.choices)
      for (const auto& assignment : choice.overrides)
        if (message.find(assignment) != std::string::npos) return &dimension;
  return nullptr;
}

/// The next combination of one choice from each dimension, the last dimension first; false after
/// the last combination.
bool advance(std::vector<std::size_t>& picks, const std::vector<Dimension>& dimensions) {
  for (std::size_t d = dimensions.size(); d-- > 0;) {
    if (++picks[d] < dimensions[d].choices.size()) return true;
    picks[d] = 0;
  }
  return false;
}

Arm make_arm(const std::vector<Dimension>& dimensions, const std::vector<std::size_t>& picks,
             const std::vector<std::string>& before) {
  Arm arm;
  arm.overrides = before;
  std::vector<std::string> parts;
  for (std::size_t d = 0; d < dimensions.size(); ++d) {
    if (dimensions[d].choices.empty()) continue;
    const Choice& choice = dimensions[d].choices[picks[d]];
    arm.overrides.insert(arm.overrides.end(), choice.overrides.begin(), choice.overrides.end());
    if (dimensions[d].choices.size() > 1) parts.push_back(choice.name);
    if (d == 2) arm.disturbance = choice.name;
    if (d == 3) arm.variant = choice.name;
  }
  arm.name = fmt::format("{}", fmt::join(parts, "/"));
  return arm;
}

std::size_t find_baseline(MapReader& reader, const std::vector<Arm>& arms) {
  if (!reader.has("baseline")) return 0;
  const std::string name = reader.text("baseline");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    if (arms[i].name == name) return i;
    names.push_back(arms[i].name);
  }
  throw reader.error("baseline", fmt::format("found \"{}\", must be the name of an arm: {}", name,
                                             fmt::join(names, ", ")));
}

}  // namespace

Campaign read_campaign(const std::filesystem::path& file,
                       const std::vector<std::string>& overrides) {
  MapReader reader(load_config(file), "campaign");
  Campaign campaign;
  campaign.name = reader.folder_name("name");
  const auto mission = file.parent_path() / reader.text("mission");
  MapReader seeds = reader.map("seeds");
  campaign.first_seed = static_cast<std::uint64_t>(seeds.integer("first", {0, 1e9}, 1));
  campaign.seeds = static_cast<int>(seeds.integer("count", {2, 1e6}, campaign.seeds));
  seeds.finish();

  const auto sets = [](const std::string& key) {
    return [key](const std::string& name) { return std::vector<std::string>{key + "=" + name}; };
  };
  const auto all = reader.has("set") ? reader.texts("set") : std::vector<std::string>{};
  const std::vector<Dimension> dimensions{
      read_names(reader, "policies", sets("planner.policy")),
      read_names(reader, "localizers", sets("localization.primary")),
      read_names(reader, "disturbances", disturbance_overrides), read_variants(reader)};

  std::vector<std::size_t> picks(dimensions.size(), 0);
  do {
    Arm arm = make_arm(dimensions, picks, all);
    arm.overrides.insert(arm.overrides.end(), overrides.begin(), overrides.end());
    try {
      arm.setup = mission::load_mission(mission, arm.overrides);
    } catch (const InputError& error) {
      const Dimension* source = origin(error.what(), dimensions);
      if (source == nullptr) throw;
      throw InputError(source->where, error.what());
    }
    if (arm.name.empty()) arm.name = arm.setup.look.policy;
    campaign.arms.push_back(std::move(arm));
  } while (advance(picks, dimensions));
  campaign.baseline = find_baseline(reader, campaign.arms);
  reader.finish();
  return campaign;
}

}  // namespace vigia::evaluation

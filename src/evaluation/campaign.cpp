#include "vigia/evaluation/campaign.hpp"

#include <algorithm>
#include <cctype>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "vigia/core/key_reference.hpp"
#include "vigia/core/shell.hpp"

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

/// What a campaign's file says.
struct CampaignFile {
  std::string name;
  std::string mission;
  std::uint64_t first_seed = 1;
  int seeds = 100;
  std::optional<std::vector<std::string>> policies;
  std::optional<std::vector<std::string>> localizers;
  std::optional<std::vector<std::string>> disturbances;
  std::vector<Choice> variants;
  std::vector<std::string> set;
  std::optional<std::string> baseline;
};

/// Names end up in tables and CSV files.
bool makes_a_name(const std::string& name) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), plain);
}

void describe_list(ParamVisitor& v, const char* key, std::optional<std::vector<std::string>>& names,
                   const About& about) {
  v.given(key, [&] {
    v.texts(key, names.emplace(), about.required());
    v.require(!names->empty(), key, "the list is empty; leave the key out");
  });
}

void describe_set(ParamVisitor& v, std::vector<std::string>& assignments, const About& about) {
  v.given("set", [&] { v.texts("set", assignments, about.required()); });
}

void describe_variant(ParamVisitor& v, std::vector<Choice>& variants) {
  Choice variant;
  v.text("name", variant.name, About("of letters, digits and _ - .").required());
  v.require(makes_a_name(variant.name), "name",
            fmt::format("found \"{}\"; letters, digits and _ - . make a name", variant.name));
  describe_set(v, variant.overrides, "`\"key.path=value\"` of this variant");
  variants.push_back(variant);
}

void describe(ParamVisitor& v, CampaignFile& file) {
  v.folder_name("name", file.name, About("its folder is named after it").required());
  v.text("mission", file.mission, About("a file, relative to this one").required());
  v.map("seeds", "the same for every arm", [&] {
    v.integer("first", file.first_seed, {0, 1e9}, "seed");
    v.integer("count", file.seeds, {2, 1e6}, "of seeds");
  });
  describe_set(v, file.set,
               "`\"key.path=value\"` for every arm, before the lists; `--set` comes last");
  const char* usual = "the mission's";
  describe_list(v, "policies", file.policies, About("values of `planner.policy`").otherwise(usual));
  describe_list(v, "localizers", file.localizers,
                About("values of `localization.primary`").otherwise(usual));
  describe_list(
      v, "disturbances", file.disturbances,
      About("keys below the mission's `disturbances`; each is set to `realistic` with all "
            "others off. `none`: all off; `all`: all but kidnapping")
          .otherwise(usual));
  v.each("variants", "each an arm, or as many as the lists make",
         [&] { describe_variant(v, file.variants); });
  v.given("baseline", [&] {
    v.text("baseline", file.baseline.emplace(),
           About("name of the arm from which differences count")
               .otherwise("the first arm")
               .required());
  });
}

/// A list of names, each of which becomes assignments by @p overrides.
template <typename Overrides>
Dimension dimension_of(const MapReader& reader, const std::string& key,
                       const std::optional<std::vector<std::string>>& names, Overrides overrides) {
  Dimension dimension{reader.where(key), {}};
  if (!names) return dimension;
  for (const auto& name : *names) dimension.choices.push_back({name, overrides(name)});
  reject_twins(reader, key, dimension.choices);
  return dimension;
}

Dimension variants_of(const MapReader& reader, const std::vector<Choice>& variants) {
  Dimension dimension{reader.where("variants"), variants};
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

std::size_t find_baseline(const MapReader& reader, const std::optional<std::string>& baseline,
                          const std::vector<Arm>& arms) {
  if (!baseline) return 0;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    if (arms[i].name == *baseline) return i;
    names.push_back(arms[i].name);
  }
  throw reader.error("baseline", fmt::format("found \"{}\", must be the name of an arm: {}",
                                             *baseline, fmt::join(names, ", ")));
}

std::vector<Dimension> dimensions_of(const MapReader& reader, const CampaignFile& file) {
  const auto sets = [](const std::string& key) {
    return [key](const std::string& name) { return std::vector<std::string>{key + "=" + name}; };
  };
  return {dimension_of(reader, "policies", file.policies, sets("planner.policy")),
          dimension_of(reader, "localizers", file.localizers, sets("localization.primary")),
          dimension_of(reader, "disturbances", file.disturbances, disturbance_overrides),
          variants_of(reader, file.variants)};
}

}  // namespace

std::vector<KeyRow> campaign_keys() {
  return key_reference<CampaignFile>("campaign.");
}

Campaign read_campaign(const std::filesystem::path& file,
                       const std::vector<std::string>& overrides) {
  MapReader reader(load_config(file), "campaign");
  CampaignFile said;
  read_params(reader, said);
  Campaign campaign;
  campaign.name = said.name;
  campaign.first_seed = said.first_seed;
  campaign.seeds = said.seeds;
  campaign.command = "vigia evaluate " + shell_word(file.string());
  for (const auto& assignment : overrides) campaign.command += " --set " + shell_word(assignment);
  const auto dimensions = dimensions_of(reader, said);
  std::vector<std::size_t> picks(dimensions.size(), 0);
  do {
    Arm arm = make_arm(dimensions, picks, said.set);
    arm.overrides.insert(arm.overrides.end(), overrides.begin(), overrides.end());
    try {
      arm.setup = mission::load_mission(file.parent_path() / said.mission, arm.overrides);
    } catch (const InputError& error) {
      const Dimension* source = origin(error.what(), dimensions);
      if (source == nullptr) throw;
      throw InputError(source->where, error.what());
    }
    if (arm.name.empty()) arm.name = arm.setup.look.policy;
    campaign.arms.push_back(std::move(arm));
  } while (advance(picks, dimensions));
  campaign.baseline = find_baseline(reader, said.baseline, campaign.arms);
  return campaign;
}

}  // namespace vigia::evaluation

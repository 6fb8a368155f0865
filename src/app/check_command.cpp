#include "commands.hpp"
#include "plan_table.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "vigia/core/field_map.hpp"
#include "vigia/evaluation/campaign.hpp"
#include "vigia/mission/setup.hpp"
#include "vigia/planner/fuzzy_engine.hpp"
#include "vigia/sim/simulator.hpp"

namespace vigia::app {
namespace {

struct CheckOptions {
  std::string file;
  std::vector<std::string> overrides;
};

std::string count_of(std::size_t count, const std::string& thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

// Each checks a file of its kind and says what it holds. All throw InputError.

std::string check_world(const std::shared_ptr<ConfigNode>& root) {
  MapReader reader(root, "world");
  const WorldMap world = read_world_map(reader);
  sim::read_appearance(reader, world);
  reader.finish();
  return fmt::format("\"{}\", with {}", world.name,
                     count_of(world.landmarks.all().size(), "landmark"));
}

std::string check_field(const std::shared_ptr<ConfigNode>& root) {
  MapReader reader(root, "field");
  const FieldMap field = read_field_map(reader.map("field"));
  reader.finish();
  return fmt::format("{:g} × {:g} m, with {}", field.length_m, field.width_m,
                     count_of(field.lines.size(), "line"));
}

std::string check_robot(const std::shared_ptr<ConfigNode>& root) {
  MapReader reader(root, "robot");
  const auto robot = sim::read_robot_setup(reader);
  reader.finish();
  return fmt::format("\"{}\"", robot.name);
}

std::string check_campaign(const CheckOptions& options) {
  const auto campaign = evaluation::read_campaign(options.file, options.overrides);
  return fmt::format("\"{}\", {} × {} seeds = {} missions", campaign.name,
                     count_of(campaign.arms.size(), "arm"), campaign.seeds, campaign.missions());
}

std::string check_mission(const CheckOptions& options) {
  const auto setup = mission::load_mission(options.file, options.overrides);
  const std::string tightest = tightest_text(setup);
  return fmt::format("\"{}\", {:.1f} m, policy {}{}{}", setup.name, setup.path.length(),
                     setup.look.policy, tightest.empty() ? "" : "; ", tightest);
}

std::string check_rules(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw InputError(file + ": cannot be read");
  const auto engine = planner::FuzzyEngine::read(text, file);
  return fmt::format("with {}", count_of(engine.input_names().size(), "input"));
}

enum class FileKind { mission, world, field, robot, campaign, rules };

std::string_view to_string(FileKind kind) {
  switch (kind) {
    case FileKind::mission:
      return "mission";
    case FileKind::world:
      return "world";
    case FileKind::field:
      return "field";
    case FileKind::robot:
      return "robot";
    case FileKind::campaign:
      return "campaign";
    case FileKind::rules:
      return "fuzzy rule base";
  }
  return "";
}

/// The kind of a YAML file shows in its keys: a campaign names a mission, a mission has a route, a
/// world a room, a field nothing
/// else, a robot a base.
FileKind kind_of(const ConfigNode& root) {
  const auto has_one_of = [&root](const std::vector<std::string>& keys) {
    return std::any_of(keys.begin(), keys.end(),
                       [&root](const std::string& key) { return root.find(key) != nullptr; });
  };
  if (has_one_of({"mission", "seeds", "variants"})) return FileKind::campaign;
  if (has_one_of({"route", "start", "world"})) return FileKind::mission;
  if (has_one_of({"room", "landmarks"})) return FileKind::world;
  if (has_one_of({"field"})) return FileKind::field;
  if (has_one_of({"head", "base", "camera", "zoom", "cameras", "range_ring"}))
    return FileKind::robot;
  return FileKind::mission;
}

std::string check_kind(FileKind kind, const std::shared_ptr<ConfigNode>& root,
                       const CheckOptions& options) {
  switch (kind) {
    case FileKind::mission:
      return check_mission(options);
    case FileKind::world:
      return check_world(root);
    case FileKind::field:
      return check_field(root);
    case FileKind::robot:
      return check_robot(root);
    case FileKind::campaign:
      return check_campaign(options);
    case FileKind::rules:
      return check_rules(options.file);
  }
  return "";
}

int check(const CheckOptions& options) {
  const bool rules = std::filesystem::path(options.file).extension() == ".fll";
  const auto root = rules ? nullptr : load_config(options.file);
  const FileKind kind = rules ? FileKind::rules : kind_of(*root);
  try {
    fmt::print("{}: a {}, {}\n", options.file, to_string(kind), check_kind(kind, root, options));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} (checked as a {})", error.what(), to_string(kind)));
  }
  return 0;
}

}  // namespace

void add_check(CLI::App& app, int& status) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand(
      "check", "Validate a mission, world, field, robot, campaign or fuzzy rule base");
  command->add_option("file", options->file, "YAML or .fll file")->required();
  command->add_option("--set", options->overrides, "Override a key of a mission")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->callback([options, &status] { status = check(*options); });
}

}  // namespace vigia::app

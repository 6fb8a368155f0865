#include "commands.hpp"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "vigia/mission/setup.hpp"

namespace vigia::app {
namespace {

struct CheckOptions {
  std::string file;
  std::vector<std::string> overrides;
};

int check(const CheckOptions& options) {
  const auto root = load_config(options.file);
  // The kind of a file shows in its keys: a mission has a route, a world landmarks, a robot a head.
  if (root->find("landmarks") != nullptr) {
    MapReader reader(root, "world");
    const WorldMap world = read_world_map(reader);
    sim::read_appearance(reader, world);
    reader.finish();
    fmt::print("{}: a world, \"{}\", with {} landmarks\n", options.file, world.name,
               world.landmarks.all().size());
  } else if (root->find("head") != nullptr && root->find("route") == nullptr) {
    MapReader reader(root, "robot");
    const auto robot = sim::read_robot_setup(reader);
    reader.finish();
    fmt::print("{}: a robot, \"{}\"\n", options.file, robot.name);
  } else {
    const auto setup = mission::load_mission(options.file, options.overrides);
    fmt::print("{}: a mission, \"{}\", {:.1f} m, policy {}\n", options.file, setup.name,
               setup.path.length(), setup.look.policy);
  }
  return 0;
}

}  // namespace

void add_check(CLI::App& app, int& status) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand("check", "Validate a mission, world or robot file");
  command->add_option("file", options->file, "YAML file")->required();
  command->add_option("--set", options->overrides, "Override a key of a mission")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->callback([options, &status] { status = check(*options); });
}

}  // namespace vigia::app

// Any text is either a world whose plan answers with finite numbers, or an InputError.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "vigia/core/world_map.hpp"

namespace {

void check(const vigia::WorldMap& world) {
  const Eigen::Vector2d middle = 0.5 * (world.plan.min_corner() + world.plan.max_corner());
  if (!std::isfinite(world.plan.clearance(middle))) std::abort();
  if (const auto hit = world.plan.cast(middle, Eigen::Vector2d::UnitX(), 1e4))
    if (!(hit->distance_m >= 0.0) || hit->wall >= world.plan.faces().size()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Files of the machine are no part of the input.
  if (text.find("extends") != std::string::npos) return -1;
  try {
    vigia::MapReader reader(vigia::parse_config(text, "input.yaml"), "world");
    check(vigia::read_world_map(reader));
    reader.finish();
  } catch (const vigia::InputError&) {
    return 0;
  }
  return 0;
}

// Any text is either a field whose queries answer with finite numbers, or an InputError.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "vigia/core/field_map.hpp"

namespace {

void check_field(const vigia::FieldMap& map) {
  const vigia::FieldDistance distance(map, 0.6, 0.5);
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(1.0, -0.7)}) {
    if (!std::isfinite(distance.distance(p))) std::abort();
    for (const vigia::FieldLine& line : map.lines)
      if (!std::isfinite(vigia::distance_to_line(line, p))) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Files of the machine are no part of the input.
  if (text.find("extends") != std::string::npos) return -1;
  try {
    vigia::MapReader reader(vigia::parse_config(text, "input.yaml"), "file");
    check_field(vigia::read_field_map(reader.map("field")));
    reader.finish();
  } catch (const vigia::InputError&) {
    return 0;
  }
  return 0;
}

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "vigia/core/config.hpp"
#include "vigia/core/world_map.hpp"

// Any text either reads as a configuration or ends in InputError; what reads as a world is written
// and read back. libFuzzer reports every other way out: another exception, an abort, a hang.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const auto root = vigia::parse_config(text, "fuzz.yaml");
    const auto again = vigia::parse_config(vigia::dump_config(*root), "dump.yaml");
    if (vigia::dump_config(*again) != vigia::dump_config(*root)) std::abort();
    vigia::MapReader reader(root, "");
    vigia::read_world_map(reader);
    reader.finish();
  } catch (const vigia::InputError&) {
    return 0;
  }
  return 0;
}

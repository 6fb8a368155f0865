// Any text is either a configuration, which survives being written and read back, or an InputError.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "vigia/core/config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  // Files of the machine are no part of the input.
  if (text.find("extends") != std::string::npos) return -1;
  try {
    const std::string once = vigia::dump_config(*vigia::parse_config(text, "input.yaml"));
    const std::string twice = vigia::dump_config(*vigia::parse_config(once, "dump.yaml"));
    if (once != twice) std::abort();
  } catch (const vigia::InputError& error) {
    if (std::string(error.what()).rfind("dump.yaml", 0) == 0) std::abort();
  }
  return 0;
}

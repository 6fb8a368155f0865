// Any text is either a fuzzy system that answers with a number everywhere, or an InputError.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "vigia/core/error.hpp"
#include "vigia/planner/fuzzy_engine.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    auto engine = vigia::planner::FuzzyEngine::read(text, "input.fll");
    for (const double x : {-1e12, 0.0, 0.37, 5.0, 1e12}) {
      const std::vector<double> inputs(engine.input_names().size(), x);
      if (!std::isfinite(engine.evaluate(inputs))) std::abort();
    }
  } catch (const vigia::InputError&) {
    return 0;
  }
  return 0;
}

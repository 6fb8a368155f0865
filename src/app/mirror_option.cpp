#include "mirror_option.hpp"

#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "vigia/core/error.hpp"

namespace vigia::app {

std::optional<std::vector<double>> parse_numbers(const std::string& text, std::size_t count) {
  std::vector<double> numbers;
  std::istringstream list(text);
  for (std::string field; std::getline(list, field, ',');) {
    double value = 0.0;
    const char* end = field.data() + field.size();
    const auto result = std::from_chars(field.data(), end, value);
    if (field.empty() || result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
      return std::nullopt;
    numbers.push_back(value);
  }
  if (numbers.size() != count || text.back() == ',') return std::nullopt;
  return numbers;
}

std::optional<tracking::MirrorImage> parse_mirror(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto n = parse_numbers(text, 4);
  if (!n || !((*n)[2] >= 0.0) || !((*n)[3] > (*n)[2]) || !((*n)[3] <= 1e5))
    throw InputError(
        fmt::format("--mirror: found '{}', must be U,V,INNER,OUTER, in pixels, with "
                    "0 ≤ INNER < OUTER ≤ 100000",
                    text));
  return tracking::MirrorImage{{(*n)[0], (*n)[1]}, (*n)[2], (*n)[3]};
}

}  // namespace vigia::app

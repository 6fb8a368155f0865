#include "object_file.hpp"

#include <fstream>

#include <fmt/format.h>

namespace vigia::app {

ObjectFile object_in(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMaxBytes = 64U << 20U;
  const std::string name = file.filename().string();
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(file, missing);
  if (missing) return {nullptr, fmt::format("there is no {}", name)};
  if (bytes > kMaxBytes) return {nullptr, fmt::format("{} is too large to be one", name)};
  std::ifstream stream(file);
  auto values = nlohmann::ordered_json::parse(stream, nullptr, false);
  if (!values.is_object()) return {nullptr, fmt::format("{} is no JSON object", name)};
  return {std::move(values), {}};
}

}  // namespace vigia::app

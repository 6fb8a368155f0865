#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace vigia::app {

/// The JSON object that a file holds, or null with @p fault saying why there is none.
struct ObjectFile {
  nlohmann::ordered_json values;
  std::string fault;
};

/// Reads a file that is at most as large as any that vigia writes.
ObjectFile object_in(const std::filesystem::path& file);

}  // namespace vigia::app

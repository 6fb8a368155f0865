#pragma once

#include <nlohmann/json.hpp>

namespace vigia::evaluation {

/// Keeps the order in which keys were added.
using Json = nlohmann::ordered_json;

}  // namespace vigia::evaluation

#pragma once

#include "json.hpp"

#include "vigia/evaluation/provenance.hpp"

namespace vigia::evaluation {

Json provenance_json(const Provenance& provenance);
/// Members that are missing are empty.
Provenance provenance_from(const Json& json);

}  // namespace vigia::evaluation

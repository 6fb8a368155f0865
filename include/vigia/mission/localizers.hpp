#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vigia/core/name_table.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::mission {

struct LocalizerEntry : NameEntry {
  bool usual;  ///< cheap: runs wherever it fits, unless the mission names its localizers
  bool (*fits)(const MissionSetup& setup);  ///< whether robot and world have what it needs
  std::unique_ptr<localization::Localizer> (*make)(const MissionSetup& setup);
};

/// Every localizer, in the order of a run's tables.
const std::vector<LocalizerEntry>& localizers();

/// The usual ones that fit.
std::vector<std::string> usual_localizers(const MissionSetup& setup);

}  // namespace vigia::mission

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vigia/core/name_table.hpp"
#include "vigia/core/stamp.hpp"
#include "vigia/localization/ceiling_model.hpp"
#include "vigia/localization/corner_filter.hpp"
#include "vigia/localization/localizer.hpp"
#include "vigia/mission/setup.hpp"

namespace vigia::mission {

/// Where a localizer has its first pose from, where the mission gives no prior.
enum class FirstPose {
  prior,     ///< it cannot start without one
  recovery,  ///< from the recovery, if it is the primary and the head directs a camera
  looks,     ///< from looks, if the head directs a camera
  itself,    ///< it finds itself
};

/// Which images a localizer learns from, and how late they may come.
struct LateImages {
  std::string eye;  ///< that reads them; empty: it learns from none
  Duration (*history)(const MissionSetup& setup);
  std::string key;  ///< of a mission, that sets it; empty: none does
};

struct LocalizerEntry : NameEntry {
  bool usual;  ///< cheap: runs wherever it fits, unless the mission names its localizers
  FirstPose first_pose;
  bool (*fits)(const MissionSetup& setup);  ///< whether robot and world have what it needs
  /// @p seed: the mission's, of a localizer that draws.
  std::unique_ptr<localization::Localizer> (*make)(const MissionSetup& setup, std::uint64_t seed);
  LateImages late;
};

/// Every localizer, in the order of a run's tables.
const std::vector<LocalizerEntry>& localizers();

/// Whether the mission wants the ceiling's flow to move that localizer on.
bool moved_by_flow(const MissionSetup& setup, const std::string& localizer);

/// The localizer of that name, moved on by the ceiling's flow as well where the mission says so.
std::unique_ptr<localization::Localizer> make_localizer(const MissionSetup& setup,
                                                        const std::string& name,
                                                        std::uint64_t seed);

/// Whether the localizer cannot be part of the mission unless that gives a prior.
bool needs_prior(const LocalizerEntry& entry, const MissionSetup& setup);

/// The first camera that looks up at the world's ceiling of patches, if there are both.
std::optional<localization::CeilingCamera> ceiling_camera(const MissionSetup& setup);

/// What the corners of the goals are measured with, where the robot's cameras are a stereo pair and
/// the world has a field with goals.
std::optional<localization::CornerFilterParams> corner_filter_params(const MissionSetup& setup);

/// The usual ones that fit and can start; where images come late, without those that take none.
std::vector<std::string> usual_localizers(const MissionSetup& setup);

}  // namespace vigia::mission

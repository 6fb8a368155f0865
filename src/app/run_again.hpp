#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/listener.hpp"

namespace vigia::app {

/// A mission file of a run folder. Throws InputError where there is none.
std::filesystem::path mission_file(const std::filesystem::path& folder);

/// Drives @p setup, the mission of a run folder, again for those who listen; @p scorer is told of
/// everything before them. @returns what to say where the drive differs from the folder's
/// summary.json, as after a change of version, or nothing.
std::string run_again(const std::filesystem::path& folder, const mission::MissionSetup& setup,
                      evaluation::DriveScorer& scorer,
                      const std::vector<mission::Listener*>& listeners);

}  // namespace vigia::app

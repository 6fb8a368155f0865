#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vigia/evaluation/drive_score.hpp"
#include "vigia/mission/listener.hpp"

namespace vigia::app {

/// A mission file of a run folder. Throws InputError where there is none.
std::filesystem::path mission_file(const std::filesystem::path& folder);

/// Drives a run folder's mission again, for those who listen; @p scorer is told of everything
/// before them. @returns what to say where the drive differs from the folder's summary.json, as
/// after a change of version, or nothing. Throws InputError for a folder that is none, or whose
/// mission the program does not read.
std::string run_again(const std::filesystem::path& folder, evaluation::DriveScorer& scorer,
                      const std::vector<mission::Listener*>& listeners);

}  // namespace vigia::app

#pragma once

#include <string>
#include <vector>

#include "vigia/report/replay_page.hpp"

namespace vigia::report {

/// The data of a replay page as JSON.
std::string replay_json(const std::vector<ReplayRun>& runs, const std::string& title,
                        int max_ticks);

}  // namespace vigia::report

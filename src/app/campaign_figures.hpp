#pragma once

#include <filesystem>
#include <string>

namespace vigia::app {

/// The page of a campaign's folder: what its summary.json and results.csv say, and nothing else. A
/// table that is missing or too large is said on the page. Throws InputError for a summary that is
/// missing or none, and for a table that was cut off.
std::string campaign_page_of(const std::filesystem::path& folder);

}  // namespace vigia::app

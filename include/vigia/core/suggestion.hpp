#pragma once

#include <string>
#include <vector>

namespace vigia {

/// Insertions, deletions and substitutions of a byte that turn one text into the other
/// (Levenshtein's distance).
std::size_t edit_distance(const std::string& a, const std::string& b);

/// "; did you mean 'x'?" for the candidate that lies near enough to be a slip, or nothing.
std::string suggestion(const std::string& given, const std::vector<std::string>& candidates);

/// The names with commas between them.
std::string joined(const std::vector<std::string>& names);

}  // namespace vigia

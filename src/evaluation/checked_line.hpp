#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vigia::evaluation {

/// 64-bit FNV-1a.
std::uint64_t fnv1a(std::string_view bytes);
/// As sixteen hexadecimal digits.
std::string fingerprint(std::string_view bytes);

/// A JSON object with a last member "check", the fingerprint of all before it, and a line feed.
std::string checked_line(const std::string& object);
/// The object of a line (without its line feed), or nothing when it is not whole.
std::optional<std::string> unchecked(std::string_view line);

}  // namespace vigia::evaluation

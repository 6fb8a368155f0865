#include "checked_line.hpp"

#include <fmt/format.h>

namespace vigia::evaluation {
namespace {

constexpr std::string_view kMember = ",\"check\":\"";
constexpr std::size_t kTail = kMember.size() + 16 + 2;  // the member, its digits, and "}

}  // namespace

std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return hash;
}

std::string fingerprint(std::string_view bytes) {
  return fmt::format("{:016x}", fnv1a(bytes));
}

std::string checked_line(const std::string& object) {
  const std::string open = object.substr(0, object.size() - 1);
  return fmt::format("{}{}{}\"}}\n", open, kMember, fingerprint(open));
}

std::optional<std::string> unchecked(std::string_view line) {
  if (line.size() < kTail) return std::nullopt;
  const std::string open(line.substr(0, line.size() - kTail));
  if (fmt::format("{}{}\"}}", kMember, fingerprint(open)) != line.substr(open.size()))
    return std::nullopt;
  return open + "}";
}

}  // namespace vigia::evaluation

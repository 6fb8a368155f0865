#include "vigia/imaging/stream_address.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "vigia/core/error.hpp"

namespace vigia::imaging {
namespace {

constexpr std::string_view kAfterScheme = "://";
constexpr std::size_t kLongest = 2048;

bool is_alphanumeric(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

bool all_of(std::string_view text, std::string_view marks) {
  return std::all_of(text.begin(), text.end(), [&](char c) {
    return is_alphanumeric(c) || marks.find(c) != std::string_view::npos;
  });
}

bool percent_escapes_are_whole(std::string_view text) {
  for (std::size_t at = text.find('%'); at != std::string_view::npos; at = text.find('%', at + 1))
    if (at + 2 >= text.size() || !std::isxdigit(static_cast<unsigned char>(text[at + 1])) ||
        !std::isxdigit(static_cast<unsigned char>(text[at + 2])))
      return false;
  return true;
}

bool is_host(std::string_view text) {
  if (text.size() > 2 && text.front() == '[' && text.back() == ']') {
    const std::string_view inner = text.substr(1, text.size() - 2);
    return std::all_of(inner.begin(), inner.end(), [](char c) {
      return std::isxdigit(static_cast<unsigned char>(c)) != 0 || c == ':' || c == '.';
    });
  }
  return !text.empty() && text.front() != '-' && all_of(text, ".-_");
}

bool is_port(std::string_view text) {
  if (text.empty() || text.size() > 5 || !std::all_of(text.begin(), text.end(), [](char c) {
        return std::isdigit(static_cast<unsigned char>(c)) != 0;
      }))
    return false;
  const int port = std::stoi(std::string(text));
  return port >= 1 && port <= 65535;
}

// Up to the last '@' anything may be a part of a password, and so may a query.
std::string without_secrets(const std::string& text) {
  const std::size_t start = text.find(kAfterScheme) + kAfterScheme.size();
  const std::size_t at = text.rfind('@');
  std::string rest = text.substr(at == std::string::npos || at < start ? start : at + 1);
  rest.resize(std::min(rest.find_first_of("?#"), rest.size()));
  std::string shown = text.substr(0, start) + rest;
  for (char& c : shown)
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = ' ';
  constexpr std::size_t kShown = 120;
  return shown.size() > kShown ? shown.substr(0, kShown) + "…" : shown;
}

struct Parts {
  std::string_view scheme, user, host, port, path;
};

// The host's end: a port's colon, but none within the brackets of an IPv6 address.
Parts split(std::string_view text) {
  Parts parts;
  const std::size_t after = text.find(kAfterScheme);
  parts.scheme = text.substr(0, after);
  text.remove_prefix(after + kAfterScheme.size());
  const std::size_t authority_end = std::min(text.find_first_of("/?"), text.size());
  std::string_view authority = text.substr(0, authority_end);
  parts.path = text.substr(authority_end);
  if (const std::size_t at = authority.rfind('@'); at != std::string_view::npos) {
    parts.user = authority.substr(0, at);
    authority.remove_prefix(at + 1);
  }
  const std::size_t bracket = authority.rfind(']');
  const std::size_t colon = authority.find(':', bracket == std::string_view::npos ? 0 : bracket);
  parts.host = authority.substr(0, colon);
  if (colon != std::string_view::npos) parts.port = authority.substr(colon);
  return parts;
}

}  // namespace

bool is_address(const std::string& text) {
  return text.find(kAfterScheme) != std::string::npos;
}

StreamAddress parse_address(const std::string& text) {
  const std::string label = without_secrets(text);
  const Parts parts = split(text);
  constexpr std::array<std::string_view, 4> kSchemes{"rtsp", "rtsps", "http", "https"};
  if (std::find(kSchemes.begin(), kSchemes.end(), parts.scheme) == kSchemes.end())
    throw InputError({label},
                     "a camera's address begins with rtsp://, rtsps://, http:// or "
                     "https://");
  if (text.size() > kLongest) throw InputError({label}, "an address of more than 2048 characters");
  if (!is_host(parts.host)) throw InputError({label}, "this address has no valid host name");
  if (!parts.port.empty() && !is_port(parts.port.substr(1)))
    throw InputError({label}, "the port after the host must lie in [1, 65535]");
  constexpr std::string_view kUserMarks = "-._~%$&+,=:";
  constexpr std::string_view kPathMarks = "-._~%$&+,=:@/?";
  if (!all_of(parts.user, kUserMarks) || !percent_escapes_are_whole(parts.user))
    throw InputError({label},
                     "user name and password: write characters other than letters, "
                     "digits and -._~$&+,= as %xx");
  if (!all_of(parts.path, kPathMarks) || !percent_escapes_are_whole(parts.path))
    throw InputError({label},
                     "path and query: write characters other than letters, digits and "
                     "-._~$&+,=:@/? as %xx");
  return {text, label};
}

}  // namespace vigia::imaging

#pragma once

#include <string>

namespace vigia::imaging {

/// The address of a live camera, checked: only what this accepts is handed to a capture, so that no
/// text of a pipeline, no file and no other protocol can be smuggled into one.
struct StreamAddress {
  std::string url;    ///< as given, with user name and password: for the capture alone
  std::string label;  ///< without user, password and query: for tables, messages and logs
};

/// Whether @p text is meant as an address (it has a scheme).
bool is_address(const std::string& text);

/// Reads `scheme://[user[:password]@]host[:port][/path][?query]` with the scheme rtsp, rtsps, http
/// or https, in the characters of RFC 3986 less `!`, `'`, `(`, `)`, `*` and `;`, which a path or a
/// password writes as %xx. Throws InputError, whose message has neither password nor query.
StreamAddress parse_address(const std::string& text);

}  // namespace vigia::imaging

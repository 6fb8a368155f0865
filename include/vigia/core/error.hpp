#pragma once

#include <stdexcept>
#include <string>

namespace vigia {

/// Where in an input file something was found. Lines and columns count from 1; 0 means unknown.
struct SourceLocation {
  std::string file;  ///< path as the user gave it, or "--set" for a command-line override
  int line = 0;
  int column = 0;
};

/// "file:line:column", leaving out what is unknown.
std::string to_string(const SourceLocation& location);

/// Wrong input: a file, a value or an option that the user can put right. The program prints the
/// message and ends with exit status 2. Expected events of a mission are statuses, never this.
class InputError : public std::runtime_error {
 public:
  /// The message reads "file:line:column: what", where the location is known.
  InputError(const SourceLocation& location, const std::string& what);
  explicit InputError(const std::string& what) : std::runtime_error(what) {}
};

}  // namespace vigia

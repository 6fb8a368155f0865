#include "vigia/core/error.hpp"

namespace vigia {

std::string to_string(const SourceLocation& location) {
  std::string text = location.file;
  if (location.line > 0) text += ":" + std::to_string(location.line);
  if (location.line > 0 && location.column > 0) text += ":" + std::to_string(location.column);
  return text;
}

InputError::InputError(const SourceLocation& location, const std::string& what)
    : std::runtime_error(location.file.empty() ? what : to_string(location) + ": " + what) {}

}  // namespace vigia

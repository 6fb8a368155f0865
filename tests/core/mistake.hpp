#pragma once

#include <ostream>
#include <string>

namespace vigia {

/// A file's text and what is said of it.
struct Mistake {
  std::string text;
  std::string message;
};

inline void PrintTo(const Mistake& mistake, std::ostream* out) {
  *out << mistake.message;
}

}  // namespace vigia

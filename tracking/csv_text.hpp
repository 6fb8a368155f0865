#pragma once

#include <string>

namespace vigia::tracking {

/// A number with so many digits after the point.
std::string csv_number(double value, int digits);
/// A field as RFC 4180 has it: quoted where it holds a comma, a quote or a line's end.
std::string csv_field(const std::string& text);

}  // namespace vigia::tracking

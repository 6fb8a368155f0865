#pragma once

#include <string>

namespace vigia::report {

inline constexpr double kMetresPerInch = 0.0254;

/// The PNG @p png with the size of its pixels (a pHYs chunk after the header), which Cairo leaves
/// out.
std::string with_resolution(const std::string& png, double dots_per_inch);

}  // namespace vigia::report

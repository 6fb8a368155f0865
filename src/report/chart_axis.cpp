#include "chart_axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vigia::report {
namespace {

constexpr int kSteps = 8;

}  // namespace

double round_step(double range, int steps) {
  const double rough = range / steps;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= rough) return factor * decade;
  return 10.0 * decade;
}

ChartAxis::ChartAxis(double low, double high, bool logarithmic) : logarithmic_(logarithmic) {
  if (logarithmic_) {
    from_ = std::log(low / 1.3);
    to_ = std::log(high * 1.3);
    const double first = std::floor(std::log10(low / 1.3));
    for (double decade = first; std::pow(10.0, decade) <= high * 1.3; ++decade)
      for (const double factor : {1.0, 2.0, 5.0}) {
        const double tick = factor * std::pow(10.0, decade);
        if (std::log(tick) >= from_ && std::log(tick) <= to_) ticks_.push_back(tick);
      }
    return;
  }
  // Arms that are all alike still get an axis.
  const double span = std::max(high - low, 0.05 * std::max(1.0, std::abs(high)));
  step_ = round_step(1.2 * span, kSteps);
  from_ = step_ * std::floor((low - 0.08 * span) / step_);
  to_ = step_ * std::ceil((high + 0.08 * span) / step_);
  const int count = static_cast<int>(std::lround((to_ - from_) / step_));
  for (int i = 0; i <= count; ++i) ticks_.push_back(from_ + i * step_);
}

double ChartAxis::scaled(double value) const {
  return logarithmic_ ? std::log(std::max(value, 1e-12)) : value;
}

double ChartAxis::fraction(double value) const {
  return std::clamp((scaled(value) - from_) / (to_ - from_), 0.0, 1.0);
}

std::string ChartAxis::label(double tick) const {
  const double unit = logarithmic_ ? tick : step_;
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(unit) + 1e-9)));
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, tick == 0.0 ? 0.0 : tick);
  return text;
}

}  // namespace vigia::report

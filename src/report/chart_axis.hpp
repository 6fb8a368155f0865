#pragma once

#include <string>
#include <vector>

namespace vigia::report {

/// The smallest of 1, 2, 5 × 10ⁿ that divides @p range into at most @p steps steps.
double round_step(double range, int steps);

/// One axis of a chart: where a value lies between its ends, and where its ticks are.
class ChartAxis {
 public:
  /// Ends a little beyond [@p low, @p high], at a whole step; logarithmic needs low > 0.
  ChartAxis(double low, double high, bool logarithmic);

  /// 0 at the low end, 1 at the high end.
  double fraction(double value) const;
  const std::vector<double>& ticks() const { return ticks_; }
  /// A tick's figure, with as many decimals as its step needs.
  std::string label(double tick) const;

 private:
  double scaled(double value) const;

  bool logarithmic_;
  double step_ = 1.0;
  double from_ = 0.0;
  double to_ = 1.0;
  std::vector<double> ticks_;
};

}  // namespace vigia::report

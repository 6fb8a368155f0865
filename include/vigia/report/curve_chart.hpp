#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vigia::report {

/// Points joined by a line, or marked one by one.
struct Curve {
  enum class Look { line, dashed, marks };
  std::string name;
  std::vector<Eigen::Vector2d> points;
  Look look = Look::line;
};

struct CurveChart {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Curve> curves;
  bool equal_scales = false;  ///< a unit of x is as long as a unit of y: for plans
  bool from_zero = true;      ///< the axes show zero
  bool decades = false;       ///< y logarithmic; all y positive
};

/// Draws the chart to a PNG, SVG or PDF, as the file's ending says. Throws InputError for another
/// ending or when writing fails, std::invalid_argument when there is no point to draw or a
/// logarithm's is not positive.
void write_curve_chart(const std::filesystem::path& file, const CurveChart& chart);

}  // namespace vigia::report

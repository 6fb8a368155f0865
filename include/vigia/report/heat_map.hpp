#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vigia::report {

/// Values over a rectangle of floor, a colour a cell; NaN is left blank.
struct HeatMap {
  std::string title;
  std::string unit;  ///< of the values, for the key
  Eigen::Vector2d min_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d max_m = Eigen::Vector2d::Zero();
  int columns = 0;
  int rows = 0;
  std::vector<double> values;  ///< row by row from min y
  double top = 1.0;            ///< of the scale, which begins at zero; what is above has its colour
  /// Lines drawn over it, metres.
  std::vector<std::vector<Eigen::Vector2d>> lines;
};

/// Draws the map to a PNG, SVG or PDF, as the file's ending says. Throws InputError for another
/// ending or when writing fails, std::invalid_argument unless there are columns × rows values and
/// the scale has a length.
void write_heat_map(const std::filesystem::path& file, const HeatMap& map);

}  // namespace vigia::report

#pragma once

#include <vector>

#include <Eigen/Core>

namespace vigia {

/// A polyline parametrised by arc length, metres.
class Path {
 public:
  Path() = default;
  /// At least two distinct points; repeated neighbours are dropped. Throws std::invalid_argument.
  explicit Path(const std::vector<Eigen::Vector2d>& points);

  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  /// Arc length at each of points().
  const std::vector<double>& stations() const { return stations_; }
  double length() const { return stations_.empty() ? 0.0 : stations_.back(); }
  bool empty() const { return points_.empty(); }

  /// The point at arc length @p s, clamped to the path.
  Eigen::Vector2d at(double s) const;
  /// Direction of travel at @p s, radians; at a corner that of the segment that begins there.
  double heading(double s) const;
  /// Arc length of the point of the path nearest to @p p among stations in [from, to], which are
  /// clamped to the path. Throws std::invalid_argument unless from ≤ to.
  double project(const Eigen::Vector2d& p, double from, double to) const;
  /// Points every @p spacing of arc length, corners kept, the ends included.
  Path resampled(double spacing) const;

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> stations_;
};

}  // namespace vigia

#include "point_window.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::tracking {

using imaging::Window;

Window window_of(const std::vector<LabelledPoint>& points, double margin, const Window& frame) {
  Eigen::Vector2d low = points.front().uv;
  Eigen::Vector2d high = low;
  for (const LabelledPoint& point : points) {
    low = low.cwiseMin(point.uv);
    high = high.cwiseMax(point.uv);
  }
  // Far outside the frame any window is as good; this keeps the numbers whole.
  constexpr double kFar = 1e6;
  low = (low.array() - margin).max(-kFar).min(kFar);
  high = (high.array() + margin).max(-kFar).min(kFar);
  const int u = static_cast<int>(std::floor(low.x()));
  const int v = static_cast<int>(std::floor(low.y()));
  return intersect({u, v, static_cast<int>(std::ceil(high.x())) + 1 - u,
                    static_cast<int>(std::ceil(high.y())) + 1 - v},
                   frame);
}

Eigen::Vector2d middle_of(const std::vector<LabelledPoint>& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const LabelledPoint& point : points) sum += point.uv;
  return sum / static_cast<double>(points.size());
}

double extent_of(const std::vector<LabelledPoint>& points) {
  const Eigen::Vector2d middle = middle_of(points);
  double extent = 0.0;
  for (const LabelledPoint& point : points) extent = std::max(extent, (point.uv - middle).norm());
  return extent;
}

bool reaches_over(const std::vector<LabelledPoint>& points, const Window& frame) {
  return std::any_of(points.begin(), points.end(), [&](const LabelledPoint& point) {
    return point.uv.x() < 0.0 || point.uv.y() < 0.0 || point.uv.x() > frame.width - 1 ||
           point.uv.y() > frame.height - 1;
  });
}

double reach_of(const PointsPrediction& prediction) {
  return 3.0 * (std::sqrt(prediction.covariance.diagonal().maxCoeff()) +
                prediction.scale_sigma * extent_of(prediction.points));
}

}  // namespace vigia::tracking

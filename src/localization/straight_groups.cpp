#include "vigia/localization/straight_groups.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "vigia/localization/normal_density.hpp"

namespace vigia::localization {
namespace {

constexpr double kInlierSigmas = 3.0;
constexpr double kNearest_m = 0.3;  // two points nearer than this give no direction
constexpr int kRefits = 2;

struct Line {
  Eigen::Vector2d at;
  Eigen::Vector2d normal;
};

double variance_along(const FieldPoint& point, const Eigen::Vector2d& normal, double floor_m) {
  return normal.dot(point.covariance * normal) + floor_m * floor_m;
}

bool lies_on(const FieldPoint& point, const Line& line, double floor_m) {
  const double d = line.normal.dot(point.p_r - line.at);
  return d * d < kInlierSigmas * kInlierSigmas * variance_along(point, line.normal, floor_m);
}

std::vector<std::size_t> points_on(const std::vector<FieldPoint>& points,
                                   const std::vector<std::size_t>& free, const Line& line,
                                   double floor_m) {
  std::vector<std::size_t> on;
  for (const std::size_t i : free)
    if (lies_on(points[i], line, floor_m)) on.push_back(i);
  return on;
}

/// The line of most free points, of those through two of them.
std::vector<std::size_t> largest_group(const std::vector<FieldPoint>& points,
                                       const std::vector<std::size_t>& free, double floor_m,
                                       Line& best) {
  std::vector<std::size_t> largest;
  for (std::size_t i = 0; i < free.size(); ++i)
    for (std::size_t j = i + 1; j < free.size(); ++j) {
      const Eigen::Vector2d along = points[free[j]].p_r - points[free[i]].p_r;
      const double length = along.norm();
      if (length < kNearest_m) continue;
      const Line line{points[free[i]].p_r, Eigen::Vector2d(-along.y(), along.x()) / length};
      std::size_t count = 0;
      for (std::size_t k = 0; k < free.size() && count + free.size() - k > largest.size(); ++k)
        count += lies_on(points[free[k]], line, floor_m) ? 1 : 0;
      if (count <= largest.size()) continue;
      largest = points_on(points, free, line, floor_m);
      best = line;
    }
  return largest;
}

/// Total least squares, each point weighed by its variance across the line.
Line fitted_line(const std::vector<FieldPoint>& points, const std::vector<std::size_t>& group,
                 const Line& start, double floor_m) {
  double weights = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const std::size_t i : group) {
    const double weight = 1.0 / variance_along(points[i], start.normal, floor_m);
    weights += weight;
    mean += weight * points[i].p_r;
  }
  mean /= weights;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const std::size_t i : group) {
    const Eigen::Vector2d d = points[i].p_r - mean;
    spread += d * d.transpose() / variance_along(points[i], start.normal, floor_m);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(spread);
  return {mean, axes.eigenvectors().col(0)};
}

double density_on(const FieldPoint& point, const Line& line, double floor_m) {
  const double d = line.normal.dot(point.p_r - line.at);
  const double variance = variance_along(point, line.normal, floor_m);
  const double incidence = std::abs(line.normal.dot(point.p_r)) / std::max(1e-6, point.p_r.norm());
  return incidence * normal_density(d, variance);
}

}  // namespace

std::vector<StraightGroup> straight_groups(const std::vector<FieldPoint>& points, double floor_m,
                                           std::size_t min_points) {
  std::vector<std::size_t> free(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) free[i] = i;
  std::vector<StraightGroup> groups;
  while (free.size() >= min_points) {
    Line line;
    std::vector<std::size_t> on = largest_group(points, free, floor_m, line);
    for (int i = 0; i < kRefits && on.size() >= min_points; ++i) {
      line = fitted_line(points, on, line, floor_m);
      on = points_on(points, free, line, floor_m);
    }
    if (on.size() < min_points) break;
    StraightGroup group;
    group.points = on;
    for (const std::size_t i : on)
      group.line_densities.push_back(density_on(points[i], line, floor_m));
    groups.push_back(std::move(group));
    std::vector<std::size_t> left;
    std::set_difference(free.begin(), free.end(), on.begin(), on.end(), std::back_inserter(left));
    free = std::move(left);
  }
  return groups;
}

}  // namespace vigia::localization

#include "vigia/core/path.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace vigia {
namespace {

constexpr double kSamePoint = 1e-9;  // metres

/// Index of the segment that holds station @p s; at a corner the one that begins there.
std::size_t segment_at(const std::vector<double>& stations, double s) {
  if (stations.empty()) throw std::logic_error("the path is empty");
  const auto next = std::upper_bound(stations.begin() + 1, stations.end() - 1, s);
  return static_cast<std::size_t>(std::distance(stations.begin(), next)) - 1;
}

}  // namespace

Path::Path(const std::vector<Eigen::Vector2d>& points) {
  for (const Eigen::Vector2d& p : points) {
    if (!p.allFinite()) throw std::invalid_argument("a point of the path is not finite");
    const double step = points_.empty() ? 0.0 : (p - points_.back()).norm();
    if (!points_.empty() && step <= kSamePoint) continue;
    stations_.push_back(length() + step);
    points_.push_back(p);
  }
  if (points_.size() < 2) throw std::invalid_argument("a path needs two distinct points");
}

Eigen::Vector2d Path::at(double s) const {
  const std::size_t i = segment_at(stations_, s);
  const double t = std::clamp((s - stations_[i]) / (stations_[i + 1] - stations_[i]), 0.0, 1.0);
  return points_[i] + t * (points_[i + 1] - points_[i]);
}

double Path::heading(double s) const {
  const std::size_t i = segment_at(stations_, s);
  const Eigen::Vector2d along = points_[i + 1] - points_[i];
  return std::atan2(along.y(), along.x());
}

double Path::project(const Eigen::Vector2d& p, double from, double to) const {
  if (!(from <= to)) throw std::invalid_argument("the stations to project on are out of order");
  const double low = std::clamp(from, 0.0, length());
  const double high = std::clamp(to, 0.0, length());
  double best = low;
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = segment_at(stations_, low); i + 1 < points_.size() && stations_[i] <= high;
       ++i) {
    const double reach = best_distance + (stations_[i + 1] - stations_[i]) + kSamePoint;
    if ((p - points_[i]).squaredNorm() > reach * reach) continue;  // no point of it is nearer
    const Eigen::Vector2d along = (points_[i + 1] - points_[i]).normalized();
    const double s = std::clamp(stations_[i] + (p - points_[i]).dot(along),
                                std::max(low, stations_[i]), std::min(high, stations_[i + 1]));
    const double distance = (p - points_[i] - (s - stations_[i]) * along).norm();
    if (distance < best_distance) {
      best = s;
      best_distance = distance;
    }
  }
  return best;
}

Path Path::resampled(double spacing) const {
  if (!(spacing > kSamePoint)) throw std::invalid_argument("the spacing must be positive");
  std::vector<double> wanted = stations_;
  for (double k = 1.0; k * spacing < length(); k += 1.0) wanted.push_back(k * spacing);
  std::sort(wanted.begin(), wanted.end());
  std::vector<Eigen::Vector2d> points;
  points.reserve(wanted.size());
  for (const double s : wanted) points.push_back(at(s));
  return Path(points);
}

}  // namespace vigia

#include "vigia/core/landmark.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vigia {

Eigen::Isometry3d wall_mount(const Eigen::Vector3d& centre_w, double normal_yaw) {
  const Eigen::Vector3d z(std::cos(normal_yaw), std::sin(normal_yaw), 0.0);
  const Eigen::Vector3d y = Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d wMl = Eigen::Isometry3d::Identity();
  wMl.linear() << y.cross(z), y, z;
  wMl.translation() = centre_w;
  return wMl;
}

double half_width(const Landmark& landmark) {
  struct HalfWidth {
    double operator()(const DiscShape& disc) const { return disc.radius_m; }
    double operator()(const PatternShape& pattern) const { return pattern.sheet_half_width_m; }
    double operator()(const TagShape& tag) const { return tag.sheet_half_width_m(); }
  };
  return std::visit(HalfWidth{}, landmark.shape);
}

std::optional<double> disc_radius(const Landmark& landmark) {
  if (const auto* disc = std::get_if<DiscShape>(&landmark.shape)) return disc->radius_m;
  return std::nullopt;
}

double extent_radius(const Landmark& landmark) {
  struct Extent {
    double operator()(const DiscShape& disc) const { return disc.radius_m; }
    double operator()(const PatternShape& pattern) const {
      return pattern.outer_radius_m + pattern.dot_radius_m;
    }
    double operator()(const TagShape& tag) const { return tag.side_m / std::sqrt(2.0); }
  };
  return std::visit(Extent{}, landmark.shape);
}

LandmarkMap::LandmarkMap(std::vector<Landmark> landmarks) : landmarks_(std::move(landmarks)) {
  std::sort(landmarks_.begin(), landmarks_.end(),
            [](const Landmark& a, const Landmark& b) { return a.id < b.id; });
  const auto twin =
      std::adjacent_find(landmarks_.begin(), landmarks_.end(),
                         [](const Landmark& a, const Landmark& b) { return a.id == b.id; });
  if (twin != landmarks_.end())
    throw std::invalid_argument("landmark id " + std::to_string(twin->id) + " occurs twice");
}

const Landmark* LandmarkMap::find(LandmarkId id) const {
  const auto it =
      std::lower_bound(landmarks_.begin(), landmarks_.end(), id,
                       [](const Landmark& landmark, LandmarkId key) { return landmark.id < key; });
  return it != landmarks_.end() && it->id == id ? &*it : nullptr;
}

}  // namespace vigia

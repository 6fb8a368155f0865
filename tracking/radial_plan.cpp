#include "radial_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vigia::tracking {
namespace {

/// A sample by its pixels' places in the picture.
struct SamplePlace {
  int near = 0;
  int far = 0;
  float share = 0.0F;
};

/// One ray by its major axis: whole steps there, fractions across.
class RayWalk {
 public:
  RayWalk(const MirrorImage& mirror, double angle, int width, int height)
      : width_(width), size_(width, height), cos_(std::cos(angle)), sin_(std::sin(angle)) {
    major_ = std::abs(cos_) >= std::abs(sin_) ? 0 : 1;
    centre_ = mirror.centre;
    const double along = major_ == 0 ? cos_ : sin_;
    slope_ = (major_ == 0 ? sin_ : cos_) / along;
    sign_ = along > 0.0 ? 1 : -1;
    ray.step_px = 1.0 / std::abs(along);
    const double from = centre_[major_] + along * mirror.inner_px;
    at_ = static_cast<int>(sign_ > 0 ? std::ceil(from) : std::floor(from));
    ray.start_px = (at_ - centre_[major_]) / along;
    outer_px_ = mirror.outer_px > 0.0 ? mirror.outer_px : std::numeric_limits<double>::infinity();
  }

  /// Adds the samples up to the mirror's edge or the picture's border. A middle outside the picture
  /// has rays that enter it.
  void walk(std::vector<SamplePlace>& out) {
    for (; ray.radius(ray.count) <= outer_px_; at_ += sign_) {
      const auto place = sample();
      if (!place) {
        if (ray.count > 0 || !heads_inside()) return;
        ray.start_px += ray.step_px;
        continue;
      }
      out.push_back(*place);
      ++ray.count;
    }
  }

  PlannedRay ray;

 private:
  std::optional<SamplePlace> sample() const {
    const int minor = 1 - major_;
    const double across = centre_[minor] + slope_ * (at_ - centre_[major_]);
    const int low = static_cast<int>(std::floor(across));
    if (at_ < 0 || at_ >= size_[major_] || low < 0 || low + 1 >= size_[minor]) return std::nullopt;
    const auto index = [&](int offset) {
      return major_ == 0 ? (low + offset) * width_ + at_ : at_ * width_ + low + offset;
    };
    return SamplePlace{index(0), index(1), static_cast<float>(across - low)};
  }

  bool heads_inside() const { return sign_ > 0 ? at_ < size_[major_] : at_ >= 0; }

  int width_;
  Eigen::Vector2i size_;
  double cos_;
  double sin_;
  Eigen::Vector2d centre_;
  int major_ = 0;
  int sign_ = 1;
  int at_ = 0;
  double slope_ = 0.0;
  double outer_px_ = 0.0;
};

/// The runs of the marked pixels, and of each marked pixel its place among what they read.
std::vector<imaging::Run> marked_runs(std::vector<std::int32_t>& place, int width, int height) {
  std::vector<imaging::Run> runs;
  std::int32_t read = 0;
  for (int v = 0; v < height; ++v) {
    std::int32_t* row = place.data() + static_cast<std::ptrdiff_t>(v) * width;
    for (int u = 0; u < width; ++u) {
      if (row[u] < 0) continue;
      if (runs.empty() || runs.back().v != v || runs.back().u_end != u) runs.push_back({v, u, u});
      runs.back().u_end = u + 1;
      row[u] = read++;
    }
  }
  return runs;
}

}  // namespace

RadialPlan plan_rays(const MirrorImage& mirror, int rays, int width, int height) {
  RadialPlan plan;
  plan.width = width;
  plan.height = height;
  plan.middle = mirror.centre;
  std::vector<SamplePlace> places;
  for (int k = 0; k < rays; ++k) {
    RayWalk walk(mirror, 2.0 * kPi * k / rays, width, height);
    walk.ray.first = static_cast<int>(places.size());
    walk.walk(places);
    plan.rays.push_back(walk.ray);
  }
  std::vector<std::int32_t> place(
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height), -1);
  for (const SamplePlace& sample : places) {
    place[static_cast<std::size_t>(sample.near)] = 0;
    place[static_cast<std::size_t>(sample.far)] = 0;
  }
  plan.runs = marked_runs(place, width, height);
  plan.pixels = imaging::pixels_in(plan.runs);
  plan.samples.reserve(places.size());
  for (const SamplePlace& sample : places)
    plan.samples.push_back({place[static_cast<std::size_t>(sample.near)],
                            place[static_cast<std::size_t>(sample.far)], sample.share});
  return plan;
}

}  // namespace vigia::tracking

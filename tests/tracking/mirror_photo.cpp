#include "tracking/mirror_photo.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"

namespace vigia::tracking::testing {
namespace {

double off_stripe(const MirrorScene::Stripe& stripe, const Eigen::Vector2d& p) {
  const Eigen::Vector2d along = stripe.b - stripe.a;
  const double s = std::clamp((p - stripe.a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - stripe.a - s * along).norm() - 0.5 * stripe.width_m;
}

double off_ring(const MirrorScene::Ring& ring, const Eigen::Vector2d& p) {
  return std::abs((p - ring.centre).norm() - ring.radius_m) - 0.5 * ring.width_m;
}

/// Where a ray over the floor enters a box; nothing where it passes.
std::optional<double> enter_box(const MirrorScene::Box& box, const Eigen::Vector2d& from,
                                const Eigen::Vector2d& direction) {
  double near = 0.0;
  double far = 1e9;
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(direction[axis]) < 1e-12) {
      if (from[axis] < box.low[axis] || from[axis] > box.high[axis]) return std::nullopt;
      continue;
    }
    const double a = (box.low[axis] - from[axis]) / direction[axis];
    const double b = (box.high[axis] - from[axis]) / direction[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  if (near > far || near <= 0.0) return std::nullopt;
  return near;
}

cv::Vec3f floor_colour(const MirrorScene& scene, const Eigen::Vector2d& p) {
  for (const auto& stripe : scene.stripes)
    if (off_stripe(stripe, p) <= 0.0) return stripe.paint;
  for (const auto& ring : scene.rings)
    if (off_ring(ring, p) <= 0.0) return ring.paint;
  const bool carpet = (p.array() >= scene.carpet_low.array()).all() &&
                      (p.array() <= scene.carpet_high.array()).all();
  return carpet ? kCarpet : cv::Vec3f(0.12F, 0.11F, 0.10F);
}

}  // namespace

std::optional<Eigen::Vector2d> MirrorScene::floor_at(double u, double v) const {
  const double r = std::hypot(u - u0, v - v0);
  const double theta = 2.0 * std::atan(r / focal_px);
  if (theta >= 0.5 * kPi - 1e-6) return std::nullopt;
  const double d = height_m * std::tan(theta);
  const double angle = std::atan2(v - v0, u - u0) + heading;
  return at + d * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

cv::Vec3f MirrorScene::colour_at(double u, double v) const {
  const double r = std::hypot(u - u0, v - v0);
  if (r > edge_px || r < body_px) return kBlackPaint;
  const double theta = 2.0 * std::atan(r / focal_px);
  const double angle = std::atan2(v - v0, u - u0) + heading;
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  const double rise = 1.0 / std::tan(theta);  // of the line of sight below the mirror, a metre
  double nearest = 1e9;
  cv::Vec3f seen(0.25F, 0.25F, 0.27F);
  for (const Box& box : boxes) {
    const auto entry = enter_box(box, at, direction);
    if (!entry || *entry >= nearest) continue;
    const double z = height_m - rise * *entry;
    if (z < 0.0 || z > box.height_m) continue;
    nearest = *entry;
    seen = box.upper && z > 0.5 * box.height_m ? *box.upper : box.paint;
  }
  if (nearest < 1e9) return seen;
  if (const auto p = floor_at(u, v)) return floor_colour(*this, *p);
  return seen;
}

cv::Mat3f MirrorScene::render() const {
  constexpr int kFine = 16;
  cv::Mat3f picture(height, width);
  RandomStream jitter(1, "mirror photo");
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      picture(v, u) = colour_at(u, v);
      if (!has_edge(u, v)) continue;
      cv::Vec3f sum(0.0F, 0.0F, 0.0F);
      for (int j = 0; j < kFine; ++j)
        for (int i = 0; i < kFine; ++i)
          sum += colour_at(u - 0.5 + (i + jitter.uniform(0.0, 1.0)) / kFine,
                           v - 0.5 + (j + jitter.uniform(0.0, 1.0)) / kFine);
      picture(v, u) = sum * (1.0F / (kFine * kFine));
    }
  return picture;
}

bool MirrorScene::has_edge(int u, int v) const {
  // Lines are a third of a pixel wide at least.
  constexpr int kProbes = 4;
  const cv::Vec3f first = colour_at(u, v);
  for (int j = 0; j <= kProbes; ++j)
    for (int i = 0; i <= kProbes; ++i)
      if (colour_at(u - 0.5 + static_cast<double>(i) / kProbes,
                    v - 0.5 + static_cast<double>(j) / kProbes) != first)
        return true;
  return false;
}

std::vector<MirrorScene::Crossing> MirrorScene::crossings(double angle) const {
  constexpr double kStep = 0.02;  // px
  std::vector<Crossing> found;
  const auto white = [&](double r) {
    const double u = u0 + r * std::cos(angle);
    const double v = v0 + r * std::sin(angle);
    const auto p = floor_at(u, v);
    return p && floor_colour(*this, *p) == kWhitePaint && colour_at(u, v) == kWhitePaint;
  };
  bool before = false;
  for (double r = body_px; r < edge_px; r += kStep) {
    const bool now = white(r);
    if (now && !before) found.push_back({r - 0.5 * kStep, r});
    if (now) found.back().outer_px = r + 0.5 * kStep;
    before = now;
  }
  return found;
}

MirrorScene field_scene() {
  MirrorScene scene;
  const auto stripe = [&](double ax, double ay, double bx, double by) {
    scene.stripes.push_back({{ax, ay}, {bx, by}, 0.125, kWhitePaint});
  };
  stripe(-6, -4, 6, -4);
  stripe(-6, 4, 6, 4);
  stripe(-6, -4, -6, 4);
  stripe(6, -4, 6, 4);
  stripe(0, -4, 0, 4);
  for (const double side : {-1.0, 1.0}) {
    stripe(side * 6, -1.75, side * 5.25, -1.75);
    stripe(side * 6, 1.75, side * 5.25, 1.75);
    stripe(side * 5.25, -1.75, side * 5.25, 1.75);
  }
  scene.rings.push_back({{0.0, 0.0}, 1.5, 0.125, kWhitePaint});
  scene.boxes.push_back({{-6.6, -1.0}, {-6.07, 1.0}, 0.9, kYellowPaint, std::nullopt});
  scene.boxes.push_back({{6.07, -1.0}, {6.6, 1.0}, 0.9, kBluePaint, std::nullopt});
  for (const double x : {-6.0, 6.0})
    for (const double y : {-4.0, 4.0})
      scene.boxes.push_back({{x - 0.1, y - 0.1},
                             {x + 0.1, y + 0.1},
                             0.8,
                             x < 0 ? kYellowPaint : kBluePaint,
                             x < 0 ? kBluePaint : kYellowPaint});
  return scene;
}

}  // namespace vigia::tracking::testing

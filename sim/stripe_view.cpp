#include "stripe_view.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace vigia::sim {
namespace {

/// A corner of what is left of a pixel, and how far inside each side it lies (in the side's own
/// unit, negative: outside).
struct CutCorner {
  Eigen::Vector2d p;
  Eigen::Vector4d inside;
};

/// The part of a pixel inside some of the sides: four corners, and one more for each cut.
struct CutPixel {
  std::array<CutCorner, 8> corners;
  std::size_t count = 0;

  void add(const CutCorner& corner) { corners[count++] = corner; }
};

CutPixel cut(const CutPixel& pixel, int side) {
  CutPixel part;
  for (std::size_t i = 0; i < pixel.count; ++i) {
    const CutCorner& a = pixel.corners[i];
    const CutCorner& b = pixel.corners[i + 1 < pixel.count ? i + 1 : 0];
    const double from = a.inside[side];
    const double to = b.inside[side];
    if (from >= 0.0) part.add(a);
    if ((from < 0.0) == (to < 0.0)) continue;
    const double t = from / (from - to);
    part.add({a.p + t * (b.p - a.p), a.inside + t * (b.inside - a.inside)});
  }
  return part;
}

double area(const CutPixel& pixel) {
  double twice = 0.0;
  for (std::size_t i = 0; i < pixel.count; ++i) {
    const Eigen::Vector2d& a = pixel.corners[i].p;
    const Eigen::Vector2d& b = pixel.corners[i + 1 < pixel.count ? i + 1 : 0].p;
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

/// Share of a pixel inside all sides, from the four corners of its square.
double share_inside(const Eigen::Vector4d& a, const Eigen::Vector4d& b, const Eigen::Vector4d& c,
                    const Eigen::Vector4d& d) {
  const Eigen::Vector4d low = a.cwiseMin(b).cwiseMin(c).cwiseMin(d);
  if ((low.array() >= 0.0).all()) return 1.0;
  const Eigen::Vector4d high = a.cwiseMax(b).cwiseMax(c).cwiseMax(d);
  if ((high.array() <= 0.0).any()) return 0.0;
  CutPixel pixel;
  pixel.add({{0.0, 0.0}, a});
  pixel.add({{1.0, 0.0}, b});
  pixel.add({{1.0, 1.0}, c});
  pixel.add({{0.0, 1.0}, d});
  for (int side = 0; side < 4; ++side)
    if (low[side] < 0.0) pixel = cut(pixel, side);
  return area(pixel);
}

}  // namespace

std::vector<Eigen::Vector3d> corner_rays(const CameraModel& model, const imaging::Window& window) {
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(static_cast<std::size_t>(window.width + 1) *
                  static_cast<std::size_t>(window.height + 1));
  for (int v = window.v; v <= window.bottom(); ++v)
    for (int u = window.u; u <= window.right(); ++u)
      corners.push_back(point_ray(model, {u - 0.5, v - 0.5}));
  return corners;
}

StripeView::StripeView(const StripeMark& mark, const Eigen::Isometry3d& cMw) : mark_(&mark) {
  const Eigen::Isometry3d cMd = cMw * mark.wMd;
  faces_camera_ = cMd.linear().col(2).dot(cMd.translation()) < -1e-4;
  if (!faces_camera_) return;
  // The ray r meets the plane at (x, y)/w times (half length, half width): −w ≤ x, y ≤ w, which
  // holds for no w < 0.
  Eigen::Matrix3d cHd;
  cHd << mark.half_length_m * cMd.linear().col(0), mark.half_width_m * cMd.linear().col(1),
      cMd.translation();
  const Eigen::Matrix3d dHray = cHd.inverse();
  sides_ << dHray.row(2) - dHray.row(0), dHray.row(2) + dHray.row(0), dHray.row(2) - dHray.row(1),
      dHray.row(2) + dHray.row(1);
}

bool StripeView::touches(const RayBox& box) const {
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3f side = sides_.row(i).transpose().cast<float>();
    if (maximum({side.x(), side.y(), side.z()}, box) < 0.0F) return false;
  }
  return true;
}

std::vector<float> StripeView::coverage(const std::vector<Eigen::Vector3d>& corners,
                                        const imaging::Window& window) const {
  const auto inside = [this](const Eigen::Vector3d& r) {
    // A ray that shows nothing is outside.
    return r.isZero() ? Eigen::Vector4d(Eigen::Vector4d::Constant(-1.0))
                      : Eigen::Vector4d(sides_ * r);
  };
  const auto width = static_cast<std::size_t>(window.width);
  std::vector<Eigen::Vector4d> above(width + 1);
  std::vector<Eigen::Vector4d> below(width + 1);
  const Eigen::Vector3d* corner = corners.data();
  for (Eigen::Vector4d& at : below) at = inside(*corner++);
  std::vector<float> shares;
  shares.reserve(width * static_cast<std::size_t>(window.height));
  for (int row = 0; row < window.height; ++row) {
    above.swap(below);
    for (Eigen::Vector4d& at : below) at = inside(*corner++);
    for (std::size_t i = 0; i < width; ++i)
      shares.push_back(
          static_cast<float>(share_inside(above[i], above[i + 1], below[i + 1], below[i])));
  }
  return shares;
}

}  // namespace vigia::sim

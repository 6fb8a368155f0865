#include "decal.hpp"

#include "disc_coverage.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "vigia/core/angle.hpp"

namespace vigia::sim {
namespace {

using imaging::Window;

/// The decal's outline lies within this radius, in units of size_m.
double outline_radius(DecalShape shape) {
  switch (shape) {
    case DecalShape::square_plate:
    case DecalShape::square:
      return std::sqrt(2.0);
    case DecalShape::blob:
      return 1.35;
    default:
      return 1.0;
  }
}

/// Whether the decal can reach the image at all, judged by a sphere round it.
bool may_be_seen(const Eigen::Vector3d& centre_c, double radius, const Intrinsics& k) {
  const double depth = centre_c.z() - radius;
  if (depth <= 1e-3) return centre_c.z() + radius > 0.0;
  const auto uv = project(k, centre_c);
  if (!uv) return true;
  const double reach =
      2.0 * radius / depth * std::max(k.px, k.py) * (1.0 + centre_c.head<2>().norm() / depth) + 4.0;
  return in_image(k, *uv, -reach);
}

/// Whole pixels round the image of the circle of radius @p radius, or an empty window.
Window outline_box(const Eigen::Isometry3d& cMd, double radius, const Intrinsics& k) {
  constexpr int kSamples = 32;
  double u0 = 1e9;
  double v0 = 1e9;
  double u1 = -1e9;
  double v1 = -1e9;
  for (int i = 0; i < kSamples; ++i) {
    const double angle = 2.0 * kPi * i / kSamples;
    const auto uv =
        project(k, cMd * Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.0));
    if (!uv) return {};
    u0 = std::min(u0, uv->x());
    v0 = std::min(v0, uv->y());
    u1 = std::max(u1, uv->x());
    v1 = std::max(v1, uv->y());
  }
  if (u1 < -1e5 || v1 < -1e5 || u0 > 1e5 || v0 > 1e5 || u1 - u0 > 1e5 || v1 - v0 > 1e5) return {};
  // The arc between two samples bulges by less than 1 % of the width.
  const double bulge_u = 1.0 + 0.02 * (u1 - u0);
  const double bulge_v = 1.0 + 0.02 * (v1 - v0);
  const Window box{static_cast<int>(std::floor(u0 - bulge_u)),
                   static_cast<int>(std::floor(v0 - bulge_v)), 0, 0};
  return {box.u, box.v, static_cast<int>(std::ceil(u1 + bulge_u)) + 1 - box.u,
          static_cast<int>(std::ceil(v1 + bulge_v)) + 1 - box.v};
}

Window grown(const Window& w, int margin) {
  return {w.u - margin, w.v - margin, w.width + 2 * margin, w.height + 2 * margin};
}

struct Implicit {
  double value;  ///< positive inside, about 1 in the middle
  double dx;
  double dy;
};

Implicit ellipse(double x, double y, double b) {
  return {1.0 - x * x - y * y / (b * b), -2.0 * x, -2.0 * y / (b * b)};
}

Implicit lesser(const Implicit& f, const Implicit& g) {
  return f.value < g.value ? f : g;
}

/// The clutter's shapes in their own plane, where they fill about the unit circle.
Implicit clutter_shape(DecalShape shape, double x, double y) {
  switch (shape) {
    case DecalShape::ellipse:
      return ellipse(x, y, 0.5);
    case DecalShape::ring: {
      const Implicit inner = ellipse(x / 0.55, y / 0.55, 1.0);
      return lesser(ellipse(x, y, 1.0), {-inner.value, -inner.dx / 0.55, -inner.dy / 0.55});
    }
    case DecalShape::square:
      return lesser({1.0 - std::abs(x), x > 0.0 ? -1.0 : 1.0, 0.0},
                    {1.0 - std::abs(y), 0.0, y > 0.0 ? -1.0 : 1.0});
    case DecalShape::half_disc:
      return lesser(ellipse(x, y, 1.0), {y, 0.0, 1.0});
    default: {
      // A circle pressed to three lobes and stretched.
      const double r2 = x * x + y * y;
      return {1.0 - r2 - 0.22 * (x * x - y * y) - 0.30 * (x * x * x - 3.0 * x * y * y),
              -2.0 * x - 0.44 * x - 0.90 * (x * x - y * y), -2.0 * y + 0.44 * y + 1.80 * x * y};
    }
  }
}

float clamp_unit(double share) {
  return static_cast<float>(std::clamp(share, 0.0, 1.0));
}

}  // namespace

DecalView::DecalView(const Decal& decal, const Eigen::Isometry3d& cMw, const Intrinsics& intrinsics,
                     double blur_px)
    : decal_(&decal), intrinsics_(&intrinsics), blur_px_(blur_px) {
  const double radius = decal.size_m * outline_radius(decal.shape);
  const Eigen::Vector3d centre_c = cMw * decal.wMd.translation();
  if (!may_be_seen(centre_c, radius, intrinsics)) return;
  const Eigen::Isometry3d cMd = cMw * decal.wMd;
  if (cMd.linear().col(2).dot(centre_c) >= 0.0) return;  // seen from behind

  const Window frame{0, 0, intrinsics.width, intrinsics.height};
  const int margin = decal.blurred ? blur_margin(blur_px) : 1;
  box_ = intersect(grown(outline_box(cMd, radius, intrinsics), margin), frame);
  if (box_.empty()) return;

  Eigen::Matrix3d cHd;
  cHd << decal.size_m * cMd.linear().col(0), decal.size_m * cMd.linear().col(1), centre_c;
  dHray_ = cHd.inverse();
  const Eigen::Vector2d xy = centre_c.head<2>() / centre_c.z();
  const Eigen::Vector3d w = dHray_ * xy.homogeneous();
  const Eigen::Matrix2d dd_dxy = dHray_.topLeftCorner<2, 2>() / w.z();
  if (const auto uv = distort(intrinsics, xy))
    dxy_duv_ = dd_dxy * distort_jacobian(intrinsics, *uv).inverse();
}

void DecalView::coverage(int u, int v, int count, float* out) {
  if (decal_->blurred) {
    if (blurred_.empty()) compute_blurred();
    const int margin = blur_margin(blur_px_);
    const std::ptrdiff_t stride = box_.width + 2 * margin;
    const float* row = blurred_.data() + (v - box_.v + margin) * stride + (u - box_.u + margin);
    std::copy_n(row, count, out);
    return;
  }
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d p = dHray_ * unproject(*intrinsics_, {u + i, v}).homogeneous();
    const Implicit f = clutter_shape(decal_->shape, p.x() / p.z(), p.y() / p.z());
    const double slope_u = f.dx * dxy_duv_(0, 0) + f.dy * dxy_duv_(1, 0);
    const double slope_v = f.dx * dxy_duv_(0, 1) + f.dy * dxy_duv_(1, 1);
    out[i] = clamp_unit(0.5 + 0.5 * f.value / (std::hypot(slope_u, slope_v) + 1e-9));
  }
}

void DecalView::compute_blurred() {
  const Window window = grown(box_, blur_margin(blur_px_));
  if (decal_->shape == DecalShape::disc) {
    // 1 − x² − y² ≥ 0 in the decal's plane.
    const Eigen::Vector3d unit(-1.0, -1.0, 1.0);
    const Eigen::Matrix3d Q = dHray_.transpose() * unit.asDiagonal() * dHray_;
    const Eigen::JacobiSVD<Eigen::Matrix2d> size(dxy_duv_);
    const double a = 1.0 / size.singularValues()(1);
    const double b = 1.0 / size.singularValues()(0);
    blurred_ = conic_coverage(Q, *intrinsics_, window, b * b / a);
  } else {
    blurred_.reserve(static_cast<std::size_t>(window.width) *
                     static_cast<std::size_t>(window.height));
    const double per_u = std::hypot(dxy_duv_(0, 0), dxy_duv_(0, 1));
    const double per_v = std::hypot(dxy_duv_(1, 0), dxy_duv_(1, 1));
    for (int v = window.v; v < window.bottom(); ++v) {
      for (int u = window.u; u < window.right(); ++u) {
        const Eigen::Vector3d p = dHray_ * unproject(*intrinsics_, {u, v}).homogeneous();
        const float x = clamp_unit(0.5 + (1.0 - std::abs(p.x() / p.z())) / per_u);
        const float y = clamp_unit(0.5 + (1.0 - std::abs(p.y() / p.z())) / per_v);
        blurred_.push_back(x * y);
      }
    }
  }
  blur(blurred_, window, blur_px_);
}

}  // namespace vigia::sim

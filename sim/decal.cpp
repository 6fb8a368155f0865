#include "decal.hpp"

#include "disc_coverage.hpp"
#include "rays.hpp"
#include "simd.hpp"
#include "single.hpp"
#include "tag_coverage.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::sim {
namespace {

using imaging::Window;

/// The decal's outline lies within this radius, in units of size_m.
double outline_radius(DecalShape shape) {
  switch (shape) {
    case DecalShape::square_plate:
    case DecalShape::tag:
    case DecalShape::square:
      return std::sqrt(2.0);
    case DecalShape::blob:
      return std::sqrt(1.8);
    default:
      return 1.0;
  }
}

/// Whether the decal can reach the image at all, judged by a sphere round it.
bool may_be_seen(const UnifiedOmni& omni, const Eigen::Vector3d& centre_c, double /*radius*/) {
  return project(CameraModel{omni}, centre_c).has_value();
}

bool may_be_seen(const Intrinsics& k, const Eigen::Vector3d& centre_c, double radius) {
  const double depth = centre_c.z() - radius;
  if (depth <= 1e-3) return centre_c.z() + radius > 0.0;
  const auto uv = project(k, centre_c);
  if (!uv) return true;
  const double reach =
      2.0 * radius / depth * std::max(k.px, k.py) * (1.0 + centre_c.head<2>().norm() / depth) + 4.0;
  return in_image(k, *uv, -reach);
}

constexpr int kMaxSamples = 16;

/// kMaxSamples points once round.
const std::vector<Eigen::Vector2d>& unit_circle() {
  static const std::vector<Eigen::Vector2d> points = [] {
    std::vector<Eigen::Vector2d> all;
    all.reserve(kMaxSamples);
    for (int i = 0; i < kMaxSamples; ++i) all.push_back(unit_vector(2.0 * kPi * i / kMaxSamples));
    return all;
  }();
  return points;
}

/// Whole pixels round the image of the circle of radius @p radius, or an empty window. Only a
/// mirror shows what it shows in part.
Window outline_box(const Eigen::Isometry3d& cMd, double radius, const CameraModel& model,
                   int samples) {
  double u0 = 1e9;
  double v0 = 1e9;
  double u1 = -1e9;
  double v1 = -1e9;
  const std::vector<Eigen::Vector2d>& circle = unit_circle();
  const std::size_t step = circle.size() / static_cast<std::size_t>(samples);
  for (int i = 0; i < samples; ++i) {
    const Eigen::Vector2d& at = circle[static_cast<std::size_t>(i) * step];
    const auto uv = project(model, cMd * Eigen::Vector3d(radius * at.x(), radius * at.y(), 0.0));
    if (!uv && is_perspective(model)) return {};
    if (!uv) continue;
    u0 = std::min(u0, uv->x());
    v0 = std::min(v0, uv->y());
    u1 = std::max(u1, uv->x());
    v1 = std::max(v1, uv->y());
  }
  if (u1 < -1e5 || v1 < -1e5 || u0 > 1e5 || v0 > 1e5 || u1 - u0 > 1e5 || v1 - v0 > 1e5) return {};
  // The arc between two samples bulges by (1 − cos(π/n))/2 of the width, doubled for perspective.
  const double share = 1.0 - std::cos(kPi / samples);
  const double bulge_u = 1.0 + share * (u1 - u0);
  const double bulge_v = 1.0 + share * (v1 - v0);
  const Window box{static_cast<int>(std::floor(u0 - bulge_u)),
                   static_cast<int>(std::floor(v0 - bulge_v)), 0, 0};
  return {box.u, box.v, static_cast<int>(std::ceil(u1 + bulge_u)) + 1 - box.u,
          static_cast<int>(std::ceil(v1 + bulge_v)) + 1 - box.v};
}

Window grown(const Window& w, int margin) {
  return {w.u - margin, w.v - margin, w.width + 2 * margin, w.height + 2 * margin};
}

/// Share of grey of a mark at a point of its plane, in units of size_m.
struct Footprint {
  std::array<float, 9> H;    ///< ray → plane
  float x_u, x_v, y_u, y_v;  ///< how the point moves with the pixel, at the mark's centre
};

struct Implicit {
  float value;  ///< positive inside, about 1 in the middle
  float dx;
  float dy;
};

inline Implicit ellipse(float x, float y, float per_b2) {
  return {1.0F - x * x - y * y * per_b2, -2.0F * x, -2.0F * y * per_b2};
}

inline Implicit lesser(const Implicit& f, const Implicit& g) {
  const bool first = f.value < g.value;
  return {first ? f.value : g.value, first ? f.dx : g.dx, first ? f.dy : g.dy};
}

/// The clutter's shapes in their own plane, where they fill about the unit circle.
struct EllipseShape {
  static Implicit at(float x, float y) { return ellipse(x, y, 4.0F); }
};
struct RingShape {
  static Implicit at(float x, float y) {
    const Implicit outer = ellipse(x, y, 1.0F);
    return lesser(outer, {x * x + y * y - 0.35F, 2.0F * x, 2.0F * y});
  }
};
struct SquareShape {
  static Implicit at(float x, float y) {
    const float ax = x > 0.0F ? x : -x;
    const float ay = y > 0.0F ? y : -y;
    return lesser({1.0F - ax, 1.0F, 0.0F}, {1.0F - ay, 0.0F, 1.0F});
  }
};
struct HalfDiscShape {
  static Implicit at(float x, float y) { return lesser(ellipse(x, y, 1.0F), {y, 0.0F, 1.0F}); }
};
struct BlobShape {
  /// A circle stretched and pressed to three lobes; cut where the cubic would open again.
  static Implicit at(float x, float y) {
    const Implicit lobes{
        1.0F - 1.22F * x * x - 0.78F * y * y - 0.20F * (x * x * x - 3.0F * x * y * y),
        -2.44F * x - 0.60F * (x * x - y * y), -1.56F * y + 1.20F * x * y};
    return lesser(lobes, {1.8F - x * x - y * y, -2.0F * x, -2.0F * y});
  }
};

template <typename Shape, bool kPerspective>
inline void shape_row(const Footprint& k, const float* __restrict rx, const float* __restrict ry,
                      const float* __restrict rz, int count, float* __restrict out) {
  const Footprint f = k;
  for (int i = 0; i < count; ++i) {
    const float z = kPerspective ? 1.0F : rz[i];
    const float per_w = f.H[6] * rx[i] + f.H[7] * ry[i] + f.H[8] * z;
    const float w = 1.0F / per_w;
    const float x = (f.H[0] * rx[i] + f.H[1] * ry[i] + f.H[2] * z) * w;
    const float y = (f.H[3] * rx[i] + f.H[4] * ry[i] + f.H[5] * z) * w;
    const Implicit shape = Shape::at(x, y);
    const float slope_u = shape.dx * f.x_u + shape.dy * f.y_u;
    const float slope_v = shape.dx * f.x_v + shape.dy * f.y_v;
    const float slope = std::sqrt(slope_u * slope_u + slope_v * slope_v + 1e-12F);
    // The edge is spread over two pixels.
    const float share = 0.5F + 0.5F * shape.value / slope;
    out[i] = share < 0.0F ? 0.0F : (share > 1.0F ? 1.0F : share);
    if (!kPerspective && per_w <= 0.0F) out[i] = 0.0F;  // behind
  }
}

template <typename Shape>
void shape_row(const Footprint& k, const Rays& rays, int count, float* out) {
  if (rays.z == nullptr)
    shape_row<Shape, true>(k, rays.x, rays.y, nullptr, count, out);
  else
    shape_row<Shape, false>(k, rays.x, rays.y, rays.z, count, out);
}

void clutter_row(DecalShape shape, const Footprint& k, const Rays& rays, int count, float* out) {
  switch (shape) {
    case DecalShape::ellipse:
      return shape_row<EllipseShape>(k, rays, count, out);
    case DecalShape::ring:
      return shape_row<RingShape>(k, rays, count, out);
    case DecalShape::square:
      return shape_row<SquareShape>(k, rays, count, out);
    case DecalShape::half_disc:
      return shape_row<HalfDiscShape>(k, rays, count, out);
    default:
      return shape_row<BlobShape>(k, rays, count, out);
  }
}

/// Share of pixels in the square |x|, |y| ≤ 1, from the distances to its sides in pixels.
template <bool kPerspective>
VIGIA_PIXEL_BODY void square_rays(const std::array<float, 9>& H, float px_per_x, float px_per_y,
                                  const float* __restrict rx, const float* __restrict ry,
                                  const float* __restrict rz, int count, float* __restrict out) {
  const std::array<float, 9> h = H;
  for (int i = 0; i < count; ++i) {
    const float z = kPerspective ? 1.0F : rz[i];
    const float per_w = h[6] * rx[i] + h[7] * ry[i] + h[8] * z;
    const float w = 1.0F / per_w;
    const float x = (h[0] * rx[i] + h[1] * ry[i] + h[2] * z) * w;
    const float y = (h[3] * rx[i] + h[4] * ry[i] + h[5] * z) * w;
    float across = 0.5F + (1.0F - std::abs(x)) * px_per_x;
    float down = 0.5F + (1.0F - std::abs(y)) * px_per_y;
    across = across < 0.0F ? 0.0F : (across > 1.0F ? 1.0F : across);
    down = down < 0.0F ? 0.0F : (down > 1.0F ? 1.0F : down);
    out[i] = across * down;
    if (!kPerspective && per_w <= 0.0F) out[i] = 0.0F;  // behind
  }
}

VIGIA_PIXEL_LOOP
void square_perspective(const std::array<float, 9>& H, float px_per_x, float px_per_y,
                        const Rays& rays, int count, float* out) {
  square_rays<true>(H, px_per_x, px_per_y, rays.x, rays.y, nullptr, count, out);
}

VIGIA_PIXEL_LOOP
void square_any(const std::array<float, 9>& H, float px_per_x, float px_per_y, const Rays& rays,
                int count, float* out) {
  square_rays<false>(H, px_per_x, px_per_y, rays.x, rays.y, rays.z, count, out);
}

/// How a point of the decal's plane moves with the pixel at the decal's centre, whose image exists.
Eigen::Matrix2d centre_scale(const UnifiedOmni& omni, const Eigen::Matrix3d& dHray,
                             const Eigen::Vector3d& centre_c) {
  const CameraModel model = omni;
  const Eigen::Vector3d direction = centre_c.normalized();
  const double w = dHray.row(2).dot(direction);
  const auto uv = project(model, centre_c);
  const auto dr_duv = uv ? ray_jacobian(model, *uv) : std::nullopt;
  if (!dr_duv) return Eigen::Matrix2d::Identity();
  return dHray.topRows<2>() * *dr_duv / w;  // the centre is the plane's origin
}

Eigen::Matrix2d centre_scale(const Intrinsics& intrinsics, const Eigen::Matrix3d& dHray,
                             const Eigen::Vector3d& centre_c) {
  const Eigen::Vector2d xy = centre_c.head<2>() / centre_c.z();
  const Eigen::Vector3d w = dHray * xy.homogeneous();
  const Eigen::Matrix2d dd_dxy = dHray.topLeftCorner<2, 2>() / w.z();
  const auto uv = distort(intrinsics, xy);
  if (!uv) return Eigen::Matrix2d::Identity();
  return dd_dxy * distort_jacobian(intrinsics, *uv).inverse();
}

}  // namespace

DecalView::DecalView(const Decal& decal, const Eigen::Isometry3d& cMw, const CameraModel& model,
                     double blur_px)
    : decal_(&decal), model_(&model), blur_px_(blur_px) {
  const double radius = decal.size_m * outline_radius(decal.shape);
  const Eigen::Vector3d centre_c = cMw * decal.wMd.translation();
  const bool may_be =
      std::visit([&](const auto& m) { return may_be_seen(m, centre_c, radius); }, model);
  if (!may_be) return;
  const Eigen::Isometry3d cMd = cMw * decal.wMd;
  if (cMd.linear().col(2).dot(centre_c) >= 0.0) return;  // seen from behind

  const Window frame{0, 0, image_width(model), image_height(model)};
  const int margin = decal.blurred ? blur_margin(blur_px) : 1;
  box_ = intersect(
      grown(outline_box(cMd, radius, model, decal.blurred ? kMaxSamples : kMaxSamples / 2), margin),
      frame);
  if (box_.empty()) return;

  Eigen::Matrix3d cHd;
  cHd << decal.size_m * cMd.linear().col(0), decal.size_m * cMd.linear().col(1), centre_c;
  dHray_ = cHd.inverse();
  dxy_duv_ = std::visit([&](const auto& m) { return centre_scale(m, dHray_, centre_c); }, model);
}

void DecalView::expect(const Window& window) {
  const Window asked = intersect(window, box_);
  if (!decal_->blurred || asked.empty() || contains(expected_, asked)) return;
  // Whoever asks again may go on asking.
  expected_ = expected_.empty() ? asked : box_;
  blurred_.clear();
}

void DecalView::coverage(int u, int v, int count, const Rays& rays, float* out) {
  if (!decal_->blurred) {
    const Footprint footprint{
        single(dHray_), static_cast<float>(dxy_duv_(0, 0)), static_cast<float>(dxy_duv_(0, 1)),
        static_cast<float>(dxy_duv_(1, 0)), static_cast<float>(dxy_duv_(1, 1))};
    clutter_row(decal_->shape, footprint, rays, count, out);
    return;
  }
  if (blurred_.empty()) compute_blurred();
  const int margin = blur_margin(blur_px_);
  const std::ptrdiff_t stride = expected_.width + 2 * margin;
  const float* row = blurred_.data() + (v - expected_.v + margin) * stride;
  std::copy_n(row + (u - expected_.u + margin), count, out);
}

void DecalView::compute_blurred() {
  const Window window = grown(expected_, blur_margin(blur_px_));
  if (decal_->shape == DecalShape::disc) {
    // 1 − x² − y² ≥ 0 in the decal's plane.
    const Eigen::Vector3d unit(-1.0, -1.0, 1.0);
    const Eigen::Matrix3d Q = dHray_.transpose() * unit.asDiagonal() * dHray_;
    const Eigen::JacobiSVD<Eigen::Matrix2d> size(dxy_duv_);
    const double a = 1.0 / size.singularValues()(1);
    const double b = 1.0 / size.singularValues()(0);
    blurred_ = conic_coverage(Q, dHray_.row(2), *model_, window, b * b / a);
  } else if (decal_->shape == DecalShape::tag) {
    blurred_ = tag_coverage(decal_->fields, dHray_, *model_, window);
  } else {
    if (within_square(window)) {
      blurred_.assign(
          static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height),
          blurred_one(blur_px_));
      return;
    }
    blurred_ = square_coverage(window);
  }
  blur(blurred_, window, blur_px_);
}

/// Whether all of the window lies well inside the square. A lens bends the square's sides by less
/// than the clearance.
bool DecalView::within_square(const Window& window) const {
  constexpr double kClearance_px = 3.0;
  if (!is_perspective(*model_)) return false;
  const double limit_x = 1.0 - kClearance_px * dxy_duv_.row(0).norm();
  const double limit_y = 1.0 - kClearance_px * dxy_duv_.row(1).norm();
  for (const int u : {window.u, window.right() - 1}) {
    for (const int v : {window.v, window.bottom() - 1}) {
      const Eigen::Vector3d at = dHray_ * point_ray(*model_, {u, v});
      if (std::abs(at.x()) > limit_x * at.z() || std::abs(at.y()) > limit_y * at.z()) return false;
    }
  }
  return true;
}

std::vector<float> DecalView::square_coverage(const Window& window) const {
  const auto width = static_cast<std::size_t>(window.width);
  std::vector<float> coverage(width * static_cast<std::size_t>(window.height));
  std::vector<float> x(width);
  std::vector<float> y(width);
  std::vector<float> z(width);
  const bool perspective = is_perspective(*model_);
  const Rays rays{x.data(), y.data(), perspective ? nullptr : z.data()};
  const auto px_per_x = static_cast<float>(1.0 / dxy_duv_.row(0).norm());
  const auto px_per_y = static_cast<float>(1.0 / dxy_duv_.row(1).norm());
  const std::array<float, 9> H = single(dHray_);
  float* out = coverage.data();
  for (int v = window.v; v < window.bottom(); ++v, out += width) {
    row_rays(*model_, window.u, v, window.width, x.data(), y.data(), z.data());
    (perspective ? square_perspective : square_any)(H, px_per_x, px_per_y, rays, window.width, out);
  }
  return coverage;
}

}  // namespace vigia::sim

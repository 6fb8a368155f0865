#include "field_paint.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/LU>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::sim {
namespace {

constexpr double kMeets_m = 1e-3;
constexpr float kTails = 4.0F;                 // σ beyond which a side is not felt
constexpr double kPixelVariance = 1.0 / 12.0;  // of a pixel's square in any direction

/// Share of a Gaussian inside a straight side at the signed distance @p d, in its σ.
float share_inside_side(float d) {
  return 0.5F + 0.5F * std::erf(d * 0.70710678F);
}

/// Share between two sides that face each other.
float share_between(float d, float opposite) {
  const float share = share_inside_side(d) + share_inside_side(opposite) - 1.0F;
  return share > 0.0F ? share : 0.0F;
}

bool meets_another(const std::vector<FieldLine>& lines, std::size_t mine,
                   const Eigen::Vector2d& end) {
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (i != mine && distance_to_line(lines[i], end) < kMeets_m) return true;
  return false;
}

/// Derivative of a ray, as row_rays() has it, by the pixel: two columns per pixel of two directions
/// of the image that are square to each other.
using RayDerivative = Eigen::Matrix<float, 3, 2>;

RayDerivative ray_derivative(const UnifiedOmni& omni, const Eigen::Vector2f& /*uv*/,
                             const Eigen::Vector3f& ray) {
  // m = sin θ/(cos θ + ξ): along the radius dm/dθ = (1 + ξ cos θ)/(cos θ + ξ)², across it m/sin θ.
  const float s = std::hypot(ray.x(), ray.y());
  const float c = s > 1e-6F ? ray.x() / s : 1.0F;
  const float d = s > 1e-6F ? ray.y() / s : 0.0F;
  const auto xi = static_cast<float>(omni.xi);
  const auto focal = static_cast<float>(std::abs(omni.px));
  const float behind = ray.z() + xi;
  const float along = behind * behind / ((1.0F + xi * ray.z()) * focal);
  const float across = behind / focal;
  RayDerivative derivative = RayDerivative::Zero();
  derivative << along * ray.z() * c, -across * d,  //
      along * ray.z() * d, across * c,             //
      -along * s, 0.0F;
  return derivative;
}

RayDerivative ray_derivative(const Intrinsics& pinhole, const Eigen::Vector2f& uv,
                             const Eigen::Vector3f& /*ray*/) {
  RayDerivative derivative = RayDerivative::Zero();
  derivative.topRows<2>() = distort_jacobian(pinhole, uv.cast<double>()).inverse().cast<float>();
  return derivative;
}

/// The largest angle that a pixel spans in any direction, rad, or a little more.
float pixel_angle(const UnifiedOmni& omni, const Eigen::Vector3f& ray) {
  const auto xi = static_cast<float>(omni.xi);
  const float behind = ray.z() + xi;
  const float across = behind / static_cast<float>(std::abs(omni.px));
  return across * std::max(1.0F, behind / (1.0F + xi * ray.z()));
}

float pixel_angle(const Intrinsics& pinhole, const Eigen::Vector3f& ray) {
  const float r2 = ray.head<2>().squaredNorm();
  const auto kdu = static_cast<float>(std::abs(pinhole.kdu));
  return (1.0F + 3.0F * kdu * r2) / static_cast<float>(std::min(pinhole.px, pinhole.py));
}

}  // namespace

FieldPaint::FieldPaint(const FieldMap& map) : lines_(map.lines) {
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    FieldLine& line = lines_[i];
    if (line.kind != FieldLine::Kind::segment) continue;
    const Eigen::Vector2d on = 0.5 * line.width_m * (line.b - line.a).normalized();
    if (meets_another(map.lines, i, map.lines[i].a)) line.a -= on;
    if (meets_another(map.lines, i, map.lines[i].b)) line.b += on;
  }
  FieldMap painted = map;
  painted.lines = lines_;
  for (const auto& [reach, cell] : {std::pair{0.4, 0.1}, {1.2, 0.3}, {4.0, 1.0}})
    by_reach_.emplace_back(painted, reach, cell);
  all_.resize(lines_.size());
  std::iota(all_.begin(), all_.end(), std::uint16_t{0});
}

FieldDistance::Candidates FieldPaint::near(const Eigen::Vector2d& p, double reach_m) const {
  const double width = lines_.empty() ? 0.0 : lines_.front().width_m;
  for (const FieldDistance& distance : by_reach_)
    if (reach_m + 0.5 * width <= distance.reach_m()) return distance.near(p);
  return {all_.data(), all_.data() + all_.size()};
}

struct FieldPaintView::Pixel {
  Eigen::Vector2f uv;
  Eigen::Vector3f ray;
  Eigen::Vector2f p;  ///< of the floor
  float w = 0.0F;     ///< inverse depth
  float reach_m = 0.0F;
  RayDerivative derivative = RayDerivative::Zero();

  /// Distance in σ of the pixel's Gaussian to the plane n·ray = 0, positive where n·ray is.
  float distance(const Eigen::Vector3f& n, float sigma_px) const {
    const Eigen::Vector2f slope = derivative.transpose() * n;
    return n.dot(ray) / (sigma_px * std::sqrt(slope.squaredNorm() + 1e-20F));
  }
};

FieldPaintView::FieldPaintView(const FieldPaint& paint, const Eigen::Isometry3d& cMw,
                               const CameraModel& model, double blur_px)
    : paint_(&paint),
      model_(&model),
      sigma_px_(static_cast<float>(std::sqrt(blur_px * blur_px + kPixelVariance))) {
  const Eigen::Isometry3d wMc = cMw.inverse(Eigen::Isometry);
  const Eigen::Vector3d t = wMc.translation();
  const Eigen::Matrix3d R = wMc.linear();
  height_m_ = static_cast<float>(t.z());
  // t + r'/w lies on the floor, with r' = R r and w = −r'_z/t_z.
  const Eigen::Vector3d w = -R.row(2).transpose() / t.z();
  const Eigen::Vector3d x = t.x() * w + R.row(0).transpose();
  const Eigen::Vector3d y = t.y() * w + R.row(1).transpose();
  floor_w_ = w.cast<float>();
  floor_x_ = x.cast<float>();
  floor_y_ = y.cast<float>();
  straight_.resize(paint.lines().size());
  round_.resize(paint.lines().size());
  for (std::size_t i = 0; i < paint.lines().size(); ++i) {
    const FieldLine& line = paint.lines()[i];
    const auto half_width = static_cast<float>(0.5 * line.width_m);
    if (line.kind == FieldLine::Kind::segment) {
      const Eigen::Vector2d d = (line.b - line.a).normalized();
      const Eigen::Vector3d along = d.x() * x + d.y() * y - d.dot(line.a) * w;
      const Eigen::Vector3d across = d.x() * y - d.y() * x - cross(d, line.a) * w;
      straight_[i] = {across.cast<float>(), along.cast<float>(), half_width,
                      static_cast<float>((line.b - line.a).norm())};
    } else {
      const Eigen::Vector2d begin = unit_vector(line.from);
      const Eigen::Vector2d end = unit_vector(line.from + line.sweep);
      round_[i] = {(x - line.centre.x() * w).cast<float>(),
                   (y - line.centre.y() * w).cast<float>(),
                   static_cast<float>(line.radius_m),
                   half_width,
                   begin.cast<float>(),
                   end.cast<float>(),
                   line.closed(),
                   line.sweep > kPi};
    }
  }
}

void FieldPaintView::coverage(int u, int v, int count, const Rays& rays, const ViewId* winner,
                              ViewId surface, float* share) const {
  std::fill_n(share, count, 0.0F);
  for (int i = 0; i < count; ++i) {
    if (winner[i] != surface) continue;
    const Eigen::Vector3f ray(rays.x[i], rays.y[i], rays.z == nullptr ? 1.0F : rays.z[i]);
    Pixel pixel = pixel_at(u + i, v, ray);
    if (pixel.w > 0.0F) share[i] = share_of(pixel);
  }
}

FieldPaintView::Pixel FieldPaintView::pixel_at(int u, int v, const Eigen::Vector3f& ray) const {
  Pixel pixel;
  pixel.ray = ray;
  pixel.w = floor_w_.dot(ray);
  if (pixel.w <= 1e-4F) return {};
  pixel.p = Eigen::Vector2f(floor_x_.dot(ray), floor_y_.dot(ray)) / pixel.w;
  const float angle = std::visit([&](const auto& m) { return pixel_angle(m, ray); }, *model_);
  // A turn by α moves the point by no more than α D²/h.
  const float depth2 = ray.squaredNorm() / (pixel.w * pixel.w);
  pixel.reach_m = kTails * sigma_px_ * angle * depth2 / height_m_;
  pixel.uv = {static_cast<float>(u), static_cast<float>(v)};
  return pixel;
}

/// Of lines that cross, the paint is what neither leaves bare.
float FieldPaintView::share_of(Pixel& pixel) const {
  const auto near = paint_->near(pixel.p.cast<double>(), pixel.reach_m);
  if (near.begin() == near.end()) return 0.0F;
  pixel.derivative =
      std::visit([&](const auto& m) { return ray_derivative(m, pixel.uv, pixel.ray); }, *model_);
  float bare = 1.0F;
  for (const std::uint16_t i : near)
    bare *=
        1.0F - (paint_->lines()[i].kind == FieldLine::Kind::segment ? share_of(straight_[i], pixel)
                                                                    : share_of(round_[i], pixel));
  return 1.0F - bare;
}

float FieldPaintView::share_of(const Straight& line, const Pixel& pixel) const {
  const float across = line.across.dot(pixel.ray) / pixel.w;
  if (std::abs(across) > line.half_width + pixel.reach_m) return 0.0F;
  const float along = line.along.dot(pixel.ray) / pixel.w;
  if (along < -pixel.reach_m || along > line.length + pixel.reach_m) return 0.0F;
  const Eigen::Vector3f half = line.half_width * floor_w_;
  float share = share_between(pixel.distance(half - line.across, sigma_px_),
                              pixel.distance(half + line.across, sigma_px_));
  if (along < pixel.reach_m || along > line.length - pixel.reach_m)
    share *= share_between(pixel.distance(line.along, sigma_px_),
                           pixel.distance(line.length * floor_w_ - line.along, sigma_px_));
  return share;
}

float FieldPaintView::share_of(const Round& line, const Pixel& pixel) const {
  const Eigen::Vector2f out(line.x.dot(pixel.ray), line.y.dot(pixel.ray));
  const float range = out.norm();
  if (std::abs(range / pixel.w - line.radius) > line.half_width + pixel.reach_m) return 0.0F;
  const Eigen::Vector2f radial = out / (range + 1e-9F);
  const Eigen::Vector3f outward = radial.x() * line.x + radial.y() * line.y;
  const float share = share_between(
      pixel.distance((line.radius + line.half_width) * floor_w_ - outward, sigma_px_),
      pixel.distance(outward - (line.radius - line.half_width) * floor_w_, sigma_px_));
  if (line.closed || share == 0.0F) return share;
  const float past_begin =
      pixel.distance(line.begin.x() * line.y - line.begin.y() * line.x, sigma_px_);
  const float before_end = pixel.distance(line.end.y() * line.x - line.end.x() * line.y, sigma_px_);
  if (line.reflex)
    return share * (1.0F - share_inside_side(-past_begin) * share_inside_side(-before_end));
  return share * share_inside_side(past_begin) * share_inside_side(before_end);
}

}  // namespace vigia::sim

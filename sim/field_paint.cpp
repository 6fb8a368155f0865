#include "field_paint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/LU>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::sim {
namespace {

constexpr double kMeets_m = 1e-3;
constexpr std::size_t kMostStrips = 8;  // lines in one pixel
constexpr float kLeastShare = 1e-4F;
constexpr float kTails = 4.0F;                 // σ beyond which a side is not felt
constexpr double kPixelVariance = 1.0 / 12.0;  // of a pixel's square in any direction

/// Share of a Gaussian inside a straight side at the signed distance @p d, in its σ.
float share_inside_side(float d) {
  return 0.5F + 0.5F * std::erf(d * 0.70710678F);
}

}  // namespace

/// What lies between two parallel sides, in σ along the normal from the pixel. A Strip has them, so
/// it has no place in an anonymous namespace.
struct Band {
  Eigen::Vector2f normal = Eigen::Vector2f::UnitX();
  float from = -kTails;
  float to = kTails;
};

namespace {

/// Share of a Gaussian inside two bands: a rectangle of the normal distribution of two variables
/// that are correlated as the bands' normals are, by Gauss's rule in pieces over the narrower; the
/// more alike the normals, the steeper its integrand and the shorter the pieces.
float share_of_both(const Band& a, const Band& b) {
  constexpr std::array<float, 5> kNodes{-0.9061798F, -0.5384693F, 0.0F, 0.5384693F, 0.9061798F};
  constexpr std::array<float, 5> kWeights{0.2369269F, 0.4786287F, 0.5688889F, 0.4786287F,
                                          0.2369269F};
  constexpr int kMostPieces = 24;
  const bool a_narrower = a.to - a.from < b.to - b.from;
  const Band& inner = a_narrower ? a : b;
  const Band& outer = a_narrower ? b : a;
  const float rho = inner.normal.dot(outer.normal);
  const float scale = 1.0F / std::sqrt(std::max(1.0F - rho * rho, 1e-4F));
  const float low = std::max(inner.from, -kTails);
  const float width = std::min(inner.to, kTails) - low;
  if (width <= 0.0F) return 0.0F;
  const int pieces = std::clamp(static_cast<int>(std::ceil(0.25F * width * std::abs(rho) * scale)),
                                2, kMostPieces);
  const float half = 0.5F * width / static_cast<float>(pieces);
  float sum = 0.0F;
  for (int piece = 0; piece < pieces; ++piece) {
    const float middle = low + half * static_cast<float>(2 * piece + 1);
    for (std::size_t i = 0; i < kNodes.size(); ++i) {
      const float x = middle + half * kNodes[i];
      const float within = share_inside_side((outer.to - rho * x) * scale) -
                           share_inside_side((outer.from - rho * x) * scale);
      sum += kWeights[i] * std::exp(-0.5F * x * x) * within;
    }
  }
  return std::max(0.0F, 0.39894228F * half * sum);
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
  /// The direction in the image, unit, in which n·ray grows.
  Eigen::Vector2f normal(const Eigen::Vector3f& n) const {
    return (derivative.transpose() * n).normalized();
  }
};

/// A line beside the pixel, as its Gaussian sees it.
struct FieldPaintView::Strip {
  Band sides;
  Band ends;
  float far_end = 1.0F;  ///< share that an arc's farther end leaves
  bool whole = true;     ///< no end is near
  bool round = false;

  float between_sides() const {
    return std::max(0.0F, share_inside_side(sides.to) - share_inside_side(sides.from));
  }
  /// Share of what lies between the sides that an arc's ends leave.
  float kept() const { return round ? share() / std::max(between_sides(), kLeastShare) : 1.0F; }
  float share() const { return whole ? between_sides() : far_end * share_of_both(sides, ends); }
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

/// The paint of lines that cross counts once: Σ P(i) − Σ P(i and j), what three have in common
/// left out.
float FieldPaintView::share_of(Pixel& pixel) const {
  const auto near = paint_->near(pixel.p.cast<double>(), pixel.reach_m);
  if (near.begin() == near.end()) return 0.0F;
  pixel.derivative =
      std::visit([&](const auto& m) { return ray_derivative(m, pixel.uv, pixel.ray); }, *model_);
  std::array<Strip, kMostStrips> strips;
  std::size_t count = 0;
  float share = 0.0F;
  for (const std::uint16_t i : near) {
    if (count == kMostStrips) break;
    const bool straight = paint_->lines()[i].kind == FieldLine::Kind::segment;
    const auto strip = straight ? strip_of(straight_[i], pixel) : strip_of(round_[i], pixel);
    const float alone = strip ? strip->share() : 0.0F;
    if (alone < kLeastShare) continue;
    share += alone;
    // A straight line that ends on another reaches its far side: what their sides have in common,
    // both have. An arc ends in another's middle.
    for (std::size_t j = 0; j < count; ++j)
      share -=
          std::min({strip->kept() * strips[j].kept() * share_of_both(strips[j].sides, strip->sides),
                    alone, strips[j].share()});
    strips[count++] = *strip;
  }
  return std::clamp(share, 0.0F, 1.0F);
}

std::optional<FieldPaintView::Strip> FieldPaintView::strip_of(const Straight& line,
                                                              const Pixel& pixel) const {
  const float across = line.across.dot(pixel.ray) / pixel.w;
  if (std::abs(across) > line.half_width + pixel.reach_m) return std::nullopt;
  const float along = line.along.dot(pixel.ray) / pixel.w;
  if (along < -pixel.reach_m || along > line.length + pixel.reach_m) return std::nullopt;
  const Eigen::Vector3f half = line.half_width * floor_w_;
  Strip strip;
  strip.sides = {pixel.normal(line.across), -pixel.distance(half + line.across, sigma_px_),
                 pixel.distance(half - line.across, sigma_px_)};
  strip.whole = along > pixel.reach_m && along < line.length - pixel.reach_m;
  if (strip.whole) return strip;
  // The ends are not parallel in the image as the sides nearly are: the nearer one's direction.
  const Eigen::Vector3f past_end = line.along - line.length * floor_w_;
  strip.ends = {pixel.normal(2.0F * along < line.length ? line.along : past_end),
                -pixel.distance(line.along, sigma_px_), -pixel.distance(past_end, sigma_px_)};
  return strip;
}

std::optional<FieldPaintView::Strip> FieldPaintView::strip_of(const Round& line,
                                                              const Pixel& pixel) const {
  const Eigen::Vector2f out(line.x.dot(pixel.ray), line.y.dot(pixel.ray));
  const float range = out.norm();
  if (std::abs(range / pixel.w - line.radius) > line.half_width + pixel.reach_m)
    return std::nullopt;
  const Eigen::Vector2f radial = out / (range + 1e-9F);
  const Eigen::Vector3f outward = radial.x() * line.x + radial.y() * line.y;
  const Eigen::Vector3f inner = (line.radius - line.half_width) * floor_w_;
  const Eigen::Vector3f outer = (line.radius + line.half_width) * floor_w_;
  Strip strip;
  strip.round = true;
  strip.sides = {pixel.normal(outward), -pixel.distance(outward - inner, sigma_px_),
                 pixel.distance(outer - outward, sigma_px_)};
  if (line.closed) return strip;
  // The sides of the sector, straight through the centre: which of them is near?
  const Eigen::Vector3f after_begin = line.begin.x() * line.y - line.begin.y() * line.x;
  const Eigen::Vector3f before_end = line.end.y() * line.x - line.end.x() * line.y;
  const bool near_begin = radial.dot(line.begin) > radial.dot(line.end);
  const Eigen::Vector3f& nearer = near_begin ? after_begin : before_end;
  strip.ends = {pixel.normal(nearer), -pixel.distance(nearer, sigma_px_), 2.0F * kTails};
  if (!line.reflex)
    strip.far_end =
        share_inside_side(pixel.distance(near_begin ? before_end : after_begin, sigma_px_));
  else if (radial.dot(near_begin ? line.begin : line.end) < 0.0F)
    return strip;  // opposite of both ends
  strip.whole = false;
  return strip;
}

}  // namespace vigia::sim

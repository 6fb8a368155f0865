#include "field_eye.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/tracking/field_palette.hpp"

namespace vigia::perception {
namespace {

using Eigen::Vector2d;

constexpr double kHalfStep_px = 0.25;
/// σ of a ray's direction on the floor, rad: what the calibration leaves.
constexpr double kRaySigma = 5e-4;
/// Beside the feet's own errors: how far a goal's ends, or a post's foot, may lie from where the
/// colour begins.
constexpr double kGoalSigma_m = 0.15;
constexpr double kPostSigma_m = 0.05;

std::optional<Vector2d> floor_at(const tracking::RadialScan& scan, const tracking::FloorView& view,
                                 int ray, double radius_px) {
  return tracking::floor_point(view, scan.pixel(ray, radius_px));
}

/// How a point of the floor moves with the pixel outwards along the ray, m per px.
std::optional<Vector2d> slope_at(const tracking::RadialScan& scan, const tracking::FloorView& view,
                                 int ray, double radius_px) {
  const auto nearer = floor_at(scan, view, ray, radius_px - kHalfStep_px);
  const auto farther = floor_at(scan, view, ray, radius_px + kHalfStep_px);
  if (!nearer || !farther) return std::nullopt;
  return Vector2d((*farther - *nearer) / (2.0 * kHalfStep_px));
}

std::optional<FieldPoint> lifted(const tracking::RadialScan& scan, const tracking::FloorView& view,
                                 const tracking::LinePoint& point) {
  const auto inner = floor_at(scan, view, point.ray, point.inner_px);
  const auto outer = floor_at(scan, view, point.ray, point.outer_px);
  const auto slope = slope_at(scan, view, point.ray, point.centre_px());
  if (!inner || !outer || !slope) return std::nullopt;
  FieldPoint on_floor{0.5 * (*inner + *outer), Eigen::Matrix2d::Zero()};
  const Vector2d along = point.sigma_px * *slope;
  const Vector2d across = kRaySigma * Vector2d(-on_floor.p_r.y(), on_floor.p_r.x());
  on_floor.covariance = along * along.transpose() + across * across.transpose();
  return on_floor;
}

struct Foot {
  Vector2d p;
  double sigma_m;
};

std::optional<Foot> lifted(const tracking::RadialScan& scan, const tracking::FloorView& view,
                           const tracking::ColourFoot& foot) {
  const auto p = floor_at(scan, view, foot.ray, foot.foot_px);
  const auto slope = slope_at(scan, view, foot.ray, foot.foot_px);
  if (!p || !slope) return std::nullopt;
  return Foot{*p, foot.sigma_px * slope->norm()};
}

/// Where the rim of a span in the direction @p angle of the image meets the floor, as far out as
/// the foot of its nearest ray.
std::optional<Foot> rim_of(const tracking::RadialScan& scan, const tracking::FloorView& view,
                           const tracking::ColourFoot& nearest, double angle) {
  const auto foot = lifted(scan, view, nearest);
  const auto at_rim =
      tracking::floor_point(view, scan.centre + nearest.foot_px * unit_vector(angle));
  if (!foot || !at_rim) return std::nullopt;
  return Foot{*at_rim, foot->sigma_m};
}

/// The middle between a span's rims on the floor, told as bearing and range.
struct SpanOnFloor {
  Vector2d middle;
  double width_m;
  double sigma_m;
  double bearing_sigma;
};

std::optional<SpanOnFloor> lifted(const tracking::RadialScan& scan, const tracking::FloorView& view,
                                  const tracking::ColourSpan& span) {
  if (span.feet.empty()) return std::nullopt;
  const auto first = rim_of(scan, view, span.feet.front(), span.first_angle);
  const auto last = rim_of(scan, view, span.feet.back(), span.last_angle);
  if (!first || !last) return std::nullopt;
  return SpanOnFloor{0.5 * (first->p + last->p), (last->p - first->p).norm(),
                     std::hypot(first->sigma_m, last->sigma_m), span.angle_sigma};
}

ColourSighting sighting_of(const SpanOnFloor& span, FieldColour colour, double beyond_m,
                           double model_sigma_m) {
  ColourSighting sighting;
  sighting.colour = colour;
  sighting.bearing = std::atan2(span.middle.y(), span.middle.x());
  sighting.range_m = span.middle.norm() + beyond_m;
  sighting.bearing_sigma =
      std::hypot(span.bearing_sigma, model_sigma_m / std::max(sighting.range_m, 0.5));
  sighting.range_sigma_m = std::hypot(span.sigma_m, model_sigma_m);
  return sighting;
}

double widest_goal(const FieldMap& field) {
  double width = 0.0;
  for (const FieldGoal& goal : field.goals) width = std::max(width, (goal.to - goal.from).norm());
  return width;
}

bool about(double measured, double expected, double share, double slack_m) {
  return measured > share * expected - slack_m && measured < expected / share + slack_m;
}

}  // namespace

FieldScan on_floor(const tracking::RadialScan& scan, const tracking::FloorView& view,
                   const FieldMap& field, Stamp stamp) {
  FieldScan on_floor;
  on_floor.stamp = stamp;
  for (const tracking::LinePoint& point : scan.points)
    if (const auto seen = lifted(scan, view, point)) on_floor.points.push_back(*seen);
  const double goal_m = widest_goal(field);
  for (const tracking::ColourSpan& span : scan.goals) {
    const auto seen = lifted(scan, view, span);
    if (seen && goal_m > 0.0 && about(seen->width_m, goal_m, 0.8, 2.0 * seen->sigma_m))
      on_floor.goals.push_back(sighting_of(*seen, span.colour, 0.0, kGoalSigma_m));
  }
  for (const tracking::ColourSpan& span : scan.posts) {
    const auto seen = lifted(scan, view, span);
    if (!seen || field.posts.empty()) continue;
    const double radius = field.posts.front().radius_m;
    if (about(seen->width_m, 2.0 * radius, 0.5, 0.1))
      on_floor.posts.push_back(sighting_of(*seen, span.colour, radius, kPostSigma_m));
  }
  return on_floor;
}

FieldEye::FieldEye(const EyeParts& parts)
    : field_(parts.field != nullptr ? std::optional<FieldMap>(*parts.field) : std::nullopt),
      on_ground_(parts.on_ground),
      hull_(parts.hull) {}

/// The camera is fixed and its optics do not change: one scanner does.
void FieldEye::look_through(const Shot& shot) {
  const auto* mirror = std::get_if<UnifiedOmni>(&shot.model);
  if (mirror == nullptr || !field_) return;
  tracking::FloorView view{*mirror, on_ground_.rig.at(shot.camera).rMc(shot.head), 0.0};
  const Eigen::Isometry3d cMr = view.rMc.inverse();
  constexpr int kRimPoints = 16;
  constexpr double kMargin_px = 3.0;
  for (int i = 0; i < kRimPoints && hull_.height_m > 0.0; ++i) {
    const Vector2d rim = hull_.radius_m * unit_vector(2.0 * kPi * i / kRimPoints);
    const auto uv = project(shot.model, cMr * Eigen::Vector3d(rim.x(), rim.y(), hull_.height_m));
    if (uv)
      view.inner_px =
          std::max(view.inner_px, (*uv - Vector2d(mirror->u0, mirror->v0)).norm() + kMargin_px);
  }
  view_ = view;
  tracking::RadialScanParams params;
  params.line_width_m = field_->lines.empty() ? params.line_width_m : field_->lines.front().width_m;
  scanner_.emplace(view, tracking::FieldPalette{}, params);
}

std::vector<Observation> FieldEye::observe(const Capture& capture, const Belief& /*then*/,
                                           const std::optional<GazeRequest>& /*request*/) {
  return survey(capture);
}

std::vector<Observation> FieldEye::survey(const Capture& capture) {
  if (!scanner_) look_through(capture.shot);
  if (!scanner_) return {};
  last_ = scanner_->scan(capture.frame);
  on_floor_ = on_floor(last_, *view_, *field_, capture.shot.stamp);
  return {FieldObservation{capture.shot, on_floor_}};
}

std::vector<std::string> FieldEye::columns() const {
  return {"line_points", "goals", "posts", "light"};
}

void FieldEye::append_cells(std::string& line) const {
  line += fmt::format(",{},{},{},{}", on_floor_.points.size(), on_floor_.goals.size(),
                      on_floor_.posts.size(), tracking::to_string(last_.light));
}

imaging::Overlay FieldEye::overlay() const {
  imaging::Overlay overlay;
  overlay.principal_point = last_.centre;
  for (const tracking::LinePoint& point : last_.points)
    overlay.points.push_back(last_.pixel(point.ray, point.centre_px()));
  overlay.lines = {fmt::format("{} line points, {} goals, {} posts", on_floor_.points.size(),
                               on_floor_.goals.size(), on_floor_.posts.size())};
  return overlay;
}

}  // namespace vigia::perception

#include "map_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace vigia::report {
namespace {

constexpr double kWallWidth = 5.0;

void draw_grid(const Sheet& sheet, const MapView& view) {
  for (double x = std::ceil(view.min_m.x()); x <= view.max_m.x(); x += 1.0)
    sheet.line(view(Eigen::Vector2d(x, view.min_m.y())), view(Eigen::Vector2d(x, view.max_m.y())),
               {palette::kGrid, 1.0});
  for (double y = std::ceil(view.min_m.y()); y <= view.max_m.y(); y += 1.0)
    sheet.line(view(Eigen::Vector2d(view.min_m.x(), y)), view(Eigen::Vector2d(view.max_m.x(), y)),
               {palette::kGrid, 1.0});
}

void hatch(const Sheet& sheet, const std::vector<Eigen::Vector2d>& polygon, double spacing) {
  Eigen::Vector2d low = polygon.front();
  Eigen::Vector2d high = polygon.front();
  for (const Eigen::Vector2d& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  cairo_save(sheet.context());
  sheet.polyline(polygon, true);
  cairo_clip(sheet.context());
  const double height = high.y() - low.y();
  for (double x = low.x() - height; x < high.x(); x += spacing)
    sheet.line({x, high.y()}, {x + height, low.y()}, {palette::kMuted.with_alpha(0.45), 1.0});
  cairo_restore(sheet.context());
}

void draw_obstacle(const Sheet& sheet, const MapView& view, const Obstacle& obstacle) {
  const std::vector<Eigen::Vector2d> polygon = view(obstacle.polygon);
  sheet.polyline(polygon, true);
  sheet.fill(palette::kSolid);
  hatch(sheet, polygon, 9.0);
  sheet.polyline(polygon, true);
  sheet.stroke({palette::kMuted, 1.5});
}

// Every how many metres an axis is labelled, so that the figures stay apart.
double label_step(double scale) {
  for (const double step : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0})
    if (step * scale >= 38.0) return step;
  return 100.0;
}

void draw_scale_bar(const Sheet& sheet, const Eigen::Vector2d& right_end, double metres,
                    double scale) {
  constexpr double kHalfHeight = 4.0;
  const double left = right_end.x() - metres * scale;
  sheet.rectangle({left, right_end.y() - kHalfHeight, metres * scale, 2.0 * kHalfHeight});
  sheet.fill(palette::kWhite);
  sheet.rectangle({left, right_end.y() - kHalfHeight, 0.5 * metres * scale, 2.0 * kHalfHeight});
  sheet.fill(palette::kInk);
  sheet.rectangle({left, right_end.y() - kHalfHeight, metres * scale, 2.0 * kHalfHeight});
  sheet.stroke({palette::kInk, 1.0});
  sheet.text(std::to_string(static_cast<int>(metres)) + " m", {left - 8.0, right_end.y()}, {13.0},
             palette::kInk, {1.0, 0.5});
}

}  // namespace

Box MapView::box() const {
  const Eigen::Vector2d size = (max_m - min_m) * scale;
  return {corner.x(), corner.y(), size.x(), size.y()};
}

Eigen::Vector2d MapView::operator()(const Eigen::Vector2d& p_m) const {
  return corner + scale * Eigen::Vector2d(p_m.x() - min_m.x(), max_m.y() - p_m.y());
}

std::vector<Eigen::Vector2d> MapView::operator()(
    const std::vector<Eigen::Vector2d>& points_m) const {
  std::vector<Eigen::Vector2d> points;
  points.reserve(points_m.size());
  for (const Eigen::Vector2d& p : points_m) points.push_back((*this)(p));
  return points;
}

MapView fit_view(const FloorPlan& plan, double margin_m, const Box& space) {
  MapView view;
  view.min_m = plan.min_corner().array() - margin_m;
  view.max_m = plan.max_corner().array() + margin_m;
  const Eigen::Vector2d extent = view.max_m - view.min_m;
  view.scale = std::min(space.width / extent.x(), space.height / extent.y());
  view.corner = {space.x + 0.5 * (space.width - extent.x() * view.scale), space.y};
  return view;
}

Colour landmark_colour(const LandmarkMap& landmarks, LandmarkId id) {
  constexpr std::array colours{palette::kGreen, palette::kPurple, palette::kOrange,
                               palette::kSkyBlue};
  const auto& all = landmarks.all();
  const auto at = std::find_if(all.begin(), all.end(),
                               [id](const Landmark& landmark) { return landmark.id == id; });
  return colours[static_cast<std::size_t>(at - all.begin()) % colours.size()];
}

void draw_floor(const Sheet& sheet, const MapView& view, const FloorPlan& plan) {
  const Sheet::Clip clip = sheet.clip(view.box());
  draw_grid(sheet, view);
  for (const Obstacle& obstacle : plan.obstacles()) draw_obstacle(sheet, view, obstacle);
  for (const Wall& wall : plan.partitions())
    sheet.line(view(wall.a), view(wall.b), {palette::kInk, kWallWidth});
  sheet.polyline(view(plan.outline()), true);
  sheet.stroke({palette::kInk, kWallWidth});
}

void draw_axes(const Sheet& sheet, const MapView& view) {
  const Box box = view.box();
  const double step = label_step(view.scale);
  for (double x = std::ceil(view.min_m.x() / step) * step; x <= view.max_m.x(); x += step) {
    const double u = view(Eigen::Vector2d(x, 0.0)).x();
    sheet.line({u, box.bottom()}, {u, box.bottom() + 6.0}, {palette::kMuted, 1.0});
    sheet.text(std::to_string(std::lround(x)), {u, box.bottom() + 17.0}, {13.0}, palette::kInk,
               {0.5, 0.5});
  }
  for (double y = std::ceil(view.min_m.y() / step) * step; y <= view.max_m.y(); y += step) {
    const double v = view(Eigen::Vector2d(0.0, y)).y();
    sheet.line({box.x, v}, {box.x - 6.0, v}, {palette::kMuted, 1.0});
    sheet.text(std::to_string(std::lround(y)), {box.x - 12.0, v}, {13.0}, palette::kInk,
               {1.0, 0.5});
  }
  sheet.rectangle(box);
  sheet.stroke({palette::kMuted, 1.0});
  sheet.text("x, m", {box.x + 0.5 * box.width, box.bottom() + 38.0}, {14.0}, palette::kInk,
             {0.5, 0.5});
  sheet.upright_text("y, m", {box.x - 46.0, box.y + 0.5 * box.height}, {14.0}, palette::kInk);
  draw_scale_bar(sheet, {box.right(), box.bottom() + 38.0}, step, view.scale);
}

void draw_landmark(const Sheet& sheet, const MapView& view, const WorldMap& world,
                   const Landmark& landmark, Colour colour) {
  constexpr double kSmallest = 7.0;
  const Eigen::Vector2d centre = view(world.in_plan(landmark));
  const Eigen::Vector2d normal(landmark.normal_w().x(), -landmark.normal_w().y());
  const double radius = std::max(kSmallest, disc_radius(landmark).value_or(0.0) * view.scale);
  sheet.line(centre, centre + (radius + 9.0) * normal, {palette::kInk, 2.0});
  sheet.circle(centre, radius);
  sheet.fill(colour);
  sheet.circle(centre, radius);
  sheet.stroke({palette::kInk, 1.5});
}

}  // namespace vigia::report

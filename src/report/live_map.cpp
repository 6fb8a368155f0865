#include "vigia/report/live_map.hpp"

#include "drive_layer.hpp"
#include "map_view.hpp"
#include "outlines.hpp"
#include "sheet.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace vigia::report {
namespace {

using MapSurface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

constexpr double kMargin_m = 0.3;
constexpr double kLabel_px = 24.0;  // ahead of a landmark, inside the room

MapSurface surface_of(int width, int height) {
  return {cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), &cairo_surface_destroy};
}

void draw_field(const Sheet& sheet, const MapView& view, const FieldMap& field) {
  const double x = 0.5 * field.length_m + field.margin_m;
  const double y = 0.5 * field.width_m + field.margin_m;
  sheet.polyline(view(std::vector<Eigen::Vector2d>{{-x, -y}, {x, -y}, {x, y}, {-x, y}}), true);
  sheet.fill(palette::kGreen.with_alpha(0.25));
  for (const FieldLine& line : field.lines) {
    sheet.polyline(view(line_points(line)));
    sheet.stroke({palette::kMuted, std::max(1.0, line.width_m * view.scale)});
  }
  for (const FieldGoal& goal : field.goals)
    sheet.line(view(goal.from), view(goal.to), {palette::kOrange, 4.0});
}

/// Colours of a surface without transparency are a native word a pixel.
vpImage<vpRGBa> image_of(cairo_surface_t* surface) {
  cairo_surface_flush(surface);
  const unsigned char* data = cairo_image_surface_get_data(surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  vpImage<vpRGBa> image(static_cast<unsigned>(cairo_image_surface_get_height(surface)),
                        static_cast<unsigned>(cairo_image_surface_get_width(surface)));
  for (unsigned v = 0; v < image.getHeight(); ++v) {
    const auto* row = reinterpret_cast<const std::uint32_t*>(data + v * stride);
    for (unsigned u = 0; u < image.getWidth(); ++u)
      image[v][u] =
          vpRGBa(static_cast<unsigned char>(row[u] >> 16U),
                 static_cast<unsigned char>(row[u] >> 8U), static_cast<unsigned char>(row[u]));
  }
  return image;
}

/// The plan fitted into the picture, in its middle.
MapView middle_view(const FloorPlan& plan, int width, int height) {
  MapView view = fit_view(plan, kMargin_m, {0.0, 0.0, 1.0 * width, 1.0 * height});
  view.corner.y() = 0.5 * (height - view.box().height);
  return view;
}

/// Adds a point where it lies far enough from the last to show.
void extend(std::vector<Eigen::Vector2d>& track, const Eigen::Vector2d& p, double apart_m) {
  if (track.empty() || (p - track.back()).norm() >= apart_m) track.push_back(p);
}

}  // namespace

struct LiveMap::Impl {
  const WorldMap& world;
  double robot_radius_m;
  int width;
  int height;
  MapView view;
  MapSurface ground;  ///< what does not change
  std::vector<Eigen::Vector2d> truth_track = {};
  std::vector<Eigen::Vector2d> believed_track = {};
  Pose2 truth = {};

  void draw_ground(const Path& route) const;
  void draw_belief(const Sheet& sheet, const Belief& belief) const;
  void draw_robot(const Sheet& sheet) const;
};

void LiveMap::Impl::draw_ground(const Path& route) const {
  const Sheet sheet(ground.get());
  sheet.rectangle({0.0, 0.0, 1.0 * width, 1.0 * height});
  sheet.fill(palette::kWhite);
  if (world.field) draw_field(sheet, view, *world.field);
  draw_floor(sheet, view, world.plan);
  sheet.polyline(view(route.points()));
  sheet.stroke({palette::kInk, 1.2, {9.0, 7.0}});
  for (const Landmark& landmark : world.landmarks.all()) {
    draw_landmark(sheet, view, world, landmark, landmark_colour(world.landmarks, landmark.id));
    const Eigen::Vector2d ahead(landmark.normal_w().x(), -landmark.normal_w().y());
    sheet.outlined_text("L" + std::to_string(landmark.id),
                        view(world.in_plan(landmark)) + kLabel_px * ahead, {12.0, true},
                        palette::kInk, palette::kWhite, 2.0, {0.5, 0.5});
  }
}

void LiveMap::Impl::draw_belief(const Sheet& sheet, const Belief& belief) const {
  const auto draw = [&](const Pose2& pose, const Eigen::Matrix3d& covariance) {
    const auto outline = view(
        ellipse_outline(pose.position(), covariance.topLeftCorner<2, 2>(), std::sqrt(kChi2At95)));
    sheet.polyline(outline, true);
    sheet.fill(palette::kBlue.with_alpha(0.16));
    sheet.polyline(outline, true);
    sheet.stroke({palette::kBlue, 1.6});
  };
  if (belief.hypotheses.empty()) draw(belief.pose, belief.covariance);
  for (const PoseHypothesis& each : belief.hypotheses) draw(each.pose, each.covariance);
}

void LiveMap::Impl::draw_robot(const Sheet& sheet) const {
  const Eigen::Vector2d centre = view(truth.position());
  const double radius = std::max(5.0, robot_radius_m * view.scale);
  sheet.circle(centre, radius);
  sheet.fill(palette::kInk.with_alpha(0.15));
  sheet.circle(centre, radius);
  sheet.stroke({palette::kInk, 2.0});
  sheet.line(centre,
             centre + radius * Eigen::Vector2d(std::cos(truth.theta), -std::sin(truth.theta)),
             {palette::kInk, 2.0});
}

LiveMap::LiveMap(const WorldMap& world, const Path& route, double robot_radius_m, int width,
                 int height)
    : impl_(new Impl{world, robot_radius_m, width, height, middle_view(world.plan, width, height),
                     surface_of(width, height)}) {
  impl_->draw_ground(route);
}

LiveMap::~LiveMap() = default;

void LiveMap::move(const Pose2& truth, const Pose2& believed) {
  const double pixel_m = 1.0 / impl_->view.scale;
  impl_->truth = truth;
  extend(impl_->truth_track, truth.position(), pixel_m);
  extend(impl_->believed_track, believed.position(), pixel_m);
}

vpImage<vpRGBa> LiveMap::picture(const Belief& belief, std::optional<LandmarkId> target) const {
  const MapSurface surface = surface_of(impl_->width, impl_->height);
  {
    const Sheet sheet(surface.get());
    cairo_set_source_surface(sheet.context(), impl_->ground.get(), 0.0, 0.0);
    cairo_paint(sheet.context());
    const MapView& view = impl_->view;
    sheet.polyline(view(impl_->truth_track));
    sheet.stroke({palette::kTruth.with_alpha(0.75), 5.0});
    sheet.polyline(view(impl_->believed_track));
    sheet.stroke({palette::kBlue, 2.0});
    const Landmark* looked_for = target ? impl_->world.landmarks.find(*target) : nullptr;
    if (looked_for != nullptr)
      sheet.line(view(impl_->truth.position()), view(impl_->world.in_plan(*looked_for)),
                 {landmark_colour(impl_->world.landmarks, *target), 1.5});
    impl_->draw_belief(sheet, belief);
    impl_->draw_robot(sheet);
  }
  return image_of(surface.get());
}

}  // namespace vigia::report

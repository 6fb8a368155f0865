#include "vigia/report/plan_picture.hpp"

#include "label_placer.hpp"
#include "map_marks.hpp"
#include "map_page.hpp"
#include "map_view.hpp"
#include "sheet.hpp"

#include <cmath>
#include <functional>

namespace vigia::report {
namespace {

constexpr double kPlanAxisHeight = 62.0;
constexpr double kLegendHeight = 42.0;
constexpr double kPlanHalo = 3.0;  // round labels

/// Neighbouring areas take turns.
Colour area_colour(std::size_t index) {
  return index % 2 == 0 ? palette::kBlue : palette::kMuted;
}

std::vector<Eigen::Vector2d> stretch(const Path& path, double from, double to) {
  constexpr double kStep_m = 0.05;
  std::vector<Eigen::Vector2d> points;
  for (double s = from; s < to; s += kStep_m) points.push_back(path.at(s));
  points.push_back(path.at(to));
  return points;
}

void draw_positions(const Sheet& sheet, const MapView& view, const PlanPicture& plan) {
  for (std::size_t i = 0; i < plan.areas.size(); ++i) {
    for (const Eigen::Vector2d& p : plan.areas[i].positions) {
      sheet.circle(view(p), plan.position_radius_m * view.scale);
      sheet.fill(area_colour(i).with_alpha(0.10));
      sheet.circle(view(p), plan.position_radius_m * view.scale);
      sheet.stroke({area_colour(i), 1.2});
    }
  }
}

void draw_sight_lines(const Sheet& sheet, const MapView& view, const PlanPicture& plan) {
  for (const PictureArea& area : plan.areas) {
    const Landmark* landmark = area.chosen ? plan.world.landmarks.find(*area.chosen) : nullptr;
    if (landmark == nullptr) continue;
    const Colour colour = landmark_colour(plan.world.landmarks, landmark->id);
    for (const Eigen::Vector2d& p : area.positions)
      sheet.line(view(p), view(plan.world.in_plan(*landmark)), {colour.with_alpha(0.85), 1.8});
  }
}

void draw_path(const Sheet& sheet, const MapView& view, const PlanPicture& plan) {
  for (std::size_t i = 0; i < plan.areas.size(); ++i) {
    sheet.polyline(view(stretch(plan.path, plan.areas[i].from_m, plan.areas[i].to_m)));
    sheet.stroke({area_colour(i), 5.0});
  }
  for (const PictureArea& area : plan.areas)
    for (const Eigen::Vector2d& p : area.positions) {
      sheet.circle(view(p), 4.0);
      sheet.fill(palette::kWhite);
      sheet.circle(view(p), 4.0);
      sheet.stroke({palette::kInk, 1.5});
    }
}

/// A bar across the path where one area ends and the next begins.
void draw_borders(const Sheet& sheet, const MapView& view, const PlanPicture& plan) {
  for (std::size_t i = 1; i < plan.areas.size(); ++i) {
    const double s = plan.areas[i].from_m;
    const double heading = plan.path.heading(s);
    const Eigen::Vector2d across(-std::sin(heading), -std::cos(heading));
    const Eigen::Vector2d at = view(plan.path.at(s));
    sheet.line(at - 17.0 * across, at + 17.0 * across, {palette::kWhite, 6.0});
    sheet.line(at - 16.0 * across, at + 16.0 * across, {palette::kInk, 3.0});
  }
}

void diamond(const Sheet& sheet, const Eigen::Vector2d& at) {
  const std::vector<Eigen::Vector2d> corners{
      at + Eigen::Vector2d(0.0, -9.0), at + Eigen::Vector2d(9.0, 0.0),
      at + Eigen::Vector2d(0.0, 9.0), at + Eigen::Vector2d(-9.0, 0.0)};
  sheet.polyline(corners, true);
  sheet.fill(palette::kVermillion);
  sheet.polyline(corners, true);
  sheet.stroke({palette::kInk, 1.2});
}

/// A chevron in the middle of each area, along the direction of travel.
void draw_arrows(const Sheet& sheet, const MapView& view, const PlanPicture& plan) {
  for (const PictureArea& area : plan.areas) {
    const double s = 0.5 * (area.from_m + area.to_m) + 0.5;
    const double heading = plan.path.heading(s);
    const Eigen::Vector2d u(std::cos(heading), -std::sin(heading));
    draw_chevron(sheet, view(plan.path.at(s)), u, 6.0, 2.6);
  }
}

/// Keeps labels off what is drawn.
void avoid_drawing(LabelPlacer& labels, const MapView& view, const PlanPicture& plan) {
  for (const Eigen::Vector2d& p : view(stretch(plan.path, 0.0, plan.path.length())))
    block_disc(labels, p, 5.0);
  for (const double s : plan.turn_points) block_disc(labels, view(plan.path.at(s)), 10.0);
  for (const PictureArea& area : plan.areas) {
    const Landmark* landmark = area.chosen ? plan.world.landmarks.find(*area.chosen) : nullptr;
    if (landmark == nullptr) continue;
    for (const Eigen::Vector2d& p : area.positions)
      for (double t = 0.0; t < 1.0; t += 0.04)
        labels.avoid(view(Eigen::Vector2d((1.0 - t) * p + t * plan.world.in_plan(*landmark))));
  }
}

void draw_labels(const Sheet& sheet, const MapView& view, const PlanPicture& plan) {
  LabelPlacer labels(view.box());
  avoid_drawing(labels, view, plan);
  for (const Landmark& landmark : plan.world.landmarks.all()) {
    draw_landmark(sheet, view, plan.world, landmark,
                  landmark_colour(plan.world.landmarks, landmark.id));
    block_disc(labels, view(plan.world.in_plan(landmark)), 10.0);
  }
  for (const Landmark& landmark : plan.world.landmarks.all())
    draw_tag(sheet, labels, "L" + std::to_string(landmark.id), view(plan.world.in_plan(landmark)),
             12.0, {-landmark.normal_w().x(), landmark.normal_w().y()}, {18.0, true}, palette::kInk,
             kPlanHalo);
  const double start = plan.path.heading(0.0);
  draw_tag(sheet, labels, "start", view(plan.path.at(0.0)), 9.0,
           {-std::cos(start), std::sin(start)}, {15.0, true}, palette::kInk, kPlanHalo);
  const double end = plan.path.heading(plan.path.length());
  draw_tag(sheet, labels, "goal", view(plan.path.at(plan.path.length())), 9.0,
           {std::cos(end), -std::sin(end)}, {15.0, true}, palette::kVermillion, kPlanHalo);
  for (std::size_t i = 0; i < plan.areas.size(); ++i) {
    const double s = 0.5 * (plan.areas[i].from_m + plan.areas[i].to_m);
    const double heading = plan.path.heading(s);
    draw_tag(sheet, labels, plan.areas[i].label, view(plan.path.at(s)), 16.0,
             {std::sin(heading), std::cos(heading)}, {18.0, true}, area_colour(i), kPlanHalo);
  }
}

double plan_entry(const Sheet& sheet, double x, double y, const std::string& text,
                  const std::function<void(const Eigen::Vector2d&)>& draw) {
  constexpr double kIcon = 40.0;
  const Font font{14.0};
  draw({x + 0.5 * kIcon, y});
  sheet.text(text, {x + kIcon + 8.0, y}, font, palette::kInk);
  return x + kIcon + 8.0 + sheet.text_size(text, font).x() + 28.0;
}

void draw_plan_legend(const Sheet& sheet, double y) {
  const Eigen::Vector2d half(18.0, 0.0);
  double x = kPageLeft;
  x = plan_entry(sheet, x, y, "control areas, by turns", [&](const Eigen::Vector2d& at) {
    sheet.line(at - half, at, {area_colour(0), 5.0});
    sheet.line(at, at + half, {area_colour(1), 5.0});
    sheet.line(at - Eigen::Vector2d(0.0, 10.0), at + Eigen::Vector2d(0.0, 10.0),
               {palette::kInk, 3.0});
  });
  x = plan_entry(sheet, x, y, "control position", [&](const Eigen::Vector2d& at) {
    sheet.circle(at, 14.0);
    sheet.fill(area_colour(0).with_alpha(0.10));
    sheet.circle(at, 14.0);
    sheet.stroke({area_colour(0), 1.2});
    sheet.circle(at, 4.0);
    sheet.stroke({palette::kInk, 1.5});
  });
  x = plan_entry(sheet, x, y, "turn point, left out",
                 [&](const Eigen::Vector2d& at) { diamond(sheet, at); });
  x = plan_entry(sheet, x, y, "sight line to the area's landmark, in its colour",
                 [&](const Eigen::Vector2d& at) {
                   sheet.line(at - half, at + half, {palette::kGreen.with_alpha(0.85), 1.8});
                 });
  plan_entry(sheet, x, y, "landmark and its normal", [&](const Eigen::Vector2d& at) {
    sheet.line(at, at + Eigen::Vector2d(16.0, 0.0), {palette::kInk, 2.0});
    sheet.circle(at, 7.0);
    sheet.fill(palette::kGreen);
    sheet.circle(at, 7.0);
    sheet.stroke({palette::kInk, 1.5});
  });
}

}  // namespace

void draw_plan(const PlanPicture& plan, const std::filesystem::path& file) {
  const MapView view = page_view(plan.world.plan);
  const double legend = view.box().bottom() + kPlanAxisHeight;
  Sheet sheet(file, kPageWidth, std::ceil(legend + kLegendHeight));
  draw_page_title(sheet, plan.title, plan.subtitle);
  draw_floor(sheet, view, plan.world.plan);
  {
    const Sheet::Clip clip = sheet.clip(view.box());
    draw_positions(sheet, view, plan);
    draw_sight_lines(sheet, view, plan);
    draw_path(sheet, view, plan);
    draw_borders(sheet, view, plan);
    draw_arrows(sheet, view, plan);
    for (const double s : plan.turn_points) diamond(sheet, view(plan.path.at(s)));
    draw_labels(sheet, view, plan);
  }
  draw_axes(sheet, view);
  draw_plan_legend(sheet, legend + 0.5 * kLegendHeight - 6.0);
  sheet.save();
}

}  // namespace vigia::report

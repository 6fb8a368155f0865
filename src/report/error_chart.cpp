#include "error_chart.hpp"

#include "chart_axis.hpp"
#include "travel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace vigia::report {
namespace {

// What the chart shows, centimetres over metres.
struct Series {
  std::vector<double> distance_m;
  std::vector<double> estimate_cm;
  std::vector<double> bound_cm;
  std::vector<double> odometry_cm;
};

Series series_of(const MapDrive& drive) {
  Series series;
  series.distance_m = travelled_m(drive);
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    const Eigen::Vector2d truth = drive.truth[i].position();
    if (!drive.estimate.empty()) {
      const MapPose& estimate = drive.estimate[i];
      series.estimate_cm.push_back(100.0 * (estimate.pose.position() - truth).norm());
      series.bound_cm.push_back(200.0 * position_sigma_m(estimate.covariance));
    }
    if (!drive.odometry.empty())
      series.odometry_cm.push_back(100.0 * (drive.odometry[i].position() - truth).norm());
  }
  return series;
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

// Odometry may drift so far that the estimate would be a line on the axis: it leaves the chart at
// four times what the estimate needs.
double top_cm(const Series& series) {
  const double estimate = std::max(largest(series.estimate_cm), largest(series.bound_cm));
  const double odometry = largest(series.odometry_cm);
  const double top = estimate > 0.0 ? std::clamp(odometry, estimate, 4.0 * estimate) : odometry;
  return top > 0.0 ? 1.08 * top : 1.0;
}

struct ErrorScales {
  Box frame;
  double right_m;
  double top_cm;

  Eigen::Vector2d operator()(double distance_m, double error_cm) const {
    return {frame.x + frame.width * distance_m / right_m,
            frame.bottom() - frame.height * error_cm / top_cm};
  }
};

std::string figure(double value, int decimals) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

void draw_frame(const Sheet& sheet, const ErrorScales& at) {
  const double step_m = round_step(at.right_m, 26);
  for (int i = 0; i * step_m <= at.right_m; ++i) {
    const Eigen::Vector2d foot = at(i * step_m, 0.0);
    sheet.line(foot, {foot.x(), at.frame.y}, {palette::kGrid, 1.0});
    sheet.text(figure(i * step_m, step_m < 1.0 ? 1 : 0), foot + Eigen::Vector2d(0.0, 16.0), {13.0},
               palette::kInk, {0.5, 0.5});
  }
  const double step_cm = round_step(at.top_cm, 6);
  for (int i = 0; i * step_cm <= at.top_cm; ++i) {
    const Eigen::Vector2d left = at(0.0, i * step_cm);
    sheet.line(left, {at.frame.right(), left.y()}, {palette::kGrid, 1.0});
    sheet.text(figure(i * step_cm, step_cm < 1.0 ? 1 : 0), left - Eigen::Vector2d(10.0, 0.0),
               {13.0}, palette::kInk, {1.0, 0.5});
  }
  sheet.rectangle(at.frame);
  sheet.stroke({palette::kMuted, 1.0});
}

std::vector<Eigen::Vector2d> curve(const ErrorScales& at, const Series& series,
                                   const std::vector<double>& values) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < values.size(); ++i)
    points.push_back(at(series.distance_m[i], values[i]));
  return points;
}

void draw_curves(const Sheet& sheet, const ErrorScales& at, const Series& series,
                 const DriveStyle& style) {
  const Sheet::Clip clip = sheet.clip(at.frame);
  if (!series.bound_cm.empty()) {
    std::vector<Eigen::Vector2d> band = curve(at, series, series.bound_cm);
    sheet.polyline(band);
    sheet.stroke({style.ellipse.colour.with_alpha(0.6), 1.2});
    band.push_back(at(series.distance_m.back(), 0.0));
    band.push_back(at(0.0, 0.0));
    sheet.polyline(band, true);
    sheet.fill(style.ellipse.colour.with_alpha(style.ellipse_fill));
  }
  sheet.polyline(curve(at, series, series.odometry_cm));
  sheet.stroke(style.odometry);
  sheet.polyline(curve(at, series, series.estimate_cm));
  sheet.stroke(style.estimate);
}

void draw_looks(const Sheet& sheet, const ErrorScales& at, const MapDrive& drive,
                const Series& series) {
  const std::vector<std::size_t> instants = look_instants(drive.truth, drive.looks);
  double free_from = at.frame.x;
  for (std::size_t i = 0; i < drive.looks.size(); ++i) {
    const Colour colour = landmark_colour(drive.world.landmarks, drive.looks[i].landmark);
    const Eigen::Vector2d foot = at(series.distance_m[instants[i]], 0.0);
    const std::vector<Eigen::Vector2d> mark{foot + Eigen::Vector2d(0.0, -9.0),
                                            foot + Eigen::Vector2d(5.0, 0.0),
                                            foot + Eigen::Vector2d(-5.0, 0.0)};
    sheet.polyline(mark, true);
    sheet.fill(drive.looks[i].fused ? colour : palette::kWhite);
    sheet.polyline(mark, true);
    sheet.stroke({palette::kInk, 1.0});
    const std::string id = "L" + std::to_string(drive.looks[i].landmark);
    const Font font{11.0};
    const double half = 0.5 * sheet.text_size(id, font).x();
    if (foot.x() - half < free_from) continue;
    sheet.text(id, foot + Eigen::Vector2d(0.0, 33.0), font, palette::kInk, {0.5, 0.5});
    free_from = foot.x() + half + 3.0;
  }
}

// A line at each mark, its word on top in the first row that has room.
void draw_marks(const Sheet& sheet, const ErrorScales& at, const MapDrive& drive,
                const Series& series) {
  const Font font{11.0, true};
  std::array<double, 4> free_from{};
  for (const MapMark& mark : drive.marks) {
    const double x = at(series.distance_m[mark.instant], 0.0).x();
    const Colour colour = mark.grave ? palette::kVermillion : palette::kMuted;
    sheet.line({x, at.frame.y}, {x, at.frame.bottom()}, {colour.with_alpha(0.7), 1.2, {5.0, 4.0}});
    const double width = sheet.text_size(mark.text, font).x();
    const double left = std::min(x + 3.0, at.frame.right() - width - 2.0);
    const auto row = std::find_if(free_from.begin(), free_from.end(),
                                  [left](double free) { return free <= left; });
    if (row == free_from.end()) continue;
    const double y = at.frame.y + 9.0 + 13.0 * static_cast<double>(row - free_from.begin());
    sheet.outlined_text(mark.text, {left, y}, font, colour, palette::kWhite, 2.0);
    *row = left + width + 6.0;
  }
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::string summary(const std::string& name, const std::vector<double>& values) {
  return name + ": rms " + figure(rms(values), 1) + ", max " + figure(largest(values), 1) +
         ", end " + figure(values.back(), 1) + " cm";
}

// The curves' names with their figures, on white, right of @p left.
double draw_key(const Sheet& sheet, double left, double y, const std::string& text,
                const Stroke& stroke) {
  const Font font{14.0};
  sheet.line({left, y}, {left + 34.0, y}, stroke);
  sheet.text(text, {left + 42.0, y}, font, palette::kInk);
  return left + 42.0 + sheet.text_size(text, font).x() + 30.0;
}

void draw_keys(const Sheet& sheet, const Box& frame, const MapDrive& drive, const Series& series,
               const DriveStyle& style) {
  const double y = frame.y - 17.0;
  sheet.text("Position error over distance", {frame.x, y}, {16.0, true}, palette::kInk);
  double x = frame.x + sheet.text_size("Position error over distance", {16.0, true}).x() + 30.0;
  if (!series.estimate_cm.empty()) {
    x = draw_key(sheet, x, y, summary(drive.estimate_name, series.estimate_cm), style.estimate);
    x = draw_key(sheet, x, y, "its 2σ bound", {style.ellipse.colour.with_alpha(0.3), 11.0, {34.0}});
  }
  if (!series.odometry_cm.empty())
    draw_key(sheet, x, y, summary("odometry", series.odometry_cm), style.odometry);
}

}  // namespace

void draw_error_chart(const Sheet& sheet, const Box& frame, const MapDrive& drive,
                      const DriveStyle& style) {
  const Series series = series_of(drive);
  const ErrorScales at{frame, std::max(series.distance_m.back(), 1e-3), top_cm(series)};
  draw_frame(sheet, at);
  draw_curves(sheet, at, series, style);
  draw_looks(sheet, at, drive, series);
  draw_marks(sheet, at, drive, series);
  draw_keys(sheet, frame, drive, series, style);
  sheet.upright_text("error, cm", {frame.x - 46.0, frame.y + 0.5 * frame.height}, {14.0},
                     palette::kInk);
  sheet.text("distance travelled, m", {frame.x + 0.5 * frame.width, frame.bottom() + 54.0}, {14.0},
             palette::kInk, {0.5, 0.5});
}

}  // namespace vigia::report

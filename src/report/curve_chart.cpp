#include "vigia/report/curve_chart.hpp"

#include "sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace vigia::report {
namespace {

constexpr double kCurveWidth = 900.0;
constexpr double kCurveHeight = 560.0;
const Box kCurveFrame{90.0, 80.0, 770.0, 400.0};
constexpr int kCurveSteps = 8;
constexpr std::array<Colour, 6> kCurveColours{palette::kBlue,   palette::kVermillion,
                                              palette::kGreen,  palette::kInk,
                                              palette::kPurple, palette::kOrange};

/// One axis: what it shows, and a step of 1, 2 or 5 × 10^n, or a decade.
struct Axis {
  double low = 0.0;
  double high = 1.0;
  bool decades = false;  ///< values are decimal logarithms

  double step() const {
    if (decades) return 1.0;
    const double rough = (high - low) / kCurveSteps;
    const double decade = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor * decade >= rough) return factor * decade;
    return 10.0 * decade;
  }
  /// The first multiple of the step on the axis.
  double first() const { return step() * std::ceil(low / step() - 1e-9); }
};

struct CurveScales {
  Axis x;
  Axis y;

  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
    return {kCurveFrame.x + kCurveFrame.width * (p.x() - x.low) / (x.high - x.low),
            kCurveFrame.bottom() - kCurveFrame.height * (p.y() - y.low) / (y.high - y.low)};
  }
};

void widen(Axis& axis, double length) {
  const double middle = 0.5 * (axis.low + axis.high);
  axis.low = middle - 0.5 * length;
  axis.high = middle + 0.5 * length;
}

CurveChart in_decades(CurveChart chart) {
  for (Curve& curve : chart.curves) {
    for (Eigen::Vector2d& p : curve.points) {
      if (!(p.y() > 0.0)) throw std::invalid_argument("a logarithm of what is not positive");
      p.y() = std::log10(p.y());
    }
  }
  return chart;
}

Axis axis_of(const CurveChart& chart, Eigen::Index i) {
  Axis axis{INFINITY, -INFINITY, false};
  for (const Curve& curve : chart.curves) {
    for (const Eigen::Vector2d& p : curve.points) {
      axis.low = std::min(axis.low, p(i));
      axis.high = std::max(axis.high, p(i));
    }
  }
  if (!(axis.low <= axis.high)) throw std::invalid_argument("a chart without a point");
  axis.decades = chart.decades && i == 1;
  if (axis.decades) {
    axis.low = std::floor(axis.low);
  } else if (chart.from_zero) {
    axis.low = std::min(axis.low, 0.0);
    axis.high = std::max(axis.high, 0.0);
  }
  if (axis.high - axis.low < 1e-12) widen(axis, 1.0);
  if (i == 1) axis.high += 0.06 * (axis.high - axis.low);
  return axis;
}

CurveScales curve_scales(const CurveChart& chart) {
  CurveScales at{axis_of(chart, 0), axis_of(chart, 1)};
  if (chart.equal_scales) {
    const double x_unit = (at.x.high - at.x.low) / kCurveFrame.width;
    const double y_unit = (at.y.high - at.y.low) / kCurveFrame.height;
    const double unit = 1.1 * std::max(x_unit, y_unit);
    widen(at.x, unit * kCurveFrame.width);
    widen(at.y, unit * kCurveFrame.height);
  }
  return at;
}

std::string label_of(const Axis& axis, double at) {
  const double step = axis.decades ? std::pow(10.0, at) : axis.step();
  double value = axis.decades ? step : at;
  if (std::abs(value) < 1e-6 * step) value = 0.0;  // never −0
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

void draw_grid(const Sheet& sheet, const CurveScales& at) {
  for (double x = at.x.first(); x <= at.x.high + 1e-9; x += at.x.step()) {
    const Eigen::Vector2d foot = at({x, at.y.low});
    sheet.line(foot, {foot.x(), kCurveFrame.y}, {palette::kGrid, 1.0});
    sheet.text(label_of(at.x, x), foot + Eigen::Vector2d(0.0, 16.0), {13.0}, palette::kInk,
               {0.5, 0.5});
  }
  for (double y = at.y.first(); y <= at.y.high + 1e-9; y += at.y.step()) {
    const Eigen::Vector2d left = at({at.x.low, y});
    sheet.line(left, {kCurveFrame.right(), left.y()}, {palette::kGrid, 1.0});
    sheet.text(label_of(at.y, y), left - Eigen::Vector2d(10.0, 0.0), {13.0}, palette::kInk,
               {1.0, 0.5});
  }
  sheet.rectangle(kCurveFrame);
  sheet.stroke({palette::kMuted, 1.0});
}

Stroke stroke_of(const Curve& curve, Colour colour) {
  Stroke stroke{colour, 2.0};
  if (curve.look == Curve::Look::dashed) stroke.dashes = {7.0, 5.0};
  return stroke;
}

void draw_curve(const Sheet& sheet, const CurveScales& at, const Curve& curve, Colour colour) {
  std::vector<Eigen::Vector2d> points;
  std::transform(curve.points.begin(), curve.points.end(), std::back_inserter(points), at);
  if (curve.look == Curve::Look::marks) {
    for (const Eigen::Vector2d& p : points) {
      sheet.circle(p, 4.0);
      sheet.fill(colour);
    }
    return;
  }
  sheet.polyline(points);
  sheet.stroke(stroke_of(curve, colour));
}

/// The curve's name with a sample of it; where the next one may begin.
double draw_curve_key(const Sheet& sheet, double left, const Curve& curve, Colour colour) {
  constexpr double kRow = 62.0;
  const Font font{14.0};
  if (curve.look == Curve::Look::marks) {
    sheet.circle({left + 15.0, kRow}, 4.0);
    sheet.fill(colour);
  } else {
    sheet.line({left, kRow}, {left + 30.0, kRow}, stroke_of(curve, colour));
  }
  sheet.text(curve.name, {left + 38.0, kRow}, font, palette::kInk);
  return left + 38.0 + sheet.text_size(curve.name, font).x() + 26.0;
}

}  // namespace

void write_curve_chart(const std::filesystem::path& file, const CurveChart& original) {
  const CurveChart chart = original.decades ? in_decades(original) : original;
  const CurveScales at = curve_scales(chart);
  Sheet sheet(file, kCurveWidth, kCurveHeight);
  sheet.rectangle({0.0, 0.0, kCurveWidth, kCurveHeight});
  sheet.fill(palette::kWhite);
  sheet.text(chart.title, {kCurveFrame.x, 30.0}, {17.0, true}, palette::kInk);
  draw_grid(sheet, at);
  double left = kCurveFrame.x;
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    const Colour colour = kCurveColours.at(i % kCurveColours.size());
    draw_curve(sheet, at, chart.curves[i], colour);
    left = draw_curve_key(sheet, left, chart.curves[i], colour);
  }
  sheet.text(chart.x_label, {kCurveFrame.x + 0.5 * kCurveFrame.width, kCurveHeight - 30.0}, {14.0},
             palette::kInk, {0.5, 0.5});
  sheet.upright_text(chart.y_label, {28.0, kCurveFrame.y + 0.5 * kCurveFrame.height}, {14.0},
                     palette::kInk);
  sheet.save();
}

}  // namespace vigia::report

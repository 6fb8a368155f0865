#include "vigia/report/arms_picture.hpp"

#include "chart_axis.hpp"
#include "label_placer.hpp"
#include "sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace vigia::report {
namespace {

constexpr double kArmsWidth = 1400.0;
constexpr double kArmsHeight = 900.0;
constexpr double kMark = 8.0;
constexpr double kLogarithmicFrom = 8.0;
const Box kArmsFrame{110.0, 130.0, 1250.0, 670.0};

constexpr std::array<Colour, 6> kArmsColours{palette::kBlue,   palette::kVermillion,
                                             palette::kGreen,  palette::kPurple,
                                             palette::kOrange, palette::kBlack};

struct ArmScales {
  ChartAxis looks;
  ChartAxis rms;
  Eigen::Vector2d operator()(double looks_value, double rms_value) const {
    return {kArmsFrame.x + kArmsFrame.width * looks.fraction(looks_value),
            kArmsFrame.bottom() - kArmsFrame.height * rms.fraction(rms_value)};
  }
};

ArmScales arm_scales(const std::vector<ArmPoint>& arms) {
  const auto span = [&](const ArmValue ArmPoint::*value) {
    double low = (arms.front().*value).low;
    double high = (arms.front().*value).high;
    for (const ArmPoint& arm : arms) {
      low = std::min(low, (arm.*value).low);
      high = std::max(high, (arm.*value).high);
    }
    return std::pair(low, high);
  };
  const auto [fewest, most] = span(&ArmPoint::looks);
  const auto [best, worst] = span(&ArmPoint::path_rms_cm);
  const bool logarithmic = best > 0.0 && worst > kLogarithmicFrom * best;
  return {ChartAxis(fewest, most, false), ChartAxis(best, worst, logarithmic)};
}

std::vector<std::string> groups_of(const std::vector<ArmPoint>& arms) {
  std::vector<std::string> groups;
  for (const ArmPoint& arm : arms)
    if (std::find(groups.begin(), groups.end(), arm.group) == groups.end())
      groups.push_back(arm.group);
  return groups;
}

// Shape and colour distinguish a group, so that either alone is enough.
void draw_mark(const Sheet& sheet, const Eigen::Vector2d& at, std::size_t group) {
  const std::size_t shape = group % 4;
  if (shape == 0) {
    sheet.circle(at, kMark);
  } else {
    static const std::array<std::vector<Eigen::Vector2d>, 3> kOutlines{
        std::vector<Eigen::Vector2d>{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},
        std::vector<Eigen::Vector2d>{{0, -1.2}, {1.2, 0.9}, {-1.2, 0.9}},
        std::vector<Eigen::Vector2d>{{0, -1.4}, {1.2, 0}, {0, 1.4}, {-1.2, 0}}};
    std::vector<Eigen::Vector2d> outline;
    for (const auto& p : kOutlines[shape - 1]) outline.push_back(at + kMark * p);
    sheet.polyline(outline, true);
  }
  sheet.fill(kArmsColours[group % kArmsColours.size()]);
}

void draw_axes(const Sheet& sheet, const ArmScales& at) {
  for (const double tick : at.looks.ticks()) {
    const double x = kArmsFrame.x + kArmsFrame.width * at.looks.fraction(tick);
    sheet.line({x, kArmsFrame.y}, {x, kArmsFrame.bottom()}, {palette::kGrid, 1.0});
    sheet.text(at.looks.label(tick), {x, kArmsFrame.bottom() + 20.0}, {16.0}, palette::kInk,
               {0.5, 0.5});
  }
  for (const double tick : at.rms.ticks()) {
    const double y = kArmsFrame.bottom() - kArmsFrame.height * at.rms.fraction(tick);
    sheet.line({kArmsFrame.x, y}, {kArmsFrame.right(), y}, {palette::kGrid, 1.0});
    sheet.text(at.rms.label(tick), {kArmsFrame.x - 10.0, y}, {16.0}, palette::kInk, {1.0, 0.5});
  }
  sheet.rectangle(kArmsFrame);
  sheet.stroke({palette::kMuted, 1.0});
  sheet.text("looks per drive", {kArmsFrame.x + 0.5 * kArmsFrame.width, kArmsFrame.bottom() + 56.0},
             {17.0, true}, palette::kInk, {0.5, 0.5});
  sheet.upright_text("path RMS, cm", {kArmsFrame.x - 76.0, kArmsFrame.y + 0.5 * kArmsFrame.height},
                     {17.0, true}, palette::kInk);
}

void draw_interval(const Sheet& sheet, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                   Colour colour) {
  const Eigen::Vector2d along = to - from;
  if (along.norm() < 1e-9) return;
  const Eigen::Vector2d cap = 5.0 * Eigen::Vector2d(-along.y(), along.x()).normalized();
  sheet.line(from, to, {colour, 2.0});
  sheet.line(from - cap, from + cap, {colour, 2.0});
  sheet.line(to - cap, to + cap, {colour, 2.0});
}

void draw_legend(const Sheet& sheet, const std::vector<std::string>& groups) {
  double x = kArmsFrame.x + kMark;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    draw_mark(sheet, {x, kArmsFrame.y - 24.0}, g);
    sheet.text(groups[g], {x + 18.0, kArmsFrame.y - 24.0}, {16.0}, palette::kInk);
    x += 18.0 + sheet.text_size(groups[g], {16.0}).x() + 34.0;
  }
  sheet.text("bars: 95 % intervals of the means; lower left is better",
             {kArmsFrame.right(), kArmsFrame.y - 24.0}, {15.0}, palette::kMuted, {1.0, 0.5});
}

void draw_points(const Sheet& sheet, const ArmScales& at, const std::vector<ArmPoint>& arms,
                 const std::vector<std::string>& groups) {
  LabelPlacer labels(kArmsFrame);
  const auto group_of = [&](const ArmPoint& arm) {
    return static_cast<std::size_t>(std::find(groups.begin(), groups.end(), arm.group) -
                                    groups.begin());
  };
  for (const ArmPoint& arm : arms) {
    const Colour colour = kArmsColours[group_of(arm) % kArmsColours.size()];
    const ArmValue& x = arm.looks;
    const ArmValue& y = arm.path_rms_cm;
    draw_interval(sheet, at(x.low, y.mean), at(x.high, y.mean), colour);
    draw_interval(sheet, at(x.mean, y.low), at(x.mean, y.high), colour);
    const Eigen::Vector2d p = at(x.mean, y.mean);
    labels.block({p.x() - kMark, p.y() - kMark, 2.0 * kMark, 2.0 * kMark});
    for (double t = 0.0; t <= 1.0; t += 0.1) {
      labels.avoid(at(x.low + t * (x.high - x.low), y.mean));
      labels.avoid(at(x.mean, y.low + t * (y.high - y.low)));
    }
  }
  for (const ArmPoint& arm : arms) {
    const Eigen::Vector2d p = at(arm.looks.mean, arm.path_rms_cm.mean);
    draw_mark(sheet, p, group_of(arm));
    const Font font{15.0, true};
    const Eigen::Vector2d size = sheet.text_size(arm.name, font) + Eigen::Vector2d(4.0, 0.0);
    const auto box = labels.place(p, size, 14.0, {0.7, -0.7});
    if (!box) continue;
    const Eigen::Vector2d middle(box->x + 0.5 * box->width, box->y + 0.5 * box->height);
    sheet.outlined_text(arm.name, middle, font, palette::kInk, palette::kWhite, 2.5, {0.5, 0.5});
  }
}

void check(const ArmsPicture& picture) {
  if (picture.arms.empty()) throw std::invalid_argument("draw_arms: there are no arms");
  for (const ArmPoint& arm : picture.arms)
    for (const ArmValue& v : {arm.looks, arm.path_rms_cm})
      if (!std::isfinite(v.mean + v.low + v.high))
        throw std::invalid_argument("draw_arms: a value of " + arm.name + " is not finite");
}

}  // namespace

void draw_arms(const ArmsPicture& picture, const std::filesystem::path& file) {
  check(picture);
  const ArmScales at = arm_scales(picture.arms);
  const auto groups = groups_of(picture.arms);
  Sheet sheet(file, kArmsWidth, kArmsHeight);
  sheet.text(picture.title, {kArmsFrame.x, 36.0}, {26.0, true}, palette::kInk);
  sheet.text(picture.subtitle, {kArmsFrame.x, 70.0}, {16.0}, palette::kMuted);
  draw_axes(sheet, at);
  draw_legend(sheet, groups);
  draw_points(sheet, at, picture.arms, groups);
  sheet.save();
}

}  // namespace vigia::report

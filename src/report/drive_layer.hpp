#pragma once

#include "label_placer.hpp"
#include "map_view.hpp"
#include "sheet.hpp"

#include <vector>

#include "vigia/report/map_picture.hpp"

namespace vigia::report {

/// χ² of two degrees of freedom at 95 %.
inline constexpr double kChi2At95 = 5.991464547107979;

/// How the lines of the map, the chart and the legend look: one kind each.
struct DriveStyle {
  Stroke planned{palette::kInk, 1.2, {9.0, 7.0}};
  Stroke truth{palette::kTruth.with_alpha(0.75), 8.0};
  Stroke estimate{palette::kBlue, 2.5};
  Stroke odometry{palette::kVermillion, 2.2, {12.0, 4.0, 2.0, 4.0}};
  Stroke kidnapping{palette::kVermillion, 2.2, {3.0, 5.0}};
  Stroke correction{palette::kBlue.with_alpha(0.5), 1.2, {3.0, 5.0}};  ///< of the estimate
  Stroke ellipse{palette::kBlue, 1.6};
  double ellipse_fill = 0.16;
  Stroke ring{palette::kInk, 1.8, {6.0, 4.0}};
  double sight_width = 1.3;
  std::vector<double> unfused_dashes{2.0, 4.0};
};

/// The exaggeration at which the estimate's ellipses are drawn: the drive's own, or a round one.
double ellipse_scale(const MapDrive& drive);

/// Sight lines, paths, ellipses, arrows, look numbers, landmarks and their ids, start and goal.
void draw_drive(const Sheet& sheet, const MapView& view, const MapDrive& drive,
                const DriveStyle& style);

/// The outline of an ellipse with semi-axes √(λ₁)·k and √(λ₂)·k of a 2×2 covariance round p.
std::vector<Eigen::Vector2d> ellipse_outline(const Eigen::Vector2d& p,
                                             const Eigen::Matrix2d& covariance, double k);

}  // namespace vigia::report

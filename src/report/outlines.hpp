#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/field_map.hpp"
#include "vigia/core/observation.hpp"

namespace vigia::report {

/// Points on an ellipse of an image.
inline std::vector<Eigen::Vector2d> outline_points(const Ellipse& e, int count) {
  const Eigen::Rotation2Dd rotation(e.psi);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double t = 2.0 * M_PI * i / count;
    points.emplace_back(Eigen::Vector2d(e.u, e.v) +
                        rotation * Eigen::Vector2d(e.a * std::cos(t), e.b * std::sin(t)));
  }
  return points;
}

/// Whether every figure of an ellipse is a number.
inline bool is_finite(const Ellipse& e) {
  return std::isfinite(e.u) && std::isfinite(e.v) && std::isfinite(e.a) && std::isfinite(e.b) &&
         std::isfinite(e.psi);
}

/// Points along a field's line, both ends included: chords of an arc.
inline std::vector<Eigen::Vector2d> line_points(const FieldLine& line) {
  constexpr double kChord_m = 0.2;
  const int pieces = line.kind == FieldLine::Kind::segment
                         ? 1
                         : std::max(24, static_cast<int>(std::ceil(line.length_m() / kChord_m)));
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= pieces; ++i) points.push_back(line.at(line.length_m() * i / pieces));
  return points;
}

}  // namespace vigia::report

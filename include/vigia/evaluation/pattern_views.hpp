#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "vigia/core/landmark.hpp"
#include "vigia/core/observation.hpp"

namespace vigia::evaluation {

/// A view of a pattern: the truth, and the points that were seen, by whatever tracker or draw.
struct PatternView {
  Landmark landmark;
  Eigen::Isometry3d wMc = Eigen::Isometry3d::Identity();
  PointsObservation seen;
};

enum class ViewMethod {
  printed,       ///< eq. 1–17 as printed: θ with the wrong sign in eq. 15 and 16
  as_published,  ///< with the signs mended, the pattern taken to lie on the optical axis
  exact,         ///< the perspective inverted, view turned so that the pattern lies on the axis
  uncentred,     ///< exact, without turning the view, angles about the ellipse's centre
  refined,       ///< least squares on all points
};

/// Errors of φ, θ (rad), D and the camera's x, y, z in the world (m), in this order: those of the
/// paper's Table 1.
inline constexpr std::size_t kViewQuantities = 6;
using ViewErrors = std::array<double, kViewQuantities>;

/// What the method makes of a view. Of a view and its twin the one from below is taken: the
/// patterns hang above the camera. Nothing when the method finds no pose.
std::optional<ViewErrors> view_errors(const PatternView& view, ViewMethod method);

/// Statistics of the absolute errors of one quantity.
struct QuantityErrors {
  double mean = 0.0;
  double deviation = 0.0;
  double greatest = 0.0;
  double smallest = 0.0;
  double rms = 0.0;
};

struct MethodErrors {
  std::array<QuantityErrors, kViewQuantities> quantities{};
  int views = 0;  ///< that the method found a pose in
};

/// What a method makes of many views.
MethodErrors judge_views(const std::vector<PatternView>& views, ViewMethod method);

/// What the Cramér–Rao bound allows over the views: the mean absolute error √(2/π) σ and the rms.
struct LimitErrors {
  std::array<double, kViewQuantities> mean{};
  std::array<double, kViewQuantities> rms{};
};
LimitErrors limit_of_views(const std::vector<PatternView>& views);

}  // namespace vigia::evaluation

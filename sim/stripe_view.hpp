#pragma once

#include "surface.hpp"

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/imaging/frame.hpp"

namespace vigia::sim {

/// A straight line painted on a surface, in frame d: x along it, z the surface's outward normal.
struct StripeMark {
  Eigen::Isometry3d wMd = Eigen::Isometry3d::Identity();
  double half_length_m = 1.0;
  double half_width_m = 0.05;
  float grey = 235.0F;
  std::array<float, 3> tint{1.0F, 1.0F, 1.0F};  ///< red, green, blue of grey 1; luma 1
  std::size_t surface = 0;                      ///< index of the surface that carries it
};

/// Rays of the corners of the pixels of a window, row by row: one more than pixels each way.
std::vector<Eigen::Vector3d> corner_rays(const CameraModel& model, const imaging::Window& window);

/// A stripe as one exposure sees it. The share of a pixel is that of the polygon which the stripe's
/// sides cut out of the pixel's square, with each side straight within the pixel: exact for a
/// perspective camera without distortion, to second order otherwise. It is computed pixel by pixel,
/// whatever the length of the stripe and wherever it leaves the field.
class StripeView {
 public:
  StripeView(const StripeMark& mark, const Eigen::Isometry3d& cMw);

  const StripeMark& mark() const { return *mark_; }
  /// Whether the camera is on the side of the surface that carries the stripe.
  bool faces_camera() const { return faces_camera_; }
  /// Whether some ray of the box may meet the stripe.
  bool touches(const RayBox& box) const;
  /// Shares of a window's pixels, from the rays of their corners.
  std::vector<float> coverage(const std::vector<Eigen::Vector3d>& corners,
                              const imaging::Window& window) const;

 private:
  const StripeMark* mark_;
  bool faces_camera_ = false;
  Eigen::Matrix<double, 4, 3> sides_;  ///< a ray r meets the stripe where no entry of sides r < 0
};

}  // namespace vigia::sim

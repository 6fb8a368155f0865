#pragma once

#include <vector>

#include <Eigen/Core>

#include "vigia/core/camera_model.hpp"
#include "vigia/imaging/frame.hpp"

namespace vigia::sim {

/// The share of each pixel of @p window (row by row) that lies inside the conic rᵀQr ≥ 0 of rays
/// r, an ellipse in front of the camera, seen through the lens: of the double cone the part where
/// front · r > 0, which is all of the window for a perspective camera. Edge pixels are cut in
/// 16 strips along which the share is exact; the lens is linear within a pixel, the conic is not.
/// @p min_curvature_px is the smallest radius of curvature of the outline.
std::vector<float> conic_coverage(const Eigen::Matrix3d& Q, const Eigen::Vector3d& front,
                                  const CameraModel& model, const imaging::Window& window,
                                  double min_curvature_px);

/// Convolves an image with a Gaussian of @p sigma pixels; what lies within blur_margin() of the
/// window's edge is not valid.
void blur(std::vector<float>& image, const imaging::Window& window, double sigma);
int blur_margin(double sigma);
/// What blur() makes of an image of ones, all of it 1 but for rounding.
float blurred_one(double sigma);

}  // namespace vigia::sim

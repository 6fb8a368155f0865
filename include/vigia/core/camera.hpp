#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace vigia {

/// A pinhole camera with ViSP's one-coefficient radial distortion. Pixels: integer = pixel centre,
/// u right, v down. kdu is taken as the truth: the undistorted normalised point of the distorted
/// (x_d, y_d) = ((u−u0)/px, (v−v0)/py) is (1 + kdu r_d²)·(x_d, y_d).
struct Intrinsics {
  int width = 640;
  int height = 480;
  double px = 700.0;  ///< focal length over pixel width, px
  double py = 700.0;  ///< focal length over pixel height, px
  double u0 = 319.5;
  double v0 = 239.5;
  double kdu = 0.0;  ///< 1, distorted to undistorted
};

/// Normalised undistorted image point of a pixel: the ray is (x, y, 1) in the camera frame.
Eigen::Vector2d unproject(const Intrinsics& intrinsics, const Eigen::Vector2d& uv);

/// Pixel of a normalised undistorted point, by inverting the distortion numerically to 1e-12.
/// Nothing when the point lies beyond the radius at which the distortion folds over.
std::optional<Eigen::Vector2d> distort(const Intrinsics& intrinsics, const Eigen::Vector2d& xy);

/// Pixel of a point in the camera frame (z forward), or nothing when it is not in front of the
/// camera or beyond the distortion's fold. The pixel may lie outside the image.
std::optional<Eigen::Vector2d> project(const Intrinsics& intrinsics, const Eigen::Vector3d& p_c);

/// ∂(u,v)/∂(x,y): how the pixel moves with the normalised undistorted point, at pixel @p uv.
Eigen::Matrix2d distort_jacobian(const Intrinsics& intrinsics, const Eigen::Vector2d& uv);

/// Whether a pixel lies inside the image by at least @p margin pixels.
bool in_image(const Intrinsics& intrinsics, const Eigen::Vector2d& uv, double margin = 0.0);

/// One row of a zoom calibration: what was measured at a position of the zoom motor.
struct ZoomSample {
  double zoom_mm = 8.0;  ///< nominal focal length, the zoom motor's coordinate
  double px = 700.0;     ///< calibrated focal length, px (square pixels)
  double kdu = 0.0;
};

/// The calibrated camera over the zoom's range. Linear between the samples; focal length strictly
/// increasing with zoom_mm. Of one sample: a lens that does not zoom.
class ZoomCalibration {
 public:
  /// One sample: a lens of 700 px.
  ZoomCalibration();
  /// At least one sample. Throws std::invalid_argument unless zoom_mm and px strictly increase.
  ZoomCalibration(int width, int height, double u0, double v0, std::vector<ZoomSample> samples);

  /// The intrinsics at a zoom position, clamped to the table's range.
  Intrinsics at(double zoom_mm) const;
  /// The zoom position whose focal length is @p px, clamped to the table's range.
  double zoom_for_focal(double px) const;
  double min_zoom_mm() const { return samples_.front().zoom_mm; }
  double max_zoom_mm() const { return samples_.back().zoom_mm; }
  const std::vector<ZoomSample>& samples() const { return samples_; }

 private:
  Intrinsics base_;
  std::vector<ZoomSample> samples_;
};

}  // namespace vigia

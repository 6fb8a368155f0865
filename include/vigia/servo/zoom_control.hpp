#pragma once

#include "vigia/core/camera.hpp"

namespace vigia::servo {

struct ZoomControlParams {
  double gain = 1.5;        ///< k of ḟ/f = k ln(a*/a) + Ż/Z, 1/s
  double dead_band = 0.10;  ///< |ln(a*/a)| below which the zoom rests
};

/// Holds the landmark's size in the image: ḟ/f = k ln(a*/a) + Ż/Z, within the zoom's range.
class ZoomControl {
 public:
  explicit ZoomControl(ZoomControlParams params) : params_(params) {}

  /// Zoom rate in mm/s of nominal focal length. @p radius_px: semi-major axis a now, @p wanted_px:
  /// a*, @p depth_rate: Ż/Z in 1/s (negative when approaching).
  double rate(const ZoomCalibration& calibration, double zoom_mm, double radius_px,
              double wanted_px, double depth_rate);

 private:
  ZoomControlParams params_;
  bool moving_ = false;
};

}  // namespace vigia::servo

#include "vigia/servo/zoom_control.hpp"

#include <algorithm>
#include <cmath>

namespace vigia::servo {
namespace {

/// d(px)/d(zoom_mm) of the calibration around a zoom position.
double focal_slope(const ZoomCalibration& calibration, double zoom_mm) {
  const double step = 1e-3 * (calibration.max_zoom_mm() - calibration.min_zoom_mm());
  const double low = std::max(calibration.min_zoom_mm(), zoom_mm - step);
  const double high = std::min(calibration.max_zoom_mm(), zoom_mm + step);
  return (calibration.at(high).px - calibration.at(low).px) / (high - low);
}

}  // namespace

double ZoomControl::rate(const ZoomCalibration& calibration, double zoom_mm, double radius_px,
                         double wanted_px, double depth_rate) {
  if (calibration.samples().size() == 1) return 0.0;
  const double zoom = std::clamp(zoom_mm, calibration.min_zoom_mm(), calibration.max_zoom_mm());
  const double error = std::log(wanted_px / radius_px);
  // Once moving, the zoom goes on well into the band, so that it does not start at every tick.
  moving_ = std::abs(error) > (moving_ ? 0.25 * params_.dead_band : params_.dead_band);
  if (!moving_) return 0.0;

  const double focal_rate = (params_.gain * error + depth_rate) * calibration.at(zoom).px;
  const double result = focal_rate / focal_slope(calibration, zoom);
  const bool at_end = (result > 0.0 && zoom >= calibration.max_zoom_mm()) ||
                      (result < 0.0 && zoom <= calibration.min_zoom_mm());
  return at_end ? 0.0 : result;
}

}  // namespace vigia::servo

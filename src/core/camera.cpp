#include "vigia/core/camera.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/LU>

namespace vigia {
namespace {

/// The distorted radius whose undistorted radius is @p r: the root of k r_d³ + r_d − r nearest 0.
std::optional<double> distorted_radius(double r, double kdu) {
  if (kdu == 0.0 || r == 0.0) return r;
  if (kdu < 0.0) {
    const double fold = 1.0 / std::sqrt(-3.0 * kdu);  // where d r / d r_d vanishes
    if (r >= fold * (1.0 + kdu * fold * fold)) return std::nullopt;
  }
  double rd = kdu > 0.0 ? r / (1.0 + kdu * r * r) : r;
  for (int i = 0; i < 50; ++i) {
    const double step = (rd * (1.0 + kdu * rd * rd) - r) / (1.0 + 3.0 * kdu * rd * rd);
    rd -= step;
    if (std::abs(step) <= 1e-15 * (1.0 + rd)) break;
  }
  return rd;
}

}  // namespace

Eigen::Vector2d unproject(const Intrinsics& intrinsics, const Eigen::Vector2d& uv) {
  const double x = (uv.x() - intrinsics.u0) / intrinsics.px;
  const double y = (uv.y() - intrinsics.v0) / intrinsics.py;
  const double scale = 1.0 + intrinsics.kdu * (x * x + y * y);
  return {scale * x, scale * y};
}

std::optional<Eigen::Vector2d> distort(const Intrinsics& intrinsics, const Eigen::Vector2d& xy) {
  const double r = xy.norm();
  const auto rd = distorted_radius(r, intrinsics.kdu);
  if (!rd) return std::nullopt;
  const double scale = r > 0.0 ? *rd / r : 1.0;
  return Eigen::Vector2d(intrinsics.u0 + intrinsics.px * scale * xy.x(),
                         intrinsics.v0 + intrinsics.py * scale * xy.y());
}

std::optional<Eigen::Vector2d> project(const Intrinsics& intrinsics, const Eigen::Vector3d& p_c) {
  if (p_c.z() <= 1e-9) return std::nullopt;
  return distort(intrinsics, Eigen::Vector2d(p_c.x() / p_c.z(), p_c.y() / p_c.z()));
}

Eigen::Matrix2d distort_jacobian(const Intrinsics& intrinsics, const Eigen::Vector2d& uv) {
  const double x = (uv.x() - intrinsics.u0) / intrinsics.px;
  const double y = (uv.y() - intrinsics.v0) / intrinsics.py;
  const double k = intrinsics.kdu;
  const double scale = 1.0 + k * (x * x + y * y);
  Eigen::Matrix2d dxy_dxdyd;
  dxy_dxdyd << scale + 2.0 * k * x * x, 2.0 * k * x * y, 2.0 * k * x * y, scale + 2.0 * k * y * y;
  return Eigen::Vector2d(intrinsics.px, intrinsics.py).asDiagonal() * dxy_dxdyd.inverse();
}

bool in_image(const Intrinsics& intrinsics, const Eigen::Vector2d& uv, double margin) {
  return uv.x() >= margin && uv.y() >= margin && uv.x() <= intrinsics.width - 1 - margin &&
         uv.y() <= intrinsics.height - 1 - margin;
}

ZoomCalibration::ZoomCalibration() : samples_(1) {}

ZoomCalibration::ZoomCalibration(int width, int height, double u0, double v0,
                                 std::vector<ZoomSample> samples)
    : samples_(std::move(samples)) {
  if (samples_.empty()) throw std::invalid_argument("a zoom calibration needs a sample");
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    if (samples_[i].zoom_mm <= samples_[i - 1].zoom_mm || samples_[i].px <= samples_[i - 1].px)
      throw std::invalid_argument("zoom and focal length must increase from sample to sample");
  }
  base_.width = width;
  base_.height = height;
  base_.u0 = u0;
  base_.v0 = v0;
}

Intrinsics ZoomCalibration::at(double zoom_mm) const {
  Intrinsics result = base_;
  if (samples_.size() == 1) {
    result.px = result.py = samples_.front().px;
    result.kdu = samples_.front().kdu;
    return result;
  }
  const double zoom = std::clamp(zoom_mm, min_zoom_mm(), max_zoom_mm());
  const auto upper = std::find_if(samples_.begin() + 1, samples_.end() - 1,
                                  [zoom](const ZoomSample& s) { return s.zoom_mm >= zoom; });
  const ZoomSample& high = *upper;
  const ZoomSample& low = *(upper - 1);
  const double t = (zoom - low.zoom_mm) / (high.zoom_mm - low.zoom_mm);
  result.px = result.py = low.px + t * (high.px - low.px);
  result.kdu = low.kdu + t * (high.kdu - low.kdu);
  return result;
}

double ZoomCalibration::zoom_for_focal(double px) const {
  if (samples_.size() == 1) return samples_.front().zoom_mm;
  const double focal = std::clamp(px, samples_.front().px, samples_.back().px);
  const auto upper = std::find_if(samples_.begin() + 1, samples_.end() - 1,
                                  [focal](const ZoomSample& s) { return s.px >= focal; });
  const ZoomSample& high = *upper;
  const ZoomSample& low = *(upper - 1);
  return low.zoom_mm + (focal - low.px) / (high.px - low.px) * (high.zoom_mm - low.zoom_mm);
}

}  // namespace vigia

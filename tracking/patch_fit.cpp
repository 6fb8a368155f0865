#include "patch_fit.hpp"

#include "patch_outline.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

using FitNormal = Eigen::Matrix<double, kFitUnknowns, kFitUnknowns>;
using FitVector = Eigen::Matrix<double, kFitUnknowns, 1>;

constexpr int kFitSteps = 12;
constexpr double kFitBand_px = 3.5;  // beside the patch that is fitted with it

struct PatchSums {
  FitNormal normal = FitNormal::Zero();
  FitVector gradient = FitVector::Zero();
  double square = 0.0;
  int pixels = 0;
};

imaging::Window band_of(const PatchWindow& window, const PatchShape& start,
                        const PatchFinderParams& params) {
  const double c = std::abs(std::cos(start.angle));
  const double s = std::abs(std::sin(start.angle));
  const double reach = kFitBand_px + 0.5 * start.motion.norm();
  const double length = 0.5 * params.length_px + reach;
  const double width = 0.5 * params.width_px + reach;
  const double across = length * c + width * s;
  const double down = length * s + width * c;
  const int u = static_cast<int>(std::floor(start.uv.x() - across));
  const int v = static_cast<int>(std::floor(start.uv.y() - down));
  return intersect(window.window, {u, v, static_cast<int>(std::ceil(2.0 * across)) + 1,
                                   static_cast<int>(std::ceil(2.0 * down)) + 1});
}

}  // namespace

std::vector<BandPixel> band_pixels(const PatchWindow& window, const PatchShape& start,
                                   const PatchFinderParams& params) {
  const imaging::Window band = band_of(window, start, params);
  const double c = std::cos(start.angle);
  const double s = std::sin(start.angle);
  const double reach = kFitBand_px + 0.5 * start.motion.norm();
  std::vector<BandPixel> pixels;
  pixels.reserve(static_cast<std::size_t>(std::max(0, band.width * band.height)));
  for (int v = band.v; v < band.bottom(); ++v) {
    for (int u = band.u; u < band.right(); ++u) {
      const double du = u - start.uv.x();
      const double dv = v - start.uv.y();
      if (std::abs(c * du + s * dv) > 0.5 * params.length_px + reach) continue;
      if (std::abs(c * dv - s * du) > 0.5 * params.width_px + reach) continue;
      pixels.push_back(
          {static_cast<float>(u), static_cast<float>(v), static_cast<float>(window.at(u, v))});
    }
  }
  return pixels;
}

namespace {

PatchSums sum_up(const std::vector<BandPixel>& pixels, const PatchShape& shape,
                 const PatchFinderParams& params, double noise) {
  const PatchOutline outline(params, shape.log_scale);
  const auto c = static_cast<float>(std::cos(shape.angle));
  const auto s = static_cast<float>(std::sin(shape.angle));
  const auto blur = static_cast<float>(shape.blur);
  const float per_blur = 1.0F / blur;
  const auto ground = static_cast<float>(shape.ground);
  const auto contrast = static_cast<float>(shape.patch - shape.ground);
  const Eigen::Vector2f middle = shape.uv.cast<float>();
  // One more than there are unknowns: eight are summed up four at a time.
  constexpr int kPadded = kFitUnknowns + 1;
  Eigen::Matrix<float, kPadded, kPadded> normal;
  normal.setZero();
  Eigen::Matrix<float, kPadded, 1> gradient;
  gradient.setZero();
  PatchSums sums;
  for (const BandPixel& pixel : pixels) {
    const float du = pixel.u - middle.x();
    const float dv = pixel.v - middle.y();
    const float x = c * du + s * dv;
    const float y = c * dv - s * du;
    const Share share = outline.share(x, y, per_blur);
    Eigen::Matrix<float, kPadded, 1> row;
    row << contrast * (s * share.dy - c * share.dx), contrast * (-s * share.dx - c * share.dy),
        contrast * (y * share.dx - x * share.dy),
        -contrast * (x * share.dx + y * share.dy + blur * share.dblur()), share.value,
        1.0F - share.value, contrast * share.dblur(), 0.0F;
    const float residual = pixel.grey - ground - contrast * share.value;
    normal.noalias() += row * row.transpose();
    gradient += residual * row;
    sums.square += static_cast<double>(residual * residual);
  }
  sums.pixels = static_cast<int>(pixels.size());
  sums.normal = normal.topLeftCorner<kFitUnknowns, kFitUnknowns>().cast<double>();
  sums.gradient = gradient.head<kFitUnknowns>().cast<double>();
  // The priors, in units of the pixels' noise.
  const auto expect = [&](int i, double off, double sigma) {
    const double weight = noise * noise / (sigma * sigma);
    sums.normal(i, i) += weight;
    sums.gradient[i] -= weight * off;
    sums.square += weight * off * off;
  };
  expect(3, shape.log_scale, params.scale_sigma);
  expect(6, shape.blur - params.blur_px, kBlurSigma_px);
  return sums;
}

}  // namespace

PatchShape stepped(const PatchShape& shape, const Eigen::Matrix<double, kFitUnknowns, 1>& step) {
  PatchShape next = shape;
  next.uv += step.head<2>().cwiseMax(-2.0).cwiseMin(2.0);
  next.angle += std::clamp(step[2], -0.3, 0.3);
  next.log_scale += std::clamp(step[3], -0.1, 0.1);
  next.patch += step[4];
  next.ground += step[5];
  next.blur = std::clamp(shape.blur + step[6], 0.35, 4.0);
  return next;
}

std::optional<PatchFit> fit_patch(const PatchWindow& window, const PatchShape& start,
                                  const PatchFinderParams& params, double give_up) {
  PatchFit fit;
  fit.shape = start;
  fit.noise = 4.0;
  std::vector<BandPixel> pixels = band_pixels(window, start, params);
  if (pixels.size() < 4 * kFitUnknowns) return std::nullopt;
  for (int i = 0; i < kFitSteps; ++i) {
    if (i == 3) pixels = band_pixels(window, fit.shape, params);
    const PatchSums sums = sum_up(pixels, fit.shape, params, fit.noise);
    if (sums.pixels < 4 * kFitUnknowns) return std::nullopt;
    const Eigen::LDLT<FitNormal> solver(sums.normal);
    const FitVector step = solver.solve(sums.gradient);
    if (!step.allFinite()) return std::nullopt;
    fit.square = sums.square;
    if (i > 1 && fit.square > give_up) return fit;
    fit.noise = std::max(kMinNoise, std::sqrt(sums.square / (sums.pixels - kFitUnknowns)));
    fit.shape = stepped(fit.shape, step);
    if (i > 3 && step.head<2>().norm() < 1e-3 && std::abs(step[2]) < 1e-4) {
      fit.shape.angle = wrap_angle(fit.shape.angle);
      return fit;
    }
  }
  return std::nullopt;
}

}  // namespace vigia::tracking

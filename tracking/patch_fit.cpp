#include "patch_fit.hpp"

#include "normal_table.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

constexpr int kFitUnknowns = 7;  // u, v, angle, log scale, patch, ground, blur
using FitNormal = Eigen::Matrix<double, kFitUnknowns, kFitUnknowns>;
using FitVector = Eigen::Matrix<double, kFitUnknowns, 1>;

constexpr int kFitSteps = 12;
constexpr double kCorrelationSigmas = 1.5;   // of neighbours by chance
constexpr std::size_t kCorrelationLags = 8;  // px
constexpr double kFitBand_px = 3.5;          // beside the patch that is fitted with it
constexpr double kBlurSigma_px = 0.3;

/// The patch's share of a pixel and its derivatives by the pixel's place in the patch's frame (x
/// forward), by the blur, and by the log of the size.
struct Share {
  float value = 0.0F;
  float dx = 0.0F;
  float dy = 0.0F;
  float dblur = 0.0F;
};

/// Φ(t/s) at an edge, and what it adds to the derivatives.
struct EdgeSide {
  float value;
  float density;  ///< ∂/∂t
  float blur;     ///< ∂/∂s
};

inline EdgeSide side(float t, float per_blur) {
  const float z = t * per_blur;
  const NormalTable::Value normal = normal_table().at(z);
  const float density = normal.density * per_blur;
  return {normal.integral, density, -z * density};
}

/// Of the rectangle between low and high in x, and within ±half in y.
inline void add_rectangle(const EdgeSide& low, const EdgeSide& high, const EdgeSide& below,
                          const EdgeSide& above, Share& share) {
  const float along = low.value - high.value;
  const float across = below.value - above.value;
  share.value += along * across;
  share.dx += (low.density - high.density) * across;
  share.dy += along * (below.density - above.density);
  share.dblur += (low.blur - high.blur) * across + along * (below.blur - above.blur);
}

/// The patch's outline for one size, px.
struct PatchOutline {
  float half_length;
  float neck;  ///< where the tongue begins
  float half_width;
  float half_tongue;
  bool tongue;

  PatchOutline(const PatchFinderParams& params, double log_scale)
      : half_length(static_cast<float>(0.5 * params.length_px * std::exp(log_scale))),
        neck(static_cast<float>(1.0 - 2.0 * kTongueLength) * half_length),
        half_width(static_cast<float>(0.5 * params.width_px * std::exp(log_scale))),
        half_tongue(static_cast<float>(kTongueWidth) * half_width),
        tongue(params.polarity) {}

  Share share(float x, float y, float per_blur) const {
    Share share;
    const EdgeSide back = side(x + half_length, per_blur);
    const EdgeSide front = side(x - half_length, per_blur);
    const EdgeSide left = side(y + half_width, per_blur);
    const EdgeSide right = side(y - half_width, per_blur);
    if (!tongue) {
      add_rectangle(back, front, left, right, share);
      return share;
    }
    const EdgeSide middle = side(x - neck, per_blur);
    add_rectangle(back, middle, left, right, share);
    add_rectangle(middle, front, side(y + half_tongue, per_blur), side(y - half_tongue, per_blur),
                  share);
    return share;
  }
};

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
  const double length = 0.5 * params.length_px + kFitBand_px;
  const double width = 0.5 * params.width_px + kFitBand_px;
  const double across = length * c + width * s;
  const double down = length * s + width * c;
  const int u = static_cast<int>(std::floor(start.uv.x() - across));
  const int v = static_cast<int>(std::floor(start.uv.y() - down));
  return intersect(window.window, {u, v, static_cast<int>(std::ceil(2.0 * across)) + 1,
                                   static_cast<int>(std::ceil(2.0 * down)) + 1});
}

/// The pixels about the start: they stay the same while the shape moves.
struct BandPixel {
  float u;
  float v;
  float grey;
};
std::vector<BandPixel> band_pixels(const PatchWindow& window, const PatchShape& start,
                                   const PatchFinderParams& params) {
  const imaging::Window band = band_of(window, start, params);
  const double c = std::cos(start.angle);
  const double s = std::sin(start.angle);
  std::vector<BandPixel> pixels;
  pixels.reserve(static_cast<std::size_t>(std::max(0, band.width * band.height)));
  for (int v = band.v; v < band.bottom(); ++v) {
    for (int u = band.u; u < band.right(); ++u) {
      const double du = u - start.uv.x();
      const double dv = v - start.uv.y();
      if (std::abs(c * du + s * dv) > 0.5 * params.length_px + kFitBand_px) continue;
      if (std::abs(c * dv - s * du) > 0.5 * params.width_px + kFitBand_px) continue;
      pixels.push_back(
          {static_cast<float>(u), static_cast<float>(v), static_cast<float>(window.at(u, v))});
    }
  }
  return pixels;
}

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
  Eigen::Matrix<float, kFitUnknowns, kFitUnknowns> normal;
  normal.setZero();
  Eigen::Matrix<float, kFitUnknowns, 1> gradient;
  gradient.setZero();
  PatchSums sums;
  for (const BandPixel& pixel : pixels) {
    const float du = pixel.u - middle.x();
    const float dv = pixel.v - middle.y();
    const float x = c * du + s * dv;
    const float y = c * dv - s * du;
    const Share share = outline.share(x, y, per_blur);
    Eigen::Matrix<float, kFitUnknowns, 1> row;
    row << contrast * (s * share.dy - c * share.dx), contrast * (-s * share.dx - c * share.dy),
        contrast * (y * share.dx - x * share.dy),
        -contrast * (x * share.dx + y * share.dy + blur * share.dblur), share.value,
        1.0F - share.value, contrast * share.dblur;
    const float residual = pixel.grey - ground - contrast * share.value;
    normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    gradient += residual * row;
    sums.square += static_cast<double>(residual * residual);
  }
  sums.pixels = static_cast<int>(pixels.size());
  sums.normal = normal.cast<double>().selfadjointView<Eigen::Lower>();
  sums.gradient = gradient.cast<double>();
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

/// By how much more the fit's variance is than that of white noise of the same size: what the
/// surroundings have of texture, neighbours share. The residuals' correlation along rows, as far as
/// it is more than chance; taken for alike along columns.
double correlation_factor(const std::vector<BandPixel>& pixels, const PatchShape& shape,
                          const PatchFinderParams& params) {
  const PatchOutline outline(params, shape.log_scale);
  const auto c = static_cast<float>(std::cos(shape.angle));
  const auto s = static_cast<float>(std::sin(shape.angle));
  const float per_blur = 1.0F / static_cast<float>(shape.blur);
  std::vector<float> residuals;
  residuals.reserve(pixels.size());
  double square = 0.0;
  for (const BandPixel& pixel : pixels) {
    const float du = pixel.u - static_cast<float>(shape.uv.x());
    const float dv = pixel.v - static_cast<float>(shape.uv.y());
    const float share = outline.share(c * du + s * dv, c * dv - s * du, per_blur).value;
    residuals.push_back(pixel.grey - static_cast<float>(shape.ground) -
                        static_cast<float>(shape.patch - shape.ground) * share);
    square += static_cast<double>(residuals.back() * residuals.back());
  }
  square /= static_cast<double>(pixels.size());
  double sum = 1.0;
  for (std::size_t lag = 1; lag <= kCorrelationLags; ++lag) {
    double products = 0.0;
    int pairs = 0;
    for (std::size_t i = lag; i < pixels.size(); ++i) {
      if (pixels[i].v != pixels[i - lag].v) continue;
      products += static_cast<double>(residuals[i] * residuals[i - lag]);
      ++pairs;
    }
    if (pairs < kFitUnknowns) break;
    const double correlation = products / (pairs * square);
    if (correlation < kCorrelationSigmas / std::sqrt(static_cast<double>(pairs))) break;
    sum += 2.0 * correlation;
  }
  return sum * sum;
}

PatchShape stepped(const PatchShape& shape, const FitVector& step) {
  PatchShape next = shape;
  next.uv += step.head<2>().cwiseMax(-2.0).cwiseMin(2.0);
  next.angle += std::clamp(step[2], -0.3, 0.3);
  next.log_scale += std::clamp(step[3], -0.1, 0.1);
  next.patch += step[4];
  next.ground += step[5];
  next.blur = std::clamp(shape.blur + step[6], 0.35, 3.0);
  return next;
}

}  // namespace

std::optional<PatchFit> fit_patch(const PatchWindow& window, const PatchShape& start,
                                  const PatchFinderParams& params) {
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
    fit.noise = std::max(0.3, std::sqrt(sums.square / (sums.pixels - kFitUnknowns)));
    fit.covariance =
        (fit.noise * fit.noise) * solver.solve(FitNormal::Identity()).topLeftCorner<3, 3>();
    fit.shape = stepped(fit.shape, step);
    if (i > 3 && step.head<2>().norm() < 1e-3 && std::abs(step[2]) < 1e-4) {
      const double factor = correlation_factor(pixels, fit.shape, params);
      fit.covariance *= factor;
      fit.misfit = fit.noise * std::sqrt(1.0 - 1.0 / std::sqrt(factor));
      fit.shape.angle = wrap_angle(fit.shape.angle);
      return fit;
    }
  }
  return std::nullopt;
}

}  // namespace vigia::tracking

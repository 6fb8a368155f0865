#include "dot_fit.hpp"

#include "pixel.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace vigia::tracking {
namespace {

using imaging::Window;

// Grey levels of dot and paper in the mixture: room for noise on both sides.
constexpr double kDot = 64.0;
constexpr double kGround = 192.0;
constexpr double kMinContrast = 12.0;  // levels, all channels together
constexpr double kMinContrastToNoise = 4.0;
constexpr double kMaxUnevenness = 0.3;  // rms of dot and paper about their levels, of the contrast
constexpr double kGroundNear = 2.0;     // px outside a dot where its blur ends, and
constexpr double kGroundFar = 5.5;      // where the next dot may begin
constexpr int kFractionBits = 12;

Eigen::Array3d channels(const vpRGBa& pixel) {
  return {static_cast<double>(pixel.R), static_cast<double>(pixel.G), static_cast<double>(pixel.B)};
}

/// Calls visit(pixel, d, q, g) on a grid of the box: d from the centre, q = dᵀΣ⁻¹d, g = |Σ⁻¹d|.
template <typename Visit>
void scan(const ColourBlock& block, const Window& box, const EllipseShape& shape, int step,
          Visit visit) {
  const Eigen::Matrix2d inverse = shape.sigma.inverse();
  for (int v = box.v; v < box.bottom(); v += step) {
    const vpRGBa* row = block.row(v) - block.window().u;
    for (int u = box.u; u < box.right(); u += step) {
      const Eigen::Vector2d d(u - shape.centre.x(), v - shape.centre.y());
      const Eigen::Vector2d gradient = inverse * d;
      visit(row[u], d, d.dot(gradient), gradient.norm());
    }
  }
}

int step_of(double minor_axis) {
  return std::max(1, static_cast<int>(minor_axis / 4.0));
}

/// Means inside and outside an outline that is only roughly known.
ColourLevels rough_levels(const ColourBlock& block, const Window& box, const EllipseShape& shape) {
  const double b = ellipse_of(shape).b;
  const double near = (1.0 + kGroundNear / b) * (1.0 + kGroundNear / b);
  const double far = (1.0 + kGroundFar / b) * (1.0 + kGroundFar / b);
  ColourLevels levels;
  int inside = 0;
  int outside = 0;
  scan(block, box, shape, step_of(b),
       [&](const vpRGBa& pixel, const Eigen::Vector2d& /*d*/, double q, double /*g*/) {
         if (q < 0.4) {
           levels.dot += channels(pixel);
           ++inside;
         } else if (q > near && q < far) {
           levels.ground += channels(pixel);
           ++outside;
         }
       });
  if (inside > 0) levels.dot /= inside;
  if (outside > 0) levels.ground /= outside;
  return levels;
}

/// Sums over a dot's pixels for the regression of the channels on the share of a pixel that the
/// blurred dot takes, and on that share's derivative by the dot's centre.
struct ShareSums {
  double n = 0.0;
  double s = 0.0;
  double ss = 0.0;
  Eigen::Array3d y = Eigen::Array3d::Zero();
  Eigen::Array3d sy = Eigen::Array3d::Zero();
  Eigen::Array3d yy = Eigen::Array3d::Zero();
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  Eigen::Vector2d gs = Eigen::Vector2d::Zero();
  Eigen::Matrix2d gg = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 2, 3> gy = Eigen::Matrix<double, 2, 3>::Zero();
};

ShareSums sum_shares(const ColourBlock& block, const Window& box, const EllipseShape& shape,
                     double blur, int step) {
  const Eigen::Matrix2d inverse = shape.sigma.inverse();
  const double reach = 1.0 + 2.5 * blur / ellipse_of(shape).b;
  ShareSums sums;
  scan(block, box, shape, step,
       [&](const vpRGBa& pixel, const Eigen::Vector2d& d, double q, double g) {
         if (q > reach * reach) return;
         // First-order distance to the outline; a logistic function is near enough to Φ here.
         constexpr double kLogistic = 1.702;
         const double level = std::sqrt(q);
         const double t = (1.0 - level) * level / (blur * (g + 1e-9));
         const bool edge = t < 3.0 && t > -3.0 && q > 1e-6;
         const double share = edge ? 1.0 / (1.0 + std::exp(-kLogistic * t)) : (t > 0.0 ? 1.0 : 0.0);
         const Eigen::Array3d value = channels(pixel);
         sums.n += 1.0;
         sums.s += share;
         sums.ss += share * share;
         sums.y += value;
         sums.sy += share * value;
         sums.yy += value * value;
         if (!edge) return;
         const Eigen::Vector2d by_centre =
             kLogistic * share * (1.0 - share) / (blur * (g + 1e-9)) * (inverse * d);
         sums.g += by_centre;
         sums.gs += share * by_centre;
         sums.gg += by_centre * by_centre.transpose();
         sums.gy += by_centre * value.matrix().transpose();
       });
  return sums;
}

/// Levels by regression on the share.
ColourLevels fitted_levels(const ShareSums& sums) {
  const double determinant = sums.n * sums.ss - sums.s * sums.s;
  ColourLevels levels;
  if (determinant <= 1e-9 * sums.n * sums.n) return levels;
  const Eigen::Array3d slope = (sums.n * sums.sy - sums.s * sums.y) / determinant;
  levels.ground = (sums.y - slope * sums.s) / sums.n;
  levels.dot = levels.ground + slope;
  const Eigen::Array3d residual =
      (sums.yy - levels.ground * sums.y - slope * sums.sy).max(0.0) / std::max(1.0, sums.n - 2.0);
  levels.noise = residual.max(kQuantisationVariance).sqrt();
  // Of ground + slope: at share 1.
  levels.dot_sigma = levels.noise * std::sqrt((sums.ss - 2.0 * sums.s + sums.n) / determinant);
  return levels;
}

/// How each channel pulls at the centre, and what it counts in the mixture.
DotPulls channel_pulls(const ShareSums& sums, const ColourLevels& levels) {
  DotPulls pulls;
  const Eigen::Array3d slope = levels.dot - levels.ground;
  const Eigen::Array3d weight = (-slope).max(0.0).square();
  pulls.share = weight / std::max(1e-9, weight.sum());
  for (int c = 0; c < 3; ++c) {
    const double variance = levels.noise[c] * levels.noise[c];
    ChannelPull& channel = pulls.channels[static_cast<std::size_t>(c)];
    channel.information = slope[c] * slope[c] / variance * sums.gg;
    channel.pull =
        slope[c] / variance * (sums.gy.col(c) - levels.ground[c] * sums.g - slope[c] * sums.gs);
  }
  return pulls;
}

/// The mixture of the channels in which dot and paper differ most against equal noise.
void mix(const ColourBlock& block, const Window& box, const ColourLevels& levels,
         const Eigen::Array3d& weight, vpImage<unsigned char>& out) {
  const Eigen::Array3d contrast = levels.ground - levels.dot;
  const double scale = (kGround - kDot) / (weight * contrast).sum();
  const double unit = 1 << kFractionBits;
  const auto fixed = [&](double value) { return static_cast<int>(std::lround(value * unit)); };
  const ChannelMixture mixture{fixed(scale * weight[0]), fixed(scale * weight[1]),
                               fixed(scale * weight[2]),
                               fixed(kDot + 0.5 - scale * (weight * levels.dot).sum())};
  out.resize(static_cast<unsigned>(box.height), static_cast<unsigned>(box.width));
  for (int v = 0; v < box.height; ++v) {
    const vpRGBa* row = block.row(box.v + v) + (box.u - block.window().u);
    mix_channels(&row->R, mixture, box.width, out[static_cast<unsigned>(v)]);
  }
}

}  // namespace

Window dot_box(const EllipseShape& shape, double blur) {
  constexpr double kSteps = 3.0;  // px that the fit may move
  return window_round(shape, 2.5 * blur + 0.3 + kSteps);
}

DotFit DotFitter::fit(const ColourBlock& block, const EllipseShape& start, double blur) {
  const Window box = intersect(dot_box(start, blur), block.window());
  if (box.empty()) return {};
  DotFit result = fit(block, start, blur, rough_levels(block, box, start));
  if (result.status == DotStatus::whole && step_of(ellipse_of(result.shape).b) > 1)
    measure(block, box, 1, result);
  return result;
}

DotFit DotFitter::fit(const ColourBlock& block, const EllipseShape& start, double blur,
                      const ColourLevels& levels) {
  DotFit result;
  result.shape = start;
  const Window box = intersect(dot_box(start, blur), block.window());
  if (box.width < 5 || box.height < 5) return result;
  result.status = DotStatus::faint;
  const Eigen::Array3d weight = (levels.ground - levels.dot).max(0.0);
  if (weight.matrix().norm() < kMinContrast) return result;
  mix(block, box, levels, weight, mixture_);

  result.status = DotStatus::hidden;
  EllipseShape local = start;
  local.centre -= Eigen::Vector2d(box.u, box.v);
  const EdgeFit fit =
      fitter_.fit(mixture_, {0, 0, box.width, box.height}, local, {kDot, kGround, blur});
  if (!fit.converged) return result;
  result.shape = fit.shape;
  result.shape.centre += Eigen::Vector2d(box.u, box.v);
  result.centre_covariance = fit.covariance.topLeftCorner<2, 2>();
  result.blur = fit.profile.blur;
  const double contrast = fit.profile.ground - fit.profile.disc;
  if (contrast < kMinContrastToNoise * fit.noise) {
    result.status = DotStatus::faint;
    return result;
  }
  if (!fit.complete || fit.agreement < min_agreement_) return result;
  measure(block, box, step_of(ellipse_of(result.shape).b), result);
  const double depth = (result.levels.ground - result.levels.dot).maxCoeff();
  if (result.levels.noise.maxCoeff() > kMaxUnevenness * depth) return result;
  result.status = DotStatus::whole;
  return result;
}

// The levels, and the pulls of the channels, on every step-th pixel.
void DotFitter::measure(const ColourBlock& block, const Window& box, int step, DotFit& dot) {
  const ShareSums sums = sum_shares(block, box, dot.shape, dot.blur, step);
  dot.levels = fitted_levels(sums);
  dot.pulls = channel_pulls(sums, dot.levels);
}

}  // namespace vigia::tracking

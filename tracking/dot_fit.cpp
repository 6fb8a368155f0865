#include "dot_fit.hpp"

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
constexpr double kGroundNear = 2.0;  // px outside a dot where its blur ends, and
constexpr double kGroundFar = 5.5;   // where the next dot may begin
constexpr int kFractionBits = 12;

Eigen::Array3d channels(const vpRGBa& pixel) {
  return {static_cast<double>(pixel.R), static_cast<double>(pixel.G), static_cast<double>(pixel.B)};
}

/// Calls visit(pixel, q, g) on a grid of the box, q = dᵀΣ⁻¹d and g = |Σ⁻¹d|, d from the centre.
template <typename Visit>
void scan(const ColourBlock& block, const Window& box, const EllipseShape& shape, int step,
          Visit visit) {
  const Eigen::Matrix2d inverse = shape.sigma.inverse();
  for (int v = box.v; v < box.bottom(); v += step) {
    const vpRGBa* row = block.row(v) - block.window().u;
    for (int u = box.u; u < box.right(); u += step) {
      const Eigen::Vector2d d(u - shape.centre.x(), v - shape.centre.y());
      const Eigen::Vector2d gradient = inverse * d;
      visit(row[u], d.dot(gradient), gradient.norm());
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
  scan(block, box, shape, step_of(b), [&](const vpRGBa& pixel, double q, double /*g*/) {
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

/// Levels by regression on the share of the pixel that the blurred dot takes.
ColourLevels fitted_levels(const ColourBlock& block, const Window& box, const EllipseShape& shape,
                           double blur) {
  const double b = ellipse_of(shape).b;
  const double reach = 1.0 + 2.5 * blur / b;
  double n = 0.0;
  double s = 0.0;
  double ss = 0.0;
  Eigen::Array3d y = Eigen::Array3d::Zero();
  Eigen::Array3d sy = Eigen::Array3d::Zero();
  Eigen::Array3d yy = Eigen::Array3d::Zero();
  scan(block, box, shape, step_of(b), [&](const vpRGBa& pixel, double q, double g) {
    if (q > reach * reach) return;
    // First-order distance to the outline; a logistic function is near enough to Φ here.
    const double level = std::sqrt(q);
    const double t = (1.0 - level) * level / (blur * (g + 1e-9));
    const double share =
        t > 3.0 || q < 1e-6 ? 1.0 : (t < -3.0 ? 0.0 : 1.0 / (1.0 + std::exp(-1.702 * t)));
    const Eigen::Array3d value = channels(pixel);
    n += 1.0;
    s += share;
    ss += share * share;
    y += value;
    sy += share * value;
    yy += value * value;
  });
  const double determinant = n * ss - s * s;
  ColourLevels levels;
  if (determinant <= 1e-9 * n * n) return levels;
  const Eigen::Array3d slope = (n * sy - s * y) / determinant;
  levels.ground = (y - slope * s) / n;
  levels.dot = levels.ground + slope;
  const Eigen::Array3d residual =
      (yy - levels.ground * y - slope * sy).max(0.0) / std::max(1.0, n - 2.0);
  // Of ground + slope: at share 1.
  const double leverage = (ss - 2.0 * s + n) / determinant;
  levels.dot_sigma = (residual.max(1.0 / 12.0) * leverage).sqrt();
  return levels;
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
  return fit(block, start, blur, rough_levels(block, box, start));
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
  result.levels = fitted_levels(block, box, result.shape, result.blur);
  result.status = DotStatus::whole;
  return result;
}

}  // namespace vigia::tracking

#include "patch_outline.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

/// Beside the plain fit's unknowns.
enum LookUnknown {
  kGamma = kFitUnknowns,
  kSlopeU,
  kSlopeV,
  kGain,
  kMotionU,
  kMotionV,
  kLookUnknowns
};
using LookNormal = Eigen::Matrix<double, kLookUnknowns, kLookUnknowns>;
using LookVector = Eigen::Matrix<double, kLookUnknowns, 1>;
/// Padded, so that it is summed up four numbers at a time.
constexpr int kLookPadded = 16;
using LookRow = Eigen::Matrix<float, kLookPadded, 1>;

constexpr int kLookSteps = 12;
constexpr float kPerSlope = 0.1F;  // slopes are stated on 10 px
constexpr double kGainSigma = 0.5;
constexpr double kGammaSigma = 3.0;  // before anything is known of it
constexpr double kMinGamma = 0.4;
constexpr double kMaxGamma = 3.0;
constexpr double kMotionSigma_px = 10.0;
constexpr float kMotionStep = 2.0F;  // of a motion, by the edges' σ, which makes it smooth
constexpr int kMinMotionSteps = 4;
constexpr double kMaxMotion_px = 20.0;
constexpr double kMotionGate = 16.0;
constexpr double kGammaGate = 4.0;  // χ² of one number, of two: below, it is taken for chance
constexpr double kSlopeGate = 5.6;
/// Grey levels that may be cut off: predicted and seen. By the prediction, not by what is seen
/// alone, which would prefer the noise of one side.
constexpr float kNearlySaturated = 247.0F;
constexpr float kSeenSaturated = 235.0F;
constexpr double kCorrelationSigmas = 1.5;   // of neighbours by chance
constexpr std::size_t kCorrelationLags = 8;  // px

/// The grey value of a mixture of two levels' light, and its derivatives.
struct MixedGrey {
  float value;
  float dshare;
  float dground;
  float dpatch;
  float dgamma;
};
inline MixedGrey mixed_grey(float ground, float patch, float share, float gamma) {
  ground = std::max(ground, 1.0F);
  patch = std::max(patch, 1.0F);
  const float log_ground = std::log(ground);
  const float log_patch = std::log(patch);
  if (gamma == 1.0F) {
    const float value = ground + share * (patch - ground);
    return {
        value, patch - ground, 1.0F - share, share,
        (1.0F - share) * ground * log_ground + share * patch * log_patch - value * std::log(value)};
  }
  const float light_ground = std::exp(gamma * log_ground);
  const float light_patch = std::exp(gamma * log_patch);
  const float light = light_ground + share * (light_patch - light_ground);
  const float log_light = std::log(light);
  const float value = std::exp(log_light / gamma);
  const float slope = value / light;
  return {value, slope / gamma * (light_patch - light_ground),
          slope * (1.0F - share) * light_ground / ground, slope * share * light_patch / patch,
          slope / gamma *
              ((1.0F - share) * light_ground * log_ground + share * light_patch * log_patch -
               light * log_light / gamma)};
}

/// The patch's share of a pixel, and its derivatives by what the outline lies like.
struct OutlineShare {
  float value = 0.0F;
  float du = 0.0F;
  float dv = 0.0F;
  float dangle = 0.0F;
  float dscale = 0.0F;
  float dblur = 0.0F;
  Eigen::Vector2f dmotion = Eigen::Vector2f::Zero();
};

/// Of a shape that may have moved while it was exposed.
class OutlineImage {
 public:
  OutlineImage(const PatchFinderParams& params, const PatchShape& shape)
      : outline_(params, shape.log_scale),
        c_(static_cast<float>(std::cos(shape.angle))),
        s_(static_cast<float>(std::sin(shape.angle))),
        blur_(static_cast<float>(shape.blur)),
        middle_(shape.uv.cast<float>()),
        motion_(shape.motion.cast<float>()) {
    const float length = motion_.norm();
    if (length > 0.0F)
      steps_ =
          std::max(kMinMotionSteps, static_cast<int>(std::ceil(length / (kMotionStep * blur_))));
  }

  OutlineShare share(const BandPixel& pixel) const {
    const Eigen::Vector2f off(pixel.u - middle_.x(), pixel.v - middle_.y());
    OutlineShare all;
    if (steps_ == 0) {
      const Share share = add(off, 1.0F, all);
      // Without motion its derivative is zero; in its place that by a blur that is more along u
      // than along v, and more along the diagonal.
      const float per_blur = 1.0F / blur_;
      const float xx = share.dblur_x * per_blur;
      const float yy = share.dblur_y * per_blur;
      const float c2 = c_ * c_ - s_ * s_;
      const float s2 = 2.0F * c_ * s_;
      all.dmotion = {0.5F * (c2 * (xx - yy) - 2.0F * s2 * share.dxy),
                     0.5F * s2 * (xx - yy) + c2 * share.dxy};
      return all;
    }
    const float part = 1.0F / static_cast<float>(steps_);
    for (int k = 0; k < steps_; ++k) {
      const float t = (static_cast<float>(k) + 0.5F) * part - 0.5F;
      const OutlineShare before = all;
      add(off - t * motion_, part, all);
      all.dmotion.x() += t * (all.du - before.du);
      all.dmotion.y() += t * (all.dv - before.dv);
    }
    return all;
  }

 private:
  Share add(const Eigen::Vector2f& off, float part, OutlineShare& all) const {
    const float x = c_ * off.x() + s_ * off.y();
    const float y = c_ * off.y() - s_ * off.x();
    const Share share = outline_.share(x, y, 1.0F / blur_);
    const float dblur = share.dblur();
    all.value += part * share.value;
    all.du += part * (s_ * share.dy - c_ * share.dx);
    all.dv -= part * (s_ * share.dx + c_ * share.dy);
    all.dangle += part * (y * share.dx - x * share.dy);
    all.dscale -= part * (x * share.dx + y * share.dy + blur_ * dblur);
    all.dblur += part * dblur;
    return share;
  }

  PatchOutline outline_;
  float c_;
  float s_;
  float blur_;
  Eigen::Vector2f middle_;
  Eigen::Vector2f motion_;
  int steps_ = 0;
};

struct LookSums {
  LookNormal normal = LookNormal::Zero();
  LookVector gradient = LookVector::Zero();
  double square = 0.0;
  int pixels = 0;                ///< that say anything: the saturated ones do not
  std::vector<float> residuals;  ///< of all pixels
  std::vector<LookRow> rows;

  void expect(int unknown, double off, double weight) {
    normal(unknown, unknown) += weight;
    gradient[unknown] -= weight * off;
    square += weight * off * off;
  }
  double noise() const {
    return std::max(kMinNoise, std::sqrt(square / std::max(1, pixels - kFitUnknowns)));
  }
};

LookSums sum_up_look(const std::vector<BandPixel>& pixels, const PatchShape& shape,
                     const PatchFinderParams& params) {
  const OutlineImage outline(params, shape);
  const auto gamma = static_cast<float>(shape.gamma);
  const Eigen::Vector2f pivot = shape.light.pivot.cast<float>();
  const Eigen::Vector2f slope = shape.light.slope.cast<float>();
  const auto darker = static_cast<float>(1.0 - shape.patch / shape.ground);
  const float follows = 1.0F - static_cast<float>(shape.light.gain) * darker;
  Eigen::Matrix<float, kLookPadded, kLookPadded> normal;
  normal.setZero();
  LookRow gradient = LookRow::Zero();
  LookSums sums;
  sums.residuals.reserve(pixels.size());
  sums.rows.reserve(pixels.size());
  for (const BandPixel& pixel : pixels) {
    const OutlineShare share = outline.share(pixel);
    const Eigen::Vector2f off = kPerSlope * (Eigen::Vector2f(pixel.u, pixel.v) - pivot);
    const float change = slope.dot(off);
    const MixedGrey mixed =
        mixed_grey(static_cast<float>(shape.ground) + change,
                   static_cast<float>(shape.patch) + follows * change, share.value, gamma);
    const bool saturated = mixed.value >= kNearlySaturated && pixel.grey >= kSeenSaturated;
    const float residual = saturated ? 0.0F : pixel.grey - mixed.value;
    sums.residuals.push_back(residual);
    LookRow& row = sums.rows.emplace_back(LookRow::Zero());
    if (saturated) continue;
    const float steep = mixed.dshare;
    const float dslope = mixed.dground + follows * mixed.dpatch;
    row.head<kLookUnknowns>() << steep * share.du, steep * share.dv, steep * share.dangle,
        steep * share.dscale, mixed.dpatch, mixed.dground, steep * share.dblur, mixed.dgamma,
        dslope * off.x(), dslope * off.y(), -darker * change * mixed.dpatch,
        steep * share.dmotion.x(), steep * share.dmotion.y();
    normal.noalias() += row * row.transpose();
    gradient += residual * row;
    sums.square += static_cast<double>(residual * residual);
    ++sums.pixels;
  }
  sums.normal = normal.topLeftCorner<kLookUnknowns, kLookUnknowns>().cast<double>();
  sums.gradient = gradient.head<kLookUnknowns>().cast<double>();
  return sums;
}

/// Of the residuals along rows, as far as it is more than chance: neighbours share what the
/// surroundings have of texture.
std::vector<double> correlations_of(const std::vector<BandPixel>& pixels,
                                    const std::vector<float>& residuals) {
  double square = 0.0;
  for (const float residual : residuals) square += static_cast<double>(residual * residual);
  square /= static_cast<double>(pixels.size());
  std::vector<double> correlations{1.0};
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
    correlations.push_back(correlation);
  }
  return correlations;
}

/// By how much more the variance of a mean along a row is than that of white residuals.
double variance_factor(const std::vector<double>& correlations) {
  double factor = 1.0;
  for (std::size_t i = 1; i < correlations.size(); ++i) factor += 2.0 * correlations[i];
  return factor;
}

/// What each pixel's residual moves u, v and the angle by, on a grid.
struct InfluenceGrid {
  using Values = Eigen::Array<float, 3, Eigen::Dynamic>;
  int width = 0;
  int height = 0;
  Values values;

  InfluenceGrid(const std::vector<BandPixel>& pixels, const std::vector<LookRow>& rows,
                const LookNormal& inverse) {
    float u0 = pixels.front().u;
    float u1 = u0;
    for (const BandPixel& pixel : pixels) {
      u0 = std::min(u0, pixel.u);
      u1 = std::max(u1, pixel.u);
    }
    const float v0 = pixels.front().v;
    width = static_cast<int>(u1 - u0) + 1;
    height = static_cast<int>(pixels.back().v - v0) + 1;
    values = Values::Zero(3, Eigen::Index{width} * height);
    const Eigen::Matrix<float, 3, kLookUnknowns> gain = inverse.topRows<3>().cast<float>();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const int row = static_cast<int>(pixels[i].v - v0);
      values.col(row * width + static_cast<int>(pixels[i].u - u0)) =
          (gain * rows[i].head<kLookUnknowns>()).array();
    }
  }

  /// Each value with its neighbours' along rows and columns, weighed by what they share.
  Values spread(const std::vector<double>& shares) const {
    Values along = values * static_cast<float>(shares[0]);
    const int lags = static_cast<int>(shares.size()) - 1;
    for (int lag = 1; lag <= std::min(lags, width - 1); ++lag) {
      const auto weight = static_cast<float>(shares[static_cast<std::size_t>(lag)]);
      const int n = width - lag;
      for (int at = 0; at < width * height; at += width) {
        along.middleCols(at, n) += weight * values.middleCols(at + lag, n);
        along.middleCols(at + lag, n) += weight * values.middleCols(at, n);
      }
    }
    Values both = along * static_cast<float>(shares[0]);
    for (int lag = 1; lag <= std::min(lags, height - 1); ++lag) {
      const auto weight = static_cast<float>(shares[static_cast<std::size_t>(lag)]);
      const int n = (height - lag) * width;
      both.leftCols(n) += weight * along.rightCols(n);
      both.rightCols(n) += weight * along.leftCols(n);
    }
    return both;
  }
};

/// Of (u, v, angle) for residuals of variance one of which neighbours share what is stated: along
/// a row and along a column the one times the other.
Eigen::Matrix3d shared_covariance(const InfluenceGrid& influence,
                                  const std::vector<double>& correlations) {
  // What is shared of a pixel itself, the rest of it being white: carried on from the lags beside
  // it as under a Gaussian.
  double own = 1.0;
  if (correlations.size() > 2)
    own = std::min(1.0, correlations[1] * std::cbrt(correlations[1] / correlations[2]));
  std::vector<double> shares = correlations;
  shares[0] = own;
  const auto values = influence.values.matrix();
  const Eigen::Matrix3d shared =
      (influence.spread(shares).matrix() * values.transpose()).cast<double>() / own;
  return shared + (1.0 - own) * (values * values.transpose()).cast<double>();
}

/// σ² of some of what the plain model leaves out, from how large it comes out (empirical Bayes); 0
/// where that is no more than chance.
double prior_variance(const LookVector& estimate, const LookNormal& covariance, int first,
                      int count, double gate) {
  double chi_square = 0.0;
  double excess = 0.0;
  for (int i = first; i < first + count; ++i) {
    const double square = estimate[i] * estimate[i];
    chi_square += square / covariance(i, i);
    excess += square - covariance(i, i);
  }
  return chi_square < gate ? 0.0 : std::max(0.0, excess / count);
}

/// A motion that blurs as much more along u and along the diagonal; χ² of that below the gate is
/// chance.
Eigen::Vector2d motion_of(const LookVector& estimate, const LookNormal& covariance, double gate) {
  const Eigen::Vector2d more = estimate.segment<2>(kMotionU);
  const Eigen::Matrix2d chance = covariance.block<2, 2>(kMotionU, kMotionU);
  if (more.dot(chance.ldlt().solve(more)) < gate) return Eigen::Vector2d::Zero();
  const double direction = 0.5 * std::atan2(more.y(), more.x());
  return std::sqrt(24.0 * more.norm()) * Eigen::Vector2d(std::cos(direction), std::sin(direction));
}

/// Prior variances of what the plain model leaves out; 0 keeps it out.
struct LookPriors {
  double gamma = 0.0;
  double slope = 0.0;

  bool any() const { return gamma > 0.0 || slope > 0.0; }
};

struct LookSuspicion {
  LookPriors priors;
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();
};

/// From the sums at a fit without them.
LookSuspicion suspect(const std::vector<BandPixel>& pixels, LookSums sums) {
  const double variance = sums.noise() * sums.noise();
  const double factor = variance_factor(correlations_of(pixels, sums.residuals));
  sums.expect(kGamma, 0.0, variance / (kGammaSigma * kGammaSigma));
  sums.expect(kMotionU, 0.0, variance / (kMotionSigma_px * kMotionSigma_px));
  sums.expect(kMotionV, 0.0, variance / (kMotionSigma_px * kMotionSigma_px));
  const Eigen::LDLT<LookNormal> solver(sums.normal);
  const LookVector estimate = solver.solve(sums.gradient);
  const LookNormal covariance = variance * solver.solve(LookNormal::Identity());
  return {{prior_variance(estimate, covariance, kGamma, 1, kGammaGate),
           prior_variance(estimate, covariance, kSlopeU, 2, kSlopeGate)},
          motion_of(estimate, covariance, kMotionGate * factor)};
}

void expect_plain(LookSums& sums, const PatchShape& shape, const PatchFinderParams& params,
                  double noise) {
  const auto weight = [&](double sigma) { return noise * noise / (sigma * sigma); };
  sums.expect(3, shape.log_scale, weight(params.scale_sigma));
  sums.expect(6, shape.blur - params.blur_px, weight(kBlurSigma_px));
  sums.expect(kGain, shape.light.gain - 0.5, weight(kGainSigma));
}

void expect_look(LookSums& sums, const PatchShape& shape, const LookPriors& priors, double noise) {
  constexpr double kKeptOut = 1e12;
  const auto weight = [&](double variance) {
    return variance > 0.0 ? noise * noise / variance : kKeptOut;
  };
  sums.expect(kGamma, shape.gamma - 1.0, weight(priors.gamma));
  sums.expect(kSlopeU, shape.light.slope.x(), weight(priors.slope));
  sums.expect(kSlopeV, shape.light.slope.y(), weight(priors.slope));
  const bool moved = shape.motion.norm() > 0.0;
  const double of_motion = weight(moved ? kMotionSigma_px * kMotionSigma_px : 0.0);
  for (const int k : {kMotionU, kMotionV})
    sums.expect(k, moved ? shape.motion[k - kMotionU] : 0.0, of_motion);
}

/// What is shared, added to what white residuals leave. Correlations of a few lags need not be
/// those of anything: no combination of u, v and angle is taken for known much better for it.
Eigen::Matrix3d beside_white(const Eigen::Matrix3d& white, const Eigen::Matrix3d& excess) {
  constexpr double kLeast = 0.5;  // of the white variance
  const Eigen::LLT<Eigen::Matrix3d> root(white);
  if (root.info() != Eigen::Success) return white;
  const Eigen::Matrix3d L = root.matrixL();
  const Eigen::Matrix3d half = root.matrixL().solve(excess);
  const Eigen::Matrix3d whitened = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(0.5 *
                                                            (whitened + whitened.transpose()));
  const Eigen::Vector3d variances = (axes.eigenvalues().array() + 1.0).max(kLeast).matrix();
  const Eigen::Matrix3d turned = L * axes.eigenvectors();
  return turned * variances.asDiagonal() * turned.transpose();
}

void state_covariance(const std::vector<BandPixel>& pixels, const LookSums& sums, PatchFit& fit) {
  const LookNormal inverse = sums.normal.ldlt().solve(LookNormal::Identity());
  const double noise = sums.noise();
  fit.noise = noise;
  fit.misfit = 0.0;
  Eigen::Matrix3d covariance = inverse.topLeftCorner<3, 3>();
  const std::vector<double> correlations = correlations_of(pixels, sums.residuals);
  if (correlations.size() > 1) {
    fit.misfit = noise * std::sqrt(1.0 - 1.0 / variance_factor(correlations));
    const InfluenceGrid influence(pixels, sums.rows, inverse);
    covariance = beside_white(covariance, shared_covariance(influence, correlations) -
                                              shared_covariance(influence, {1.0}));
  }
  fit.covariance = noise * noise * covariance;
}

/// Whether it has come to rest.
bool step_look(PatchShape& shape, const LookVector& step) {
  const double gamma = shape.gamma;
  shape = stepped(shape, step.head<kFitUnknowns>());
  shape.gamma = std::clamp(gamma + std::clamp(step[kGamma], -0.7, 0.7), kMinGamma, kMaxGamma);
  shape.light.slope += step.segment<2>(kSlopeU);
  shape.light.gain += step[kGain];
  if (shape.motion.norm() > 0.0)
    shape.motion += step.segment<2>(kMotionU).cwiseMax(-3.0).cwiseMin(3.0);
  return step.head<2>().norm() < 2e-3 && std::abs(step[2]) < 2e-4 &&
         std::abs(shape.gamma - gamma) < 0.02 && step.segment<2>(kSlopeU).norm() < 0.1 &&
         (shape.motion.norm() == 0.0 || step.segment<2>(kMotionU).norm() < 0.02);
}

/// Moves the shape until it rests: the sums there. Where ever other pixels saturate, it hardly
/// moves any more, but does not rest.
std::optional<LookSums> settle(const std::vector<BandPixel>& pixels,
                               const PatchFinderParams& params, const LookPriors& priors,
                               PatchShape& shape) {
  if (pixels.size() < 4 * kLookUnknowns) return std::nullopt;
  bool at_rest = false;
  for (int i = 0;; ++i) {
    LookSums sums = sum_up_look(pixels, shape, params);
    expect_plain(sums, shape, params, sums.noise());
    const double noise = sums.noise();
    expect_look(sums, shape, priors, noise);
    if (at_rest || i == kLookSteps) return sums;
    const LookVector step = sums.normal.ldlt().solve(sums.gradient);
    if (!step.allFinite()) return std::nullopt;
    at_rest = step_look(shape, step);
  }
}

}  // namespace

std::optional<PatchFit> refine_patch(const PatchWindow& window, const PatchFinderParams& params,
                                     bool whole, PatchFit fit) {
  const std::vector<BandPixel> pixels = band_pixels(window, fit.shape, params);
  if (pixels.size() < 4 * kFitUnknowns) return std::nullopt;
  fit.shape.light.pivot = fit.shape.uv;
  std::optional<LookSums> sums = sum_up_look(pixels, fit.shape, params);
  expect_plain(*sums, fit.shape, params, sums->noise());
  const LookSuspicion suspicion = suspect(pixels, *sums);
  if (whole) fit.suspected_motion = suspicion.motion;
  if (whole && suspicion.priors.any()) {
    sums = settle(pixels, params, suspicion.priors, fit.shape);
    if (!sums) return std::nullopt;
  } else {
    expect_look(*sums, fit.shape, {}, sums->noise());
  }
  state_covariance(pixels, *sums, fit);
  fit.shape.angle = wrap_angle(fit.shape.angle);
  return fit;
}

std::optional<PatchFit> fit_moved(const PatchWindow& window, const PatchFinderParams& params,
                                  const PatchShape& start) {
  PatchFit fit;
  fit.shape = start;
  fit.shape.light.pivot = start.uv;
  if (!settle(band_pixels(window, fit.shape, params), params, {}, fit.shape)) return std::nullopt;
  if (fit.shape.motion.norm() > kMaxMotion_px) return std::nullopt;
  const std::vector<BandPixel> pixels = band_pixels(window, fit.shape, params);
  LookSums before = sum_up_look(pixels, fit.shape, params);
  expect_plain(before, fit.shape, params, before.noise());
  const LookPriors priors = suspect(pixels, before).priors;
  const auto sums = settle(pixels, params, priors, fit.shape);
  if (!sums) return std::nullopt;
  fit.square = sums->square;
  state_covariance(pixels, *sums, fit);
  fit.shape.angle = wrap_angle(fit.shape.angle);
  return fit;
}

}  // namespace vigia::tracking

#include "stripe_fit.hpp"

#include "normal_table.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace vigia::tracking {
namespace {

// Unknowns of a stripe.
constexpr int kStripeUnknowns = 6;
enum StripeUnknown { kCentre, kWidth, kHeight, kSigma, kLevel, kSlant };
using StripeVector = Eigen::Matrix<double, kStripeUnknowns, 1>;
using StripeMatrix = Eigen::Matrix<double, kStripeUnknowns, kStripeUnknowns>;

/// Value and gradient of the model at a place.
struct StripeModel {
  double value = 0.0;
  StripeVector gradient;
};

StripeModel stripe_at(const StripeVector& x, double position, double middle) {
  const double inverse = 1.0 / x[kSigma];
  const double a = (position - x[kCentre] + 0.5 * x[kWidth]) * inverse;
  const double b = (position - x[kCentre] - 0.5 * x[kWidth]) * inverse;
  const auto at_a = normal_table().at(static_cast<float>(a));
  const auto at_b = normal_table().at(static_cast<float>(b));
  const double inside = static_cast<double>(at_a.integral - at_b.integral);
  const auto density_a = static_cast<double>(at_a.density);
  const auto density_b = static_cast<double>(at_b.density);
  const double slope = x[kHeight] * inverse;
  StripeModel model;
  model.value = x[kLevel] + x[kSlant] * (position - middle) + x[kHeight] * inside;
  model.gradient[kCentre] = slope * (density_b - density_a);
  model.gradient[kWidth] = 0.5 * slope * (density_a + density_b);
  model.gradient[kHeight] = inside;
  model.gradient[kSigma] = slope * (b * density_b - a * density_a);
  model.gradient[kLevel] = 1.0;
  model.gradient[kSlant] = position - middle;
  return model;
}

/// Ground from the samples beside the stripe, its centre and width from moment and area.
StripeVector stripe_start(const StripeProfile& profile, int begin, int end,
                          const StripePrior& prior) {
  double ground = 0.0;
  int beside = 0;
  for (int i = 0; i < profile.count; ++i) {
    if (i >= begin - 1 && i < end + 1) continue;
    ground += profile.values[static_cast<std::size_t>(i)];
    ++beside;
  }
  ground /= std::max(1, beside);
  double area = 0.0;
  double moment = 0.0;
  double peak = 0.0;
  for (int i = std::max(0, begin - 1); i < std::min(profile.count, end + 1); ++i) {
    const double over = std::max(0.0, profile.values[static_cast<std::size_t>(i)] - ground);
    area += over * profile.step_px;
    moment += over * profile.step_px * profile.position(i);
    peak = std::max(peak, over);
  }
  StripeVector x;
  // A stripe wider than its blur shows its height.
  const bool resolved = area > 3.0 * prior.blur_px * peak;
  x[kHeight] = resolved ? peak : std::max(peak, prior.height);
  x[kWidth] = std::max(0.1, area / std::max(1e-6, x[kHeight]));
  x[kCentre] = area > 0.0 ? moment / area : profile.position((begin + end) / 2);
  x[kSigma] = prior.blur_px;
  x[kLevel] = ground;
  x[kSlant] = 0.0;
  return x;
}

/// Normal equations of one step, with what is known before.
struct StripeStep {
  StripeMatrix information = StripeMatrix::Zero();
  StripeVector gradient = StripeVector::Zero();
  double chi2 = 0.0;  ///< of the samples
  double cost = 0.0;  ///< with what is known before

  void know(StripeUnknown what, double found, double expected, double sigma) {
    const double weight = 1.0 / (sigma * sigma);
    cost += weight * (expected - found) * (expected - found);
    information(what, what) += weight;
    gradient[what] += weight * (expected - found);
  }
};

StripeStep stripe_step(const StripeProfile& profile, const StripeVector& x,
                       const StripePrior& prior, double height) {
  StripeStep step;
  const double middle = profile.position(profile.count / 2);
  for (int i = 0; i < profile.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const StripeModel model = stripe_at(x, profile.position(i), middle);
    const double weight = 1.0 / profile.variances[at];
    const double rest = profile.values[at] - model.value;
    step.information.selfadjointView<Eigen::Lower>().rankUpdate(model.gradient, weight);
    step.gradient += weight * rest * model.gradient;
    step.chi2 += weight * rest * rest;
  }
  step.cost = step.chi2;
  step.know(kHeight, x[kHeight], height, 0.3 * height);
  step.know(kSigma, x[kSigma], prior.blur_px, 0.35 * prior.blur_px);
  step.know(kSlant, x[kSlant], 0.0, 0.03 * height);
  return step;
}

void keep_possible(StripeVector& x, const StripePrior& prior) {
  x[kWidth] = std::max(0.05, x[kWidth]);
  x[kSigma] = std::clamp(x[kSigma], 0.4 * prior.blur_px, 4.0 * prior.blur_px);
}

}  // namespace

std::optional<StripeFit> fit_stripe(const StripeProfile& profile, int begin, int end,
                                    const StripePrior& prior) {
  constexpr int kStripeSteps = 8;
  constexpr double kStill = 0.05;    // of χ², that a step would gain
  constexpr double kShorter = 0.4;   // of a step that worsens the fit
  constexpr double kSettled = 0.02;  // px, of the centre in the last step
  StripeVector x = stripe_start(profile, begin, end, prior);
  const double height = x[kHeight];
  StripeStep step = stripe_step(profile, x, prior, height);
  Eigen::LDLT<StripeMatrix> factors(step.information);
  StripeVector change = factors.solve(step.gradient);
  double length = 1.0;
  for (int k = 0; k < kStripeSteps && change.dot(step.gradient) > kStill; ++k) {
    StripeVector trial = x + length * change;
    keep_possible(trial, prior);
    const StripeStep next = stripe_step(profile, trial, prior, height);
    if (!(next.cost < step.cost)) {
      length *= kShorter;
      continue;
    }
    length = 1.0;
    x = trial;
    step = next;
    factors.compute(step.information);
    change = factors.solve(step.gradient);
  }
  const bool inside =
      x[kCentre] >= profile.start_px && x[kCentre] <= profile.position(profile.count - 1);
  if (!x.allFinite() || !inside || std::abs(change[kCentre]) > kSettled || x[kHeight] <= 0.0)
    return std::nullopt;
  const StripeMatrix covariance = factors.solve(StripeMatrix::Identity());
  StripeFit fit;
  fit.centre_px = x[kCentre];
  fit.width_px = x[kWidth];
  fit.height = x[kHeight];
  fit.blur_px = x[kSigma];
  fit.misfit = step.chi2 / std::max(1, profile.count - kStripeUnknowns + 2);
  fit.centre_sigma_px = std::sqrt(covariance(kCentre, kCentre));
  fit.width_sigma_px = std::sqrt(covariance(kWidth, kWidth));
  return fit;
}

}  // namespace vigia::tracking

#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace vigia::tracking {

/// A stretch of a ray across a bright stripe: equally spaced samples with independent errors.
struct StripeProfile {
  static constexpr int kMost = 96;
  int count = 0;
  double start_px = 0.0;
  double step_px = 1.0;
  std::array<double, kMost> values{};
  std::array<double, kMost> variances{};
  double position(int i) const { return start_px + i * step_px; }
};

/// A bright stripe on a ground that may slope, blurred by a Gaussian.
struct StripeFit {
  double centre_px = 0.0;
  double width_px = 1.0;
  double height = 1.0;  ///< over the ground
  double blur_px = 0.8;
  double centre_sigma_px = 0.1;
  double width_sigma_px = 0.1;
  double misfit = 1.0;  ///< χ² per degree of freedom
};

/// What is known of a stripe before.
struct StripePrior {
  double height = 1.0;  ///< of a wide stripe; a narrow one does not tell height and width apart
  double blur_px = 0.8;
};

/// Fits a stripe between samples @p begin and @p end of the profile, by Gauss-Newton. Nothing
/// where it does not settle.
std::optional<StripeFit> fit_stripe(const StripeProfile& profile, int begin, int end,
                                    const StripePrior& prior);

}  // namespace vigia::tracking

#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/pose.hpp"

namespace vigia::evaluation {

/// A closed interval.
struct Interval {
  double low = 0.0;
  double high = 0.0;
  bool contains(double value) const { return low <= value && value <= high; }
};

/// An estimate beside the truth at one instant.
struct PoseSample {
  Pose2 truth;
  Pose2 estimate;
  Eigen::Matrix3d covariance;  ///< of (x, y, θ), as the estimator claims
};

/// Errors of an estimator along one drive: metres, radians.
struct DriveErrors {
  double position_final = 0.0;
  double position_rmse = 0.0;
  double position_max = 0.0;
  double heading_final = 0.0;
  double heading_rmse = 0.0;
  double heading_max = 0.0;
  double nees_mean = 0.0;  ///< over the samples, 3 degrees of freedom
};

/// Normalised estimation error squared eᵀ P⁻¹ e, 3 degrees of freedom.
double nees(const PoseSample& sample);

/// Throws std::invalid_argument when there are no samples.
DriveErrors drive_errors(const std::vector<PoseSample>& samples);

/// Mean length of a planar Gaussian error with this covariance, σ₁ √(2/π) E(1 − σ₂²/σ₁²), E the
/// complete elliptic integral of the second kind.
double mean_length(const Eigen::Matrix2d& covariance);

/// Where the average NEES over @p runs independent runs lies with probability @p probability when
/// the estimator is consistent, per degree of freedom.
Interval anees_band(int runs, int dof, double probability = 0.95);

/// ANEES over independent runs.
struct Anees {
  std::vector<double> per_dof;  ///< average over the runs at each instant, per degree of freedom
  double inside_band = 0.0;     ///< share of the instants at which it lies in its 95 % band
  double mean_per_dof = 0.0;    ///< over the instants
};

/// @p nees[run][instant]; every run has the same number of instants, at least one. Throws
/// std::invalid_argument.
Anees anees(const std::vector<std::vector<double>>& nees, int dof);

/// An estimate with its 95 % interval.
struct Estimate {
  double value = 0.0;
  Interval interval;
};

/// √(Σ MSE / Σ tr P): @p squared_errors and @p bounds hold, per run, the sums along the drive of
/// the squared error and of the trace of the bound. The interval is a percentile bootstrap over the
/// runs. Throws std::invalid_argument unless both have the same, positive, number of runs.
Estimate pcrlb_ratio(const std::vector<double>& squared_errors, const std::vector<double>& bounds,
                     std::uint64_t seed, int resamples = 2000);

/// The exact interval of a share of which @p successes of @p trials were seen.
Interval clopper_pearson(int successes, int trials, double confidence = 0.95);

/// The exact interval of the mean of a Poisson variable of which @p count was seen (Garwood 1936).
Interval poisson_mean(int count, double confidence = 0.95);

/// Mean of a[i] − b[i] over paired runs with its 95 % interval by Student's t. At least two pairs;
/// throws std::invalid_argument.
Estimate paired_difference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace vigia::evaluation

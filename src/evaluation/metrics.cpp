#include "vigia/evaluation/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/ellint_2.hpp>

#include "vigia/core/random.hpp"
#include "vigia/localization/chi_square.hpp"

namespace vigia::evaluation {
namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The value below which the share @p p of the sorted values lies, interpolated.
double percentile(const std::vector<double>& sorted, double p) {
  const double rank = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (rank - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

double nees(const PoseSample& sample) {
  const Eigen::Vector3d e = difference(sample.estimate, sample.truth);
  return e.dot(sample.covariance.ldlt().solve(e));
}

DriveErrors drive_errors(const std::vector<PoseSample>& samples) {
  if (samples.empty()) throw std::invalid_argument("a drive without samples has no errors");
  DriveErrors errors;
  const double n = static_cast<double>(samples.size());
  for (const PoseSample& sample : samples) {
    const Eigen::Vector3d e = difference(sample.estimate, sample.truth);
    errors.position_final = e.head<2>().norm();
    errors.heading_final = std::abs(e.z());
    errors.position_max = std::max(errors.position_max, errors.position_final);
    errors.heading_max = std::max(errors.heading_max, errors.heading_final);
    errors.position_rmse += e.head<2>().squaredNorm() / n;
    errors.heading_rmse += e.z() * e.z() / n;
    errors.nees_mean += nees(sample) / n;
  }
  errors.position_rmse = std::sqrt(errors.position_rmse);
  errors.heading_rmse = std::sqrt(errors.heading_rmse);
  return errors;
}

double mean_length(const Eigen::Matrix2d& covariance) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(covariance, Eigen::EigenvaluesOnly);
  const double small = std::max(0.0, axes.eigenvalues()(0));
  const double large = axes.eigenvalues()(1);
  if (large <= 0.0) return 0.0;
  return std::sqrt(2.0 * large / kPi) * boost::math::ellint_2(std::sqrt(1.0 - small / large));
}

Interval anees_band(int runs, int dof, double probability) {
  const double total = static_cast<double>(runs) * dof;
  const double tail = 0.5 * (1.0 - probability);
  return {localization::chi_square_quantile(tail, total) / total,
          localization::chi_square_quantile(1.0 - tail, total) / total};
}

Anees anees(const std::vector<std::vector<double>>& nees, int dof) {
  if (nees.empty() || nees.front().empty())
    throw std::invalid_argument("ANEES needs at least one run and one instant");
  const double scale = 1.0 / (static_cast<double>(nees.size()) * dof);
  Anees result;
  result.per_dof.assign(nees.front().size(), 0.0);
  for (const auto& run : nees) {
    if (run.size() != result.per_dof.size())
      throw std::invalid_argument("ANEES needs the same instants in every run");
    for (std::size_t i = 0; i < run.size(); ++i) result.per_dof[i] += scale * run[i];
  }
  const Interval band = anees_band(static_cast<int>(nees.size()), dof);
  const auto inside = std::count_if(result.per_dof.begin(), result.per_dof.end(),
                                    [&band](double value) { return band.contains(value); });
  result.inside_band = static_cast<double>(inside) / static_cast<double>(result.per_dof.size());
  result.mean_per_dof = mean(result.per_dof);
  return result;
}

Estimate pcrlb_ratio(const std::vector<double>& squared_errors, const std::vector<double>& bounds,
                     std::uint64_t seed, int resamples) {
  if (squared_errors.empty() || squared_errors.size() != bounds.size())
    throw std::invalid_argument("the PCRLB ratio needs as many errors as bounds, at least one");
  RandomStream random(seed, "pcrlb bootstrap");
  std::vector<double> ratios(static_cast<std::size_t>(resamples));
  for (double& ratio : ratios) {
    double errors = 0.0;
    double bound = 0.0;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const std::size_t run = random.index(bounds.size());
      errors += squared_errors[run];
      bound += bounds[run];
    }
    ratio = std::sqrt(errors / bound);
  }
  std::sort(ratios.begin(), ratios.end());
  return {std::sqrt(mean(squared_errors) / mean(bounds)),
          {percentile(ratios, 0.025), percentile(ratios, 0.975)}};
}

Interval clopper_pearson(int successes, int trials, double confidence) {
  using Beta = boost::math::beta_distribution<double>;
  const double tail = 0.5 * (1.0 - confidence);
  const double k = successes;
  const double n = trials;
  return {successes == 0 ? 0.0 : boost::math::quantile(Beta(k, n - k + 1.0), tail),
          successes == trials ? 1.0 : boost::math::quantile(Beta(k + 1.0, n - k), 1.0 - tail)};
}

Interval poisson_mean(int count, double confidence) {
  using ChiSquared = boost::math::chi_squared_distribution<double>;
  const double tail = 0.5 * (1.0 - confidence);
  const double k = count;
  return {count == 0 ? 0.0 : 0.5 * boost::math::quantile(ChiSquared(2.0 * k), tail),
          0.5 * boost::math::quantile(ChiSquared(2.0 * k + 2.0), 1.0 - tail)};
}

Estimate paired_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() < 2 || a.size() != b.size())
    throw std::invalid_argument("a paired difference needs at least two pairs");
  std::vector<double> differences(a.size());
  std::transform(a.begin(), a.end(), b.begin(), differences.begin(), std::minus<>());
  const double centre = mean(differences);
  const double n = static_cast<double>(a.size());
  double squares = 0.0;
  for (const double d : differences) squares += (d - centre) * (d - centre);
  const boost::math::students_t_distribution<double> student(n - 1.0);
  const double half = boost::math::quantile(student, 0.975) * std::sqrt(squares / (n - 1.0) / n);
  return {centre, {centre - half, centre + half}};
}

}  // namespace vigia::evaluation

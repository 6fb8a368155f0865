#include "bare_dots.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "vigia/core/median.hpp"

namespace vigia::tracking {
namespace {

// What is rare beside the other dots' median. Of growth and offset a part is left out below which
// all dots are alike, px.
constexpr double kRareGrowth = 5.0;  // median deviations as σ
constexpr double kRareOffset = 3.0;
constexpr double kRareSplit = 4.5;
constexpr double kRareTint = 3.0;
// And beyond the median, as a share of it.
constexpr double kRareNoise = 1.0;
constexpr double kRareFaintNoise = 2.5;
constexpr double kRareSigma = 1.0;
// Below these all dots are alike.
constexpr double kAlike = 0.03;  // px
constexpr double kTintAlike = 0.02;
constexpr double kOtherInk = 0.25;  // between the tints of two inks
constexpr double kSigmaOfDeviation = 1.4826;

/// One dot's features.
struct Features {
  double growth = 0.0;       ///< of the rim against the plane, px
  double offset = 0.0;       ///< of the centre against the plane, px
  double split = 0.0;        ///< of the channels' centres, the largest, px
  double noise = 0.0;        ///< about the fitted profile, grey levels
  double faint_noise = 0.0;  ///< of the channel that the dot absorbs least
  double sigma = 0.0;        ///< stated error of the centre, px
  double tint = 0.0;         ///< distance to the nearest tint of the ring's others; 0: none is near
};

double split_of(const DotPulls& pulls, const ChromaticShift& shift) {
  double split = 0.0;
  for (std::size_t c = 0; c < pulls.channels.size(); ++c) {
    const ChannelPull& channel = pulls.channels[c];
    if (channel.information.determinant() < 1e-9) continue;
    const Eigen::Vector2d lens = shift.of_channel(static_cast<int>(c), pulls.share);
    split = std::max(split, (channel.information.inverse() * channel.pull - lens).norm());
  }
  return split;
}

/// What the channels absorb, of the most absorbed one.
Eigen::Array3d tint_of(const ColourLevels& levels) {
  const Eigen::Array3d absorbed = 1.0 - levels.dot / levels.ground.max(1.0);
  return absorbed / std::max(absorbed.maxCoeff(), 1e-6);
}

double faint_noise(const ColourLevels& levels) {
  Eigen::Index faintest = 0;
  (levels.ground - levels.dot).minCoeff(&faintest);
  return levels.noise[faintest];
}

double nearest_tint(const std::array<DotFit, kPatternDots>& dots, std::size_t place) {
  double nearest = kOtherInk;
  for (std::size_t i = 1; i < dots.size(); ++i)
    if (i != place && dots[i].status == DotStatus::whole)
      nearest = std::min(nearest,
                         (tint_of(dots[i].levels) - tint_of(dots[place].levels)).matrix().norm());
  return nearest < kOtherInk ? nearest : 0.0;
}

/// The median of one feature over the ring's dots.
template <typename Feature>
double ring_median(const std::vector<Features>& ring, Feature feature) {
  std::vector<double> values(ring.size());
  std::transform(ring.begin(), ring.end(), values.begin(), feature);
  return median_of(std::move(values));
}

/// Medians and, of growth, the deviation from it.
struct Company {
  Features median;
  double growth_deviation = 0.0;
};

Company company_of(const std::vector<Features>& ring) {
  Company company;
  const double growth = ring_median(ring, [](const Features& f) { return f.growth; });
  company.median.growth = growth;
  company.median.offset = ring_median(ring, [](const Features& f) { return f.offset; });
  company.median.split = ring_median(ring, [](const Features& f) { return f.split; });
  company.median.noise = ring_median(ring, [](const Features& f) { return f.noise; });
  company.median.faint_noise = ring_median(ring, [](const Features& f) { return f.faint_noise; });
  company.median.sigma = ring_median(ring, [](const Features& f) { return f.sigma; });
  company.median.tint = ring_median(ring, [](const Features& f) { return f.tint; });
  company.growth_deviation = kSigmaOfDeviation * ring_median(ring, [=](const Features& f) {
                               return std::abs(f.growth - growth);
                             });
  return company;
}

double excess(double value, double median) {
  return std::max(0.0, value / std::max(median, 1e-6) - 1.0);
}

double oddness(const Features& dot, const Company& company) {
  const double growth =
      (dot.growth - company.median.growth) / (company.growth_deviation + kAlike) / kRareGrowth;
  const double offset = dot.offset / (company.median.offset + kAlike) / kRareOffset;
  const double split = dot.split / (company.median.split + kAlike) / kRareSplit;
  const double tint = dot.tint / (company.median.tint + kTintAlike) / kRareTint;
  const double noise = excess(dot.noise, company.median.noise) / kRareNoise;
  const double faint = excess(dot.faint_noise, company.median.faint_noise) / kRareFaintNoise;
  const double sigma = excess(dot.sigma, company.median.sigma) / kRareSigma;
  return std::sqrt(growth * growth + offset * offset + split * split + tint * tint + noise * noise +
                   faint * faint + sigma * sigma);
}

}  // namespace

double growth_of(const EllipseShape& shape, const EllipseShape& expected) {
  const Ellipse seen = ellipse_of(shape);
  const Ellipse plane = ellipse_of(expected);
  return (seen.a * seen.b - plane.a * plane.b) / (0.5 * (seen.a + seen.b + plane.a + plane.b));
}

std::array<double, kPatternDots> oddness_of(const std::array<DotFit, kPatternDots>& dots,
                                            const std::array<EllipseShape, kPatternDots>& expected,
                                            const ChromaticShift& shift) {
  std::array<Features, kPatternDots> features;
  std::vector<Features> ring;
  for (std::size_t i = 0; i < dots.size(); ++i) {
    if (dots[i].status != DotStatus::whole) continue;
    features[i].growth = growth_of(dots[i].shape, expected[i]);
    features[i].offset = (dots[i].shape.centre - expected[i].centre).norm();
    features[i].split = split_of(dots[i].pulls, shift);
    features[i].noise = dots[i].levels.noise.matrix().norm();
    features[i].faint_noise = faint_noise(dots[i].levels);
    features[i].sigma = std::sqrt(0.5 * dots[i].centre_covariance.trace());
    if (i > 0) features[i].tint = nearest_tint(dots, i);
    if (i > 0) ring.push_back(features[i]);
  }
  std::array<double, kPatternDots> result{};
  if (ring.empty()) return result;
  const Company company = company_of(ring);
  for (std::size_t i = 0; i < dots.size(); ++i)
    if (dots[i].status == DotStatus::whole) result[i] = oddness(features[i], company);
  return result;
}

}  // namespace vigia::tracking

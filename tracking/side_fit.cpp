#include "side_fit.hpp"

#include "pixel.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

constexpr double kMaxSideBlur = 4.0;  // px
constexpr double kBandBlurs = 3.0;
constexpr double kEndBlurs = 2.5;
constexpr int kPasses = 3;         // bands, each round the last result
constexpr int kSteps = 3;          // of Gauss–Newton in one band
constexpr double kShortest = 6.0;  // px
constexpr double kLargestStep = 1.0;
constexpr double kMinStep = 15.0;  // grey levels

struct Sample {
  double along;   ///< from the middle, px
  double across;  ///< towards the light, px
  double grey;
};

/// Unknowns in the order of the columns.
struct Edge {
  double offset = 0.0;
  double turn = 0.0;
  double dark = 0.0;
  double light = 0.0;
  double blur = kStartBlur;
};

using Normal = Eigen::Matrix<double, 5, 5>;
using Vector = Eigen::Matrix<double, 5, 1>;

struct Sums {
  Normal normal = Normal::Zero();
  Vector gradient = Vector::Zero();
  double squares = 0.0;
};

Sums accumulate(const std::vector<Sample>& samples, const Edge& edge) {
  Sums sums;
  for (const Sample& sample : samples) {
    const double t = (sample.across - edge.offset - edge.turn * sample.along) / edge.blur;
    const double share = 0.5 * std::erfc(-t / std::sqrt(2.0));
    const double density = std::exp(-0.5 * t * t) / std::sqrt(2.0 * kPi);
    const double slope = (edge.light - edge.dark) * density / edge.blur;
    Vector row;
    row << -slope, -slope * sample.along, 1.0 - share, share, -slope * t;
    const double residual = sample.grey - edge.dark - (edge.light - edge.dark) * share;
    sums.normal.noalias() += row * row.transpose();
    sums.gradient += row * residual;
    sums.squares += residual * residual;
  }
  return sums;
}

void take(Edge& edge, const Vector& step) {
  edge.offset += step[0];
  edge.turn += step[1];
  edge.dark += step[2];
  edge.light += step[3];
  edge.blur = std::clamp(edge.blur + step[4], kPixelBlur, kMaxSideBlur);
}

/// The pixels within @p half_width of the line and @p half_length of its middle.
std::vector<Sample> collect(const vpImage<unsigned char>& image, const SideFit& line,
                            double half_length, double half_width) {
  const Eigen::Vector2d tangent(-line.normal.y(), line.normal.x());
  const Eigen::Vector2d reach =
      half_length * tangent.cwiseAbs() + half_width * line.normal.cwiseAbs();
  const auto low = [](double value) { return static_cast<int>(std::ceil(value)); };
  const auto high = [](double value) { return static_cast<int>(std::floor(value)); };
  const int u0 = std::max(0, low(line.middle.x() - reach.x()));
  const int v0 = std::max(0, low(line.middle.y() - reach.y()));
  const int u1 =
      std::min(static_cast<int>(image.getWidth()) - 1, high(line.middle.x() + reach.x()));
  const int v1 =
      std::min(static_cast<int>(image.getHeight()) - 1, high(line.middle.y() + reach.y()));
  std::vector<Sample> samples;
  for (int v = v0; v <= v1; ++v)
    for (int u = u0; u <= u1; ++u) {
      const Eigen::Vector2d d = Eigen::Vector2d(u, v) - line.middle;
      const double along = d.dot(tangent);
      const double across = d.dot(line.normal);
      if (std::abs(along) > half_length || std::abs(across) > half_width) continue;
      samples.push_back({along, across, static_cast<double>(image[static_cast<unsigned>(v)][u])});
    }
  return samples;
}

/// Means on both sides, away from the edge.
void start_levels(const std::vector<Sample>& samples, double half_width, Edge& edge) {
  double dark = 0.0;
  double light = 0.0;
  int dark_count = 0;
  int light_count = 0;
  for (const Sample& sample : samples) {
    if (sample.across < -0.4 * half_width) {
      dark += sample.grey;
      ++dark_count;
    } else if (sample.across > 0.4 * half_width) {
      light += sample.grey;
      ++light_count;
    }
  }
  edge.dark = dark / std::max(1, dark_count);
  edge.light = light / std::max(1, light_count);
}

/// Moves the line by offset and turn, and turns the covariance into that of the moved line.
void move(SideFit& line, const Edge& edge) {
  const Eigen::Vector2d tangent(-line.normal.y(), line.normal.x());
  line.middle += edge.offset * line.normal;
  line.normal = (line.normal - edge.turn * tangent).normalized();
}

}  // namespace

double SideFit::variance_at(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d tangent(-normal.y(), normal.x());
  const Eigen::Vector2d lever(1.0, (point - middle).dot(tangent));
  return lever.dot(covariance * lever);
}

std::optional<SideFit> fit_side(const vpImage<unsigned char>& image, const SideBand& band) {
  SideFit line;
  const Eigen::Vector2d side = band.to - band.from;
  const double length = side.norm();
  line.middle = 0.5 * (band.from + band.to);
  line.normal = Eigen::Vector2d(-side.y(), side.x()) / length;
  if (line.normal.dot(band.inside - line.middle) > 0.0) line.normal = -line.normal;

  Edge edge;
  for (int pass = 0; pass < kPasses; ++pass) {
    const double half_width = std::min(kBandBlurs * edge.blur + 0.5, band.half_width);
    const double half_length = 0.5 * length - kEndBlurs * edge.blur;
    if (2.0 * half_length < kShortest) return std::nullopt;
    const std::vector<Sample> samples = collect(image, line, half_length, half_width);
    if (samples.size() < 20) return std::nullopt;
    if (pass == 0) start_levels(samples, half_width, edge);
    edge.offset = edge.turn = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const Sums sums = accumulate(samples, edge);
      const Vector step = sums.normal.ldlt().solve(sums.gradient);
      if (!step.allFinite() || std::abs(step[0]) > 3.0 * kLargestStep) return std::nullopt;
      take(edge, step);
    }
    const Sums sums = accumulate(samples, edge);
    const double variance =
        std::max(sums.squares / (static_cast<double>(samples.size()) - 5.0), kQuantisationVariance);
    const Normal covariance = variance * sums.normal.ldlt().solve(Normal::Identity());
    line.covariance = covariance.topLeftCorner<2, 2>();
    line.noise = std::sqrt(variance);
    line.blur = edge.blur;
    line.contrast = edge.light - edge.dark;
    move(line, edge);
  }
  if (!line.covariance.allFinite() || line.contrast < kMinStep) return std::nullopt;
  return line;
}

std::optional<Corner> meet(const SideFit& a, const SideFit& b) {
  Eigen::Matrix2d normals;
  normals << a.normal.transpose(), b.normal.transpose();
  constexpr double kParallel = 0.05;
  if (std::abs(normals.determinant()) < kParallel) return std::nullopt;
  const Eigen::Matrix2d inverse = normals.inverse();
  Corner corner;
  corner.uv = inverse * Eigen::Vector2d(a.normal.dot(a.middle), b.normal.dot(b.middle));
  const Eigen::Vector2d variances(a.variance_at(corner.uv), b.variance_at(corner.uv));
  corner.covariance = inverse * variances.asDiagonal() * inverse.transpose();
  return corner;
}

double corner_bound(double length, double contrast, double noise, double blur) {
  const double information = contrast * contrast / (noise * noise) / (2.0 * std::sqrt(kPi) * blur);
  return std::sqrt(4.0 / (information * length));
}

}  // namespace vigia::tracking

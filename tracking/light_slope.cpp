#include "light_slope.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace vigia::tracking {
namespace {

constexpr std::size_t kLightSectors = 16;
constexpr double kRingWidth = 6.0;      // px of ground outside the band
constexpr double kLeastInterior = 3.0;  // px of the disc's semi-minor axis within the band

/// Sums over the pixels of one sector.
struct SectorSum {
  double pixels = 0.0;
  double u = 0.0;
  double v = 0.0;
  double grey = 0.0;
  double clipped = 0.0;  ///< pixels at 0 or 255, which tell no slope

  double level() const { return grey / pixels; }
};
using SectorSums = std::array<SectorSum, kLightSectors>;

// Sums whole columns of a row between two chords' ends.
class SectorSummer {
 public:
  SectorSummer(const vpImage<unsigned char>& image, const imaging::Window& bounds,
               const Eigen::Vector2d& centre)
      : image_(image), bounds_(bounds), centre_(centre) {}

  // Columns from @p first to @p last of row @p v.
  void add(int v, double first, double last, SectorSums& sums) const {
    if (v < bounds_.v || v >= bounds_.bottom()) return;
    const int from = std::max(bounds_.u, static_cast<int>(std::ceil(first)));
    const int to = std::min(bounds_.right() - 1, static_cast<int>(std::floor(last)));
    const unsigned char* row = image_[static_cast<unsigned>(v)];
    const auto y = static_cast<float>(v - centre_.y());
    for (int u = from; u <= to; ++u) {
      const auto x = static_cast<float>(u - centre_.x());
      // A substitute for the angle that needs no arc tangent: 0..4 once round.
      const float turn = y / (std::abs(x) + std::abs(y) + 1e-6F);
      const float angle = x >= 0.0F ? 1.0F + turn : 3.0F - turn;
      constexpr float kPerTurn = kLightSectors / 4.0F;
      SectorSum& sum =
          sums[std::min(static_cast<std::size_t>(kPerTurn * angle), kLightSectors - 1)];
      sum.pixels += 1.0;
      sum.u += static_cast<double>(x);
      sum.v += static_cast<double>(y);
      sum.grey += static_cast<double>(row[u]);
      sum.clipped += row[u] == 0 || row[u] == 255 ? 1.0 : 0.0;
    }
  }

 private:
  const vpImage<unsigned char>& image_;
  imaging::Window bounds_;
  Eigen::Vector2d centre_;
};

/// Where the row @p dv below the centre cuts the ellipse Σ: left and right of the centre.
struct Cut {
  double left = 1.0;
  double right = -1.0;  // less than left: no cut
};

Cut cut_of(const Eigen::Matrix2d& sigma, double dv) {
  const double inside = 1.0 - dv * dv / sigma(1, 1);
  if (inside < 0.0) return {};
  const double slant = sigma(0, 1) / sigma(1, 1);
  const double half = std::sqrt((sigma(0, 0) - sigma(0, 1) * slant) * inside);
  return {slant * dv - half, slant * dv + half};
}

EllipseShape with_margin(const EllipseShape& shape, double margin) {
  Ellipse ellipse = ellipse_of(shape);
  ellipse.a += margin;
  ellipse.b += margin;
  return shape_of(ellipse);
}

// Of a large disc every second or third row says enough.
int row_step_for(double size) {
  return size < 10.0 ? 1 : size < 25.0 ? 2 : 3;
}

SectorSums ring_sums(const vpImage<unsigned char>& image, const imaging::Window& bounds,
                     const EllipseShape& shape, double band_px) {
  const SectorSummer summer(image, bounds, shape.centre);
  const EllipseShape inner = with_margin(shape, band_px);
  const EllipseShape outer = with_margin(shape, band_px + kRingWidth);
  const imaging::Window rows = window_round(outer, 0.0);
  SectorSums sums{};
  for (int v = rows.v; v < rows.bottom(); v += row_step_for(size_of(shape))) {
    const double u0 = shape.centre.x();
    const double dv = v - shape.centre.y();
    const Cut whole = cut_of(outer.sigma, dv);
    if (whole.right < whole.left) continue;
    const Cut hole = cut_of(inner.sigma, dv);
    if (hole.right < hole.left) {
      summer.add(v, u0 + whole.left, u0 + whole.right, sums);
      continue;
    }
    summer.add(v, u0 + whole.left, u0 + hole.left, sums);
    summer.add(v, u0 + hole.right, u0 + whole.right, sums);
  }
  return sums;
}

SectorSums interior_sums(const vpImage<unsigned char>& image, const imaging::Window& bounds,
                         const EllipseShape& shape, double band_px) {
  const SectorSummer summer(image, bounds, shape.centre);
  const EllipseShape inner = with_margin(shape, -band_px);
  const imaging::Window rows = window_round(inner, 0.0);
  SectorSums sums{};
  for (int v = rows.v; v < rows.bottom(); v += row_step_for(size_of(shape))) {
    const Cut cut = cut_of(inner.sigma, v - shape.centre.y());
    if (cut.left < cut.right)
      summer.add(v, shape.centre.x() + cut.left, shape.centre.x() + cut.right, sums);
  }
  return sums;
}

/// The plane through the sectors' mean levels.
struct Plane {
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

struct PlaneFit {
  Eigen::Vector3d levels;                        // at the centre, along u, along v
  Eigen::Matrix3d inverse;                       // of the normal matrix
  double scatter = 0.0;                          // χ² per degree of freedom
  std::array<double, kLightSectors> residual{};  // times √pixels
};

std::optional<PlaneFit> fit_plane(const SectorSums& sums,
                                  const std::array<bool, kLightSectors>& used) {
  constexpr int kLeastSectors = 10;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d product = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t k = 0; k < kLightSectors; ++k) {
    if (!used[k]) continue;
    const SectorSum& sum = sums[k];
    const Eigen::Vector3d row(1.0, sum.u / sum.pixels, sum.v / sum.pixels);
    normal += sum.pixels * row * row.transpose();
    product += sum.grey * row;
    ++count;
  }
  if (count < kLeastSectors) return std::nullopt;
  PlaneFit fit;
  fit.inverse = normal.inverse();
  fit.levels = fit.inverse * product;
  double squares = 0.0;
  for (std::size_t k = 0; k < kLightSectors; ++k) {
    const SectorSum& sum = sums[k];
    if (sum.pixels == 0.0) continue;
    const double predicted =
        fit.levels.dot(Eigen::Vector3d(1.0, sum.u / sum.pixels, sum.v / sum.pixels));
    fit.residual[k] = (sum.level() - predicted) * std::sqrt(sum.pixels);
    if (used[k]) squares += fit.residual[k] * fit.residual[k];
  }
  // Rounding alone leaves 1/12.
  fit.scatter = std::max(squares / (count - 3), 1.0 / 12.0);
  return fit.levels.allFinite() ? std::optional(fit) : std::nullopt;
}

// The sectors whose residuals lie within a multiple of their median.
std::array<bool, kLightSectors> inliers(const PlaneFit& fit,
                                        const std::array<bool, kLightSectors>& seen) {
  constexpr double kOutlier = 4.0;
  std::array<double, kLightSectors> sizes{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < kLightSectors; ++k)
    if (seen[k]) sizes[count++] = std::abs(fit.residual[k]);
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(count / 2),
                   sizes.begin() + static_cast<std::ptrdiff_t>(count));
  // The median of a normal number's size is 0.6745 σ.
  const double limit = kOutlier * std::max(sizes[count / 2], 0.3) / 0.6745;
  std::array<bool, kLightSectors> used{};
  for (std::size_t k = 0; k < kLightSectors; ++k)
    used[k] = seen[k] && std::abs(fit.residual[k]) <= limit;
  return used;
}

std::optional<Plane> plane_of(const SectorSums& sums) {
  constexpr double kLeastPixels = 3.0;
  constexpr double kMostClipped = 0.1;
  std::array<bool, kLightSectors> seen{};
  for (std::size_t k = 0; k < kLightSectors; ++k)
    seen[k] = sums[k].pixels >= kLeastPixels && sums[k].clipped <= kMostClipped * sums[k].pixels;
  std::optional<PlaneFit> fit = fit_plane(sums, seen);
  // Twice: what stands out draws the first plane to itself.
  for (int pass = 0; fit && pass < 2; ++pass) fit = fit_plane(sums, inliers(*fit, seen));
  if (!fit) return std::nullopt;
  return Plane{fit->levels.tail<2>(), fit->scatter * fit->inverse.bottomRightCorner<2, 2>()};
}

/// What the disc shows itself, weighed against the ground's light: a dark surface throws back so
/// much less of it, and stray light nothing less.
Plane slope_of_disc(const std::optional<Plane>& seen, const Plane& ground,
                    const SideLevels& levels) {
  const double share = std::clamp(levels.disc / std::max(levels.ground, 1.0), 0.0, 2.0);
  Plane guess;
  guess.slope = share * ground.slope;
  const double unsure = 0.6 * std::abs(1.0 - share) * ground.slope.norm();
  guess.covariance = unsure * unsure * Eigen::Matrix2d::Identity() +
                     share * share * ground.covariance + 1e-9 * Eigen::Matrix2d::Identity();
  if (!seen) return guess;
  const Eigen::Matrix2d gain = guess.covariance * (guess.covariance + seen->covariance).inverse();
  Plane out;
  out.slope = guess.slope + gain * (seen->slope - guess.slope);
  out.covariance = (Eigen::Matrix2d::Identity() - gain) * guess.covariance;
  return out;
}

double ground_share(const SectorSums& ring, const SideLevels& levels) {
  int seen = 0;
  int like_ground = 0;
  for (const SectorSum& sum : ring) {
    if (sum.pixels == 0.0) continue;
    ++seen;
    like_ground +=
        std::abs(sum.level() - levels.ground) < std::abs(sum.level() - levels.disc) ? 1 : 0;
  }
  return seen > 0 ? static_cast<double>(like_ground) / seen : 1.0;
}

bool stands_clear(const Plane& plane) {
  // χ² of two, with the tails of a scatter that thirteen sectors tell: once in three hundred.
  constexpr double kClear = 18.0;
  return plane.slope.dot(plane.covariance.ldlt().solve(plane.slope)) >= kClear;
}

}  // namespace

Surroundings measure_surroundings(const vpImage<unsigned char>& image,
                                  const imaging::Window& bounds, const EllipseShape& shape,
                                  double band_px, const SideLevels& levels) {
  const SectorSums ring = ring_sums(image, bounds, shape, band_px);
  Surroundings out;
  out.ground_share = ground_share(ring, levels);
  const auto ground = plane_of(ring);
  if (!ground || !stands_clear(*ground)) return out;
  std::optional<Plane> interior;
  if (ellipse_of(shape).b - band_px >= kLeastInterior)
    interior = plane_of(interior_sums(image, bounds, shape, band_px));
  const Plane disc = slope_of_disc(interior, *ground, levels);
  out.light =
      LightSlope{shape.centre, ground->slope, disc.slope, ground->covariance, disc.covariance};
  return out;
}

}  // namespace vigia::tracking

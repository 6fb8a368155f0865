#include "edge_fit.hpp"

#include "pixel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

constexpr double kMaxBlur = 6.0;
constexpr double kMinAxis = 1.5;     // px
constexpr double kLevelRest = 0.05;  // of the contrast: levels that change less are at rest

// Φ and φ of the normal distribution, tabulated; linear in between (error below 1e-5).
class NormalTable {
 public:
  static constexpr float kLimit = 4.5F;
  static constexpr int kPerUnit = 64;

  NormalTable() {
    for (int i = 0; i < kSize; ++i) {
      const double t = static_cast<double>(i) / kPerUnit - static_cast<double>(kLimit);
      values_[static_cast<std::size_t>(i)] = {
          static_cast<float>(0.5 * std::erfc(-t / std::sqrt(2.0))),
          static_cast<float>(std::exp(-0.5 * t * t) / std::sqrt(2.0 * kPi))};
    }
  }

  struct Value {
    float integral;
    float density;
  };

  Value at(float t) const {
    const float place = (std::clamp(t, -kLimit, kLimit) + kLimit) * kPerUnit;
    const int index = std::min(static_cast<int>(place), kSize - 2);
    const float rest = place - static_cast<float>(index);
    const Value& low = values_[static_cast<std::size_t>(index)];
    const Value& high = values_[static_cast<std::size_t>(index) + 1];
    return {low.integral + rest * (high.integral - low.integral),
            low.density + rest * (high.density - low.density)};
  }

 private:
  static constexpr int kSize = 2 * 288 + 1;
  std::array<Value, kSize> values_{};
};

const NormalTable& normal_table() {
  static const NormalTable table;
  return table;
}

// Where the row v cuts the ellipse: the half length of the chord and its middle.
struct Chord {
  double middle;
  double half;  // negative: no cut
};

Chord chord_of(const EllipseShape& shape, double v) {
  const double dv = v - shape.centre.y();
  const double p = shape.sigma(0, 0);
  const double q = shape.sigma(0, 1);
  const double r = shape.sigma(1, 1);
  const double inside = 1.0 - dv * dv / r;
  if (inside < 0.0) return {0.0, -1.0};
  return {shape.centre.x() + q / r * dv, std::sqrt((p - q * q / r) * inside)};
}

// The ellipse of the same directions with both axes longer by @p margin (shorter if negative).
EllipseShape grown(const EllipseShape& shape, double margin) {
  Ellipse ellipse = ellipse_of(shape);
  ellipse.a += margin;
  ellipse.b += margin;
  return shape_of(ellipse);
}

bool is_ellipse(const EllipseShape& shape) {
  return shape.sigma.allFinite() && shape.centre.allFinite() && shape.sigma.determinant() > 0.0 &&
         shape.sigma(0, 0) > 0.0 && ellipse_of(shape).b >= kMinAxis;
}

}  // namespace

void EdgeFitter::collect(const vpImage<unsigned char>& image, const imaging::Window& bounds) {
  band_shape_ = shape_;
  band_blur_ = profile_.blur;
  const double half_width = parameters_.band_blurs * profile_.blur + 0.3;
  const Ellipse ellipse = ellipse_of(shape_);
  const EllipseShape outer = grown(shape_, half_width);
  const bool has_hole = ellipse.b > half_width + 0.5;
  const EllipseShape inner = has_hole ? grown(shape_, -half_width) : shape_;

  const double area =
      kPi * ((ellipse.a + half_width) * (ellipse.b + half_width) -
             (has_hole ? (ellipse.a - half_width) * (ellipse.b - half_width) : 0.0));
  const int thinning = std::max(1, static_cast<int>(std::ceil(area / parameters_.max_pixels)));
  const Eigen::Index capacity = padded(static_cast<int>(1.1 * area / thinning) + 256);
  if (u_.size() < capacity) {
    u_.resize(capacity);
    v_.resize(capacity);
    grey_.resize(capacity);
    residual_.resize(capacity);
    t_.resize(capacity);
    work_.resize(capacity, 6);
    jacobian_.resize(capacity, kUnknowns);
    sector_.resize(static_cast<std::size_t>(capacity));
  }

  complete_ = true;
  count_ = 0;
  const imaging::Window rows = window_round(outer, 0.0);
  for (int v = rows.v; v < rows.bottom(); ++v) {
    const Chord whole = chord_of(outer, v);
    if (whole.half < 0.0) continue;
    const int first = static_cast<int>(std::ceil(whole.middle - whole.half));
    const int last = static_cast<int>(std::floor(whole.middle + whole.half));
    if (last < first) continue;
    if (v < bounds.v || v >= bounds.bottom() || first < bounds.u || last >= bounds.right())
      complete_ = false;
    if (v < bounds.v || v >= bounds.bottom()) continue;
    const unsigned char* row = image[static_cast<unsigned>(v)];
    const Chord hole = has_hole ? chord_of(inner, v) : Chord{0.0, -1.0};
    const int hole_first =
        hole.half < 0.0 ? last + 1 : static_cast<int>(std::ceil(hole.middle - hole.half));
    const int hole_last =
        hole.half < 0.0 ? last : static_cast<int>(std::floor(hole.middle + hole.half));
    const auto take = [&](int from, int to) {
      from = std::max(from, bounds.u);
      to = std::min(to, bounds.right() - 1);
      // A fixed pattern over the image, so that thinning picks no direction of the outline.
      if (thinning > 1) {
        const int phase = (from + 2 * v) % thinning;
        if (phase != 0) from += thinning - phase;
      }
      for (int u = from; u <= to && count_ < capacity; u += thinning) {
        u_[count_] = static_cast<float>(u - band_shape_.centre.x());
        v_[count_] = static_cast<float>(v - band_shape_.centre.y());
        grey_[count_] = static_cast<float>(row[u]);
        ++count_;
      }
    };
    take(first, std::min(last, hole_first - 1));
    take(std::max(first, hole_last + 1), last);
  }
}

void EdgeFitter::evaluate() {
  const int n = count_;
  const double determinant = shape_.sigma.determinant();
  const OutlineConstants outline{static_cast<float>(shape_.centre.x() - band_shape_.centre.x()),
                                 static_cast<float>(shape_.centre.y() - band_shape_.centre.y()),
                                 static_cast<float>(shape_.sigma(1, 1) / determinant),
                                 static_cast<float>(-shape_.sigma(0, 1) / determinant),
                                 static_cast<float>(shape_.sigma(0, 0) / determinant),
                                 static_cast<float>(1.0 / determinant),
                                 static_cast<float>(profile_.blur)};
  const auto contrast = static_cast<float>(profile_.ground - profile_.disc);
  const auto ground = static_cast<float>(profile_.ground);
  const OutlinePlaces places{work_.col(0).data(), work_.col(1).data(), work_.col(2).data(),
                             work_.col(3).data(), t_.data()};
  place_pixels(outline, u_.data(), v_.data(), n, places);

  float* density = work_.col(4).data();
  float* share = jacobian_.col(kContrast).data();
  const NormalTable& table = normal_table();
  for (int i = 0; i < n; ++i) {
    const NormalTable::Value value = table.at(t_[i]);
    share[i] = -value.integral;
    density[i] = value.density;
    residual_[i] = grey_[i] - ground + contrast * value.integral;
  }
  differentiate_edge(places, density, contrast, outline.blur, n, columns());
  jacobian_.col(kGround).head(n).setOnes();
  const int padding = padded(n) - n;
  jacobian_.middleRows(n, padding).setZero();
  residual_.segment(n, padding).setZero();
}

JacobianColumns EdgeFitter::columns() {
  JacobianColumns out{};
  for (int i = 0; i < kUnknowns; ++i) out[static_cast<std::size_t>(i)] = jacobian_.col(i).data();
  return out;
}

// Jᵀr of the model as evaluated last.
void EdgeFitter::project_residual() {
  const auto sums = gradient_sums(columns(), residual_.data(), padded(count_));
  for (int i = 0; i < kUnknowns; ++i)
    gradient_[i] = static_cast<double>(sums[static_cast<std::size_t>(i)]);
}

// JᵀJ and Jᵀr of the model as evaluated last.
void EdgeFitter::accumulate() {
  project_residual();
  const auto sums = normal_sums(columns(), padded(count_));
  std::size_t k = 0;
  for (int i = 0; i < kUnknowns; ++i)
    for (int j = 0; j <= i; ++j, ++k) normal_(i, j) = normal_(j, i) = static_cast<double>(sums[k]);
}

// Applies one Gauss–Newton step, shortened where it is out of proportion. False when the ellipse
// is gone.
bool EdgeFitter::step() {
  Vector delta = normal_.ldlt().solve(gradient_);
  if (!delta.allFinite()) return false;
  const double limit = 1.5 + 0.5 * profile_.blur;
  const Ellipse ellipse = ellipse_of(shape_);
  const double movement =
      std::max({delta.head<2>().norm(), 0.5 * delta.segment<3>(2).norm() / (ellipse.b + 1e-9)});
  if (movement > limit) delta *= limit / movement;
  delta *= damping_;
  shape_.centre += delta.head<2>();
  shape_.sigma(0, 0) += delta[2];
  shape_.sigma(0, 1) += delta[3];
  shape_.sigma(1, 0) += delta[3];
  shape_.sigma(1, 1) += delta[4];
  const double contrast = profile_.ground - profile_.disc + delta[6];
  profile_.ground += delta[5];
  profile_.disc = profile_.ground - contrast;
  profile_.blur = std::clamp(profile_.blur + std::clamp(delta[7], -0.5, 0.5), kPixelBlur, kMaxBlur);
  return is_ellipse(shape_);
}

// Steps until the ellipse has all but come to rest, with the model evaluated there.
bool EdgeFitter::iterate(const vpImage<unsigned char>& image, const imaging::Window& bounds) {
  constexpr double kRest = 0.1;  // px: what is left then is a few hundredths of it
  for (int iteration = 0; iteration < parameters_.max_iterations; ++iteration) {
    if (!advance(image, bounds)) return false;
    if (change_ < kRest && level_change_ < kLevelRest) return true;
  }
  // What the model leaves of the grey values, as under a slope of light, makes full steps overshoot
  // a sharp edge and swing about it without end; half steps settle.
  constexpr double kSwing = 0.2;           // px
  constexpr double kSharp = 0.3;           // px of blur
  constexpr double kSettledRest = 0.02;    // px
  constexpr int kEnough = 16 * kUnknowns;  // pixels; few may swing for want of an outline
  if (change_ > kSwing || profile_.blur > kSharp || count_ < kEnough) return false;
  damping_ = 0.5;
  for (int iteration = 0; iteration < parameters_.max_iterations; ++iteration) {
    if (!advance(image, bounds)) return false;
    if (change_ < kSettledRest && level_change_ < kLevelRest) return true;
  }
  return false;
}

// One step, and how far it went.
bool EdgeFitter::advance(const vpImage<unsigned char>& image, const imaging::Window& bounds) {
  const EllipseShape before = shape_;
  const EdgeProfile before_profile = profile_;
  accumulate();
  if (!step()) return false;
  const double axis = ellipse_of(shape_).b;
  const auto distance = [&](const EllipseShape& from) {
    return (shape_.centre - from.centre).norm() + 0.5 * (shape_.sigma - from.sigma).norm() / axis;
  };
  if (distance(band_shape_) > 0.4 * profile_.blur || profile_.blur > 1.25 * band_blur_)
    collect(image, bounds);
  if (count_ < 4 * kUnknowns) return false;
  evaluate();
  const double levels = std::abs(profile_.ground - before_profile.ground) +
                        std::abs(profile_.disc - before_profile.disc);
  change_ = std::max(distance(before), std::abs(profile_.blur - before_profile.blur));
  level_change_ = levels / std::abs(profile_.ground - profile_.disc);
  return true;
}

// Leaves out the pixels of the sectors that disagree with the model as evaluated last; the share of
// the outline that stays.
double EdgeFitter::drop_bad_sectors(double& raggedness) {
  const auto n = static_cast<Eigen::Index>(count_);
  const double l11 = std::sqrt(shape_.sigma(0, 0));
  const double l21 = shape_.sigma(0, 1) / l11;
  const double l22 = std::sqrt(shape_.sigma(1, 1) - l21 * l21);
  auto x = work_.col(0).head(n);
  auto y = work_.col(1).head(n);
  auto turn = work_.col(2).head(n);
  x = (u_.head(n) - static_cast<float>(shape_.centre.x() - band_shape_.centre.x())) *
      static_cast<float>(1.0 / l11);
  y = (v_.head(n) - static_cast<float>(shape_.centre.y() - band_shape_.centre.y()) -
       static_cast<float>(l21) * x) *
      static_cast<float>(1.0 / l22);
  // A substitute for the angle that needs no arc tangent: 0..4 once round.
  constexpr float kPerTurn = kSectors / 4.0F;
  turn = kPerTurn * y / (x.abs() + y.abs() + 1e-9F);
  // ∂g/∂d, whose product with the residual tells how far a sector lies outside.
  auto edge = work_.col(3).head(n);
  edge = jacobian_.col(0).head(n).square() + jacobian_.col(1).head(n).square();
  auto pull = work_.col(4).head(n);
  pull = edge.sqrt() * residual_.head(n);

  struct Sector {
    double square = 0.0;
    double edge = 0.0;
    double pull = 0.0;
    int pixels = 0;
  };
  std::array<Sector, kSectors> sectors{};
  for (Eigen::Index i = 0; i < n; ++i) {
    const float angle = x[i] >= 0.0F ? kPerTurn + turn[i] : 3.0F * kPerTurn - turn[i];
    const auto index =
        static_cast<std::size_t>(std::clamp(static_cast<int>(angle), 0, kSectors - 1));
    sector_[static_cast<std::size_t>(i)] = static_cast<unsigned char>(index);
    Sector& sector = sectors[index];
    sector.square += static_cast<double>(residual_[i] * residual_[i]);
    sector.edge += static_cast<double>(edge[i]);
    sector.pull += static_cast<double>(pull[i]);
    ++sector.pixels;
  }
  std::array<double, kSectors> sorted{};
  for (std::size_t k = 0; k < kSectors; ++k) {
    sectors[k].square /= std::max(1, sectors[k].pixels);
    sorted[k] = sectors[k].square;
  }
  std::nth_element(sorted.begin(), sorted.begin() + kSectors / 2, sorted.end());
  const double variance = std::max(sorted[kSectors / 2], kQuantisationVariance);
  const double contrast = profile_.ground - profile_.disc;
  const double square_limit = std::max(std::pow(parameters_.sector_noise_ratio, 2) * variance,
                                       std::pow(parameters_.sector_contrast_ratio * contrast, 2));
  const double offset_limit = std::max(parameters_.sector_offset_px,
                                       parameters_.sector_offset_ratio * ellipse_of(shape_).b);
  std::array<bool, kSectors> bad{};
  int good = 0;
  double unrest = 0.0;
  raggedness = 0.0;
  for (std::size_t k = 0; k < kSectors; ++k) {
    const Sector& sector = sectors[k];
    const double offset = sector.edge > 0.0 ? sector.pull / sector.edge : 0.0;
    bad[k] =
        sector.pixels == 0 || sector.square > square_limit ||
        (std::abs(offset) > offset_limit &&
         std::abs(offset) > parameters_.sector_offset_sigmas * std::sqrt(variance / sector.edge));
    if (bad[k]) continue;
    ++good;
    unrest += offset * offset * sector.edge / variance;
    raggedness += offset * offset - variance / sector.edge;
  }
  raggedness = std::sqrt(std::max(0.0, raggedness) / std::max(1, good));
  bad_arcs_ = 0;
  for (std::size_t k = 0; k < kSectors; ++k)
    bad_arcs_ += bad[k] && !bad[(k + 1) % kSectors] ? 1 : 0;
  unrest_ = unrest / std::max(1, good - 5);
  if (good == kSectors) return 1.0;
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    if (bad[sector_[static_cast<std::size_t>(i)]]) continue;
    u_[kept] = u_[i];
    v_[kept] = v_[i];
    grey_[kept] = grey_[i];
    ++kept;
  }
  count_ = kept;
  return static_cast<double>(good) / kSectors;
}

EdgeFit EdgeFitter::fit(const vpImage<unsigned char>& image, const imaging::Window& bounds,
                        const EllipseShape& start, const EdgeProfile& profile) {
  EdgeFit result;
  if (!is_ellipse(start)) return result;
  shape_ = start;
  profile_ = profile;
  profile_.blur = std::clamp(profile.blur, kPixelBlur, kMaxBlur);
  damping_ = 1.0;
  collect(image, bounds);
  if (count_ < 4 * kUnknowns) return result;
  evaluate();
  if (!iterate(image, bounds)) return result;

  // Without the sectors that disagree the ellipse moves, and then others may disagree.
  constexpr int kPasses = 2;
  for (int pass = 0; pass < kPasses; ++pass) {
    if (pass > 0) {
      collect(image, bounds);
      evaluate();
    }
    result.agreement = drop_bad_sectors(result.raggedness);
    if (result.agreement == 1.0) break;
    if (result.agreement < parameters_.min_agreement) return result;
    // No new band here, or the bad sectors would be back.
    for (int iteration = 0; iteration < 3; ++iteration) {
      if (count_ < 4 * kUnknowns) return result;
      evaluate();
      accumulate();
      if (!step()) return result;
    }
    evaluate();
  }
  // The last step is so small that the normal matrix of the one before serves.
  project_residual();
  const double squares = static_cast<double>(residual_.head(count_).matrix().squaredNorm()) -
                         gradient_.dot(normal_.ldlt().solve(gradient_));
  if (!step()) return result;
  const double variance = std::max(squares / (count_ - kUnknowns), kQuantisationVariance);
  // Texture beside the outline, or a print that isn't round, moves whole sectors: errors that the
  // residuals of single pixels do not show. Chance alone stays below the limit, 2 σ of χ²/19.
  constexpr double kChance = 1.65;
  const double inflation = unrest_ > kChance ? unrest_ : 1.0;
  const Normal covariance = inflation * variance * normal_.ldlt().solve(Normal::Identity());
  result.converged = covariance.allFinite();
  result.shape = shape_;
  result.covariance = covariance.topLeftCorner<5, 5>();
  result.covariance = 0.5 * (result.covariance + result.covariance.transpose()).eval();
  result.profile = profile_;
  result.bad_arcs = bad_arcs_;
  result.noise = std::sqrt(variance);
  result.complete = complete_;
  return result;
}

}  // namespace vigia::tracking

#include "edge_fit.hpp"

#include "normal_table.hpp"
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

bool is_ellipse(const EllipseShape& shape) {
  return shape.sigma.allFinite() && shape.centre.allFinite() && shape.sigma.determinant() > 0.0 &&
         shape.sigma(0, 0) > 0.0 && ellipse_of(shape).b >= kMinAxis;
}

std::bitset<kOutlineSectors> turned(const std::bitset<kOutlineSectors>& sectors, std::size_t by) {
  return sectors << by | sectors >> (kOutlineSectors - by);
}

// With the neighbours of what covers more than one sector: one alone is a rough edge.
std::bitset<kOutlineSectors> with_neighbours(const std::bitset<kOutlineSectors>& sectors) {
  const auto ahead = turned(sectors, 1);
  const auto behind = turned(sectors, kOutlineSectors - 1);
  const auto runs = sectors & (ahead | behind);
  return sectors | turned(runs, 1) | turned(runs, kOutlineSectors - 1);
}

// Of a standard normal number beyond z: its mean λ = φ(z)/Φ(−z).
double mean_beyond(double z) {
  constexpr double kFar = 8.0;
  if (z > kFar) return z + 1.0 / z;
  const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * kPi);
  return density / (0.5 * std::erfc(z / std::sqrt(2.0)));
}

bool is_clipped(float grey) {
  return grey <= 0.0F || grey >= 255.0F;
}

}  // namespace

UnitCoordinates::UnitCoordinates(const Eigen::Matrix2d& sigma)
    : l11(std::sqrt(sigma(0, 0))),
      l21(sigma(0, 1) / l11),
      l22(std::sqrt(sigma(1, 1) - l21 * l21)) {}

std::size_t outline_sector(float x, float y) {
  // 0..4 once round.
  constexpr float kPerTurn = kOutlineSectors / 4.0F;
  const float turn = kPerTurn * y / (std::abs(x) + std::abs(y) + 1e-9F);
  const float angle = x >= 0.0F ? kPerTurn + turn : 3.0F * kPerTurn - turn;
  return static_cast<std::size_t>(
      std::clamp(static_cast<int>(angle), 0, static_cast<int>(kOutlineSectors) - 1));
}

double EdgeFitter::band_half_width() const {
  return parameters_.band_blurs * profile_.blur + 0.3;
}

void EdgeFitter::reserve(Eigen::Index capacity) {
  if (u_.size() >= capacity) return;
  u_.resize(capacity);
  v_.resize(capacity);
  grey_.resize(capacity);
  residual_.resize(capacity);
  t_.resize(capacity);
  work_.resize(capacity, 6);
  jacobian_.resize(capacity, kUnknowns);
  sector_.resize(static_cast<std::size_t>(capacity));
}

void EdgeFitter::collect(const vpImage<unsigned char>& image, const imaging::Window& bounds) {
  band_shape_ = shape_;
  band_blur_ = profile_.blur;
  const double half_width = band_half_width();
  const Ellipse ellipse = ellipse_of(shape_);
  const bool has_hole = band_has_hole(ellipse, half_width);
  const double area =
      kPi * ((ellipse.a + half_width) * (ellipse.b + half_width) -
             (has_hole ? (ellipse.a - half_width) * (ellipse.b - half_width) : 0.0));
  const int thinning = std::max(1, static_cast<int>(std::ceil(area / parameters_.max_pixels)));
  const Eigen::Index capacity = padded(static_cast<int>(1.1 * area / thinning) + 256);
  reserve(capacity);

  complete_ = true;
  count_ = 0;
  for (const BandRow& band : band_rows(shape_, half_width)) {
    const int v = band.v;
    if (v < bounds.v || v >= bounds.bottom() || band.first < bounds.u ||
        band.last >= bounds.right())
      complete_ = false;
    if (v < bounds.v || v >= bounds.bottom()) continue;
    const unsigned char* row = image[static_cast<unsigned>(v)];
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
    take(band.first, std::min(band.last, band.hole_first - 1));
    take(std::max(band.first, band.hole_last + 1), band.last);
  }
  if (covered_.any()) leave_out_covered();
  const auto greys = grey_.head(count_);
  clipped_ =
      count_ > 0 ? static_cast<double>((greys <= 0.0F || greys >= 255.0F).count()) / count_ : 0.0;
}

void EdgeFitter::leave_out_covered() {
  const UnitCoordinates unit(band_shape_.sigma);
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    const float x = u_[i] * static_cast<float>(1.0 / unit.l11);
    const float y = (v_[i] - static_cast<float>(unit.l21) * x) * static_cast<float>(1.0 / unit.l22);
    if (covered_[outline_sector(x, y)]) continue;
    u_[kept] = u_[i];
    v_[kept] = v_[i];
    grey_[kept] = grey_[i];
    ++kept;
  }
  count_ = kept;
}

// A level that the camera cuts off says only that the light was at least so strong, or so weak
// (Tobin 1958). In the place of such a pixel stands its mean given that, which pulls at the model
// with the weight λ (λ − z): all of it where the model is on the near side of the limit, nothing
// where it is well beyond.
void EdgeFitter::expect_clipped() {
  constexpr double kLeastNoise = 0.5;  // grey levels
  constexpr double kLeastWeight = 1e-4;
  double squares = 0.0;
  int whole = 0;
  for (int i = 0; i < count_; ++i) {
    if (is_clipped(grey_[i])) continue;
    squares += static_cast<double>(residual_[i] * residual_[i]);
    ++whole;
  }
  const double noise = std::max(kLeastNoise, std::sqrt(squares / std::max(1, whole)));
  weight_ = whole;
  for (int i = 0; i < count_; ++i) {
    if (!is_clipped(grey_[i])) continue;
    const double sign = grey_[i] <= 0.0F ? -1.0 : 1.0;
    // Rounding takes half a level more for the limit.
    const double z = (sign * static_cast<double>(residual_[i]) - 0.5) / noise;
    const double beyond = mean_beyond(z);
    const double weight = beyond * (beyond - z);
    weight_ += weight;
    const double root = weight > kLeastWeight ? std::sqrt(weight) : 0.0;
    residual_[i] = root > 0.0 ? static_cast<float>(sign * noise * beyond / root) : 0.0F;
    jacobian_.row(i) *= static_cast<float>(root);
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
  if (beside_.light) take_out_light();
  differentiate_edge(places, density, contrast, outline.blur, n, columns());
  jacobian_.col(kGround).head(n).setOnes();
  weight_ = n;
  if (parameters_.robust && clipped_ > 0.0) expect_clipped();
  const int padding = padded(n) - n;
  jacobian_.middleRows(n, padding).setZero();
  residual_.segment(n, padding).setZero();
}

// The planes of ground and disc less their levels at the centre, in the disc's share.
void EdgeFitter::take_out_light() {
  const LightSlope& light = *beside_.light;
  const Eigen::Vector2f shift = (band_shape_.centre - light.centre).cast<float>();
  const Eigen::Vector2f ground = light.ground.cast<float>();
  const Eigen::Vector2f difference = (light.disc - light.ground).cast<float>();
  const float* share = jacobian_.col(kContrast).data();  // less the disc's share
  for (int i = 0; i < count_; ++i) {
    const float u = u_[i] + shift.x();
    const float v = v_[i] + shift.y();
    residual_[i] -=
        ground.x() * u + ground.y() * v - share[i] * (difference.x() * u + difference.y() * v);
  }
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
  if (parameters_.blur_prior_px > 0.0) expect_blur();
}

// What is known of the blur beforehand, as one more observation.
void EdgeFitter::expect_blur() {
  const double weight = std::pow(parameters_.noise / parameters_.blur_prior_px, 2);
  normal_(kBlur, kBlur) += weight;
  gradient_[kBlur] += weight * (start_blur_ - profile_.blur);
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
  // What stands for clipped pixels changes with the model: steps are small without being at the
  // end.
  constexpr double kClippedRest = 0.01;
  const bool clipped = parameters_.robust && clipped_ > 0.0;
  const int most = clipped ? 3 * parameters_.max_iterations : parameters_.max_iterations;
  for (int iteration = 0; iteration < most; ++iteration) {
    if (!advance(image, bounds)) return false;
    if (change_ < (clipped ? kClippedRest : kRest) && level_change_ < kLevelRest) return true;
  }
  if (clipped && change_ < kRest && level_change_ < kLevelRest) return true;
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

// Assigns the pixels to the outline's sectors, for the model as evaluated last.
EdgeFitter::Sectors EdgeFitter::sum_sectors() {
  const auto n = static_cast<Eigen::Index>(count_);
  const UnitCoordinates unit(shape_.sigma);
  auto x = work_.col(0).head(n);
  auto y = work_.col(1).head(n);
  x = (u_.head(n) - static_cast<float>(shape_.centre.x() - band_shape_.centre.x())) *
      static_cast<float>(1.0 / unit.l11);
  y = (v_.head(n) - static_cast<float>(shape_.centre.y() - band_shape_.centre.y()) -
       static_cast<float>(unit.l21) * x) *
      static_cast<float>(1.0 / unit.l22);
  // ∂g/∂d, whose product with the residual tells how far a sector lies outside.
  auto edge = work_.col(3).head(n);
  edge = jacobian_.col(0).head(n).square() + jacobian_.col(1).head(n).square();
  auto pull = work_.col(4).head(n);
  pull = edge.sqrt() * residual_.head(n);

  Sectors sectors{};
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t index = outline_sector(x[i], y[i]);
    sector_[static_cast<std::size_t>(i)] = static_cast<unsigned char>(index);
    Sector& sector = sectors[index];
    sector.square += static_cast<double>(residual_[i] * residual_[i]);
    sector.edge += static_cast<double>(edge[i]);
    sector.pull += static_cast<double>(pull[i]);
    ++sector.pixels;
  }
  for (Sector& sector : sectors) sector.square /= std::max(1, sector.pixels);
  return sectors;
}

EdgeFitter::Agreement EdgeFitter::judge_sectors(const Sectors& sectors) const {
  std::array<double, kOutlineSectors> sorted{};
  for (std::size_t k = 0; k < kOutlineSectors; ++k) sorted[k] = sectors[k].square;
  std::nth_element(sorted.begin(), sorted.begin() + kOutlineSectors / 2, sorted.end());
  const double variance = std::max(sorted[kOutlineSectors / 2], kQuantisationVariance);
  const double contrast = profile_.ground - profile_.disc;
  const double square_limit = std::max(std::pow(parameters_.sector_noise_ratio, 2) * variance,
                                       std::pow(parameters_.sector_contrast_ratio * contrast, 2));
  const double offset_limit = std::max(parameters_.sector_offset_px,
                                       parameters_.sector_offset_ratio * ellipse_of(shape_).b);
  Agreement out;
  int good = 0;
  double unrest = 0.0;
  double chance = 0.0;  // variance of the raggedness' sum
  for (std::size_t k = 0; k < kOutlineSectors; ++k) {
    const Sector& sector = sectors[k];
    const double offset = sector.edge > 0.0 ? sector.pull / sector.edge : 0.0;
    out.bad[k] =
        sector.pixels == 0 || sector.square > square_limit ||
        (std::abs(offset) > offset_limit &&
         std::abs(offset) > parameters_.sector_offset_sigmas * std::sqrt(variance / sector.edge));
    if (out.bad[k]) continue;
    ++good;
    unrest += offset * offset * sector.edge / variance;
    out.raggedness += offset * offset - variance / sector.edge;
    chance += 2.0 * std::pow(variance / sector.edge, 2);
  }
  out.raggedness = std::sqrt(std::max(0.0, out.raggedness) / std::max(1, good));
  // Chance is the picture's noise, not what a poor model leaves.
  const double explained = std::min(1.0, std::pow(picture_noise(), 2) / variance);
  out.raggedness_chance = std::sqrt(3.0 * explained * std::sqrt(chance) / std::max(1, good));
  for (std::size_t k = 0; k < kOutlineSectors; ++k)
    out.bad_arcs += out.bad[k] && !out.bad[(k + 1) % kOutlineSectors] ? 1 : 0;
  out.unrest = unrest / std::max(1, good - 5);
  if (parameters_.robust) out.bad = with_neighbours(out.bad & ~covered_) | out.bad;
  return out;
}

// Of the pixels in a band, whose median is as uncertain as few pixels make it.
double EdgeFitter::picture_noise() const {
  constexpr double kSlack = 1.25;
  return kSlack * parameters_.noise;
}

// Leaves out the pixels of bad sectors.
void EdgeFitter::keep_sectors(const std::bitset<kOutlineSectors>& bad) {
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    if (bad[sector_[static_cast<std::size_t>(i)]]) continue;
    u_[kept] = u_[i];
    v_[kept] = v_[i];
    grey_[kept] = grey_[i];
    ++kept;
  }
  count_ = kept;
}

// Nothing when too little of the outline agrees.
std::optional<EdgeFitter::Agreement> EdgeFitter::refine_without_bad(
    const vpImage<unsigned char>& image, const imaging::Window& bounds) {
  // Without the sectors that disagree the ellipse moves, and then others may disagree.
  constexpr int kPasses = 2;
  Agreement agreement;
  for (int pass = 0; pass < kPasses; ++pass) {
    if (pass > 0) {
      collect(image, bounds);
      evaluate();
    }
    agreement = judge_sectors(sum_sectors());
    if (agreement.bad.none()) break;
    if (agreement.share() < parameters_.min_agreement) return std::nullopt;
    keep_sectors(agreement.bad);
    // No new band here, or the bad sectors would be back.
    for (int iteration = 0; iteration < 3; ++iteration) {
      if (count_ < 4 * kUnknowns) return std::nullopt;
      evaluate();
      accumulate();
      if (!step()) return std::nullopt;
    }
    evaluate();
  }
  return agreement;
}

void EdgeFitter::begin(const EllipseShape& start, const EdgeProfile& profile) {
  shape_ = start;
  profile_ = profile;
  profile_.blur = std::clamp(profile.blur, kPixelBlur, kMaxBlur);
  start_blur_ = profile_.blur;
  damping_ = 1.0;
  beside_ = {};
  covered_.reset();
}

void EdgeFitter::look_beside(const vpImage<unsigned char>& image, const imaging::Window& bounds) {
  constexpr double kClearance = 0.7;  // px from the band
  beside_ = measure_surroundings(image, bounds, shape_, band_half_width() + kClearance,
                                 {profile_.disc, profile_.ground});
}

// Steps until the ellipse rests, with the slope of light where there is one. Where a strong slope
// keeps it restless, the slope beside the start brings it near.
bool EdgeFitter::settle(const vpImage<unsigned char>& image, const imaging::Window& bounds) {
  const EllipseShape start = shape_;
  const EdgeProfile profile = profile_;
  const auto rests = [&] {
    damping_ = 1.0;
    collect(image, bounds);
    if (count_ < 4 * kUnknowns) return false;
    evaluate();
    return iterate(image, bounds);
  };
  if (!rests()) {
    constexpr double kLargeEnough = 8.0;  // px: what is smaller and restless is a blot
    if (!parameters_.robust || ellipse_of(start).b < kLargeEnough) return false;
    shape_ = start;
    profile_ = profile;
    look_beside(image, bounds);
    if (!beside_.light || !rests()) return false;
  }
  if (!parameters_.robust) return true;
  look_beside(image, bounds);
  return !beside_.light || rests();
}

// What is unsure of the slopes of light moves the ellipse: with J_s the model's derivatives by the
// slopes and S their covariance, by K S Kᵀ, K = (JᵀJ)⁻¹ Jᵀ J_s.
Eigen::Matrix<double, 5, 5> EdgeFitter::light_covariance(const Normal& inverse) const {
  if (!beside_.light) return Eigen::Matrix<double, 5, 5>::Zero();
  Eigen::Matrix<double, kUnknowns, 4> product = Eigen::Matrix<double, kUnknowns, 4>::Zero();
  const LightSlope& light = *beside_.light;
  const Eigen::Vector2f shift = (band_shape_.centre - light.centre).cast<float>();
  for (int i = 0; i < count_; ++i) {
    const float u = u_[i] + shift.x();
    const float v = v_[i] + shift.y();
    const float disc = -jacobian_(i, kContrast);
    const Eigen::Vector4f slopes(u * (1.0F - disc), v * (1.0F - disc), u * disc, v * disc);
    product += (jacobian_.row(i).matrix().transpose() * slopes.transpose()).cast<double>();
  }
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  covariance.topLeftCorner<2, 2>() = light.ground_covariance;
  covariance.bottomRightCorner<2, 2>() = light.disc_covariance;
  const Eigen::Matrix<double, 5, 4> gain = inverse.topRows<5>() * product;
  return gain * covariance * gain.transpose();
}

EdgeFit EdgeFitter::conclude(const Agreement& agreement) {
  EdgeFit result;
  result.agreement = agreement.share();
  result.raggedness = agreement.raggedness;
  // The last step is so small that the normal matrix of the one before serves.
  project_residual();
  const double squares = static_cast<double>(residual_.head(count_).matrix().squaredNorm()) -
                         gradient_.dot(normal_.ldlt().solve(gradient_));
  if (!step()) return result;
  const double variance = std::max(squares / (weight_ - kUnknowns), kQuantisationVariance);
  // Texture beside the outline, or a print that isn't round, moves whole sectors: errors that the
  // residuals of single pixels do not show. Chance alone stays below the limit, 2 σ of χ²/19.
  constexpr double kChance = 1.65;
  const double inflation = agreement.unrest > kChance ? agreement.unrest : 1.0;
  const Normal inverse = normal_.ldlt().solve(Normal::Identity());
  const Normal covariance = inflation * variance * inverse;
  result.converged = covariance.allFinite();
  result.shape = shape_;
  result.covariance = covariance.topLeftCorner<5, 5>();
  if (beside_.light) result.covariance += light_covariance(inverse);
  result.covariance = 0.5 * (result.covariance + result.covariance.transpose()).eval();
  result.profile = profile_;
  result.bad_arcs = agreement.bad_arcs;
  result.bad_sectors = agreement.bad;
  result.noise = std::sqrt(variance);
  result.picture_noise = picture_noise();
  result.complete = complete_;
  result.clipped = clipped_;
  result.raggedness_chance = agreement.raggedness_chance;
  result.ground_share = beside_.ground_share;
  result.light = beside_.light;
  return result;
}

EdgeFit EdgeFitter::finish(const vpImage<unsigned char>& image, const imaging::Window& bounds) {
  if (!settle(image, bounds)) return {};
  const auto agreement = refine_without_bad(image, bounds);
  if (!agreement) return {};
  return conclude(*agreement);
}

EdgeFit EdgeFitter::fit(const vpImage<unsigned char>& image, const imaging::Window& bounds,
                        const EllipseShape& start, const EdgeProfile& profile) {
  if (!is_ellipse(start)) return {};
  begin(start, profile);
  return finish(image, bounds);
}

EdgeFit EdgeFitter::fit_covered(const vpImage<unsigned char>& image, const imaging::Window& bounds,
                                const EllipseShape& start, const EdgeProfile& profile) {
  if (!is_ellipse(start)) return {};
  begin(start, profile);
  collect(image, bounds);
  if (count_ < 4 * kUnknowns) return {};
  evaluate();
  const Agreement first = judge_sectors(sum_sectors());
  if (first.share() < parameters_.min_agreement) return {};
  covered_ = first.bad;
  return finish(image, bounds);
}

}  // namespace vigia::tracking

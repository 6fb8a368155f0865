#include "tag_fit.hpp"

#include "pixel.hpp"
#include "plane_map.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

// Unknowns: 0–7 the homography's entries, row by row; then
constexpr int kDark = 8;
constexpr int kContrast = 9;
constexpr int kSlopeU = 10;
constexpr int kSlopeV = 11;
constexpr int kBlur = 12;
constexpr int kTone = 13;
constexpr int kToneShape = 14;
constexpr int kTagUnknowns = 15;
using TagNormal = Eigen::Matrix<double, kTagUnknowns, kTagUnknowns>;
using TagVector = Eigen::Matrix<double, kTagUnknowns, 1>;

constexpr double kMaxTagBlur = 6.0;  // px
constexpr double kEdgeReach = 2.5;   // blurs from an edge that are fitted; flat parts are thinned
constexpr int kFlatThinning = 4;
constexpr double kTail = 3.5;            // blurs beyond which a field has no light in a pixel
constexpr double kSureBlurs = 2.0;       // blurs that stay free at the rim of what is printed
constexpr double kToneSigma = 0.5;       // prior of κ
constexpr double kToneShapeSigma = 0.3;  // prior of λ
constexpr double kTagRest = 0.03;        // px: what is left then is a few hundredths of it
constexpr double kMaxCornerStep = 1.5;   // px

/// Φ and φ at equal steps.
class GaussTable {
 public:
  struct Value {
    double integral;
    double density;
  };
  GaussTable() {
    for (int i = 0; i < kSize; ++i) {
      const double t = static_cast<double>(i) / kPerUnit - kLimit;
      values_[static_cast<std::size_t>(i)] = {0.5 * std::erfc(-t / std::sqrt(2.0)),
                                              std::exp(-0.5 * t * t) / std::sqrt(2.0 * kPi)};
    }
  }
  Value at(double t) const {
    if (t <= -kLimit) return {0.0, 0.0};
    if (t >= kLimit) return {1.0, 0.0};
    const double place = (t + kLimit) * kPerUnit;
    const auto index = static_cast<std::size_t>(place);
    const double rest = place - static_cast<double>(index);
    const Value& low = values_[index];
    const Value& high = values_[index + 1];
    return {low.integral + rest * (high.integral - low.integral),
            low.density + rest * (high.density - low.density)};
  }

 private:
  static constexpr double kLimit = 5.0;
  static constexpr int kPerUnit = 128;
  static constexpr int kSize = 2 * 5 * kPerUnit + 2;
  std::array<Value, kSize> values_{};
};

const GaussTable& gauss_table() {
  static const GaussTable table;
  return table;
}

struct TagPixel {
  double u, v;  ///< from the tag's middle, px
  double grey;
  int field;              ///< of the grid, where the pixel lay when it was collected
  double residual = 0.0;  ///< of the model as evaluated last
};

/// What is estimated, with the homography from the grid (fields from its upper left corner) to px
/// from the tag's middle, its last entry 1.
struct TagState {
  Eigen::Matrix3d iHg = Eigen::Matrix3d::Identity();
  double dark = 0.0;
  double contrast = 0.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< a px
  double blur = kStartBlur;
  /// The camera's response to a share T of white: T + (κ + λ(1 − 2T)) T(1 − T).
  double tone = 0.0;        ///< κ
  double tone_shape = 0.0;  ///< λ
};

/// Where a pixel lies in the grid, and how the grid is stretched there.
struct GridPlace {
  Eigen::Vector2d g;
  Eigen::Matrix2d dg_dx;
};

GridPlace place_in_grid(const Eigen::Matrix3d& gHi, double u, double v) {
  const Eigen::Vector3d p = gHi.col(0) * u + gHi.col(1) * v + gHi.col(2);
  const double w = 1.0 / p.z();
  GridPlace place;
  place.g = w * p.head<2>();
  place.dg_dx = w * (gHi.topLeftCorner<2, 2>() - place.g * gHi.block<1, 2>(2, 0));
  return place;
}

/// The shares of the fields along one axis in a blurred pixel, with their derivatives by the place
/// and by the blur.
struct FieldShares {
  int first = 0;
  int count = 0;
  static constexpr int kMost = 24;
  std::array<double, kMost> share, by_place, by_blur;
};

void share_fields(double place, double sigma, int fields, FieldShares& out) {
  const GaussTable& table = gauss_table();
  const double inverse = 1.0 / sigma;
  out.first = std::clamp(static_cast<int>(std::floor(place - kTail * sigma)), 0, fields - 1);
  const int last = std::clamp(static_cast<int>(std::floor(place + kTail * sigma)), 0, fields - 1);
  out.count = std::min(last - out.first + 1, FieldShares::kMost);
  // The outermost fields go on for ever.
  GaussTable::Value low{0.0, 0.0};
  double low_t = 0.0;
  for (int k = 0; k < out.count; ++k) {
    GaussTable::Value high{1.0, 0.0};
    double high_t = 0.0;
    if (k + 1 < out.count) {
      high_t = (out.first + k + 1 - place) * inverse;
      high = table.at(high_t);
    }
    const auto i = static_cast<std::size_t>(k);
    out.share[i] = high.integral - low.integral;
    out.by_place[i] = (low.density - high.density) * inverse;
    out.by_blur[i] = (low_t * low.density - high_t * high.density) * inverse;
    low = high;
    low_t = high_t;
  }
}

/// The blurred print at a pixel.
struct PrintValue {
  double white = 0.0;
  Eigen::RowVector2d by_uv = Eigen::RowVector2d::Zero();
  double by_blur = 0.0;
  GridPlace place;
};

class PrintModel {
 public:
  PrintModel(const TagGrid& grid, const TagState& state)
      : grid_(grid), gHi_(state.iHg.inverse()), blur_(state.blur) {}

  PrintValue at(double u, double v) {
    PrintValue value;
    value.place = place_in_grid(gHi_, u, v);
    const double stretch_x = value.place.dg_dx.row(0).norm();
    const double stretch_y = value.place.dg_dx.row(1).norm();
    share_fields(value.place.g.x(), blur_ * stretch_x, grid_.fields, across_);
    share_fields(value.place.g.y(), blur_ * stretch_y, grid_.fields, down_);
    double by_x = 0.0;
    double by_y = 0.0;
    double by_sigma_x = 0.0;
    double by_sigma_y = 0.0;
    // The blur is round in the image, not in the grid, which is drawn out askew: x and y share a
    // covariance, whose part is a series in it (Mehler 1866, two terms).
    const double first = blur_ * blur_ * value.place.dg_dx.row(0).dot(value.place.dg_dx.row(1));
    const double second = 0.5 * first * first / (blur_ * blur_ * stretch_x * stretch_y);
    for (int j = 0; j < down_.count; ++j) {
      double share = 0.0;
      double by_place = 0.0;
      double by_blur = 0.0;
      for (int i = 0; i < across_.count; ++i) {
        if (!grid_.is_white(across_.first + i, down_.first + j)) continue;
        const auto k = static_cast<std::size_t>(i);
        share += across_.share[k];
        by_place += across_.by_place[k];
        by_blur += across_.by_blur[k];
      }
      const auto k = static_cast<std::size_t>(j);
      value.white += share * down_.share[k] + first * by_place * down_.by_place[k] +
                     second * by_blur * down_.by_blur[k];
      by_x += by_place * down_.share[k];
      by_sigma_x += by_blur * down_.share[k];
      by_y += share * down_.by_place[k];
      by_sigma_y += share * down_.by_blur[k];
    }
    value.by_uv = Eigen::RowVector2d(by_x, by_y) * value.place.dg_dx;
    value.by_blur = by_sigma_x * stretch_x + by_sigma_y * stretch_y;
    return value;
  }

 private:
  const TagGrid& grid_;
  Eigen::Matrix3d gHi_;
  double blur_;
  FieldShares across_;
  FieldShares down_;
};

struct TagSums {
  TagNormal normal = TagNormal::Zero();
  TagVector gradient = TagVector::Zero();
  double squares = 0.0;
};

/// The model's derivatives at one pixel, whose residual is set.
TagVector linearise(const TagState& state, const PrintValue& print, TagPixel& pixel) {
  const double T = print.white;
  const double bend = T * (1.0 - T);
  const double tone = T + (state.tone + state.tone_shape * (1.0 - 2.0 * T)) * bend;
  const double light = 1.0 + state.slope.x() * pixel.u + state.slope.y() * pixel.v;
  const double base = state.dark + state.contrast * tone;
  pixel.residual = pixel.grey - base * light;
  const double by_print =
      state.contrast * light *
      (1.0 + state.tone * (1.0 - 2.0 * T) + state.tone_shape * (1.0 - 6.0 * bend));
  // x = N(g)/w(g): moving the print by ∂x/∂h changes a fixed pixel by −∇T·∂x/∂h.
  const Eigen::Vector2d& g = print.place.g;
  const double w = 1.0 / (state.iHg(2, 0) * g.x() + state.iHg(2, 1) * g.y() + state.iHg(2, 2));
  const Eigen::RowVector2d pull = -by_print * w * print.by_uv;
  const double along = -(pull.x() * pixel.u + pull.y() * pixel.v);
  TagVector row;
  row << pull.x() * g.x(), pull.x() * g.y(), pull.x(), pull.y() * g.x(), pull.y() * g.y(), pull.y(),
      along * g.x(), along * g.y(), light, light * tone, base * pixel.u, base * pixel.v,
      by_print * print.by_blur, state.contrast * light * bend,
      state.contrast * light * bend * (1.0 - 2.0 * T);
  return row;
}

TagSums accumulate_tag(const TagGrid& grid, const TagState& state, std::vector<TagPixel>& pixels) {
  PrintModel model(grid, state);
  TagSums sums;
  for (TagPixel& pixel : pixels) {
    const TagVector row = linearise(state, model.at(pixel.u, pixel.v), pixel);
    for (int i = 0; i < kTagUnknowns; ++i)
      sums.normal.col(i).head(i + 1).noalias() += row[i] * row.head(i + 1);
    sums.gradient += row * pixel.residual;
    sums.squares += pixel.residual * pixel.residual;
  }
  sums.normal = TagNormal(sums.normal.selfadjointView<Eigen::Upper>());
  return sums;
}

/// Corners of the border in the grid, in the order of the labels.
TagCorners grid_corners(const TagGrid& grid) {
  const double low = 0.5 * (grid.fields - grid.border);
  const double high = grid.fields - low;
  return {Eigen::Vector2d(low, high), Eigen::Vector2d(high, high), Eigen::Vector2d(high, low),
          Eigen::Vector2d(low, low)};
}

Eigen::Vector2d map_point(const Eigen::Matrix3d& H, const Eigen::Vector2d& p) {
  const Eigen::Vector3d q = H * Eigen::Vector3d(p.x(), p.y(), 1.0);
  return q.head<2>() / q.z();
}

/// ∂(corner)/∂h.
Eigen::Matrix<double, 2, 8> corner_jacobian(const Eigen::Matrix3d& H, const Eigen::Vector2d& p) {
  const Eigen::Vector2d x = map_point(H, p);
  const double w = 1.0 / (H(2, 0) * p.x() + H(2, 1) * p.y() + H(2, 2));
  Eigen::Matrix<double, 2, 8> J;
  J << p.x(), p.y(), 1.0, 0.0, 0.0, 0.0, -x.x() * p.x(), -x.x() * p.y(),  //
      0.0, 0.0, 0.0, p.x(), p.y(), 1.0, -x.y() * p.x(), -x.y() * p.y();
  return w * J;
}

/// The tag's fit in progress.
class TagFitting {
 public:
  TagFitting(const vpImage<unsigned char>& image, const TagGrid& grid, const TagCorners& corners,
             const TagFitParams& params)
      : image_(image), grid_(grid), params_(params), at_(grid_corners(grid)) {
    state_.blur = params.start_blur;
    for (const Eigen::Vector2d& corner : corners) middle_ += 0.25 * corner;
    std::vector<PlanePoint> points;
    for (std::size_t k = 0; k < 4; ++k) points.push_back({at_[k], corners[k] - middle_});
    const auto map = fit_plane_map(points);
    started_ = map.has_value();
    if (started_) state_.iHg = map->iHl / map->iHl(2, 2);
  }

  TagFit run() {
    TagFit result;
    if (!started_ || !start_levels() || !settle()) return result;
    find_bad_fields();
    result.bad_fields = static_cast<int>(bad_.size());
    const bool border_covered =
        std::any_of(bad_.begin(), bad_.end(), [&](int f) { return !is_inner(f); });
    if (border_covered || result.bad_fields > params_.max_bad_fields) {
      result.status = TagFitStatus::covered;
      return result;
    }
    if (!bad_.empty()) {
      leave_out_bad_fields();
      if (!rest()) return result;
    }
    describe(result);
    return result;
  }

 private:
  bool is_inner(int field) const {
    const int edge = (grid_.fields - grid_.border) / 2;
    const int column = field % grid_.fields;
    const int row = field / grid_.fields;
    return std::min(column, row) > edge && std::max(column, row) < grid_.fields - 1 - edge;
  }

  // Means over the middles of the border's and the print's fields.
  bool start_levels() {
    double sum[2] = {0.0, 0.0};
    int count[2] = {0, 0};
    for (int row = 0; row < grid_.fields; ++row)
      for (int column = 0; column < grid_.fields; ++column) {
        const Eigen::Vector2d uv = map_point(state_.iHg, {column + 0.5, row + 0.5}) + middle_;
        const long u = std::lround(uv.x());
        const long v = std::lround(uv.y());
        if (u < 0 || v < 0 || u >= static_cast<long>(image_.getWidth()) ||
            v >= static_cast<long>(image_.getHeight()))
          continue;
        const int white = grid_.is_white(column, row) ? 1 : 0;
        sum[white] += image_[static_cast<unsigned>(v)][u];
        ++count[white];
      }
    if (count[0] == 0 || count[1] == 0) return false;
    state_.dark = sum[0] / count[0];
    state_.contrast = sum[1] / count[1] - state_.dark;
    return state_.contrast > params_.min_contrast;
  }

  /// Whether an edge of the print is near, in fields.
  bool near_edge(const Eigen::Vector2d& g, const Eigen::Vector2d& reach) const {
    const auto field = [&](double x) {
      return std::clamp(static_cast<int>(std::floor(x)), 0, grid_.fields - 1);
    };
    const int left = field(g.x() - reach.x());
    const int right = field(g.x() + reach.x());
    const int top = field(g.y() - reach.y());
    const int bottom = field(g.y() + reach.y());
    const bool white = grid_.is_white(left, top);
    for (int row = top; row <= bottom; ++row)
      for (int column = left; column <= right; ++column)
        if (grid_.is_white(column, row) != white) return true;
    return false;
  }

  // The pixels of what is surely printed, fewer where it is flat; about @p most of them.
  void collect_pixels(int most) {
    pixels_.clear();
    const Eigen::Matrix3d gHi = state_.iHg.inverse();
    const double half = 0.5 * grid_.fields;
    Eigen::Vector2d low(1e9, 1e9);
    Eigen::Vector2d high(-1e9, -1e9);
    for (const double x : {half - grid_.sure, half + grid_.sure})
      for (const double y : {half - grid_.sure, half + grid_.sure}) {
        const Eigen::Vector2d uv = map_point(state_.iHg, {x, y}) + middle_;
        low = low.cwiseMin(uv);
        high = high.cwiseMax(uv);
      }
    const int u0 = std::max(0, static_cast<int>(std::ceil(low.x())));
    const int v0 = std::max(0, static_cast<int>(std::ceil(low.y())));
    const int u1 =
        std::min(static_cast<int>(image_.getWidth()) - 1, static_cast<int>(std::floor(high.x())));
    const int v1 =
        std::min(static_cast<int>(image_.getHeight()) - 1, static_cast<int>(std::floor(high.y())));
    const double area = std::max(1.0, 0.7 * (u1 - u0 + 1.0) * (v1 - v0 + 1.0));
    const int thinning = std::max(1, static_cast<int>(std::ceil(area / most)));
    for (int v = v0; v <= v1; ++v)
      for (int u = u0; u <= u1; ++u) {
        // Fixed patterns over the image that pick no direction.
        const int phase = u + 2 * v + (v / 2) * 3;
        if (phase % thinning != 0) continue;
        const GridPlace place = place_in_grid(gHi, u - middle_.x(), v - middle_.y());
        const Eigen::Vector2d sigma =
            state_.blur * Eigen::Vector2d(place.dg_dx.row(0).norm(), place.dg_dx.row(1).norm());
        const Eigen::Vector2d off = (place.g.array() - half).abs();
        if (((off + kSureBlurs * sigma).array() > grid_.sure).any()) continue;
        if (phase % (kFlatThinning * thinning) != 0 && !near_edge(place.g, kEdgeReach * sigma))
          continue;
        const int column = std::clamp(static_cast<int>(place.g.x()), 0, grid_.fields - 1);
        const int row = std::clamp(static_cast<int>(place.g.y()), 0, grid_.fields - 1);
        pixels_.push_back({u - middle_.x(), v - middle_.y(),
                           static_cast<double>(image_[static_cast<unsigned>(v)][u]),
                           row * grid_.fields + column});
      }
  }

  /// One step of Gauss–Newton; by how much it moved the corners (px), nothing when it failed.
  std::optional<double> step() {
    TagSums sums = accumulate_tag(grid_, state_, pixels_);
    const double variance =
        std::max(sums.squares / std::max(1.0, static_cast<double>(pixels_.size()) - kTagUnknowns),
                 kQuantisationVariance);
    const double prior = variance / (kToneSigma * kToneSigma);
    sums.normal(kTone, kTone) += prior;
    sums.gradient[kTone] -= prior * state_.tone;
    const double shape_prior = variance / (kToneShapeSigma * kToneShapeSigma);
    sums.normal(kToneShape, kToneShape) += shape_prior;
    sums.gradient[kToneShape] -= shape_prior * state_.tone_shape;
    TagVector delta = sums.normal.ldlt().solve(sums.gradient);
    if (!delta.allFinite()) return std::nullopt;
    double movement = 0.0;
    for (const Eigen::Vector2d& p : at_)
      movement = std::max(movement, (corner_jacobian(state_.iHg, p) * delta.head<8>()).norm());
    if (movement > kMaxCornerStep) delta *= kMaxCornerStep / movement;
    for (int i = 0; i < 8; ++i) state_.iHg(i / 3, i % 3) += delta[i];
    state_.dark += delta[kDark];
    state_.contrast += delta[kContrast];
    state_.slope += delta.segment<2>(kSlopeU);
    const double blur = state_.blur;
    state_.blur = std::clamp(blur + std::clamp(delta[kBlur], -0.4, 0.6), kPixelBlur, kMaxTagBlur);
    state_.tone = std::clamp(state_.tone + delta[kTone], -0.9, 0.95);
    state_.tone_shape = std::clamp(state_.tone_shape + delta[kToneShape], -0.9, 0.9);
    normal_ = sums.normal;
    variance_ = variance;
    if (state_.contrast < params_.min_contrast || !(std::abs(state_.slope.maxCoeff()) < 0.1))
      return std::nullopt;
    return std::max(movement, 0.3 * std::abs(state_.blur - blur));
  }

  /// Steps on the same pixels until the corners rest.
  bool rest() {
    for (int k = 0; k < params_.max_iterations; ++k) {
      if (static_cast<int>(pixels_.size()) < 4 * kTagUnknowns) return false;
      const auto movement = step();
      if (!movement) return false;
      if (*movement < kTagRest) return true;
    }
    return false;
  }

  /// Steps on a few pixels, collected anew each time, until corners and blur are near; then on all.
  bool settle() {
    constexpr int kRough = 700;
    for (int k = 0; k < params_.max_iterations; ++k) {
      const double blur = state_.blur;
      collect_pixels(kRough);
      if (static_cast<int>(pixels_.size()) < 4 * kTagUnknowns) return false;
      const auto movement = step();
      if (!movement) return false;
      if (*movement < 0.2 && std::abs(state_.blur - blur) < 0.15 * blur) {
        collect_pixels(params_.max_pixels);
        return rest();
      }
    }
    return false;
  }

  struct FieldSum {
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
  };

  std::vector<FieldSum> field_sums() const {
    std::vector<FieldSum> sums(static_cast<std::size_t>(grid_.fields * grid_.fields));
    for (const TagPixel& pixel : pixels_) {
      FieldSum& field = sums[static_cast<std::size_t>(pixel.field)];
      field.sum += pixel.residual;
      field.squares += pixel.residual * pixel.residual;
      ++field.count;
    }
    return sums;
  }

  // Fields whose residuals stand out, and how restless the means of the others are.
  void find_bad_fields() {
    constexpr int kFew = 4;
    const std::vector<FieldSum> sums = field_sums();
    std::vector<double> variances;
    for (const FieldSum& field : sums)
      if (field.count >= kFew) variances.push_back(field.squares / field.count);
    bad_.clear();
    if (variances.empty()) return;
    const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
    std::nth_element(variances.begin(), middle, variances.end());
    const double noise = std::sqrt(std::max(*middle, kQuantisationVariance));
    double unrest = 0.0;
    int fields = 0;
    for (std::size_t f = 0; f < sums.size(); ++f) {
      const FieldSum& field = sums[f];
      if (field.count < kFew) continue;
      const double n = field.count;
      const double mean = field.sum / n;
      // Chance: a mean within 4.5 σ, a variance within 4.5 σ of χ².
      const double mean_limit = 4.5 * noise / std::sqrt(n) + 0.03 * state_.contrast;
      const double rms_limit =
          noise * std::sqrt(1.0 + 4.5 * std::sqrt(2.0 / n)) + 0.05 * state_.contrast;
      if (std::abs(mean) > mean_limit || std::sqrt(field.squares / n) > rms_limit) {
        bad_.push_back(static_cast<int>(f));
        continue;
      }
      unrest += mean * mean * n / (noise * noise);
      ++fields;
    }
    unrest_ = fields > 0 ? unrest / fields : 1.0;
  }

  void leave_out_bad_fields() {
    pixels_.erase(std::remove_if(pixels_.begin(), pixels_.end(),
                                 [&](const TagPixel& pixel) {
                                   return std::find(bad_.begin(), bad_.end(), pixel.field) !=
                                          bad_.end();
                                 }),
                  pixels_.end());
  }

  void describe(TagFit& result) {
    result.noise = std::sqrt(variance_);
    result.blur = state_.blur;
    result.contrast = state_.contrast;
    result.tone = state_.tone;
    if (state_.contrast < params_.min_contrast_to_noise * result.noise) return;
    // Noise that neighbouring pixels share moves the means of fields more than pixels alone tell.
    constexpr double kChance = 1.6;
    const double inflation = unrest_ > kChance ? unrest_ : 1.0;
    const TagNormal covariance =
        inflation * variance_ * normal_.ldlt().solve(TagNormal::Identity());
    if (!covariance.allFinite()) return;
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Matrix<double, 2, 8> J = corner_jacobian(state_.iHg, at_[k]);
      const Eigen::Matrix2d C = J * covariance.topLeftCorner<8, 8>() * J.transpose();
      result.corners[k] = map_point(state_.iHg, at_[k]) + middle_;
      result.covariance[k] = 0.5 * (C + C.transpose());
    }
    result.status = TagFitStatus::fitted;
  }

  const vpImage<unsigned char>& image_;
  const TagGrid& grid_;
  TagFitParams params_;
  TagCorners at_;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  bool started_ = false;
  TagState state_;
  std::vector<TagPixel> pixels_;
  TagNormal normal_ = TagNormal::Identity();
  double variance_ = 1.0;
  std::vector<int> bad_;
  double unrest_ = 1.0;
};

}  // namespace

TagFit fit_tag(const vpImage<unsigned char>& image, const TagGrid& grid, const TagCorners& corners,
               const TagFitParams& params) {
  return TagFitting(image, grid, corners, params).run();
}

}  // namespace vigia::tracking

#include "disc_template.hpp"

#include "pixel.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

constexpr double kReach = 4.5;  // blurs beyond which the model is flat

/// The blurred disc at one point and how it moves with centre and Σ.
struct ModelValue {
  double share;
  Eigen::Matrix<double, 5, 1> gradient;
};

/// The model's edge: an error function of the distance, shifted by what the blur does to a curved
/// edge. Within the outline's reach the distance is exact to third order.
class BlurredDisc {
 public:
  BlurredDisc(const EllipseShape& shape, double blur)
      : centre_(shape.centre),
        inverse_(shape.sigma.inverse()),
        determinant_(shape.sigma.determinant()),
        axis_(ellipse_of(shape).b),
        blur_(blur) {}

  ModelValue at(double u, double v) const {
    ModelValue value{0.0, Eigen::Matrix<double, 5, 1>::Zero()};
    Eigen::Vector2d p(u - centre_.x(), v - centre_.y());
    const double level = std::sqrt(p.dot(inverse_ * p));
    // (1 − level)·b is a lower bound of the distance's size inside, and level·… outside too.
    if (std::abs(1.0 - level) * axis_ > kReach * blur_) {
      value.share = level < 1.0 ? 1.0 : 0.0;
      return value;
    }
    double distance = 0.0;
    Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
    for (int step = 0; step < 2; ++step) {
      const Eigen::Vector2d gradient = inverse_ * p;
      const double length = std::max(gradient.norm(), 1e-9);
      const double root = std::sqrt(p.dot(gradient));
      normal = gradient / length;
      const double d = (1.0 - root) * root / length;
      p += d * normal;
      distance += d;
    }
    normal = (inverse_ * p).normalized();
    const double h = std::max(p.dot(normal), 0.1);
    const double curvature = h * h * h / determinant_;
    const double t = (distance - 0.5 * curvature * blur_ * blur_) / blur_;
    value.share = 0.5 * std::erfc(-t / std::sqrt(2.0));
    const double density = std::exp(-0.5 * t * t) / (std::sqrt(2.0 * kPi) * blur_);
    value.gradient << normal.x(), normal.y(), normal.x() * normal.x() / (2.0 * h),
        normal.x() * normal.y() / h, normal.y() * normal.y() / (2.0 * h);
    value.gradient *= density;
    return value;
  }

 private:
  Eigen::Vector2d centre_;
  Eigen::Matrix2d inverse_;
  double determinant_;
  double axis_;
  double blur_;
};

}  // namespace

double correlation_score(double r) {
  const double positive = std::max(r, 0.0);
  return positive * positive;
}

DiscTemplate::DiscTemplate(const EllipseShape& shape, double margin, double blur)
    : window_(window_round(shape, margin)) {
  const BlurredDisc disc(shape, blur);
  model_.reserve(static_cast<std::size_t>(window_.width) *
                 static_cast<std::size_t>(window_.height));
  double sum = 0.0;
  for (int v = window_.v; v < window_.bottom(); ++v)
    for (int u = window_.u; u < window_.right(); ++u) {
      const double share = disc.at(u, v).share;
      model_.push_back(static_cast<float>(share));
      sum += share;
    }
  const auto mean = static_cast<float>(sum / static_cast<double>(model_.size()));
  double squares = 0.0;
  for (float& value : model_) {
    value -= mean;
    squares += static_cast<double>(value * value);
  }
  norm_ = std::sqrt(squares);
}

bool DiscTemplate::fits(int du, int dv, const imaging::Window& bounds) const {
  return contains(bounds, {window_.u + du, window_.v + dv, window_.width, window_.height});
}

double DiscTemplate::correlation(const vpImage<unsigned char>& image, int du, int dv) const {
  double product = 0.0;
  std::int64_t sum = 0;
  std::int64_t squares = 0;
  const float* model = model_.data();
  for (int row = 0; row < window_.height; ++row, model += window_.width) {
    const unsigned char* grey = image[static_cast<unsigned>(window_.v + dv + row)] + window_.u + du;
    int row_sum = 0;
    int row_squares = 0;
    float row_product = 0.0F;
    for (int i = 0; i < window_.width; ++i) {
      const int value = grey[i];
      row_sum += value;
      row_squares += value * value;
      row_product += model[i] * static_cast<float>(value);
    }
    sum += row_sum;
    squares += row_squares;
    product += static_cast<double>(row_product);
  }
  // Armingol eq. 2; Σ(M − mean)(I − mean) = Σ(M − mean) I.
  const double n = static_cast<double>(model_.size());
  const double variance =
      static_cast<double>(squares) - static_cast<double>(sum) * static_cast<double>(sum) / n;
  return variance > n * kQuantisationVariance ? product / (norm_ * std::sqrt(variance)) : 0.0;
}

namespace {

constexpr int kMatchUnknowns = 7;  // centre, Σ, gain, offset
using MatchNormal = Eigen::Matrix<double, kMatchUnknowns, kMatchUnknowns>;
using MatchVector = Eigen::Matrix<double, kMatchUnknowns, 1>;

/// Sums over the template's pixels, gain and offset being linear.
struct MatchSums {
  MatchNormal normal = MatchNormal::Zero();
  MatchVector product = MatchVector::Zero();  ///< Jᵀ of the grey value
  /// Jᵀ of the slopes of light, ground and disc, without the gain.
  Eigen::Matrix<double, kMatchUnknowns, 4> slopes =
      Eigen::Matrix<double, kMatchUnknowns, 4>::Zero();
  double squares = 0.0;
  int count = 0;
};

/// What a match leaves of the grey values.
struct MatchLevels {
  Eigen::Vector2d levels;  ///< gain, offset
  double variance = 0.0;
  double correlation = 0.0;
};

class TemplateMatcher {
 public:
  TemplateMatcher(const vpImage<unsigned char>& image, const imaging::Window& bounds,
                  const TemplateMatchParameters& parameters)
      : image_(image), bounds_(bounds), parameters_(parameters) {}

  TemplateMatch match(const EllipseShape& start);

 private:
  MatchSums sum(const EllipseShape& shape) const;
  void add_pixel(int u, int v, const ModelValue& value, MatchSums& sums) const;
  static std::optional<MatchLevels> solve_levels(const MatchSums& sums);
  Eigen::Matrix<double, 5, 5> covariance(const MatchSums& sums, const MatchNormal& normal,
                                         const MatchVector& scale, double variance) const;

  const vpImage<unsigned char>& image_;
  imaging::Window bounds_;
  TemplateMatchParameters parameters_;
  imaging::Window window_;
};

void TemplateMatcher::add_pixel(int u, int v, const ModelValue& value, MatchSums& sums) const {
  double grey = image_[static_cast<unsigned>(v)][u];
  MatchVector row;
  row << value.gradient, value.share, 1.0;
  if (parameters_.light) {
    const LightSlope& light = *parameters_.light;
    const Eigen::Vector2d p = Eigen::Vector2d(u, v) - light.centre;
    grey -= (1.0 - value.share) * light.ground.dot(p) + value.share * light.disc.dot(p);
    Eigen::Matrix<double, 1, 4> slopes;
    slopes << (1.0 - value.share) * p.transpose(), value.share * p.transpose();
    sums.slopes += row * slopes;
  }
  if (value.gradient[0] == 0.0 && value.gradient[1] == 0.0) {
    sums.normal.bottomRightCorner<2, 2>() += row.tail<2>() * row.tail<2>().transpose();
    sums.product.tail<2>() += row.tail<2>() * grey;
  } else {
    sums.normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    sums.product += row * grey;
  }
  sums.squares += grey * grey;
  ++sums.count;
}

MatchSums TemplateMatcher::sum(const EllipseShape& shape) const {
  const BlurredDisc disc(shape, parameters_.blur_px);
  const UnitCoordinates unit(shape.sigma);
  const bool masked = parameters_.covered.any();
  MatchSums sums;
  for (int v = window_.v; v < window_.bottom(); ++v)
    for (int u = window_.u; u < window_.right(); ++u) {
      if (masked) {
        const double x = (u - shape.centre.x()) / unit.l11;
        const double y = (v - shape.centre.y() - unit.l21 * x) / unit.l22;
        if (parameters_.covered[outline_sector(static_cast<float>(x), static_cast<float>(y))])
          continue;
      }
      add_pixel(u, v, disc.at(u, v), sums);
    }
  sums.normal.triangularView<Eigen::StrictlyUpper>() = sums.normal.transpose();
  return sums;
}

// Nothing where image or model is flat.
std::optional<MatchLevels> TemplateMatcher::solve_levels(const MatchSums& sums) {
  MatchLevels out;
  out.levels = sums.normal.bottomRightCorner<2, 2>().ldlt().solve(sums.product.tail<2>());
  const double n = sums.count;
  const double mean = sums.product[6] / n;
  const double grey_variance = sums.squares - n * mean * mean;
  const double model_variance = sums.normal(5, 5) - sums.normal(5, 6) * sums.normal(5, 6) / n;
  const double covariance = sums.product[5] - sums.normal(5, 6) * mean;
  if (grey_variance <= n * kQuantisationVariance || model_variance <= 0.0) return std::nullopt;
  out.correlation = -covariance / std::sqrt(grey_variance * model_variance);
  const double residual_squares =
      std::max(sums.squares - out.levels.dot(sums.product.tail<2>()), 0.0);
  out.variance = std::max(residual_squares / (sums.count - kMatchUnknowns), kQuantisationVariance);
  return out;
}

// Of centre and Σ; what is unsure of a slope of light goes through the fit as well.
Eigen::Matrix<double, 5, 5> TemplateMatcher::covariance(const MatchSums& sums,
                                                        const MatchNormal& normal,
                                                        const MatchVector& scale,
                                                        double variance) const {
  const MatchNormal inverse = normal.ldlt().solve(MatchNormal::Identity());
  Eigen::Matrix<double, 5, 5> out = (variance * inverse).topLeftCorner<5, 5>();
  if (!parameters_.light) return out;
  Eigen::Matrix4d slopes = Eigen::Matrix4d::Zero();
  slopes.topLeftCorner<2, 2>() = parameters_.light->ground_covariance;
  slopes.bottomRightCorner<2, 2>() = parameters_.light->disc_covariance;
  const Eigen::Matrix<double, 5, 4> gain =
      inverse.topRows<5>() * (scale.asDiagonal() * sums.slopes);
  out += gain * slopes * gain.transpose();
  return out;
}

// Moves a shape by a step, shortened where it is out of proportion; the length of the step, px.
double move_shape(EllipseShape& shape, MatchVector delta, double damping) {
  constexpr double kLongest = 1.5;  // px
  const double axis = ellipse_of(shape).b;
  const double movement = delta.head<2>().norm() + 0.5 * delta.segment<3>(2).norm() / axis;
  if (movement > kLongest) delta *= kLongest / movement;
  delta *= damping;
  shape.centre += delta.head<2>();
  shape.sigma(0, 0) += delta[2];
  shape.sigma(0, 1) += delta[3];
  shape.sigma(1, 0) += delta[3];
  shape.sigma(1, 1) += delta[4];
  return movement;
}

TemplateMatch TemplateMatcher::match(const EllipseShape& start) {
  constexpr double kRest = 1e-3;  // px
  // After a few steps the pixels stay the same, or their coming and going would keep it restless.
  constexpr int kSettled = 4;
  // Where the model leaves much of the grey values, full steps overshoot and swing; half steps
  // settle.
  constexpr double kSwing = 0.02;  // px
  constexpr double kClose = 0.9;   // a score: less is another form
  TemplateMatch match;
  match.shape = start;
  bool resting = false;
  double movement = 0.0;
  double damping = 1.0;
  for (int iteration = 0; iteration < 2 * parameters_.max_iterations; ++iteration) {
    if (iteration == parameters_.max_iterations) {
      if (movement > kSwing || correlation_score(std::abs(match.correlation)) < kClose)
        return match;
      damping = 0.5;
    }
    if (ellipse_of(match.shape).b < 1.5) return match;
    if (iteration < kSettled)
      window_ = intersect(window_round(match.shape, parameters_.margin_px), bounds_);
    const MatchSums sums = sum(match.shape);
    if (sums.count < 4 * kMatchUnknowns) return match;
    const auto solved = solve_levels(sums);
    if (!solved) return match;
    const double gain = solved->levels[0];
    const double offset = solved->levels[1];
    match.correlation = solved->correlation;
    match.contrast = -gain;
    match.ground = offset;
    match.noise = std::sqrt(solved->variance);

    // The gain enters the Jacobian, so it was solved for first from the columns of share and one.
    // Jᵀr with r = I − gain·M − offset, J = (gain·∂M, M, 1).
    MatchVector scale;
    scale << Eigen::Matrix<double, 5, 1>::Constant(gain), 1.0, 1.0;
    MatchVector residual = sums.product - sums.normal.col(5) * gain - sums.normal.col(6) * offset;
    residual = residual.cwiseProduct(scale);
    const MatchNormal normal = scale.asDiagonal() * sums.normal * scale.asDiagonal();
    match.covariance = covariance(sums, normal, scale, solved->variance);
    if (resting) {
      match.converged = match.covariance.allFinite();
      break;
    }
    const MatchVector delta = normal.ldlt().solve(residual);
    if (!delta.allFinite()) return match;
    movement = move_shape(match.shape, delta, damping);
    if (!(match.shape.sigma.determinant() > 0.0) || match.shape.sigma(0, 0) <= 0.0) return match;
    resting = movement < kRest;
  }
  return match;
}

}  // namespace

TemplateMatch match_template(const vpImage<unsigned char>& image, const imaging::Window& bounds,
                             const EllipseShape& start, const TemplateMatchParameters& parameters) {
  return TemplateMatcher(image, bounds, parameters).match(start);
}

}  // namespace vigia::tracking

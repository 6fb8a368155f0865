#include "vigia/tracking/correlation_tracker.hpp"

#include "disc_finder.hpp"
#include "disc_template.hpp"
#include "lost_feature.hpp"
#include "noise_smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <Eigen/LU>

namespace vigia::tracking {
namespace {

using imaging::Canvas;
using imaging::Window;

// Whole-pixel shifts on a grid of @p step in order of their distance from none.
std::vector<std::pair<int, int>> outward(int reach_u, int reach_v, int step) {
  std::vector<std::pair<int, int>> shifts;
  for (int dv = -(reach_v / step) * step; dv <= reach_v; dv += step)
    for (int du = -(reach_u / step) * step; du <= reach_u; du += step) shifts.emplace_back(du, dv);
  std::sort(shifts.begin(), shifts.end(), [](const auto& a, const auto& b) {
    const auto key = [](const auto& s) {
      return std::make_tuple(s.first * s.first + s.second * s.second, s.second, s.first);
    };
    return key(a) < key(b);
  });
  return shifts;
}

EllipseShape moved(EllipseShape shape, int du, int dv, double scale) {
  shape.centre += Eigen::Vector2d(du, dv);
  shape.sigma *= scale * scale;
  return shape;
}

}  // namespace

class CorrelationTracker::State {
 public:
  explicit State(const CorrelationTrackerParameters& parameters)
      : parameters_(parameters),
        finder_(parameters.finder),
        fitter_(edge_fit_parameters(parameters.finder)) {}

  /// What is looked for and how far off it may be.
  struct Gate {
    EllipseShape shape;
    Eigen::Matrix2d centre_covariance;
    double log_size_sigma;
  };

  EllipseFeature search(Canvas& canvas, const Gate& gate, const Eigen::Vector2d& reach,
                        const std::vector<double>& scales);
  EllipseFeature refine(const vpImage<unsigned char>& image, const Window& window,
                        const EllipseShape& start, const Gate* gate, const Window& frame);
  TemplateMatch match(const vpImage<unsigned char>& image, const Window& window,
                      const EllipseShape& start, double blur, const EdgeFit* outline) const;
  EllipseFeature judge(const TemplateMatch& match, const EdgeFit& outline, const Gate* gate,
                       const Window& frame) const;
  double noise_inflation(const TemplateMatch& match, const EdgeFit& outline) const;
  void keep(const EllipseShape& shape);

  CorrelationTrackerParameters parameters_;
  DiscFinder finder_;
  EdgeFitter fitter_;
  bool tracking_ = false;
  double sign_ = 1.0;  ///< +1 for a dark disc
  EllipseShape shape_;
  Eigen::Vector2d motion_ = Eigen::Vector2d::Zero();
};

TemplateMatch CorrelationTracker::State::match(const vpImage<unsigned char>& image,
                                               const Window& window, const EllipseShape& start,
                                               double blur, const EdgeFit* outline) const {
  constexpr double kMarginBlurs = 2.5;
  TemplateMatchParameters parameters;
  parameters.margin_px = std::max(parameters_.template_margin_px, kMarginBlurs * blur);
  parameters.blur_px = blur;
  parameters.max_iterations = parameters_.max_iterations;
  if (outline != nullptr) {
    parameters.light = outline->light;
    parameters.covered = outline->bad_sectors;
  }
  return match_template(image, window, start, parameters);
}

EllipseFeature CorrelationTracker::State::refine(const vpImage<unsigned char>& image,
                                                 const Window& window, const EllipseShape& start,
                                                 const Gate* gate, const Window& frame) {
  TemplateMatch sharp = match(image, window, start, parameters_.blur_px, nullptr);
  if (parameters_.finder.robust) fitter_.set_noise(noise_level(image, window));
  // A correlation over all pixels hardly tells a hidden arc, another form or a cut outline.
  const EdgeFit outline =
      fitter_.fit(image, window, sharp.converged ? sharp.shape : start,
                  {sharp.ground - sharp.contrast, sharp.ground, parameters_.blur_px});
  // What the outline shows of light and cover is no part of the model.
  const bool disturbed = parameters_.finder.robust && (outline.light || outline.bad_sectors.any());
  const EdgeFit* disturbance = disturbed ? &outline : nullptr;
  if (disturbed) sharp = match(image, window, outline.shape, parameters_.blur_px, disturbance);
  EllipseFeature feature = judge(sharp, outline, gate, frame);
  // Against an edge that is much less sharp than its own, a template seldom settles.
  constexpr double kBlurred = 1.5;
  constexpr double kResolved = 3.0;  // blurs: a smaller ellipse may be any blot
  const double blur = outline.profile.blur;
  if (judge_fit(outline, parameters_.finder) == FeatureStatus::found &&
      blur > kBlurred * parameters_.blur_px && ellipse_of(outline.shape).b > kResolved * blur) {
    const TemplateMatch blurred = match(image, window, outline.shape, blur, disturbance);
    EllipseFeature better = judge(blurred, outline, gate, frame);
    // With one freedom more, the match is to be that much better.
    if (better.status == FeatureStatus::found && better.score >= parameters_.certainty) {
      keep(blurred.shape);
      return better;
    }
  }
  if (feature.status == FeatureStatus::found) keep(sharp.shape);
  return feature;
}

void CorrelationTracker::State::keep(const EllipseShape& shape) {
  tracking_ = true;
  shape_ = shape;
  motion_.setZero();
}

// Strong noise is cut off at 0 and 255: the flat parts of the template are then calmer than the
// edge, and it's the edge that tells centre and axes.
double CorrelationTracker::State::noise_inflation(const TemplateMatch& match,
                                                  const EdgeFit& outline) const {
  constexpr double kChance = 1.5;  // of two estimates of one variance
  if (smoothing_for(outline.noise, parameters_.finder.min_contrast) == 0.0) return 1.0;
  const double ratio = std::pow(outline.noise / match.noise, 2);
  return ratio > kChance ? ratio : 1.0;
}

EllipseFeature CorrelationTracker::State::judge(const TemplateMatch& match, const EdgeFit& outline,
                                                const Gate* gate, const Window& frame) const {
  const double score = correlation_score(sign_ * match.correlation);
  if (!match.converged) return lost_ellipse(FeatureStatus::wrong_object, score);
  if (score < parameters_.acceptance) return lost_ellipse(FeatureStatus::not_found, score);
  const Eigen::Vector2d half = half_extent(match.shape);
  const Eigen::Vector2d& c = match.shape.centre;
  if (c.x() < half.x() || c.y() < half.y() || c.x() + half.x() > frame.width - 1 ||
      c.y() + half.y() > frame.height - 1)
    return lost_ellipse(FeatureStatus::cut_by_border, score);
  if (gate != nullptr) {
    const Eigen::Vector2d off = c - gate->shape.centre;
    const double size =
        0.25 * std::log(match.shape.sigma.determinant() / gate->shape.sigma.determinant()) * 1.0;
    const double distance = std::max(off.dot(gate->centre_covariance.inverse() * off),
                                     std::pow(size / gate->log_size_sigma, 2));
    if (distance > parameters_.gate_sigmas * parameters_.gate_sigmas)
      return lost_ellipse(FeatureStatus::wrong_object, score);
  }
  const FeatureStatus judged = judge_fit(outline, parameters_.finder);
  if (judged != FeatureStatus::found) return lost_ellipse(judged, score);
  if ((outline.shape.centre - c).norm() > parameters_.max_outline_offset_px)
    return lost_ellipse(FeatureStatus::occluded, score);

  // Where the camera has cut a level off, r is largest for a disc of another size: the outline's
  // fit knows of the limit.
  constexpr double kClipped = 0.05;
  if (parameters_.finder.robust && outline.clipped > kClipped) {
    EllipseFeature feature = feature_of(outline, FeatureStatus::found);
    feature.score = score;
    return feature;
  }
  EllipseFeature feature;
  feature.status = FeatureStatus::found;
  const EllipseEstimate estimate = estimate_of(match.shape, match.covariance);
  feature.ellipse = estimate.ellipse;
  feature.covariance = noise_inflation(match, outline) * estimate.covariance;
  feature.contrast = match.contrast;
  feature.score = score;
  feature.visible = outline.agreement;
  feature.clipped = outline.clipped;
  return feature;
}

EllipseFeature CorrelationTracker::State::search(Canvas& canvas, const Gate& gate,
                                                 const Eigen::Vector2d& reach,
                                                 const std::vector<double>& scales) {
  const Window frame = canvas.frame().full();
  const double largest = *std::max_element(scales.begin(), scales.end());
  const EllipseShape widest = moved(gate.shape, 0, 0, largest);
  Window window = window_round(widest, parameters_.template_margin_px + 2.0);
  const int reach_u = static_cast<int>(std::ceil(reach.x()));
  const int reach_v = static_cast<int>(std::ceil(reach.y()));
  window = intersect({window.u - reach_u, window.v - reach_v, window.width + 2 * reach_u,
                      window.height + 2 * reach_v},
                     frame);
  if (window.empty()) return lost_ellipse(FeatureStatus::not_found, 0.0);
  canvas.require(window);
  const vpImage<unsigned char>& image = canvas.image();

  // The peak of r is about as wide as the disc's smaller half.
  const int step = std::clamp(static_cast<int>(ellipse_of(gate.shape).b / 4.0), 1, 8);
  const std::vector<std::pair<int, int>> shifts = outward(reach_u, reach_v, step);
  double best = 0.0;
  EllipseShape best_shape = gate.shape;
  bool any_fits = false;
  for (const double scale : scales) {
    const EllipseShape scaled = moved(gate.shape, 0, 0, scale);
    const DiscTemplate model(scaled, parameters_.template_margin_px, parameters_.blur_px);
    double scale_best = 0.0;
    std::pair<int, int> at{0, 0};
    // M is the disc's share, so a dark disc correlates negatively.
    const auto score = [&](int du, int dv) {
      return model.fits(du, dv, window)
                 ? correlation_score(-sign_ * model.correlation(image, du, dv))
                 : -1.0;
    };
    for (const auto& [du, dv] : shifts) {
      const double s = score(du, dv);
      any_fits = any_fits || s >= 0.0;
      if (s > scale_best) {
        scale_best = s;
        at = {du, dv};
      }
      if (scale_best >= parameters_.certainty) break;
    }
    for (int climb = step; climb >= 1;) {
      std::pair<int, int> next = at;
      for (const auto& [du, dv] : {std::pair{climb, 0}, {-climb, 0}, {0, climb}, {0, -climb}}) {
        const double s = score(at.first + du, at.second + dv);
        if (s <= scale_best) continue;
        scale_best = s;
        next = {at.first + du, at.second + dv};
      }
      if (next == at)
        climb /= 2;
      else
        at = next;
    }
    if (scale_best > best) {
      best = scale_best;
      best_shape = moved(scaled, at.first, at.second, 1.0);
    }
    if (best >= parameters_.certainty) break;
  }
  if (!any_fits) return lost_ellipse(FeatureStatus::cut_by_border, 0.0);
  // The refinement may gain what the grid of positions and scales has lost.
  if (best < 0.6 * parameters_.acceptance) return lost_ellipse(FeatureStatus::not_found, best);
  return refine(image, window, best_shape, &gate, frame);
}

CorrelationTracker::CorrelationTracker(const CorrelationTrackerParameters& parameters)
    : state_(std::make_unique<State>(parameters)) {}
CorrelationTracker::~CorrelationTracker() = default;

EllipseFeature CorrelationTracker::acquire(Canvas& canvas, const EllipsePrediction& prediction) {
  constexpr double kRounding = 0.25;  // px²
  constexpr double kScaleStep = 0.15;
  state_->sign_ = state_->parameters_.finder.polarity == Polarity::bright ? -1.0 : 1.0;
  const State::Gate gate{shape_of(prediction.ellipse),
                         prediction.centre_covariance + kRounding * Eigen::Matrix2d::Identity(),
                         std::hypot(prediction.scale_sigma, 0.02)};
  std::vector<double> scales{1.0};
  for (int k = 1; k * kScaleStep < 2.5 * prediction.scale_sigma; ++k) {
    scales.push_back(std::exp(k * kScaleStep));
    scales.push_back(std::exp(-k * kScaleStep));
  }
  const Eigen::Vector2d reach =
      3.0 * prediction.centre_covariance.diagonal().cwiseMax(0.0).cwiseSqrt() +
      Eigen::Vector2d::Constant(4.0);
  return state_->search(canvas, gate, reach, scales);
}

EllipseFeature CorrelationTracker::track(Canvas& canvas) {
  if (!state_->tracking_) return lost_ellipse(FeatureStatus::not_found, 0.0);
  EllipseShape predicted = state_->shape_;
  predicted.centre += state_->motion_;
  const double reach = state_->parameters_.search_margin_px;
  const double sigma = reach / state_->parameters_.gate_sigmas;
  const State::Gate gate{predicted, Eigen::Matrix2d::Identity() * (sigma * sigma * 2.0),
                         state_->parameters_.max_scale_step / state_->parameters_.gate_sigmas};
  return state_->search(canvas, gate, Eigen::Vector2d::Constant(reach), {1.0});
}

std::vector<EllipseFeature> CorrelationTracker::find_all(Canvas& canvas) {
  const Window frame = canvas.frame().full();
  canvas.require(frame);
  const DiscTrackerParameters& finder = state_->parameters_.finder;
  std::vector<EllipseFeature> features;
  for (const DiscCandidate& candidate :
       state_->finder_.find(canvas.image(), frame, finder.polarity, finder.min_axis_ratio)) {
    if (candidate.status != FeatureStatus::found) continue;
    state_->sign_ = candidate.fit.profile.disc < candidate.fit.profile.ground ? 1.0 : -1.0;
    const EllipseFeature feature =
        state_->refine(canvas.image(), frame, candidate.blob.ellipse, nullptr, frame);
    if (feature.status == FeatureStatus::found) features.push_back(feature);
  }
  return features;
}

void CorrelationTracker::start(Canvas& canvas, const Ellipse& ellipse) {
  state_->shape_ = shape_of(ellipse);
  state_->motion_.setZero();
  state_->tracking_ = true;
  const Window window = intersect(
      window_round(state_->shape_, state_->parameters_.template_margin_px), canvas.frame().full());
  const DiscTemplate model(state_->shape_, state_->parameters_.template_margin_px,
                           state_->parameters_.blur_px);
  canvas.require(window);
  if (model.fits(0, 0, window))
    state_->sign_ = model.correlation(canvas.image(), 0, 0) > 0.0 ? -1.0 : 1.0;
}

void CorrelationTracker::expect_motion(const Eigen::Vector2d& shift) {
  state_->motion_ += shift;
}

}  // namespace vigia::tracking

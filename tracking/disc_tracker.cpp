#include "vigia/tracking/disc_tracker.hpp"

#include "disc_finder.hpp"
#include "lost_feature.hpp"
#include "noise_smoothing.hpp"
#include "pixel.hpp"
#include "seeded_dot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/LU>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::tracking {
namespace {

using imaging::Canvas;
using imaging::Window;

constexpr int kWidenings = 4;
constexpr double kEdgeBand = 3.0;  // px round an outline that its fit needs
constexpr double kVisible = 1.5;   // contrast to noise at which something is there at all
constexpr double kExpected = 3.5;  // px that a disc which moves as expected stays within
constexpr double kMoving = 1.5;    // px by which a band strays while it is fitted
constexpr double kHollow = 3.0;    // widths of the band from which on it pays to leave out the hole

double log_size_ratio(const EllipseShape& a, const EllipseShape& b) {
  return std::log(size_of(a) / size_of(b));
}

bool touches(const Window& inner, const Window& outer) {
  return inner.u <= outer.u || inner.v <= outer.v || inner.right() >= outer.right() ||
         inner.bottom() >= outer.bottom();
}

// Where the row through the centre leaves the ellipse.
double right_end(const EllipseShape& shape) {
  const double off = shape.sigma(0, 1);
  return shape.centre.x() + std::sqrt(shape.sigma(0, 0) - off * off / shape.sigma(1, 1));
}

std::vector<imaging::Run> runs_of(const std::vector<BandRow>& band) {
  std::vector<imaging::Run> runs;
  runs.reserve(2 * band.size());
  const auto add = [&](int v, int first, int last) {
    if (first <= last) runs.push_back({v, first, last + 1});
  };
  for (const BandRow& row : band) {
    add(row.v, row.first, std::min(row.last, row.hole_first - 1));
    add(row.v, std::max(row.first, row.hole_last + 1), row.last);
  }
  return runs;
}

// Whether the ellipse's outline reaches over the frame's edge.
bool cut_by_frame(const EllipseShape& shape, const Window& frame) {
  const Eigen::Vector2d half = half_extent(shape);
  return shape.centre.x() - half.x() < 0.0 || shape.centre.y() - half.y() < 0.0 ||
         shape.centre.x() + half.x() > frame.width - 1 ||
         shape.centre.y() + half.y() > frame.height - 1;
}

}  // namespace

class DiscTracker::State {
 public:
  explicit State(const DiscTrackerParameters& parameters)
      : parameters_(parameters), finder_(parameters), fitter_(edge_fit_parameters(parameters)) {}

  EllipseFeature acquire(Canvas& canvas, const EllipsePrediction& prediction);
  EllipseFeature track(Canvas& canvas);
  std::vector<EllipseFeature> find_all(Canvas& canvas);
  void start(Canvas& canvas, const Ellipse& ellipse);
  void expect_motion(const Eigen::Vector2d& shift) { motion_ += shift; }

 private:
  /// What was looked for, and how far it may be off.
  struct Gate {
    EllipseShape shape;
    Eigen::Matrix2d centre_covariance;
    double log_size_sigma;
  };

  std::optional<EllipseFeature> follow_band(Canvas& canvas, const EllipseShape& predicted,
                                            const Window& window);
  std::optional<EdgeFit> follow(const vpImage<unsigned char>& image, const EllipseShape& predicted,
                                const Eigen::Vector2d& seed, const Window& window);
  std::optional<EllipseShape> follow_dot(const vpImage<unsigned char>& image,
                                         const EllipseShape& predicted, const Eigen::Vector2d& seed,
                                         const Window& window);
  EllipseFeature search(Canvas& canvas, const Gate& gate, double margin);
  FeatureStatus blame(const std::vector<DiscCandidate>& candidates, const Gate& gate,
                      const vpImage<unsigned char>& image, const Window& window,
                      const Window& frame);
  double distance(const EllipseShape& shape, const Gate& gate) const;
  double margin_of(const EllipseShape& shape) const;
  double band_half_width(double blur) const;
  void keep(const EdgeFit& fit);

  DiscTrackerParameters parameters_;
  DiscFinder finder_;
  EdgeFitter fitter_;
  SeededDot dot_;

  bool tracking_ = false;
  EllipseShape shape_;
  EdgeProfile profile_;
  Eigen::Vector2d motion_ = Eigen::Vector2d::Zero();
};

void DiscTracker::State::keep(const EdgeFit& fit) {
  tracking_ = true;
  shape_ = fit.shape;
  profile_ = fit.profile;
  motion_.setZero();
}

double DiscTracker::State::margin_of(const EllipseShape& shape) const {
  return std::max(parameters_.search_margin_px,
                  parameters_.search_margin_ratio * half_extent(shape).maxCoeff());
}

double DiscTracker::State::band_half_width(double blur) const {
  return edge_fit_parameters(parameters_).band_blurs * blur;
}

// Squared distance from the prediction in gate units; at most 1 inside the gate.
double DiscTracker::State::distance(const EllipseShape& shape, const Gate& gate) const {
  const Eigen::Vector2d off = shape.centre - gate.shape.centre;
  const double centre = off.dot(gate.centre_covariance.inverse() * off);
  const double size = log_size_ratio(shape, gate.shape) / gate.log_size_sigma;
  const double limit = parameters_.gate_sigmas;
  return std::max(centre, size * size) / (limit * limit);
}

EllipseFeature DiscTracker::State::search(Canvas& canvas, const Gate& gate, double margin) {
  const Window frame = canvas.frame().full();
  const Ellipse expected = ellipse_of(gate.shape);
  const double ratio = std::clamp(0.6 * expected.b / expected.a, 0.1, parameters_.min_axis_ratio);
  for (int attempt = 0;; ++attempt, margin *= 2.0) {
    const Window window = intersect(window_round(gate.shape, margin), frame);
    if (window.empty()) return lost_ellipse(FeatureStatus::not_found);
    canvas.require(window);
    const std::vector<DiscCandidate> candidates =
        finder_.find(canvas.image(), window, parameters_.polarity, ratio);

    const DiscCandidate* best = nullptr;
    double best_distance = 1.0;
    bool unfinished = false;
    for (const DiscCandidate& candidate : candidates) {
      if (candidate.touches_window && !touches(candidate.blob.box, frame)) unfinished = true;
      if (candidate.status != FeatureStatus::found) continue;
      const double d = distance(candidate.fit.shape, gate);
      if (d > best_distance) continue;
      best = &candidate;
      best_distance = d;
    }
    if (best != nullptr) {
      keep(best->fit);
      return feature_of(best->fit, FeatureStatus::found);
    }
    const bool everything = contains(window, frame);
    if (!unfinished || everything || attempt == kWidenings)
      return lost_ellipse(blame(candidates, gate, canvas.image(), window, frame));
  }
}

// Why nothing was found, by the candidate that comes nearest to the prediction.
FeatureStatus DiscTracker::State::blame(const std::vector<DiscCandidate>& candidates,
                                        const Gate& gate, const vpImage<unsigned char>& image,
                                        const Window& window, const Window& frame) {
  const EdgeFit direct = fitter_.fit(image, window, gate.shape, profile_);
  const FeatureStatus judged = judge_fit(direct, parameters_);
  if (direct.converged && distance(direct.shape, gate) < 1.0) {
    if (judged == FeatureStatus::occluded)
      return cut_by_frame(direct.shape, frame) ? FeatureStatus::cut_by_border
                                               : FeatureStatus::occluded;
    if (judged == FeatureStatus::low_contrast &&
        std::abs(direct.profile.ground - direct.profile.disc) > kVisible * direct.noise)
      return FeatureStatus::low_contrast;
  }
  FeatureStatus status = FeatureStatus::not_found;
  double nearest = std::numeric_limits<double>::infinity();
  for (const DiscCandidate& candidate : candidates) {
    const Blob& blob = candidate.blob;
    const Eigen::Vector2d off = blob.ellipse.centre - gate.shape.centre;
    const double limit =
        parameters_.gate_sigmas * std::sqrt(gate.centre_covariance.trace()) + size_of(gate.shape);
    if (off.norm() > limit || off.norm() > nearest) continue;
    nearest = off.norm();
    status = candidate.status;
    if (status == FeatureStatus::found) status = FeatureStatus::wrong_object;
    if (status == FeatureStatus::cut_by_border &&
        contains(frame, window_round(blob.ellipse, kEdgeBand)))
      status = FeatureStatus::wrong_object;
    // A part of what was looked for: smaller, and not larger than it in any direction.
    const Eigen::Vector2d extent = half_extent(gate.shape) * 2.0 * 1.15 + Eigen::Vector2d(2.0, 2.0);
    const double full = kPi * std::sqrt(gate.shape.sigma.determinant());
    if (status == FeatureStatus::wrong_object && blob.area < 0.95 * full &&
        blob.area > 0.25 * full && blob.box.width < extent.x() && blob.box.height < extent.y() &&
        candidate.fit.agreement < parameters_.min_agreement)
      status = FeatureStatus::occluded;
  }
  return status;
}

EllipseFeature DiscTracker::State::acquire(Canvas& canvas, const EllipsePrediction& prediction) {
  constexpr double kRounding = 0.25;  // px²: a perfect prediction still needs a gate
  constexpr double kShapeSlack = 0.02;
  Gate gate{shape_of(prediction.ellipse),
            prediction.centre_covariance + kRounding * Eigen::Matrix2d::Identity(),
            std::hypot(prediction.scale_sigma, kShapeSlack)};
  const double spread = 3.0 * std::sqrt(std::max(prediction.centre_covariance(0, 0),
                                                 prediction.centre_covariance(1, 1)));
  const double growth = 3.0 * prediction.scale_sigma * prediction.ellipse.a;
  profile_ = EdgeProfile{};
  return search(canvas, gate, spread + growth + parameters_.search_margin_px);
}

std::optional<EllipseShape> DiscTracker::State::follow_dot(const vpImage<unsigned char>& image,
                                                           const EllipseShape& predicted,
                                                           const Eigen::Vector2d& seed,
                                                           const Window& window) {
  const Window seedable{window.u + 2, window.v + 2, window.width - 4, window.height - 4};
  const Window at{static_cast<int>(std::lround(seed.x())), static_cast<int>(std::lround(seed.y())),
                  1, 1};
  if (!contains(seedable, at)) return std::nullopt;
  const int middle = static_cast<int>(0.5 * (profile_.disc + profile_.ground));
  const bool dark = profile_.disc < profile_.ground;
  const auto dot = dark ? dot_.track(image, seed, 0, middle) : dot_.track(image, seed, middle, 255);
  if (!dot) return std::nullopt;
  const vpRect box = dot_.getBBox();
  const Window dot_window{static_cast<int>(box.getLeft()), static_cast<int>(box.getTop()),
                          static_cast<int>(box.getWidth()), static_cast<int>(box.getHeight())};
  if (touches(dot_window, window)) return std::nullopt;
  // vpDot2's axes are half a pixel short: take its centre, and of its size only the change.
  const double ratio = (size_of(*dot) + 0.5) / size_of(predicted);
  if (std::abs(std::log(ratio)) > parameters_.max_scale_step) return std::nullopt;
  // Below this, its change is its own raggedness.
  constexpr double kRagged = 0.03;
  const double growth = std::abs(std::log(ratio)) > kRagged ? ratio * ratio : 1.0;
  return EllipseShape{dot->centre, predicted.sigma * growth};
}

// What vpDot2, from the seed, and the fit find in the window; nothing where they are not sure of
// it.
std::optional<EdgeFit> DiscTracker::State::follow(const vpImage<unsigned char>& image,
                                                  const EllipseShape& predicted,
                                                  const Eigen::Vector2d& seed,
                                                  const Window& window) {
  const auto dot = follow_dot(image, predicted, seed, window);
  if (!dot) return std::nullopt;
  EdgeFit fit = fitter_.fit(image, window, *dot, profile_);
  const bool near = (fit.shape.centre - dot->centre).norm() < 0.5 + 0.05 * size_of(*dot) &&
                    std::abs(log_size_ratio(fit.shape, predicted)) < parameters_.max_scale_step;
  if (!near || !fit.complete || judge_fit(fit, parameters_) != FeatureStatus::found)
    return std::nullopt;
  return fit;
}

// follow() with no pixels but those round the outline of a disc that moves as expected: what is
// farther out, and the inside of a large disc, nobody reads. Nothing where the outline leaves them.
std::optional<EllipseFeature> DiscTracker::State::follow_band(Canvas& canvas,
                                                              const EllipseShape& predicted,
                                                              const Window& window) {
  if (parameters_.robust) return std::nullopt;  // looks beside the outline
  const double half_width = band_half_width(profile_.blur) + kExpected;
  const Window whole = window_round(predicted, half_width);
  if (!contains(window, whole)) return std::nullopt;
  const double axis = ellipse_of(predicted).b;
  const bool hollow = axis > kHollow * half_width;
  if (hollow)
    canvas.require(runs_of(band_rows(predicted, half_width)));
  else
    canvas.require(whole);
  // vpDot2 goes to the right from its seed, to the border.
  const Eigen::Vector2d seed(hollow ? right_end(predicted) - kExpected : predicted.centre.x(),
                             predicted.centre.y());
  const auto fit = follow(canvas.image(), predicted, seed, whole);
  if (!fit) return std::nullopt;
  const double moved = (fit->shape.centre - predicted.centre).norm() +
                       0.5 * (fit->shape.sigma - predicted.sigma).norm() / axis;
  if (moved + band_half_width(fit->profile.blur) > half_width - kMoving) return std::nullopt;
  keep(*fit);
  return feature_of(*fit, FeatureStatus::found);
}

EllipseFeature DiscTracker::State::track(Canvas& canvas) {
  if (!tracking_) return lost_ellipse(FeatureStatus::not_found);
  EllipseShape predicted = shape_;
  predicted.centre += motion_;
  const Window frame = canvas.frame().full();
  const double margin = margin_of(predicted);
  const Window window = intersect(window_round(predicted, margin), frame);
  if (window.empty()) return lost_ellipse(FeatureStatus::not_found);
  if (const auto feature = follow_band(canvas, predicted, window)) return *feature;
  canvas.require(window);
  if (parameters_.robust) fitter_.set_noise(noise_level(canvas.image(), window));
  if (const auto fit = follow(canvas.image(), predicted, predicted.centre, window)) {
    keep(*fit);
    return feature_of(*fit, FeatureStatus::found);
  }
  const double reach = margin / parameters_.gate_sigmas;
  const Gate gate{predicted, Eigen::Matrix2d::Identity() * (reach * reach),
                  parameters_.max_scale_step / parameters_.gate_sigmas};
  return search(canvas, gate, margin);
}

std::vector<EllipseFeature> DiscTracker::State::find_all(Canvas& canvas) {
  const Window frame = canvas.frame().full();
  canvas.require(frame);
  std::vector<EllipseFeature> features;
  for (const DiscCandidate& candidate :
       finder_.find(canvas.image(), frame, parameters_.polarity, parameters_.min_axis_ratio))
    if (candidate.status == FeatureStatus::found)
      features.push_back(feature_of(candidate.fit, FeatureStatus::found));
  return features;
}

void DiscTracker::State::start(Canvas& canvas, const Ellipse& ellipse) {
  shape_ = shape_of(ellipse);
  motion_.setZero();
  tracking_ = true;
  const Window frame = canvas.frame().full();
  const Window window = intersect(window_round(shape_, parameters_.search_margin_px), frame);
  if (window.empty()) return;
  canvas.require(window);
  // Levels from the middle and from a ring outside.
  const vpImage<unsigned char>& image = canvas.image();
  const auto level = [&](const Eigen::Vector2d& p) {
    const int u = std::clamp(static_cast<int>(std::lround(p.x())), window.u, window.right() - 1);
    const int v = std::clamp(static_cast<int>(std::lround(p.y())), window.v, window.bottom() - 1);
    return static_cast<double>(image[static_cast<unsigned>(v)][u]);
  };
  constexpr int kSamples = 16;
  const Eigen::Vector2d half = half_extent(shape_);
  double inside = 0.0;
  double outside = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    const double angle = 2.0 * kPi * k / kSamples;
    const Eigen::Vector2d direction = unit_vector(angle);
    inside += level(shape_.centre + 0.25 * half.minCoeff() * direction) / kSamples;
    const double rim = 1.0 / std::sqrt(direction.dot(shape_.sigma.inverse() * direction));
    outside += level(shape_.centre + (rim + 4.0) * direction) / kSamples;
  }
  profile_ = {inside, outside, kStartBlur};
}

DiscTracker::DiscTracker(const DiscTrackerParameters& parameters)
    : state_(std::make_unique<State>(parameters)) {}
DiscTracker::~DiscTracker() = default;

EllipseFeature DiscTracker::acquire(Canvas& canvas, const EllipsePrediction& prediction) {
  return state_->acquire(canvas, prediction);
}
EllipseFeature DiscTracker::track(Canvas& canvas) {
  return state_->track(canvas);
}
std::vector<EllipseFeature> DiscTracker::find_all(Canvas& canvas) {
  return state_->find_all(canvas);
}
void DiscTracker::start(Canvas& canvas, const Ellipse& ellipse) {
  state_->start(canvas, ellipse);
}
void DiscTracker::expect_motion(const Eigen::Vector2d& shift) {
  state_->expect_motion(shift);
}

}  // namespace vigia::tracking

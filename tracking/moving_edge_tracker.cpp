#include "vigia/tracking/moving_edge_tracker.hpp"

#include "disc_finder.hpp"
#include "lost_feature.hpp"
#include "noise_smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/me/vpMeEllipse.h>

#include "vigia/core/angle.hpp"

namespace vigia::tracking {
namespace {

using imaging::Canvas;
using imaging::Window;

/// vpMeEllipse with its count of sites made readable.
class EdgeSites : public vpMeEllipse {
 public:
  unsigned good_sites() const { return m_numberOfGoodPoints; }
  unsigned expected_sites() const { return m_expectedDensity; }
};

// The point at parameter t of the ellipse with both axes grown by @p growth.
Eigen::Vector2d outline_point(const Ellipse& ellipse, double t, double growth) {
  const double x = (ellipse.a + growth) * std::cos(t);
  const double y = (ellipse.b + growth) * std::sin(t);
  return {ellipse.u + x * std::cos(ellipse.psi) - y * std::sin(ellipse.psi),
          ellipse.v + x * std::sin(ellipse.psi) + y * std::cos(ellipse.psi)};
}

struct EdgeMeasurement {
  Ellipse ellipse;
  double scatter = 0.0;  ///< rms distance of the sites from the ellipse, px
  double held = 0.0;     ///< share of the sites that hold on
  unsigned sites = 0;
};

// Rms of the first-order distances of the sites that are in use.
double scatter_of(EdgeSites& sites, const EllipseShape& shape) {
  const Eigen::Matrix2d inverse = shape.sigma.inverse();
  double sum = 0.0;
  int count = 0;
  for (const vpMeSite& site : sites.getMeList()) {
    if (site.getState() != vpMeSite::NO_SUPPRESSION) continue;
    const Eigen::Vector2d p(site.get_jfloat() - shape.centre.x(),
                            site.get_ifloat() - shape.centre.y());
    const double d = depth_in(inverse, p);
    sum += d * d;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

// The share of the outline that lies inside the frame, a pixel from its edge.
double visible_share(const Ellipse& ellipse, const Window& frame) {
  constexpr int kSamples = 128;
  int inside = 0;
  for (int k = 0; k < kSamples; ++k) {
    const Eigen::Vector2d p = outline_point(ellipse, 2.0 * kPi * k / kSamples, 0.0);
    inside += p.x() >= 1.0 && p.y() >= 1.0 && p.x() <= frame.width - 2 && p.y() <= frame.height - 2
                  ? 1
                  : 0;
  }
  return static_cast<double>(inside) / kSamples;
}

// The ellipse through the visible outline of a blob that the border cuts.
std::optional<EllipseShape> arc_ellipse(const Blob& blob) {
  constexpr std::size_t kLeast = 30;
  if (blob.arc.size() < kLeast) return std::nullopt;
  std::vector<cv::Point2f> points;
  points.reserve(blob.arc.size());
  for (const Eigen::Vector2d& p : blob.arc)
    points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  const cv::RotatedRect rectangle = cv::fitEllipseDirect(points);
  const Ellipse ellipse{static_cast<double>(rectangle.center.x),
                        static_cast<double>(rectangle.center.y),
                        0.5 * static_cast<double>(rectangle.size.width),
                        0.5 * static_cast<double>(rectangle.size.height),
                        from_deg(static_cast<double>(rectangle.angle))};
  const EllipseShape shape = shape_of(ellipse);
  if (!shape.sigma.allFinite() || !(shape.sigma.determinant() > 0.0)) return std::nullopt;
  const Eigen::Matrix2d inverse = shape.sigma.inverse();
  double squares = 0.0;
  for (const Eigen::Vector2d& point : blob.arc) {
    const double d = depth_in(inverse, point - shape.centre);
    squares += d * d;
  }
  constexpr double kRagged = 0.7;  // px rms; whole pixels alone make 0.3
  if (std::sqrt(squares / static_cast<double>(blob.arc.size())) > kRagged) return std::nullopt;
  return shape;
}

// Mean grey level inside less that outside, on two ellipses beside the outline.
double contrast_of(const vpImage<unsigned char>& image, const Ellipse& ellipse) {
  constexpr int kSamples = 24;
  const auto level = [&](double growth) {
    double sum = 0.0;
    for (int k = 0; k < kSamples; ++k) {
      const Eigen::Vector2d p = outline_point(ellipse, 2.0 * kPi * k / kSamples, growth);
      const long row = std::clamp(std::lround(p.y()), 0L, static_cast<long>(image.getHeight()) - 1);
      const long column =
          std::clamp(std::lround(p.x()), 0L, static_cast<long>(image.getWidth()) - 1);
      sum += image[static_cast<unsigned>(row)][column];
    }
    return sum / kSamples;
  };
  return level(3.0) - level(-std::min(3.0, 0.5 * ellipse.b));
}

// The share of the outline across which the grey level steps as @p contrast says. Sites hold on to
// the grain of a surface where the outline has left the edge; the step is not there.
double stepping_share(const vpImage<unsigned char>& image, const Ellipse& ellipse,
                      double contrast) {
  constexpr int kSamples = 64;
  constexpr double kLeastStep = 0.3;  // of the contrast: light may fall off along the outline
  const auto inside_image = [&](const Eigen::Vector2d& p) {
    return p.x() >= 0.0 && p.y() >= 0.0 && p.x() <= image.getWidth() - 1.0 &&
           p.y() <= image.getHeight() - 1.0;
  };
  const auto level = [&](const Eigen::Vector2d& p) {
    return static_cast<double>(
        image[static_cast<unsigned>(std::lround(p.y()))][std::lround(p.x())]);
  };
  int seen = 0;
  int steps = 0;
  for (int k = 0; k < kSamples; ++k) {
    const double t = 2.0 * kPi * k / kSamples;
    const Eigen::Vector2d outer = outline_point(ellipse, t, 3.0);
    const Eigen::Vector2d inner = outline_point(ellipse, t, -std::min(3.0, 0.5 * ellipse.b));
    if (!inside_image(outer) || !inside_image(inner)) continue;
    ++seen;
    if ((level(outer) - level(inner)) / contrast >= kLeastStep) ++steps;
  }
  return seen > 0 ? static_cast<double>(steps) / seen : 0.0;
}

}  // namespace

class MovingEdgeTracker::State {
 public:
  explicit State(const MovingEdgeTrackerParameters& parameters)
      : parameters_(parameters), seeds_(parameters.finder), finder_(parameters.finder) {
    edges_.setRange(parameters.range_px);
    edges_.setMaskSize(parameters.mask_size);
    edges_.setThreshold(parameters.threshold);
    edges_.setMaskNumber(180);
    edges_.initMask();
  }

  std::optional<EdgeMeasurement> measure(const vpImage<unsigned char>& image,
                                         const EllipseShape& start);
  EllipseFeature follow(Canvas& canvas, const EllipseShape& start, const EllipseShape& expected);
  double margin() const { return 2.0 * parameters_.range_px + parameters_.mask_size + 4.0; }
  std::optional<EllipseShape> seed_in_noise(Canvas& canvas, const EllipseShape& predicted);
  EllipseFeature feature_of(const EdgeMeasurement& measured, double contrast) const;

  MovingEdgeTrackerParameters parameters_;
  vpMe edges_;
  DiscTracker seeds_;
  DiscFinder finder_;
  vpImage<unsigned char> crop_;
  bool tracking_ = false;
  EllipseShape shape_;
  Eigen::Vector2d motion_ = Eigen::Vector2d::Zero();
};

// ViSP throws when too few sites hold; everything that it throws means a lost ellipse.
std::optional<EdgeMeasurement> MovingEdgeTracker::State::measure(
    const vpImage<unsigned char>& image, const EllipseShape& start) {
  vpColVector parameters(5);
  parameters[0] = start.centre.x();
  parameters[1] = start.centre.y();
  // ViSP's normalised moments: n₂₀, n₁₁, n₀₂ = Σ/4.
  parameters[2] = 0.25 * start.sigma(0, 0);
  parameters[3] = 0.25 * start.sigma(0, 1);
  parameters[4] = 0.25 * start.sigma(1, 1);
  // ViSP's step is an angle in degrees.
  constexpr double kFewSites = 20.0;  // degrees
  constexpr double kManySites = 2.0;
  const Ellipse outline = ellipse_of(start);
  const double radius = 0.5 * (outline.a + outline.b);
  edges_.setSampleStep(
      std::clamp(to_deg(parameters_.sample_step_px / radius), kManySites, kFewSites));
  EdgeSites sites;
  sites.setMe(&edges_);
  sites.setDisplay(vpMeSite::NONE);
  EdgeMeasurement out;
  // A site holds on to what it first sees, and looks for the like of it from then on: on the flank
  // of an edge it would stay beside it.
  constexpr double kFirstLook = 4.0;  // px to either side, and less where the other side is near
  sites.setInitRange(static_cast<unsigned>(std::clamp(outline.b / 3.0, 1.0, kFirstLook)));
  try {
    sites.initTracking(image, parameters);
    sites.track(image);
  } catch (const vpException&) {
    return std::nullopt;
  }
  const vpColVector axes = sites.get_ABE();
  out.ellipse = {sites.getCenter().get_u(), sites.getCenter().get_v(), axes[0], axes[1], axes[2]};
  const EllipseShape shape = shape_of(out.ellipse);
  if (!shape.sigma.allFinite() || !shape.centre.allFinite() || out.ellipse.b < 2.0)
    return std::nullopt;
  out.ellipse = ellipse_of(shape);
  out.sites = sites.good_sites();
  out.held = std::min(1.0, static_cast<double>(out.sites) / std::max(1U, sites.expected_sites()));
  out.scatter = scatter_of(sites, shape);
  // ViSP cuts a site's place off to the pixel whose edge it takes.
  constexpr double kHalfPixel = 0.5;
  out.ellipse.u -= kHalfPixel;
  out.ellipse.v -= kHalfPixel;
  return out;
}

EllipseFeature MovingEdgeTracker::State::feature_of(const EdgeMeasurement& measured,
                                                    double contrast) const {
  EllipseFeature feature;
  feature.status = FeatureStatus::found;
  feature.ellipse = measured.ellipse;
  feature.contrast = contrast;
  feature.score = measured.held;
  // The scatter averages out over the sites, the bias does not.
  const double scatter = 2.0 * measured.scatter * measured.scatter / std::max(1U, measured.sites);
  const double centre = scatter + parameters_.centre_bias_px * parameters_.centre_bias_px;
  const double axis = scatter + parameters_.axis_bias_px * parameters_.axis_bias_px;
  const double difference = measured.ellipse.a - measured.ellipse.b;
  const double psi = 1.0 / (difference * difference / (0.5 * axis) + 12.0 / (kPi * kPi));
  feature.covariance.setZero();
  feature.covariance.diagonal() << centre, centre, axis, axis, psi;
  return feature;
}

EllipseFeature MovingEdgeTracker::State::follow(Canvas& canvas, const EllipseShape& start,
                                                const EllipseShape& expected) {
  const Window frame = canvas.frame().full();
  const Window window = intersect(window_round(start, margin()), frame);
  if (window.empty() || window.width < 8 || window.height < 8)
    return lost_ellipse(FeatureStatus::not_found);
  canvas.require(window);
  // vpMeEllipse reads where it likes: it gets a copy of the window and nothing else.
  crop_.resize(static_cast<unsigned>(window.height), static_cast<unsigned>(window.width));
  for (int v = 0; v < window.height; ++v)
    std::copy_n(canvas.image()[static_cast<unsigned>(window.v + v)] + window.u, window.width,
                crop_[static_cast<unsigned>(v)]);
  const Eigen::Vector2d origin(window.u, window.v);
  EllipseShape local = start;
  local.centre -= origin;
  auto measured = measure(crop_, local);
  if (!measured) return lost_ellipse(FeatureStatus::not_found);
  const double contrast = contrast_of(crop_, measured->ellipse);
  const double stepping = stepping_share(crop_, measured->ellipse, contrast);
  measured->ellipse.u += origin.x();
  measured->ellipse.v += origin.y();

  const EllipseShape shape = shape_of(measured->ellipse);
  const double visible = visible_share(measured->ellipse, frame);
  constexpr unsigned kArcSites = 30;  // an arc that fewer hold may be of any curve
  if (visible < parameters_.min_visible || (visible < 1.0 && measured->sites < kArcSites))
    return lost_ellipse(FeatureStatus::cut_by_border);
  measured->held = std::min(1.0, measured->held / visible);
  const double growth = 0.25 * std::log(shape.sigma.determinant() / expected.sigma.determinant());
  if (std::abs(growth) > parameters_.max_scale_step ||
      (shape.centre - expected.centre).norm() > 2.0 * parameters_.range_px)
    return lost_ellipse(FeatureStatus::wrong_object);
  if (std::abs(contrast) < parameters_.finder.min_contrast)
    return lost_ellipse(FeatureStatus::low_contrast);
  if (std::min(measured->held, stepping) < parameters_.min_good_sites)
    return lost_ellipse(FeatureStatus::occluded);
  tracking_ = true;
  shape_ = shape;
  motion_.setZero();
  return feature_of(*measured, contrast);
}

// In noise that makes steps of its own, sites that start beside the edge hold on to those: the disc
// detector has to bring them to it.
std::optional<EllipseShape> MovingEdgeTracker::State::seed_in_noise(Canvas& canvas,
                                                                    const EllipseShape& predicted) {
  const Window window = intersect(window_round(predicted, margin()), canvas.frame().full());
  if (window.empty()) return std::nullopt;
  canvas.require(window);
  const double noise = noise_level(canvas.image(), window);
  if (smoothing_for(noise, parameters_.finder.min_contrast) == 0.0) return std::nullopt;
  EllipsePrediction prediction;
  prediction.ellipse = ellipse_of(predicted);
  const double sigma = parameters_.range_px / parameters_.gate_sigmas;
  prediction.centre_covariance = Eigen::Matrix2d::Identity() * sigma * sigma;
  prediction.scale_sigma = parameters_.max_scale_step / parameters_.gate_sigmas;
  const EllipseFeature seed = seeds_.acquire(canvas, prediction);
  if (seed.status != FeatureStatus::found) return std::nullopt;
  return shape_of(seed.ellipse);
}

MovingEdgeTracker::MovingEdgeTracker(const MovingEdgeTrackerParameters& parameters)
    : state_(std::make_unique<State>(parameters)) {}
MovingEdgeTracker::~MovingEdgeTracker() = default;

EllipseFeature MovingEdgeTracker::acquire(Canvas& canvas, const EllipsePrediction& prediction) {
  EllipseFeature seed = state_->seeds_.acquire(canvas, prediction);
  if (seed.status != FeatureStatus::found) return seed;
  const EllipseShape shape = shape_of(seed.ellipse);
  return state_->follow(canvas, shape, shape);
}

EllipseFeature MovingEdgeTracker::track(Canvas& canvas) {
  if (!state_->tracking_) return lost_ellipse(FeatureStatus::not_found);
  EllipseShape predicted = state_->shape_;
  predicted.centre += state_->motion_;
  const EllipseShape start = state_->seed_in_noise(canvas, predicted).value_or(predicted);
  return state_->follow(canvas, start, predicted);
}

std::vector<EllipseFeature> MovingEdgeTracker::find_all(Canvas& canvas) {
  const Window frame = canvas.frame().full();
  canvas.require(frame);
  const MovingEdgeTrackerParameters& parameters = state_->parameters_;
  std::vector<EllipseFeature> features;
  for (const DiscCandidate& candidate : state_->finder_.find(
           canvas.image(), frame, parameters.finder.polarity, parameters.finder.min_axis_ratio)) {
    std::optional<EllipseShape> seed;
    if (candidate.status == FeatureStatus::found)
      seed = candidate.fit.shape;
    else if (candidate.status == FeatureStatus::cut_by_border && parameters.min_visible < 1.0)
      seed = arc_ellipse(candidate.blob);
    if (!seed) continue;
    const EllipseFeature feature = state_->follow(canvas, *seed, *seed);
    // Two blobs of one cut ellipse lead to the same outline.
    const bool known = std::any_of(features.begin(), features.end(), [&](const auto& other) {
      return std::hypot(other.ellipse.u - feature.ellipse.u, other.ellipse.v - feature.ellipse.v) <
             0.5 * other.ellipse.b;
    });
    if (feature.status == FeatureStatus::found && !known) features.push_back(feature);
  }
  return features;
}

void MovingEdgeTracker::start(Canvas& /*canvas*/, const Ellipse& ellipse) {
  state_->shape_ = shape_of(ellipse);
  state_->motion_.setZero();
  state_->tracking_ = true;
}

void MovingEdgeTracker::expect_motion(const Eigen::Vector2d& shift) {
  state_->motion_ += shift;
}

}  // namespace vigia::tracking

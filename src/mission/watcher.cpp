#include "watcher.hpp"

#include <algorithm>

#include "vigia/localization/disc_model.hpp"
#include "vigia/localization/points_model.hpp"

namespace vigia::mission {
namespace {

/// The circle that holds the landmark's features, as a disc.
Landmark outline_of(const Landmark& landmark) {
  return {landmark.id, landmark.wMl, DiscShape{extent_radius(landmark)}};
}

/// Of the landmark's outline.
std::optional<Ellipse> expected_image(const Shot& shot, const Belief& belief,
                                      const Landmark& landmark, const RigOnGround& on_ground) {
  const Eigen::Isometry3d wMc = on_ground.wMc(shot.camera, shot.head, belief.pose);
  return localization::disc_image(outline_of(landmark), pinhole(shot), wMc);
}

template <typename Shape>
std::unique_ptr<tracking::PointTracker> tracker_of(const std::string& name,
                                                   const LandmarkMap& map) {
  const auto& all = map.all();
  const bool needed = std::any_of(all.begin(), all.end(), [](const Landmark& landmark) {
    return std::holds_alternative<Shape>(landmark.shape);
  });
  return needed ? tracking::make_point_tracker(name, {false, map}) : nullptr;
}

PointsObservation observed(const tracking::PointsFeature& feature, const Shot& shot,
                           std::optional<LandmarkId> expected) {
  return {shot, expected, *feature.landmark, feature.points, feature.confidence};
}

}  // namespace

Watcher::Watcher(const std::string& tracker, const LandmarkMap& map, RigOnGround on_ground,
                 SensorNoise noise)
    : tracker_(tracking::make_ellipse_tracker(tracker)),
      patterns_(tracker_of<PatternShape>("pattern", map)),
      tags_(tracker_of<TagShape>("tag", map)),
      on_ground_(std::move(on_ground)),
      noise_(noise) {}

tracking::PointTracker* Watcher::point_tracker(const Landmark& landmark) const {
  if (std::holds_alternative<PatternShape>(landmark.shape)) return patterns_.get();
  if (std::holds_alternative<TagShape>(landmark.shape)) return tags_.get();
  return nullptr;
}

std::optional<tracking::EllipsePrediction> Watcher::predict(const Shot& shot, const Belief& belief,
                                                            const Landmark& landmark) const {
  const auto image = expected_image(shot, belief, landmark, on_ground_);
  const auto model =
      localization::predict_disc(outline_of(landmark), shot, on_ground_, belief.pose, {});
  if (!image || !model) return std::nullopt;
  const double angle =
      noise_.look_angle * noise_.look_angle + noise_.reading_angle * noise_.reading_angle;
  const Eigen::Vector3d bias(angle, angle, noise_.look_focal * noise_.look_focal);
  const Eigen::Matrix3d covariance =
      model->dz_dpose * belief.covariance * model->dz_dpose.transpose() +
      model->dz_dbias * bias.asDiagonal() * model->dz_dbias.transpose();
  tracking::EllipsePrediction prediction;
  prediction.ellipse = *image;
  prediction.centre_covariance = covariance.topLeftCorner<2, 2>() + Eigen::Matrix2d::Identity();
  prediction.scale_sigma = std::sqrt(covariance(2, 2) + 0.02 * 0.02);
  return prediction;
}

std::optional<tracking::PointsPrediction> Watcher::predict_points(
    const Shot& shot, const Belief& belief, const Landmark& landmark,
    const tracking::EllipsePrediction& outline) const {
  const Eigen::Isometry3d wMc = on_ground_.wMc(shot.camera, shot.head, belief.pose);
  const Eigen::Isometry3d cMl = wMc.inverse(Eigen::Isometry) * landmark.wMl;
  tracking::PointsPrediction prediction;
  prediction.landmark = landmark.id;
  for (const auto& point : localization::landmark_points(landmark)) {
    const auto image = localization::predict_point(point, pinhole(shot), cMl);
    if (image) prediction.points.push_back({point.label, image->uv, Eigen::Matrix2d::Identity()});
  }
  if (prediction.points.empty()) return std::nullopt;
  prediction.covariance = outline.centre_covariance;
  prediction.scale_sigma = outline.scale_sigma;
  return prediction;
}

Sighting Watcher::watch(const imaging::Frame& frame, servo::TrackRequest request, const Shot& shot,
                        const Belief& belief, const Landmark& landmark) {
  const auto outline = predict(shot, belief, landmark);
  Sighting sighting;
  std::optional<Eigen::Vector2d> moved;
  if (outline) {
    sighting.predicted = outline->ellipse;
    if (settled_) moved = Eigen::Vector2d(outline->ellipse.u, outline->ellipse.v) - *settled_;
  }
  if (tracking::PointTracker* tracker = point_tracker(landmark)) {
    const auto points = outline ? predict_points(shot, belief, landmark, *outline) : std::nullopt;
    const auto feature = watch_points(*tracker, frame, request, points, moved);
    sighting.status = feature.status;
    if (feature.status == tracking::FeatureStatus::found && feature.landmark)
      sighting.observation = observed(feature, shot, landmark.id);
    return sighting;
  }
  const auto feature = watch_disc(frame, request, outline, moved);
  sighting.status = feature.status;
  if (feature.status == tracking::FeatureStatus::found)
    sighting.observation =
        EllipseObservation{shot, landmark.id, feature.ellipse, feature.covariance};
  return sighting;
}

tracking::EllipseFeature Watcher::watch_disc(
    const imaging::Frame& frame, servo::TrackRequest request,
    const std::optional<tracking::EllipsePrediction>& prediction,
    const std::optional<Eigen::Vector2d>& moved) {
  canvas_.attach(frame);
  if (request == servo::TrackRequest::track) {
    if (moved) tracker_->expect_motion(*moved);
    return tracker_->track(canvas_);
  }
  return prediction ? tracker_->acquire(canvas_, *prediction) : tracking::EllipseFeature{};
}

tracking::PointsFeature Watcher::watch_points(
    tracking::PointTracker& tracker, const imaging::Frame& frame, servo::TrackRequest request,
    const std::optional<tracking::PointsPrediction>& prediction,
    const std::optional<Eigen::Vector2d>& moved) {
  if (request == servo::TrackRequest::track) {
    if (moved) tracker.expect_motion(*moved);
    return tracker.track(frame);
  }
  return prediction ? tracker.acquire(frame, *prediction) : tracking::PointsFeature{};
}

void Watcher::settle(const Shot& shot, const Belief& belief, const Landmark& landmark) {
  const auto image = expected_image(shot, belief, landmark, on_ground_);
  settled_ = image ? std::optional(Eigen::Vector2d(image->u, image->v)) : std::nullopt;
}

std::optional<ImageMotion> Watcher::motion(const Shot& from, const Belief& belief_from,
                                           const Shot& to, const Belief& belief_to,
                                           const Landmark& landmark) const {
  const auto first = expected_image(from, belief_from, landmark, on_ground_);
  const auto second = expected_image(to, belief_to, landmark, on_ground_);
  if (!first || !second) return std::nullopt;
  return ImageMotion{{second->u - first->u, second->v - first->v}, second->a / first->a};
}

std::vector<PointsObservation> Watcher::survey_points(const imaging::Frame& frame,
                                                      const Shot& shot) {
  std::vector<PointsObservation> observations;
  for (tracking::PointTracker* tracker : {patterns_.get(), tags_.get()}) {
    if (tracker == nullptr) continue;
    for (const auto& feature : tracker->find_all(frame))
      if (feature.status == tracking::FeatureStatus::found && feature.landmark)
        observations.push_back(observed(feature, shot, std::nullopt));
  }
  return observations;
}

std::vector<EllipseObservation> Watcher::survey(const imaging::Frame& frame, const Shot& shot) {
  canvas_.attach(frame);
  std::vector<EllipseObservation> observations;
  for (const auto& feature : tracker_->find_all(canvas_)) {
    EllipseObservation observation;
    observation.shot = shot;
    observation.ellipse = feature.ellipse;
    observation.covariance = feature.covariance;
    observations.push_back(observation);
  }
  return observations;
}

}  // namespace vigia::mission

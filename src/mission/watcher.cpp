#include "watcher.hpp"

#include "vigia/localization/disc_model.hpp"

namespace vigia::mission {
namespace {

std::optional<Ellipse> expected_image(const SensorSnapshot& sensor, const Belief& belief,
                                      const Landmark& landmark, const HeadGeometry& head) {
  const Eigen::Isometry3d wMc = to_isometry(belief.pose) * camera_in_base(head, sensor.head);
  return localization::disc_image(landmark, sensor.intrinsics, wMc);
}

}  // namespace

Watcher::Watcher(const std::string& tracker, HeadGeometry head, SensorNoise noise)
    : tracker_(tracking::make_ellipse_tracker(tracker)), head_(std::move(head)), noise_(noise) {}

std::optional<tracking::EllipsePrediction> Watcher::predict(const SensorSnapshot& sensor,
                                                            const Belief& belief,
                                                            const Landmark& landmark) const {
  const auto image = expected_image(sensor, belief, landmark, head_);
  const auto model = localization::predict_disc(landmark, sensor, head_, belief.pose, {});
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

Sighting Watcher::watch(const imaging::Frame& frame, servo::TrackRequest request,
                        const SensorSnapshot& sensor, const Belief& belief,
                        const Landmark& landmark) {
  const auto prediction = predict(sensor, belief, landmark);
  Sighting sighting;
  if (prediction) sighting.predicted = prediction->ellipse;
  canvas_.attach(frame);
  tracking::EllipseFeature feature;
  if (request == servo::TrackRequest::track) {
    if (prediction && settled_)
      tracker_->expect_motion(Eigen::Vector2d(prediction->ellipse.u, prediction->ellipse.v) -
                              *settled_);
    feature = tracker_->track(canvas_);
  } else if (prediction) {
    feature = tracker_->acquire(canvas_, *prediction);
  }
  sighting.status = feature.status;
  if (feature.status == tracking::FeatureStatus::found)
    sighting.observation =
        EllipseObservation{sensor, landmark.id, feature.ellipse, feature.covariance};
  return sighting;
}

void Watcher::settle(const SensorSnapshot& sensor, const Belief& belief, const Landmark& landmark) {
  const auto image = expected_image(sensor, belief, landmark, head_);
  settled_ = image ? std::optional(Eigen::Vector2d(image->u, image->v)) : std::nullopt;
}

std::optional<ImageMotion> Watcher::motion(const SensorSnapshot& from, const Belief& belief_from,
                                           const SensorSnapshot& to, const Belief& belief_to,
                                           const Landmark& landmark) const {
  const auto first = expected_image(from, belief_from, landmark, head_);
  const auto second = expected_image(to, belief_to, landmark, head_);
  if (!first || !second) return std::nullopt;
  return ImageMotion{{second->u - first->u, second->v - first->v}, second->a / first->a};
}

std::vector<EllipseObservation> Watcher::survey(const imaging::Frame& frame,
                                                const SensorSnapshot& sensor) {
  canvas_.attach(frame);
  std::vector<EllipseObservation> observations;
  for (const auto& feature : tracker_->find_all(canvas_)) {
    EllipseObservation observation;
    observation.sensor = sensor;
    observation.ellipse = feature.ellipse;
    observation.covariance = feature.covariance;
    observations.push_back(observation);
  }
  return observations;
}

}  // namespace vigia::mission

#include "landmark_eye.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "vigia/core/belief_on_ground.hpp"
#include "vigia/core/overloaded.hpp"
#include "vigia/localization/disc_model.hpp"
#include "vigia/localization/points_model.hpp"
#include "vigia/perception/landmark_image.hpp"

namespace vigia::perception {
namespace {

/// The tracker for landmarks of one shape; null when the map has none.
template <typename Shape>
std::unique_ptr<tracking::PointTracker> tracker_of(const std::string& name,
                                                   const LandmarkMap& map) {
  const auto& all = map.all();
  const bool needed = std::any_of(all.begin(), all.end(), [](const Landmark& landmark) {
    return std::holds_alternative<Shape>(landmark.shape);
  });
  return needed ? tracking::make_point_tracker(name, {false, map}) : nullptr;
}

std::optional<tracking::PointsPrediction> predict_points(
    const Shot& shot, const Belief& belief, const Landmark& landmark, const RigOnGround& on_ground,
    const tracking::EllipsePrediction& outline) {
  const Eigen::Isometry3d wMc =
      believed_wMr(belief, on_ground.ground) * on_ground.rig.at(shot.camera).rMc(shot.head);
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

tracking::PointsFeature find_points(tracking::PointTracker& tracker, const imaging::Frame& frame,
                                    TrackRequest request,
                                    const std::optional<tracking::PointsPrediction>& prediction,
                                    const std::optional<Eigen::Vector2d>& moved) {
  if (request == TrackRequest::track) {
    if (moved) tracker.expect_motion(*moved);
    return tracker.track(frame);
  }
  return prediction ? tracker.acquire(frame, *prediction) : tracking::PointsFeature{};
}

PointsObservation observed(const tracking::PointsFeature& feature, const Shot& shot,
                           std::optional<LandmarkId> expected) {
  return {shot, expected, *feature.landmark, feature.points, feature.confidence};
}

/// Leaves out discs so small that their size is measured a per cent too small: where nobody brings
/// them to a size by a zoom, the same error comes in every image.
void drop_small_discs(std::vector<Observation>& observations) {
  constexpr double kMinAxis_px = 4.5;
  const auto small = [](const Observation& observation) {
    const auto* disc = std::get_if<EllipseObservation>(&observation);
    return disc != nullptr && disc->ellipse.b < kMinAxis_px;
  };
  observations.erase(std::remove_if(observations.begin(), observations.end(), small),
                     observations.end());
}

/// Centre, and of an ellipse its axes, of other features their radius.
void append_feature(std::string& line, const Observation& seen) {
  const auto out = std::back_inserter(line);
  if (const auto* disc = std::get_if<EllipseObservation>(&seen)) {
    const Ellipse& e = disc->ellipse;
    fmt::format_to(out, ",{:.4f},{:.4f},{:.4f},{:.4f},{:.5f}", e.u, e.v, e.a, e.b, e.psi);
    return;
  }
  const ImageExtent extent = image_extent(seen);
  fmt::format_to(out, ",{:.4f},{:.4f},{:.4f},,", extent.centre.x(), extent.centre.y(),
                 extent.radius_px);
}

}  // namespace

LandmarkEye::LandmarkEye(const EyeParts& parts)
    : landmarks_(parts.landmarks),
      on_ground_(parts.on_ground),
      directed_(parts.directed),
      noise_(parts.noise),
      discs_(tracking::make_ellipse_tracker(parts.tracker)),
      patterns_(tracker_of<PatternShape>("pattern", parts.landmarks)),
      tags_(tracker_of<TagShape>("tag", parts.landmarks)) {}

std::vector<Observation> LandmarkEye::observe(const Capture& capture, const Belief& then,
                                              const std::optional<GazeRequest>& request) {
  last_ = {};
  if (!directed_) {
    last_.observations = survey(capture);
    drop_small_discs(last_.observations);
    last_.status = last_.observations.empty() ? tracking::FeatureStatus::not_found
                                              : tracking::FeatureStatus::found;
  } else if (!request) {
    target_ = {};
  } else {
    last_ = follow(capture, then, request->track, *landmarks_.find(request->landmark));
  }
  return last_.observations;
}

LandmarkEye::Sighting LandmarkEye::follow(const Capture& capture, const Belief& then,
                                          TrackRequest request, const Landmark& landmark) {
  Sighting sighting;
  const auto outline = predict(capture.shot, then, landmark);
  std::optional<Eigen::Vector2d> moved;
  if (outline) {
    sighting.predicted = outline->ellipse;
    if (target_.settled)
      moved = Eigen::Vector2d(outline->ellipse.u, outline->ellipse.v) - *target_.settled;
  }
  target_ = {&landmark, capture.shot, std::nullopt};

  if (tracking::PointTracker* tracker = point_tracker(landmark)) {
    const auto points =
        outline ? predict_points(capture.shot, then, landmark, on_ground_, *outline) : std::nullopt;
    const auto feature = find_points(*tracker, capture.frame, request, points, moved);
    sighting.status = feature.status;
    if (feature.status == tracking::FeatureStatus::found && feature.landmark)
      sighting.observations.emplace_back(observed(feature, capture.shot, landmark.id));
    return sighting;
  }
  const auto feature = find_disc(capture.frame, request, outline, moved);
  sighting.status = feature.status;
  if (feature.status == tracking::FeatureStatus::found)
    sighting.observations.emplace_back(
        EllipseObservation{capture.shot, landmark.id, feature.ellipse, feature.covariance});
  return sighting;
}

std::optional<tracking::EllipsePrediction> LandmarkEye::predict(const Shot& shot,
                                                                const Belief& belief,
                                                                const Landmark& landmark) const {
  const auto image =
      expected_image(shot, believed_wMr(belief, on_ground_.ground), landmark, on_ground_.rig);
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

tracking::PointTracker* LandmarkEye::point_tracker(const Landmark& landmark) const {
  using Tracker = tracking::PointTracker*;
  return std::visit(Overloaded{[](const DiscShape&) -> Tracker { return nullptr; },
                               [this](const PatternShape&) -> Tracker { return patterns_.get(); },
                               [this](const TagShape&) -> Tracker { return tags_.get(); }},
                    landmark.shape);
}

tracking::EllipseFeature LandmarkEye::find_disc(
    const imaging::Frame& frame, TrackRequest request,
    const std::optional<tracking::EllipsePrediction>& prediction,
    const std::optional<Eigen::Vector2d>& moved) {
  canvas_.attach(frame);
  if (request == TrackRequest::track) {
    if (moved) discs_->expect_motion(*moved);
    return discs_->track(canvas_);
  }
  return prediction ? discs_->acquire(canvas_, *prediction) : tracking::EllipseFeature{};
}

void LandmarkEye::settle(const Belief& then) {
  if (target_.landmark == nullptr) return;
  const auto image = expected_image(target_.shot, believed_wMr(then, on_ground_.ground),
                                    *target_.landmark, on_ground_.rig);
  if (image) target_.settled = Eigen::Vector2d(image->u, image->v);
}

std::vector<Observation> LandmarkEye::survey(const Capture& capture) {
  std::vector<Observation> observations;
  canvas_.attach(capture.frame);
  for (const auto& feature : discs_->find_all(canvas_))
    observations.emplace_back(
        EllipseObservation{capture.shot, std::nullopt, feature.ellipse, feature.covariance});
  for (tracking::PointTracker* tracker : {patterns_.get(), tags_.get()}) {
    if (tracker == nullptr) continue;
    for (const auto& feature : tracker->find_all(capture.frame))
      if (feature.status == tracking::FeatureStatus::found && feature.landmark)
        observations.emplace_back(observed(feature, capture.shot, std::nullopt));
  }
  return observations;
}

std::vector<std::string> LandmarkEye::columns() const {
  return {"feature", "u_px", "v_px", "a_px", "b_px", "psi_rad"};
}

void LandmarkEye::append_cells(std::string& line) const {
  line += ',';
  if (last_.status) line += tracking::to_string(*last_.status);
  if (last_.observations.empty())
    line += ",,,,,";
  else
    append_feature(line, last_.observations.front());
}

imaging::Overlay LandmarkEye::overlay() const {
  imaging::Overlay overlay;
  overlay.predicted = last_.predicted;
  for (const Observation& observation : last_.observations) {
    const Intrinsics& camera = pinhole(shot_of(observation));
    overlay.principal_point = Eigen::Vector2d(camera.u0, camera.v0);
    const auto* disc = std::get_if<EllipseObservation>(&observation);
    if (disc != nullptr && !overlay.measured)
      overlay.measured = disc->ellipse;
    else if (disc != nullptr)
      overlay.points.emplace_back(disc->ellipse.u, disc->ellipse.v);
    if (const auto* seen = std::get_if<PointsObservation>(&observation))
      for (const LabelledPoint& point : seen->points) overlay.points.push_back(point.uv);
  }
  return overlay;
}

}  // namespace vigia::perception

#pragma once

#include <memory>
#include <optional>

#include "vigia/core/belief.hpp"
#include "vigia/core/landmark.hpp"
#include "vigia/core/rig.hpp"
#include "vigia/core/sensor_noise.hpp"
#include "vigia/imaging/canvas.hpp"
#include "vigia/servo/gaze_controller.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::mission {

/// What the tracker found in a frame, and what was expected of it.
struct Sighting {
  tracking::FeatureStatus status = tracking::FeatureStatus::not_found;
  std::optional<Observation> observation;  ///< when found
  std::optional<Ellipse> predicted;        ///< outline
};

/// How a landmark's image moves between two instants, as the belief has it.
struct ImageMotion {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< px
  double growth = 1.0;                              ///< of the semi-major axis
};

/// Turns the gaze's request into a call of the tracker: predicts the landmark's image from the
/// belief and carries the expected motion from frame to frame.
class Watcher {
 public:
  /// @p tracker: of discs. Patterns and tags of @p map have their own.
  Watcher(const std::string& tracker, const LandmarkMap& map, RigOnGround on_ground,
          SensorNoise noise);

  /// Acquires or tracks @p landmark in @p frame. @p request is not none.
  Sighting watch(const imaging::Frame& frame, servo::TrackRequest request, const Shot& shot,
                 const Belief& belief, const Landmark& landmark);

  /// Remembers where the belief, after this tick's update, puts the landmark: the next frame's
  /// expected motion counts from there.
  void settle(const Shot& shot, const Belief& belief, const Landmark& landmark);

  /// What became of the landmark's image from one instant to another; nothing when it has none.
  std::optional<ImageMotion> motion(const Shot& from, const Belief& belief_from, const Shot& to,
                                    const Belief& belief_to, const Landmark& landmark) const;

  /// Every disc of a whole frame, as observations of unknown identity.
  std::vector<EllipseObservation> survey(const imaging::Frame& frame, const Shot& shot);

  /// Every pattern and tag of the map that a whole frame shows.
  std::vector<PointsObservation> survey_points(const imaging::Frame& frame, const Shot& shot);

 private:
  tracking::PointTracker* point_tracker(const Landmark& landmark) const;
  tracking::EllipseFeature watch_disc(const imaging::Frame& frame, servo::TrackRequest request,
                                      const std::optional<tracking::EllipsePrediction>& prediction,
                                      const std::optional<Eigen::Vector2d>& moved);
  static tracking::PointsFeature watch_points(
      tracking::PointTracker& tracker, const imaging::Frame& frame, servo::TrackRequest request,
      const std::optional<tracking::PointsPrediction>& prediction,
      const std::optional<Eigen::Vector2d>& moved);
  std::optional<tracking::PointsPrediction> predict_points(
      const Shot& shot, const Belief& belief, const Landmark& landmark,
      const tracking::EllipsePrediction& outline) const;
  std::optional<tracking::EllipsePrediction> predict(const Shot& shot, const Belief& belief,
                                                     const Landmark& landmark) const;

  std::unique_ptr<tracking::EllipseTracker> tracker_;
  std::unique_ptr<tracking::PointTracker> patterns_;  ///< null when the map has none
  std::unique_ptr<tracking::PointTracker> tags_;      ///< null when the map has none
  RigOnGround on_ground_;
  SensorNoise noise_;
  imaging::Canvas canvas_;
  std::optional<Eigen::Vector2d> settled_;
};

}  // namespace vigia::mission

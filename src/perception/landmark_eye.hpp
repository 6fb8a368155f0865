#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vigia/imaging/canvas.hpp"
#include "vigia/perception/eye.hpp"
#include "vigia/tracking/ellipse_tracker.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::perception {

/// Observes the map's discs, patterns and tags. Directed, it acquires and tracks the landmark that
/// is asked for: it predicts the landmark's image from the belief and carries the expected motion
/// from capture to capture. Not directed, it searches every capture for all of them.
class LandmarkEye : public Eye {
 public:
  explicit LandmarkEye(const EyeParts& parts);

  std::string_view name() const override { return "landmark"; }
  std::vector<Observation> observe(const Capture& capture, const Belief& then,
                                   const std::optional<GazeRequest>& request) override;
  void settle(const Belief& then) override;
  std::vector<Observation> survey(const Capture& capture) override;

  std::vector<std::string> columns() const override;
  void append_cells(std::string& line) const override;
  imaging::Overlay overlay() const override;

 private:
  /// What became of the last capture.
  struct Sighting {
    std::optional<tracking::FeatureStatus> status;  ///< when the tracker was asked
    std::optional<Ellipse> predicted;               ///< outline of the landmark that was asked for
    std::vector<Observation> observations;
  };
  /// The landmark that was asked for last, and where the belief puts its image.
  struct Target {
    const Landmark* landmark = nullptr;
    Shot shot;
    std::optional<Eigen::Vector2d> settled;
  };

  Sighting follow(const Capture& capture, const Belief& then, TrackRequest request,
                  const Landmark& landmark);
  tracking::EllipseFeature find_disc(const imaging::Frame& frame, TrackRequest request,
                                     const std::optional<tracking::EllipsePrediction>& prediction,
                                     const std::optional<Eigen::Vector2d>& moved);
  tracking::PointTracker* point_tracker(const Landmark& landmark) const;
  std::optional<tracking::EllipsePrediction> predict(const Shot& shot, const Belief& belief,
                                                     const Landmark& landmark) const;

  const LandmarkMap& landmarks_;
  RigOnGround on_ground_;
  bool directed_;
  SensorNoise noise_;
  std::unique_ptr<tracking::EllipseTracker> discs_;
  std::unique_ptr<tracking::PointTracker> patterns_;  ///< null when the map has none
  std::unique_ptr<tracking::PointTracker> tags_;      ///< null when the map has none
  imaging::Canvas canvas_;
  Target target_;
  Sighting last_;
};

}  // namespace vigia::perception

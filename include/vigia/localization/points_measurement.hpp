#pragma once

#include <optional>
#include <vector>

#include "vigia/core/observation.hpp"
#include "vigia/localization/measurement.hpp"
#include "vigia/localization/points_model.hpp"

namespace vigia::localization {

/// An image of a landmark that says who it is: a pattern's dots or a tag's corners.
struct PointsMatch {
  Shot shot;
  Landmark landmark;
  std::vector<SeenPoint> points;  ///< at least one
};

/// Whether anything was seen at all.
bool is_usable(const PointsObservation& observation);

/// Whether the points are where the state expects those of the landmark that they name. The state
/// is first moved to the most likely one given both (iterated update: near a landmark the first
/// linearisation is not enough). Two tests there: the innovation of what the points say about the
/// state (its NIS is the result's), and the scatter of the points about it. `gated` when the
/// landmark is not of the map, `degenerate` without usable points or without an image. @p state
/// carries the biases of the observation's look.
AssociationOf<PointsMatch> associate(const MeasurementModel& model,
                                     const PointsObservation& observation, const LookState& state);

/// The points as those of @p landmark; nothing when none of them is.
std::optional<PointsMatch> match(const MeasurementModel& model,
                                 const PointsObservation& observation, const Landmark& landmark);

/// The points, compressed to six numbers, about @p at. Nothing where one of them has no image.
std::optional<Linearised<6>> linearise(const MeasurementModel& model, const PointsMatch& match,
                                       const Vector6& at);

/// ln p(pixels | pose), the look's biases marginalised to first order. Nothing when the landmark is
/// not of the map or has no image from there.
std::optional<double> log_likelihood(const MeasurementModel& model,
                                     const PointsObservation& observation, const Pose2& pose);

}  // namespace vigia::localization

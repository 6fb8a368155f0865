#pragma once

#include <optional>

#include "vigia/core/observation.hpp"
#include "vigia/localization/measurement.hpp"

namespace vigia::localization {

/// An image of a disc whose landmark is known.
struct DiscMatch {
  Shot shot;
  Landmark landmark;
  Eigen::Vector3d z;  ///< as measured_disc()
  Eigen::Matrix3d R;  ///< of z in the image; the white part of the readings comes on top
};

/// Whether the ellipse is one that can be measured with: positive axes, finite covariance.
bool is_usable(const EllipseObservation& observation);

/// The landmark that the ellipse shows: of those whose predicted image lies within the gate of the
/// measured (u, v, s) and that no wall hides, the one that is likelier than any other by
/// ambiguity_ratio (Armingol §5). Discs look all alike: the landmark that a look expects has no
/// privilege. `degenerate` when none has an image, `gated` when none is near, `ambiguous` when
/// several are. @p state carries the biases of the observation's look.
AssociationOf<DiscMatch> associate(const MeasurementModel& model,
                                   const EllipseObservation& observation, const LookState& state);

/// The ellipse as the image of @p landmark; nothing when that is no disc.
std::optional<DiscMatch> match(const MeasurementModel& model, const EllipseObservation& observation,
                               const Landmark& landmark);

/// (u, v, ln √(ab)) about @p at. Nothing where the disc has no image.
std::optional<Linearised<3>> linearise(const MeasurementModel& model, const DiscMatch& match,
                                       const Vector6& at);

/// ln p(u, v, s | pose) of the likeliest landmark that no wall hides, the look's biases
/// marginalised. Nothing where no landmark has an image.
std::optional<double> log_likelihood(const MeasurementModel& model,
                                     const EllipseObservation& observation, const Pose2& pose);

}  // namespace vigia::localization

#pragma once

#include <optional>

#include <Eigen/Core>

#include "vigia/core/landmark.hpp"
#include "vigia/core/pose.hpp"

namespace vigia {

/// What one look would teach: the seam through which a planner asks localization without knowing
/// its models.
class InformationModel {
 public:
  virtual ~InformationModel() = default;

  /// Fisher information on (x, y, θ) of one look at @p landmark from @p pose with the zoom that the
  /// look would use, per-look errors marginalised; nothing when the landmark has no image there.
  virtual std::optional<Eigen::Matrix3d> look_information(const Landmark& landmark,
                                                          const Pose2& pose) const = 0;
};

}  // namespace vigia

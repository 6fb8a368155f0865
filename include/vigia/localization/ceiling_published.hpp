#pragma once

#include <optional>
#include <vector>

#include "vigia/localization/ceiling_model.hpp"

namespace vigia::localization {

/// Chonbuk §II and §IV: the patch nearest the image's middle, whose cell is that of nine neighbours
/// which puts the robot nearest to where it was; and the fusion with optical flow by a threshold.
class CeilingPublished {
 public:
  /// @p threshold_m is fig. 8's Th; nothing: landmarks alone.
  CeilingPublished(const CeilingCamera& camera, const CeilingGrid& grid,
                   std::optional<double> threshold_m = std::nullopt)
      : camera_(camera), grid_(grid), threshold_m_(threshold_m) {}

  /// The initial position is given.
  void reset(const Pose2& pose);
  /// One frame. @p flow: the motion since the last frame by optical flow, where there is one.
  void update(const std::vector<PatchImage>& patches, const std::optional<Pose2>& flow = {});
  const Pose2& pose() const { return pose_; }

 private:
  struct Fix {
    Pose2 pose;
    CeilingCell cell;
  };
  std::optional<Fix> landmark_fix(const std::vector<PatchImage>& patches) const;

  CeilingCamera camera_;
  CeilingGrid grid_;
  std::optional<double> threshold_m_;
  Pose2 pose_;
  CeilingCell cell_;
};

}  // namespace vigia::localization

#pragma once

#include <optional>
#include <string>

#include "vigia/core/camera.hpp"
#include "vigia/imaging/picture_source.hpp"
#include "vigia/perception/ceiling_follower.hpp"
#include "vigia/tracking/patch_finder.hpp"

namespace vigia::app {

/// Patches of a ceiling in pictures one after the other, and where the camera is calibrated its
/// pose under the grid.
class CeilingTrack {
 public:
  explicit CeilingTrack(const tracking::PatchFinderParams& params);
  /// @p rate_hz: of pictures that have no time of their own.
  CeilingTrack(const perception::CeilingView& view, double rate_hz);

  bool gives_poses() const { return view_.has_value(); }
  const std::optional<perception::CeilingView>& view() const { return view_; }

  struct Row {
    tracking::PatchScan scan;
    std::string pose;  ///< the fields of pose_header(), where it gives poses
  };
  /// @p number counts the pictures, from 1.
  Row next(const imaging::Picture& picture, int number);

  static std::string pose_header();

 private:
  std::string pose_fields(const perception::CeilingFollower::Step& step) const;

  tracking::PatchFinder finder_;
  double rate_hz_ = 25.0;
  std::optional<perception::CeilingView> view_;
  std::optional<perception::CeilingFollower> follower_;
};

}  // namespace vigia::app

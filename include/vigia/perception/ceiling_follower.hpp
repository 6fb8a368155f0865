#pragma once

#include <optional>

#include <visp3/core/vpImage.h>

#include "vigia/core/ceiling_grid.hpp"
#include "vigia/localization/ceiling_filter.hpp"
#include "vigia/tracking/patch_finder.hpp"
#include "vigia/tracking/plane_flow.hpp"

namespace vigia::perception {

/// A camera under a patched ceiling.
struct CeilingView {
  Intrinsics camera;
  double rise_m = 2.2;         ///< from the camera to the ceiling
  CeilingGrid grid;            ///< its height counts for nothing
  double tilt_sigma = 0.0;     ///< rad, of the camera from the vertical, about either axis
  double height_sigma = 0.0;   ///< of rise_m, relative
  double max_speed_mps = 1.5;  ///< where neither patches nor flow tell the motion
};

/// How large the finder's patches are in the pictures of such a camera.
tracking::PatchFinderParams finder_of(const CeilingView& view);

/// Follows a camera by the ceiling alone: patches, and the motion of its edges between them. The
/// grid has no identities: the cell of the first patch that is seen (of several the one nearest to
/// the picture's middle) is (0, 0), and its direction the grid's x; of patches without polarity
/// mark, that way round in which the camera's u points along x. Camera frame and the robot's have
/// the same axes: x where u grows, y where v grows, z up; the world's handedness is theirs.
class CeilingFollower {
 public:
  /// @p about: what the filter takes the camera's errors for at the start.
  explicit CeilingFollower(const CeilingView& view,
                           const localization::CeilingCameraErrors& about = {});

  /// What a picture shows.
  struct Sight {
    Stamp stamp;
    tracking::PatchScan scan;
    std::optional<ImageShift> motion;  ///< since the picture before
  };
  /// Looks at the next picture and does not yet follow it.
  Sight look(const vpImage<unsigned char>& picture, Stamp stamp);

  /// What a picture tells.
  struct Step {
    tracking::PatchScan scan;
    bool flow = false;  ///< whether it was matched to the picture before
    std::optional<localization::CeilingUpdate> update;  ///< nothing until a patch has been seen
  };
  Step follow(const Sight& sight);
  Step next(const vpImage<unsigned char>& picture, Stamp stamp) {
    return follow(look(picture, stamp));
  }

  /// Nothing until a patch has been seen.
  std::optional<Belief> belief() const;
  /// What its patches have said of tilt (rad) and height (relative) so far, and the covariance.
  /// What patches' images err by alike in every frame, which the filter takes for noise, is part of
  /// it.
  localization::CeilingCameraErrors camera_errors() const { return filter_.camera_errors(); }
  Eigen::Matrix3d camera_errors_covariance() const;

 private:
  bool begin(const tracking::PatchScan& scan, Stamp stamp);

  localization::CeilingCamera camera_;
  CeilingGrid grid_;
  localization::CeilingCameraErrors about_;
  tracking::PatchFinder finder_;
  tracking::FrameFlow flow_;
  localization::CeilingFilter filter_;
  double start_tilt_m_;  ///< what a tilt moves the first patch by, σ
  bool begun_ = false;
};

}  // namespace vigia::perception

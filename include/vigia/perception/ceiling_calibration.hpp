#pragma once

#include <vector>

#include "vigia/perception/ceiling_follower.hpp"

namespace vigia::perception {

/// Tilt and height of a camera by what a drive under a patched ceiling showed. A filter takes each
/// picture's patches as they are from where it believes the camera's errors to be at that time; of
/// the first pictures that is the mounting as it was known, and the second order of a tilt of
/// degrees is many times what a patch's image errs by. The pictures' patches are therefore kept and
/// gone through again, linearised at what the drive has told (an iterated smoother's last pass).
class CeilingCalibration {
 public:
  explicit CeilingCalibration(const CeilingView& view);

  /// The picture is followed with what is known by then, and what it tells is kept.
  CeilingFollower::Step next(const vpImage<unsigned char>& picture, Stamp stamp);

  struct Result {
    localization::CeilingCameraErrors errors;  ///< tilts, rad, and log of the height
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< prior included
  };
  /// By all pictures so far; before the first with a patch the prior.
  Result result() const;

 private:
  CeilingView view_;
  CeilingFollower follower_;
  std::vector<CeilingFollower::Sight> sights_;
};

}  // namespace vigia::perception

#pragma once

#include <map>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/mission/listener.hpp"

namespace vigia::app {

/// The pictures of a robot's cameras side by side, each with what its eye made of it: black until
/// the first comes, then the last that came.
class CameraWall {
 public:
  /// Even in width and height, as videos are.
  explicit CameraWall(const mission::MissionSetup& setup);

  /// Shows a picture that has come.
  void show(const mission::Tick& tick, const mission::EyeTick& shown);
  const vpImage<vpRGBa>& picture() const { return picture_; }

 private:
  std::map<CameraId, unsigned> left_;  ///< column at which a camera's picture begins
  vpImage<vpRGBa> picture_;
};

}  // namespace vigia::app

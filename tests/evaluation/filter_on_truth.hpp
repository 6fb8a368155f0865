#pragma once

#include "localization/drive.hpp"

#include <memory>

#include "vigia/localization/ekf.hpp"

namespace vigia::evaluation::test {

/// A filter at the drive's true start. With perfect odometry and perfect images it linearises where
/// the bound does.
inline std::unique_ptr<localization::EkfLocalizer> filter_on_truth(
    const localization::test::Drive& drive) {
  localization::EkfParams params;
  params.odometry = drive.noise.odometry;
  params.centre_floor_px = 0.0;
  params.size_floor = 0.0;
  const RigOnGround rig{head_rig(drive.geometry), {}};
  auto ekf = std::make_unique<localization::EkfLocalizer>(localization::test::room_landmarks(), rig,
                                                          params);
  ekf->reset({}, Prior{drive.start, drive.prior.covariance});
  return ekf;
}

}  // namespace vigia::evaluation::test

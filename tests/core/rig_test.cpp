#include "vigia/core/rig.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace vigia {
namespace {

Rig mixed_rig() {
  const ZoomCalibration zoom(640, 480, 319.5, 239.5, {{8.0, 700.0, 0.0}, {80.0, 7000.0, 0.0}});
  FixedMount mirror;
  mirror.rMc.translation() = Eigen::Vector3d(0.0, 0.0, 0.7);
  return {{{0, HeadGeometry{{0.1, 0.0, 1.0}, 0.2, {0.05, 0.01, 0.0}}, zoom},
           {4, mirror, CameraModel{UnifiedOmni{}}}}};
}

TEST(Rig, FindsACameraByItsId) {
  const Rig rig = mixed_rig();
  EXPECT_EQ(rig.find(4), &rig.cameras[1]);
  EXPECT_EQ(&rig.at(0), &rig.cameras[0]);
  EXPECT_EQ(rig.find(1), nullptr);
  EXPECT_THROW(rig.at(1), std::out_of_range);
}

TEST(Rig, TurnsTheCamerasOnTheHeadAndNoOthers) {
  const Rig rig = mixed_rig();
  const HeadAngles head{0.3, -0.1};
  const auto& geometry = std::get<HeadGeometry>(rig.at(0).mount);
  EXPECT_TRUE(rig.at(0).rMc(head).isApprox(camera_in_base(geometry, head), 1e-15));
  EXPECT_TRUE(rig.at(4).rMc(head).isApprox(rig.at(4).rMc({}), 1e-15));
}

TEST(Rig, ZoomsTheCamerasThatHaveAZoom) {
  const Rig rig = mixed_rig();
  EXPECT_DOUBLE_EQ(std::get<Intrinsics>(rig.at(0).model(80.0)).px, 7000.0);
  EXPECT_TRUE(std::holds_alternative<UnifiedOmni>(rig.at(4).model(80.0)));
}

TEST(Rig, DirectsTheFirstPinholeOnTheHeadWithAZoomOrWithout) {
  Rig rig = mixed_rig();
  EXPECT_EQ(directed_camera(rig), &rig.cameras[0]);
  rig.cameras[0].optics = CameraModel{Intrinsics{}};
  EXPECT_EQ(directed_camera(rig), &rig.cameras[0]);
  EXPECT_DOUBLE_EQ(zoom_calibration(rig.cameras[0].optics)->at(0.0).px, Intrinsics{}.px);
  rig.cameras[0].optics = CameraModel{UnifiedOmni{}};
  EXPECT_EQ(directed_camera(rig), nullptr);
  rig.cameras[0].optics = CameraModel{Intrinsics{}};
  rig.cameras[0].mount = FixedMount{};
  EXPECT_EQ(directed_camera(rig), nullptr);
}

}  // namespace
}  // namespace vigia

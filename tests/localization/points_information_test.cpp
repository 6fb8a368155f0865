#include "vigia/localization/points_information.hpp"

#include "localization/points_drive.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/localization/ekf.hpp"

namespace vigia::localization {
namespace {

const Pose2 kPointsPose{4.0, 3.0, 0.2};

PointsInformation points_information() {
  PointsInformationParams params;
  params.frames_per_look = 1.0;
  return PointsInformation({}, test::zoom_calibration(), params);
}

TEST(PointsInformation, EqualsWhatOneImageTeachesTheFilter) {
  for (const Landmark& landmark :
       {test::pattern(4, 6.0, 3.9, 1.5, 180.0), test::tag(4, 6.0, 3.9, 1.5, 180.0)}) {
    const auto information = points_information().look_information(landmark, kPointsPose);
    ASSERT_TRUE(information);
    EkfParams params;
    params.centre_floor_px = 0.0;
    EkfLocalizer ekf(LandmarkMap({landmark}), {}, params);
    const Eigen::Vector3d sigma(0.05, 0.05, from_deg(1.0));
    const Eigen::Matrix3d prior = sigma.cwiseAbs2().asDiagonal();
    ekf.reset({}, {kPointsPose, prior});
    Shot shot;
    shot.look = 1;
    shot.head = aim_at({}, to_isometry(kPointsPose).inverse() * landmark.centre_w());
    const double range =
        (to_isometry(kPointsPose) * Eigen::Vector3d(0.15, 0.0, 1.0) - landmark.centre_w()).norm();
    double reach = 0.0;
    for (const LandmarkPoint& point : landmark_points(landmark))
      reach = std::max(reach, point.centre_l.norm() + point.radius_m);
    const ZoomCalibration zoom = test::zoom_calibration();
    shot.model = zoom.at(zoom.zoom_for_focal(0.8 * 240.0 * range / reach));
    RandomStream random(1, "unused");
    PointsObservation seen =
        test::observe_points(landmark, shot, {}, to_isometry(kPointsPose), {}, 0.0, 0.0, random);
    for (LabelledPoint& point : seen.points) point.covariance = 0.01 * Eigen::Matrix2d::Identity();
    ASSERT_EQ(ekf.update(seen).status, UpdateStatus::fused);
    const Eigen::Matrix3d expected = (prior.inverse() + *information).inverse();
    EXPECT_LT((ekf.belief().covariance - expected).norm(), 1e-3 * expected.norm());
  }
}

TEST(PointsInformation, APatternTeachesMoreFromNearerAndNothingFromBehind) {
  const Landmark landmark = test::pattern(4, 6.0, 3.9, 1.5, 180.0);
  const auto near = points_information().look_information(landmark, {4.0, 3.0, 0.0});
  const auto far = points_information().look_information(landmark, {1.0, 1.65, 0.0});
  ASSERT_TRUE(near && far);
  EXPECT_GT(near->selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
  EXPECT_GT(near->determinant(), far->determinant());
  EXPECT_FALSE(points_information().look_information(landmark, {8.0, 3.0, 0.0}));
  EXPECT_FALSE(
      points_information().look_information(test::disc(1, 6.0, 3.9, 1.5, 180.0), kPointsPose));
}

TEST(LandmarkInformation, AsksTheModelOfTheShape) {
  const DiscInformation discs({}, test::zoom_calibration(), {});
  const LandmarkInformation both(discs, points_information());
  const Landmark disc = test::disc(1, 6.0, 3.9, 1.5, 180.0);
  const Landmark pattern = test::pattern(4, 6.0, 3.9, 1.5, 180.0);
  EXPECT_TRUE(both.look_information(disc, kPointsPose)
                  ->isApprox(*discs.look_information(disc, kPointsPose)));
  EXPECT_TRUE(both.look_information(pattern, kPointsPose)
                  ->isApprox(*points_information().look_information(pattern, kPointsPose)));
}

}  // namespace
}  // namespace vigia::localization

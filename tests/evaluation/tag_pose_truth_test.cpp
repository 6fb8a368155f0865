#include "tag_detector.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/localization/points_pose.hpp"
#include "vigia/tracking/point_tracker.hpp"

namespace vigia::evaluation {
namespace {

namespace fs = std::filesystem;
using localization::FittedPose;
using Corners = std::vector<LabelledPoint>;

// ViSP's picture of five rendered tags and their poses cMo_*: 700 px, principal point in the
// middle of the picture, 319.5 and 239.5 with integers at the pixels' centres. Frame o as vigia's
// frame l: x to the reader's right, y up, z towards the viewer. The sheet of tags 0–2 is 0.25 m
// wide, that of tags 3 and 4 half as wide.
const fs::path kFolder = "/usr/share/visp-images-data/ViSP-images/AprilTag/benchmark/640x480";
constexpr int kTagCount = 5;

Intrinsics camera() {
  Intrinsics intrinsics;
  intrinsics.px = intrinsics.py = 700.0;
  return intrinsics;
}

/// A tag of which the black square takes @p share of the sheet's width.
Landmark square(int tag, double share) {
  const double sheet = tag < 3 ? 0.25 : 0.125;
  return {1, Eigen::Isometry3d::Identity(), TagShape{tag, share * sheet}};
}
Landmark tag36h11(int tag) {
  return square(tag, 8.0 / 10.0);
}

Eigen::Isometry3d truth_of(int tag) {
  std::ifstream file(kFolder / ("cMo_" + std::to_string(tag) + ".txt"));
  Eigen::Isometry3d cMo;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) file >> cMo.matrix()(row, column);
  return cMo;
}

FittedPose pose_of(const Landmark& landmark, const Corners& corners) {
  PointsObservation observation;
  observation.points = corners;
  const auto pose =
      localization::solve_points(localization::seen_points(landmark, observation), camera());
  EXPECT_EQ(pose.status, localization::PointsPoseStatus::solved);
  return pose.pose;
}

/// How far a pose lies from another: of the centre, mm, and of the orientation, degrees.
struct Distance {
  Distance(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
    const localization::PoseVector delta = localization::move_between(from, to);
    mm = 1e3 * delta.head<3>().norm();
    deg = to_deg(delta.tail<3>().norm());
  }
  double mm;
  double deg;
};

/// The same corners, each with standard deviation @p sigma_px on both axes.
Corners with_sigma(Corners corners, double sigma_px) {
  for (LabelledPoint& corner : corners)
    corner.covariance = sigma_px * sigma_px * Eigen::Matrix2d::Identity();
  return corners;
}

struct TagPoseAgainstViSP : ::testing::Test {
  void SetUp() override {
    if (!fs::exists(kFolder)) GTEST_SKIP() << "visp-images-data is not installed";
    const imaging::ImageFrame picture = imaging::read_image(kFolder / "tag36_11_640x480.png");
    for (const auto& feature : tracking::make_point_tracker("tag", {})->find_all(picture))
      refined[std::get<int>(*feature.code)] = feature.points;
    vpImage<unsigned char> image(480, 640);
    picture.read_grey(picture.full(), image.bitmap, picture.full().width);
    for (const auto& seen : tracking::TagDetector("36h11", 1.0, 1).detect(image)) {
      detected[seen.tag] = refined.at(seen.tag);
      for (std::size_t k = 0; k < 4; ++k) detected[seen.tag][k].uv = seen.corners[k];
    }
    ASSERT_EQ(refined.size(), static_cast<std::size_t>(kTagCount));
    ASSERT_EQ(detected.size(), refined.size());
  }

  std::map<int, Corners> refined;   ///< vigia's corners
  std::map<int, Corners> detected;  ///< libapriltag's, with the refined ones' covariances
};

// Five squares in perspective, two degrees of freedom each: 10, and a thousandth lies beyond 29.6.
TEST_F(TagPoseAgainstViSP, RefinedCornersAreASquareWithinTheirCovariances) {
  double refined_chi2 = 0.0;
  double detected_chi2 = 0.0;
  for (int tag = 0; tag < kTagCount; ++tag) {
    refined_chi2 += pose_of(tag36h11(tag), refined.at(tag)).chi2;
    detected_chi2 += pose_of(tag36h11(tag), detected.at(tag)).chi2;
  }
  std::printf("chi2 of 10: refined %.1f, libapriltag's %.1f\n", refined_chi2, detected_chi2);
  EXPECT_LT(refined_chi2, 29.6);
  EXPECT_GT(detected_chi2, 29.6);
}

// The truth is taken to be right to the pixel: corners within half a pixel, of standard deviation
// 1/√12 px. The pose may then be off by what such corners make of it, three times. The picture's
// whites have grown by a tenth of a pixel and more (its floor's white squares are 0.4 to 1.6 px
// wider than the black ones), which the fit takes off and the listed truth, it seems, does not.
TEST_F(TagPoseAgainstViSP, PosesLieWhereTheGroundTruthPutsThemToThePixel) {
  for (int tag = 0; tag < kTagCount; ++tag) {
    const Eigen::Isometry3d truth = truth_of(tag);
    const FittedPose pose = pose_of(tag36h11(tag), refined.at(tag));
    const FittedPose plain = pose_of(tag36h11(tag), detected.at(tag));
    const auto budget =
        pose_of(tag36h11(tag), with_sigma(refined.at(tag), 1.0 / std::sqrt(12.0))).covariance;
    const double budget_mm = 3e3 * std::sqrt(budget.topLeftCorner<3, 3>().trace());
    const double budget_deg = 3.0 * to_deg(std::sqrt(budget.bottomRightCorner<3, 3>().trace()));
    const Distance off(truth, pose.cMl);
    const Distance plain_off(truth, plain.cMl);
    std::printf(
        "tag %d at %.2f m: %.2f mm %.3f deg, libapriltag's corners %.2f mm %.3f deg, "
        "bound %.2f mm %.3f deg, budget %.1f mm %.2f deg\n",
        tag, truth.translation().norm(), off.mm, off.deg, plain_off.mm, plain_off.deg,
        1e3 * std::sqrt(pose.covariance.topLeftCorner<3, 3>().trace()),
        to_deg(std::sqrt(pose.covariance.bottomRightCorner<3, 3>().trace())), budget_mm,
        budget_deg);
    EXPECT_LT(off.mm, budget_mm);
    EXPECT_LT(off.deg, budget_deg);
    for (const auto& point : localization::landmark_points(tag36h11(tag))) {
      const Eigen::Vector3d p_l(point.centre_l.x(), point.centre_l.y(), 0.0);
      const Eigen::Vector2d uv = *project(camera(), truth * p_l);
      const auto& seen = refined.at(tag)[static_cast<std::size_t>(point.label)].uv;
      EXPECT_LT((seen - uv).cwiseAbs().maxCoeff(), 0.5 + 0.15)
          << "tag " << tag << ", " << point.label;
    }
  }
}

// The tags of the family 16h5 stand in the same places in a picture of their own, for which ViSP
// lists libapriltag's corners, the first pixel's centre at (0.5, 0.5). What is common to both
// families' distance from cMo_* is the file's. Corners are good to 0.15 px or better there.
TEST_F(TagPoseAgainstViSP, AnotherFamilyInTheSamePlacesStandsWhereThisOneDoes) {
  std::ifstream file(kFolder / "corners_tag16_05.txt");
  for (int tag = 0; tag < kTagCount; ++tag) {
    int id = -1;
    ASSERT_TRUE(file >> id);
    Corners corners;
    for (int k = 0; k < 4; ++k) {
      Eigen::Vector2d uv;
      file >> uv.x() >> uv.y();
      corners.push_back({k, uv - Eigen::Vector2d(0.5, 0.5), Eigen::Matrix2d::Identity()});
    }
    const FittedPose pose = pose_of(tag36h11(id), refined.at(id));
    const FittedPose other = pose_of(square(id, 6.0 / 8.0), with_sigma(corners, 0.15));
    const Distance apart(pose.cMl, other.cMl);
    std::printf("tag %d: %.2f mm from cMo, %.2f mm from 16h5\n", id,
                Distance(truth_of(id), pose.cMl).mm, apart.mm);
    EXPECT_LT(apart.mm, 3e3 * std::sqrt(other.covariance.topLeftCorner<3, 3>().trace()));
  }
}

}  // namespace
}  // namespace vigia::evaluation

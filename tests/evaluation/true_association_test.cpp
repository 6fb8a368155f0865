#include "true_association.hpp"

#include "localization/points_drive.hpp"

#include <gtest/gtest.h>

namespace vigia::evaluation {
namespace {

namespace room = localization::test;

const Pose2 kAssociationTruth{4.0, 3.0, 0.2};

TEST(TrueAssociation, ADiscIsTheOneWhoseTrueImageItIsWhateverTheHeadReads) {
  RandomStream random(1, "ellipse");
  const LandmarkMap map = room::room_landmarks();
  const localization::LookBias bias{0.05, -0.02, 0.01};  // the disc's image moves by 50 px
  const Shot shot = room::aimed_shot(*map.find(4), {}, kAssociationTruth, bias, 1, {});
  const EllipseObservation seen =
      room::observe(*map.find(4), shot, {}, kAssociationTruth, bias, 0.0, 0.05, random);
  const Landmark* shown = true_landmark(seen, map, {}, kAssociationTruth, bias);
  ASSERT_NE(shown, nullptr);
  EXPECT_EQ(shown->id, 4);
}

TEST(TrueAssociation, ADarkSpotBesideEveryLandmarkIsNone) {
  RandomStream random(1, "ellipse");
  const LandmarkMap map = room::room_landmarks();
  const Shot shot = room::aimed_shot(*map.find(4), {}, kAssociationTruth, {}, 1, {});
  EllipseObservation seen =
      room::observe(*map.find(4), shot, {}, kAssociationTruth, {}, 0.0, 0.0, random);
  seen.ellipse.u += 2.0 * seen.ellipse.a;
  EXPECT_EQ(true_landmark(seen, map, {}, kAssociationTruth, {}), nullptr);
}

TEST(TrueAssociation, PointsSayWhoTheyAre) {
  PointsObservation seen;
  seen.landmark = 3;
  const LandmarkMap map = room::room_points();
  EXPECT_EQ(true_landmark(seen, map, {}, kAssociationTruth, {})->id, 3);
  seen.landmark = 77;
  EXPECT_EQ(true_landmark(seen, map, {}, kAssociationTruth, {}), nullptr);
}

}  // namespace
}  // namespace vigia::evaluation

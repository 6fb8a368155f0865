#include "vigia/localization/relocalizer.hpp"

#include "localization/points_views.hpp"
#include "localization/room.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace vigia::localization {
namespace {

using test::room_landmarks;
using test::room_plan;

constexpr double kPixelSigma = 0.05;

LandmarkId id_of(const EllipseObservation& seen) {
  return *seen.expected;
}
LandmarkId id_of(const PointsObservation& seen) {
  return seen.landmark;
}
template <typename Other>
LandmarkId id_of(const Other&) {
  return -1;
}

/// A camera that turns once round in steps of 30° at the shortest zoom; each view is a look.
struct SweepMaker {
  HeadGeometry geometry;
  SensorNoise noise;
  LandmarkMap map = room_landmarks();
  FloorPlan plan = room_plan();

  bool detectable(const Landmark& landmark, const Ellipse& image, const Intrinsics& intrinsics,
                  const Eigen::Vector3d& eye) const {
    const Eigen::Vector3d line = eye - landmark.centre_w();
    return image.a >= (disc_radius(landmark) ? 6.0 : 20.0) &&
           in_image(intrinsics, {image.u, image.v}, 2.0 * image.a) &&
           line.normalized().dot(landmark.normal_w()) > std::cos(from_deg(65.0)) &&
           plan.line_of_sight(eye, landmark.centre_w());
  }

  Sweep operator()(const Pose2& truth, RandomStream& random) const {
    Sweep sweep;
    for (int i = 0; i < 12; ++i) {
      Shot view;
      view.look = i + 1;
      view.head = {wrap_angle(from_deg(30.0 * i)), from_deg(8.0)};
      view.model = test::zoom_calibration().at(8.0);
      sweep.views.push_back(view);
      const LookBias bias = test::draw_bias(random, noise);
      const HeadAngles head{view.head.pan + bias.pan, view.head.tilt + bias.tilt};
      const Eigen::Isometry3d wMc = to_isometry(truth) * camera_in_base(geometry, head);
      for (const Landmark& landmark : map.all()) {
        const Landmark outline{landmark.id, landmark.wMl, DiscShape{extent_radius(landmark)}};
        const auto image = disc_image(outline, pinhole(view), wMc);
        if (!image || !detectable(landmark, *image, pinhole(view), wMc.translation())) continue;
        if (disc_radius(landmark))
          sweep.sightings.emplace_back(
              test::observe(landmark, view, geometry, truth, bias, 0.0, kPixelSigma, random));
        else
          sweep.sightings.emplace_back(see_code(landmark, view, wMc, bias, random));
      }
    }
    return sweep;
  }

  static PointsObservation see_code(const Landmark& landmark, const Shot& view,
                                    const Eigen::Isometry3d& wMc, const LookBias& bias,
                                    RandomStream& random) {
    Intrinsics lens = pinhole(view);
    lens.px *= std::exp(bias.log_focal);
    lens.py *= std::exp(bias.log_focal);
    return test::observe_points(landmark, view, lens, wMc.inverse() * landmark.wMl, kPixelSigma,
                                random);
  }
};

std::size_t landmarks_seen(const Sweep& sweep) {
  std::set<LandmarkId> ids;
  for (const Observation& seen : sweep.sightings)
    std::visit([&ids](const auto& one) { ids.insert(id_of(one)); }, seen);
  return ids.size();
}

Pose2 random_pose(const FloorPlan& plan, RandomStream& random) {
  for (;;) {
    const Pose2 pose{random.uniform(0.0, 12.0), random.uniform(0.0, 7.0),
                     random.uniform(-kPi, kPi)};
    if (plan.clearance(pose.position()) > 0.4) return pose;
  }
}

bool is_near(const Pose2& a, const Pose2& b) {
  const Eigen::Vector3d apart = difference(a, b);
  return apart.head<2>().norm() < 0.3 && std::abs(apart.z()) < from_deg(5.0);
}

Relocalizer relocalizer_for(const SweepMaker& maker) {
  return Relocalizer(maker.map, maker.plan, {head_rig(maker.geometry), {}}, {});
}

/// How often the relocalizer was right, wrong though sure, or unsure, over random poses from which
/// at least two landmarks are seen; @p clutter adds a dark disc on the wall that is no landmark.
struct Tally {
  int right = 0;
  int wrong = 0;
  double nees = 0.0;
};

Tally tally(int poses, bool clutter, std::uint64_t seed) {
  const SweepMaker make_sweep;
  const Relocalizer relocalizer = relocalizer_for(make_sweep);
  RandomStream random(seed, "relocalizer");
  SweepMaker clutter_maker;
  clutter_maker.map =
      LandmarkMap({test::disc(9, 0.0, 1.5, 1.2, 0.0), test::disc(10, 12.0, 5.0, 1.9, 180.0)});
  Tally counts;
  while (poses > 0) {
    const Pose2 truth = random_pose(make_sweep.plan, random);
    Sweep sweep = make_sweep(truth, random);
    if (landmarks_seen(sweep) < 2) continue;
    --poses;
    if (clutter) {
      const Sweep extra = clutter_maker(truth, random);
      sweep.sightings.insert(sweep.sightings.end(), extra.sightings.begin(), extra.sightings.end());
    }
    const Relocalization result = relocalizer.solve(sweep);
    if (result.status != RelocalizationStatus::found) continue;
    const PoseHypothesis& best = result.hypotheses.front();
    const Eigen::Vector3d e = difference(best.pose, truth);
    is_near(best.pose, truth) ? ++counts.right : ++counts.wrong;
    if (is_near(best.pose, truth)) counts.nees += e.dot(best.covariance.inverse() * e);
  }
  counts.nees /= counts.right;
  return counts;
}

TEST(Relocalizer, FindsTheRobotAtRandomPosesAndIsNotSureOfAWrongOne) {
  constexpr int kPoses = 300;
  const Tally counts = tally(kPoses, false, 1);
  EXPECT_GE(counts.right, 0.95 * kPoses);
  EXPECT_LE(counts.wrong, 0.01 * kPoses);
  // 3 degrees of freedom; the floors of the pixel noise make the claim a little cautious.
  EXPECT_LT(counts.nees / 3.0, 1.0 + 4.0 * std::sqrt(2.0 / (3.0 * kPoses)));  // k = 4
  EXPECT_GT(counts.nees / 3.0, 0.6);
}

TEST(Relocalizer, IsNotMisledByDiscsThatAreNoLandmarks) {
  constexpr int kPoses = 150;
  const Tally counts = tally(kPoses, true, 2);
  EXPECT_GE(counts.right, 0.9 * kPoses);
  EXPECT_LE(counts.wrong, 0.01 * kPoses);
}

/// @p count discs on the four walls of a room of 12 × 7 m, at random places and heights.
LandmarkMap crowded_walls(int count, RandomStream& random) {
  std::vector<Landmark> discs;
  for (int i = 0; i < count; ++i) {
    const double height = random.uniform(1.0, 2.2);
    const double x = random.uniform(0.4, 11.6);
    const double y = random.uniform(0.4, 6.6);
    if (i % 4 == 0) discs.push_back(test::disc(i + 1, x, 0.0, height, 90.0));
    if (i % 4 == 1) discs.push_back(test::disc(i + 1, x, 7.0, height, -90.0));
    if (i % 4 == 2) discs.push_back(test::disc(i + 1, 0.0, y, height, 0.0));
    if (i % 4 == 3) discs.push_back(test::disc(i + 1, 12.0, y, height, 180.0));
  }
  return LandmarkMap(discs);
}

/// A building of @p columns × @p rows rooms of 6 × 6 m with doors of 1 m, @p count discs on its
/// walls at random.
SweepMaker building(int columns, int rows, int count, RandomStream& random) {
  constexpr double kRoom_m = 6.0;
  SweepMaker make_sweep;
  const double width = kRoom_m * columns;
  const double depth = kRoom_m * rows;
  std::vector<Wall> walls;
  for (int i = 0; i < columns; ++i) {
    for (int k = 0; k < rows; ++k) {
      const Eigen::Vector2d corner(kRoom_m * i, kRoom_m * k);
      if (i > 0) walls.push_back({corner, corner + Eigen::Vector2d(0.0, kRoom_m - 1.0), 2.8});
      if (k > 0) walls.push_back({corner, corner + Eigen::Vector2d(kRoom_m - 1.0, 0.0), 2.8});
    }
  }
  make_sweep.plan =
      FloorPlan({{0.0, 0.0}, {width, 0.0}, {width, depth}, {0.0, depth}}, 2.8, walls, {});
  std::vector<Landmark> discs;
  for (int id = 1; id <= count; ++id) {
    const double x = kRoom_m * std::floor(random.uniform(0.0, columns));
    const double y = kRoom_m * std::floor(random.uniform(0.0, rows));
    const double along = random.uniform(0.4, kRoom_m - 1.4);
    const double height = random.uniform(1.0, 2.2);
    if (id % 4 == 0) discs.push_back(test::disc(id, x + along, y, height, 90.0));
    if (id % 4 == 1) discs.push_back(test::disc(id, x + along, y + kRoom_m, height, -90.0));
    if (id % 4 == 2) discs.push_back(test::disc(id, x, y + along, height, 0.0));
    if (id % 4 == 3) discs.push_back(test::disc(id, x + kRoom_m, y + along, height, 180.0));
  }
  make_sweep.map = LandmarkMap(discs);
  return make_sweep;
}

Pose2 pose_in(const FloorPlan& plan, RandomStream& random) {
  for (;;) {
    const Pose2 pose{random.uniform(0.0, plan.max_corner().x()),
                     random.uniform(0.0, plan.max_corner().y()), random.uniform(-kPi, kPi)};
    if (plan.clearance(pose.position()) > 0.4) return pose;
  }
}

/// What relocalization took and gave over poses from which three landmarks are seen.
struct Effort {
  int poses = 0;
  int right = 0;
  int wrong = 0;
  double max_s = 0.0;  ///< of modelled time
};

Effort effort(const SweepMaker& make_sweep, int poses, RandomStream& random) {
  const Relocalizer relocalizer = relocalizer_for(make_sweep);
  Effort sum;
  while (sum.poses < poses) {
    const Pose2 truth = pose_in(make_sweep.plan, random);
    const Sweep sweep = make_sweep(truth, random);
    if (landmarks_seen(sweep) < 3) continue;
    ++sum.poses;
    const Relocalization result = relocalizer.solve(sweep);
    sum.max_s = std::max(sum.max_s, result.modelled_s);
    if (result.status != RelocalizationStatus::found) continue;
    ++(is_near(result.hypotheses.front().pose, truth) ? sum.right : sum.wrong);
  }
  return sum;
}

TEST(Relocalizer, TakesAsLongAsItsBudgetAllowsHoweverManyLandmarksThereAre) {
  struct Case {
    int columns, rows, discs;
    double max_s;
  };
  for (const Case& a :
       {Case{1, 1, 6, 0.05}, Case{2, 1, 18, 0.1}, Case{2, 2, 36, 0.2}, Case{10, 6, 500, 1.0}}) {
    RandomStream random(static_cast<std::uint64_t>(a.discs), "budget");
    const Effort sum = effort(building(a.columns, a.rows, a.discs, random), 20, random);
    EXPECT_LE(sum.max_s, a.max_s) << a.discs;
    EXPECT_GE(sum.right, 19) << a.discs;
    EXPECT_EQ(sum.wrong, 0) << a.discs;
  }
}

TEST(Relocalizer, IsSoonDoneWhereAllDiscsAreInSightAtOnce) {
  for (const int discs : {18, 36, 50}) {
    RandomStream random(static_cast<std::uint64_t>(discs), "crowded");
    SweepMaker make_sweep;
    make_sweep.plan = FloorPlan({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8, {}, {});
    make_sweep.map = crowded_walls(discs, random);
    const Effort sum = effort(make_sweep, 20, random);
    EXPECT_LE(sum.max_s, 0.2) << discs;
    EXPECT_GE(sum.right, 19) << discs;
    EXPECT_EQ(sum.wrong, 0) << discs;
  }
}

TEST(Relocalizer, IsNotSureWhereTheBudgetEndsBeforeTheCandidates) {
  RandomStream random(9, "poor");
  const SweepMaker make_sweep = building(10, 6, 500, random);
  RelocalizerParams params;
  params.max_pairs = 200;
  const Relocalizer relocalizer(make_sweep.map, make_sweep.plan, {head_rig({}), {}}, params);
  const Relocalization result =
      relocalizer.solve(make_sweep(pose_in(make_sweep.plan, random), random));
  EXPECT_FALSE(result.complete);
  EXPECT_NE(result.status, RelocalizationStatus::found);
}

/// Discs, patterns and tags on the walls of a room of 9 × 6 m.
SweepMaker mixed_room() {
  SweepMaker make_sweep;
  make_sweep.plan = FloorPlan({{0.0, 0.0}, {9.0, 0.0}, {9.0, 6.0}, {0.0, 6.0}}, 2.8,
                              {Wall{{4.5, 0.0}, {4.5, 3.0}, 2.8}}, {});
  make_sweep.map =
      LandmarkMap({test::pattern(1, 0.0, 3.2, 1.9, 0.0), test::tag(2, 2.2, 0.0, 1.7, 90.0),
                   test::disc(3, 1.8, 6.0, 1.6, -90.0), test::tag(4, 5.6, 6.0, 1.8, -90.0),
                   test::disc(5, 9.0, 4.4, 1.9, 180.0), test::disc(6, 9.0, 1.4, 1.7, 180.0),
                   test::tag(7, 6.8, 0.0, 1.6, 90.0)});
  return make_sweep;
}

TEST(Relocalizer, TakesAnyMixtureOfDiscsPatternsAndTags) {
  const SweepMaker make_sweep = mixed_room();
  const Relocalizer relocalizer = relocalizer_for(make_sweep);
  RandomStream random(7, "mixture");
  int tried = 0;
  int right = 0;
  double nees = 0.0;
  constexpr int kPoses = 100;
  while (tried < kPoses) {
    const Pose2 truth = pose_in(make_sweep.plan, random);
    const Sweep sweep = make_sweep(truth, random);
    if (landmarks_seen(sweep) < 2) continue;
    ++tried;
    const Relocalization result = relocalizer.solve(sweep);
    if (result.status != RelocalizationStatus::found) continue;
    const PoseHypothesis& best = result.hypotheses.front();
    ASSERT_TRUE(is_near(best.pose, truth)) << tried;
    const Eigen::Vector3d e = difference(best.pose, truth);
    nees += e.dot(best.covariance.inverse() * e);
    ++right;
  }
  EXPECT_GE(right, 95);
  EXPECT_LT(nees / right / 3.0, 1.0 + 4.0 * std::sqrt(2.0 / (3.0 * kPoses)));  // k = 4
}

TEST(Relocalizer, ATagIsBelievedAmongManyLookAlikesOfDiscs) {
  SweepMaker make_sweep = mixed_room();
  RandomStream random(10, "look-alikes");
  SweepMaker clutter;
  clutter.plan = make_sweep.plan;
  clutter.map = crowded_walls(40, random);
  make_sweep.map = LandmarkMap({test::tag(2, 2.2, 0.0, 1.7, 90.0)});
  const Pose2 truth{1.2, 2.0, 0.7};
  Sweep sweep = make_sweep(truth, random);
  const Sweep extra = clutter(truth, random);
  ASSERT_GT(extra.sightings.size(), 2 * sweep.sightings.size());
  sweep.sightings.insert(sweep.sightings.end(), extra.sightings.begin(), extra.sightings.end());
  const Relocalization result = relocalizer_for(make_sweep).solve(sweep);
  ASSERT_EQ(result.status, RelocalizationStatus::found);
  EXPECT_TRUE(is_near(result.hypotheses.front().pose, truth));
}

TEST(Relocalizer, OneTagIsEnoughWhereNothingElseIsToBeSeen) {
  SweepMaker make_sweep = mixed_room();
  make_sweep.map = LandmarkMap({test::tag(2, 2.2, 0.0, 1.7, 90.0)});
  RandomStream random(8, "one tag");
  const Pose2 truth{1.2, 2.0, 0.7};
  const Sweep sweep = make_sweep(truth, random);
  ASSERT_GE(sweep.sightings.size(), 1U);
  const Relocalization result = relocalizer_for(make_sweep).solve(sweep);
  ASSERT_EQ(result.status, RelocalizationStatus::found);
  EXPECT_TRUE(is_near(result.hypotheses.front().pose, truth));
}

/// Two pairs of discs, turned by half a turn: every sweep fits two places.
SweepMaker half_turn_room() {
  SweepMaker make_sweep;
  make_sweep.map =
      LandmarkMap({test::disc(1, 2.0, 0.0, 1.5, 90.0), test::disc(2, 5.0, 0.0, 1.5, 90.0),
                   test::disc(3, 10.0, 7.0, 1.5, -90.0), test::disc(4, 7.0, 7.0, 1.5, -90.0)});
  make_sweep.plan = FloorPlan({{0.0, 0.0}, {12.0, 0.0}, {12.0, 7.0}, {0.0, 7.0}}, 2.8, {}, {});
  return make_sweep;
}

TEST(Relocalizer, SaysAmbiguousInARoomThatLooksTheSameFromTwoPlaces) {
  const SweepMaker make_sweep = half_turn_room();
  RandomStream random(3, "symmetric");
  const Pose2 truth{3.0, 2.5, 0.4};
  const Pose2 mirrored{9.0, 4.5, 0.4 + kPi};
  const Relocalization result = relocalizer_for(make_sweep).solve(make_sweep(truth, random));
  ASSERT_EQ(result.status, RelocalizationStatus::ambiguous);
  ASSERT_GE(result.hypotheses.size(), 2U);
  for (const Pose2& pose : {truth, mirrored}) {
    EXPECT_TRUE(is_near(result.hypotheses[0].pose, pose) ||
                is_near(result.hypotheses[1].pose, pose));
  }
}

TEST(Relocalizer, OneSightingIsNotEnoughUnlessThereIsAPrior) {
  const SweepMaker make_sweep;
  RandomStream random(4, "single");
  const Pose2 truth{4.0, 2.5, 0.4};
  Sweep sweep = make_sweep(truth, random);
  ASSERT_GE(sweep.sightings.size(), 2U);
  sweep.sightings.resize(1);
  const LookId look = shot_of(sweep.sightings.front()).look;
  const std::vector<Shot> all_round = sweep.views;
  sweep.views = {all_round.at(static_cast<std::size_t>(look - 1))};
  const Relocalizer relocalizer = relocalizer_for(make_sweep);
  EXPECT_EQ(relocalizer.solve(sweep).status, RelocalizationStatus::not_found);
  const Eigen::Vector3d sigma(0.2, 0.2, from_deg(4.0));
  const Prior prior{{4.1, 2.4, 0.43}, sigma.cwiseAbs2().asDiagonal()};
  const Relocalization result = relocalizer.confirm(sweep, prior);
  ASSERT_EQ(result.status, RelocalizationStatus::found);
  EXPECT_TRUE(is_near(result.hypotheses.front().pose, truth));

  // Where the rest of the circle should have shown more than was seen, one sighting is not enough.
  sweep.views = all_round;
  EXPECT_EQ(relocalizer.confirm(sweep, prior).status, RelocalizationStatus::not_found);
}

TEST(Relocalizer, IsNotTalkedIntoOneOfTwoPlacesByABeliefThatFitsNeither) {
  const SweepMaker make_sweep = half_turn_room();
  RandomStream random(5, "talked into");
  const Pose2 truth{3.0, 2.5, 0.4};
  const Sweep sweep = make_sweep(truth, random);
  const Eigen::Vector3d sigma(0.05, 0.05, from_deg(2.0));
  // Nearer to the truth's twin, by far, and at neither.
  const PlacePrior place{{{{8.0, 4.0, 0.4 + kPi}, sigma.cwiseAbs2().asDiagonal(), 0.5}}};
  const Relocalization result = relocalizer_for(make_sweep).solve(sweep, place);
  EXPECT_EQ(result.status, RelocalizationStatus::ambiguous);
  EXPECT_NEAR(result.hypotheses.at(0).weight, 0.5, 0.02);
}

TEST(Relocalizer, TakesTheOneOfTwoPlacesThatTheSweepBeforeLeavesOpen) {
  const SweepMaker make_sweep = half_turn_room();
  RandomStream random(6, "left open");
  const Pose2 truth{3.0, 2.5, 0.4};
  const Sweep sweep = make_sweep(truth, random);
  const Eigen::Vector3d sigma(0.1, 0.1, from_deg(5.0));
  const PlacePrior place{{{{3.1, 2.4, 0.43}, sigma.cwiseAbs2().asDiagonal(), 0.9}}};
  const Relocalization result = relocalizer_for(make_sweep).solve(sweep, place);
  ASSERT_EQ(result.status, RelocalizationStatus::found);
  EXPECT_TRUE(is_near(result.hypotheses.front().pose, truth));
}

TEST(Relocalizer, FindsNothingInAnEmptySweep) {
  const Relocalization result = relocalizer_for({}).solve({});
  EXPECT_EQ(result.status, RelocalizationStatus::not_found);
  EXPECT_TRUE(result.hypotheses.empty());
}

}  // namespace
}  // namespace vigia::localization

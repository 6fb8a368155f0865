#include "vigia/localization/ceiling_model.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"
#include "vigia/localization/ceiling_filter.hpp"
#include "vigia/localization/ceiling_published.hpp"

namespace vigia::localization {
namespace {

CeilingCamera up_camera() {
  CeilingCamera camera;
  Intrinsics pinhole;
  pinhole.px = pinhole.py = 554.26;
  camera.model = pinhole;
  camera.rMc.translation() = Eigen::Vector3d(0.1, -0.05, 0.5);
  return camera;
}

/// The image of a patch that hangs at @p patch, as a camera with these errors sees it.
PatchImage image_of(const CeilingCamera& known, const CeilingCameraErrors& errors,
                    const Pose2& robot, const Pose2& patch) {
  const CeilingCamera camera = corrected(known, errors);
  const Eigen::Isometry3d cMw = (to_isometry(robot) * camera.rMc).inverse();
  const auto at = [&](double forward) {
    const Pose2 p = compose(patch, {forward, 0.0, 0.0});
    return *project(camera.model, cMw * Eigen::Vector3d(p.x, p.y, camera.ceiling_m));
  };
  PatchImage image;
  image.uv = at(0.0);
  const Eigen::Vector2d along = at(1e-4) - at(-1e-4);
  image.angle = std::atan2(along.y(), along.x());
  image.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  image.forward_log_odds = 100.0;
  return image;
}

std::vector<PatchImage> images_about(const CeilingCamera& camera, const CeilingCameraErrors& errors,
                                     const Pose2& robot, const CeilingGrid& grid = {}) {
  std::vector<PatchImage> images;
  const CeilingCell middle = nearest_cell({}, robot.position());
  for (std::int64_t i = middle.i - 1; i <= middle.i + 1; ++i)
    for (std::int64_t j = middle.j - 1; j <= middle.j + 1; ++j) {
      if (!has_patch(grid, {i, j})) continue;
      const Eigen::Vector2d p = cell_centre({}, {i, j});
      const PatchImage image = image_of(camera, errors, robot, {p.x(), p.y(), 0.0});
      if (in_image(camera.model, image.uv)) images.push_back(image);
    }
  return images;
}

Prior near(const Pose2& pose, double sigma_m, double sigma_rad) {
  return {
      pose,
      Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad).asDiagonal()};
}

TEST(CeilingModel, PutsAPatchWhereItHangs) {
  const Pose2 robot{3.2, -1.1, 0.7};
  const CeilingCameraErrors errors{0.02, -0.01, 0.03};
  const PatchImage image = image_of(up_camera(), errors, robot, {3.0, -1.0, 0.1});
  const PatchOnCeiling seen = *on_ceiling(up_camera(), image, errors);
  const Pose2 patch = compose(inverse(robot), {3.0, -1.0, 0.1});
  EXPECT_LT((seen.q - patch.position()).norm(), 1e-9);
  EXPECT_NEAR(wrap_angle(seen.psi - patch.theta), 0.0, 1e-7);
}

TEST(CeilingModel, DerivativesByTheCamerasErrorsAreThoseOfFiniteDifferences) {
  const PatchImage image = image_of(up_camera(), {}, {0.3, 0.4, 1.2}, {0.0, 1.0, 0.0});
  const PatchOnCeiling seen = *on_ceiling(up_camera(), image);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
    const auto after = *on_ceiling(up_camera(), image, CeilingCameraErrors::from_vector(step));
    const auto before = *on_ceiling(up_camera(), image, CeilingCameraErrors::from_vector(-step));
    const Eigen::Vector2d dq = (after.q - before.q) / (2.0 * kStep);
    EXPECT_LT((dq - seen.derrors.block<2, 1>(0, i)).norm(), 1e-6) << i;
    EXPECT_NEAR(wrap_angle(after.psi - before.psi) / (2.0 * kStep), seen.derrors(2, i), 1e-6) << i;
  }
}

TEST(CeilingModel, AnImageTellsThePlaceUnderOtherErrorsAsWell) {
  const CeilingCameraErrors from{0.02, -0.01, 0.03};
  const CeilingCameraErrors to{-0.015, 0.03, -0.02};
  const PatchImage image = image_of(up_camera(), from, {0.3, 0.4, 1.2}, {0.0, 1.0, 0.4});
  const PatchOnCeiling then = *on_ceiling(up_camera(), image, from);
  const PatchOnCeiling expected = *on_ceiling(up_camera(), image, to);
  const PatchOnCeiling now = with_errors(up_camera(), then, from, to);
  EXPECT_LT((now.q - expected.q).norm(), 1e-12);
  EXPECT_NEAR(wrap_angle(now.psi - expected.psi), 0.0, 1e-12);
  EXPECT_LT((now.derrors - expected.derrors).norm(), 1e-12);
}

TEST(CeilingModel, CovarianceIsThatOfThePixelsPropagated) {
  const PatchImage image = image_of(up_camera(), {}, {0.3, 0.4, 1.2}, {0.0, 1.0, 0.0});
  const PatchOnCeiling seen = *on_ceiling(up_camera(), image);
  Eigen::Matrix3d J;
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 3; ++i) {
    PatchImage after = image;
    PatchImage before = image;
    (i < 2 ? after.uv[i] : after.angle) += kStep;
    (i < 2 ? before.uv[i] : before.angle) -= kStep;
    const auto to = *on_ceiling(up_camera(), after);
    const auto from = *on_ceiling(up_camera(), before);
    J.block<2, 1>(0, i) = (to.q - from.q) / (2.0 * kStep);
    J(2, i) = wrap_angle(to.psi - from.psi) / (2.0 * kStep);
  }
  const Eigen::Matrix3d expected = J * image.covariance * J.transpose();
  EXPECT_LT((seen.covariance - expected).norm(), 1e-4 * expected.norm());
}

TEST(CeilingPublished, FollowsAnIdealDriveAndFailsWhenItMovesMoreThanHalfAPitchUnseen) {
  for (const double step : {0.4, 0.6}) {
    CeilingPublished published(up_camera(), {});
    published.reset({0.0, 0.0, 0.3});
    double worst = 0.0;
    for (int i = 1; i <= 10; ++i) {
      const Pose2 robot{i * step, 0.0, 0.3};
      published.update(images_about(up_camera(), {}, robot));
      worst = std::max(worst, (published.pose().position() - robot.position()).norm());
    }
    if (step < 0.5)
      EXPECT_LT(worst, 1e-6);
    else
      EXPECT_GT(worst, 0.9);
  }
}

TEST(CeilingFilter, FindsTiltAndHeightFromThePatchesThatItSees) {
  const CeilingCameraErrors errors{from_deg(0.8), from_deg(-0.5), 0.02};
  CeilingFilterParams params;
  params.tilt_sigma = from_deg(1.0);
  params.height_sigma = 0.02;
  CeilingFilter filter(up_camera(), {}, params);
  const Pose2 start{0.2, 0.1, 0.4};
  filter.reset({}, near(start, 0.05, 0.05));
  Pose2 robot = start;
  for (int i = 1; i <= 20; ++i) {
    const Stamp now = Stamp::from_seconds(0.04 * i);
    const OdometryIncrement u{filter.belief().stamp, now, 0.01, 0.02, 0.01};
    robot = move(robot, u);
    filter.predict(u);
    ASSERT_EQ(filter.update(images_about(up_camera(), errors, robot)), CeilingUpdate::fused);
  }
  EXPECT_LT((filter.belief().pose.position() - robot.position()).norm(), 5e-4);
  EXPECT_NEAR(filter.camera_errors().tilt_x, errors.tilt_x, 2e-4);
  EXPECT_NEAR(filter.camera_errors().tilt_y, errors.tilt_y, 2e-4);
  EXPECT_NEAR(filter.camera_errors().log_height, errors.log_height, 2e-4);
  EXPECT_EQ(filter.belief().status, BeliefStatus::tracking);
}

/// Of a filter that is told what is drawn: 1° of tilt, 2 % of height, 5 mm and 1.3° a patch.
struct Consistency {
  double nees = 0.0;  ///< per degree of freedom, after eight frames, mean over the drives
  double worst = 0.0;
  double sigma_ratio = 0.0;  ///< of the position's σ, after the last frame and the first
};

Consistency consistency(double speed_mps, double turn_radps, int drives) {
  CeilingGrid grid;
  grid.placement_m = 0.005;
  grid.placement_turn = from_deg(1.3);
  CeilingFilterParams params;
  params.tilt_sigma = from_deg(1.0);
  params.height_sigma = 0.02;
  Consistency result;
  for (int drive = 0; drive < drives; ++drive) {
    RandomStream random(static_cast<std::uint64_t>(drive), "consistency");
    const CeilingCameraErrors errors{params.tilt_sigma * random.normal(),
                                     params.tilt_sigma * random.normal(),
                                     params.height_sigma * random.normal()};
    std::map<CeilingCell, Pose2> patches;
    for (std::int64_t i = -4; i <= 4; ++i)
      for (std::int64_t j = -4; j <= 4; ++j) {
        const double dx = grid.placement_m * random.normal();
        const double dy = grid.placement_m * random.normal();
        patches[{i, j}] = {static_cast<double>(i) + dx, static_cast<double>(j) + dy,
                           grid.placement_turn * random.normal()};
      }
    Pose2 robot{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-kPi, kPi)};
    CeilingFilter filter(up_camera(), grid, params);
    filter.reset({}, near(compose(robot, {0.05 * random.normal(), 0.05 * random.normal(),
                                          from_deg(2.0) * random.normal()}),
                          0.05, from_deg(2.0)));
    double first = 0.0;
    constexpr double kFrame_s = 0.125;
    for (int frame = 0; frame < 8; ++frame) {
      OdometryIncrement u;
      u.from = filter.belief().stamp;
      u.to = u.from + Duration::from_seconds(kFrame_s);
      u.trans = speed_mps * kFrame_s;
      u.rot2 = turn_radps * kFrame_s;
      if (frame > 0) {
        filter.predict(u);
        robot = move(robot, u);
      }
      std::vector<PatchImage> images;
      for (const auto& [cell, patch] : patches) {
        PatchImage image = image_of(up_camera(), errors, robot, patch);
        if (!in_image(up_camera().model, image.uv)) continue;
        image.uv += Eigen::Vector2d(0.01 * random.normal(), 0.01 * random.normal());
        image.angle += 1e-3 * random.normal();
        images.push_back(image);
      }
      filter.update(images);
      if (frame == 0) first = filter.belief().position_sigma();
    }
    const Eigen::Vector3d error = difference(filter.belief().pose, robot);
    const double nees = error.dot(filter.belief().covariance.ldlt().solve(error)) / 3.0;
    result.nees += nees / drives;
    result.worst = std::max(result.worst, nees);
    result.sigma_ratio += filter.belief().position_sigma() / first / drives;
  }
  return result;
}

TEST(CeilingFilter, ARobotThatStandsStillLearnsNothingFromMorePictures) {
  const Consistency stands = consistency(0.0, 0.0, 60);
  EXPECT_GT(stands.nees, 0.7);
  EXPECT_LT(stands.nees, 1.4);
  EXPECT_LT(stands.worst, 6.0);
  EXPECT_GT(stands.sigma_ratio, 0.95);
}

TEST(CeilingFilter, ARobotThatMovesSlowlyIsAsSureAsItMayBe) {
  for (const double turn_radps : {0.0, 0.2}) {
    const Consistency moves = consistency(0.1, turn_radps, 60);
    EXPECT_GT(moves.nees, 0.7) << turn_radps;
    EXPECT_LT(moves.nees, 1.5) << turn_radps;
    EXPECT_LT(moves.worst, 6.0) << turn_radps;
    EXPECT_LT(moves.sigma_ratio, 0.5) << turn_radps;
  }
}

TEST(CeilingFilter, AThousandFramesLeaveItsCovarianceSymmetric) {
  CeilingFilterParams params;
  params.tilt_sigma = from_deg(0.3);
  params.height_sigma = 0.005;
  CeilingGrid grid;
  grid.placement_m = 0.005;
  grid.placement_turn = from_deg(1.3);
  CeilingFilter filter(up_camera(), grid, params);
  Pose2 robot{0.2, 0.1, 0.4};
  filter.reset({}, near(robot, 0.05, 0.05));
  for (int i = 1; i <= 1000; ++i) {
    const OdometryIncrement u{filter.belief().stamp, Stamp::from_seconds(0.04 * i), 0.02, 0.0,
                              0.004};
    robot = move(robot, u);
    filter.predict(u);
    ASSERT_EQ(filter.update(images_about(up_camera(), {}, robot)), CeilingUpdate::fused) << i;
    for (const Eigen::Matrix3d& P : {filter.belief().covariance, filter.camera_errors_covariance()})
      ASSERT_LT((P - P.transpose()).norm(), 1e-12 * P.norm()) << i;
  }
  EXPECT_LT((filter.belief().pose.position() - robot.position()).norm(), 1e-3);
}

/// The variance of odometry follows the distance that it reads: next to nothing is uncertain at
/// zero.
TEST(CeilingFilter, ATickThatTheOdometryReadTooShortIsNoContradiction) {
  CeilingGrid grid;
  grid.placement_m = 0.005;
  grid.placement_turn = from_deg(1.3);
  CeilingFilterParams params;
  params.odometry = {0.02, 0.02, 0.02};
  CeilingFilter filter(up_camera(), grid, params);
  Pose2 robot{0.2, 0.1, 0.4};
  filter.reset({}, near(robot, 0.05, 0.05));
  const auto drive = [&](int i, double read_m) {
    const Stamp now = Stamp::from_seconds(0.04 * i);
    robot = move(robot, {filter.belief().stamp, now, 0.0, 0.02, 0.0});
    filter.predict(OdometryIncrement{filter.belief().stamp, now, 0.0, read_m, 0.0});
    return filter.update(images_about(up_camera(), {}, robot));
  };
  for (int i = 1; i < 20; ++i) ASSERT_EQ(drive(i, 0.02), CeilingUpdate::fused);
  const double sigma = filter.belief().position_sigma();
  EXPECT_EQ(drive(20, 0.01), CeilingUpdate::fused);
  EXPECT_LT((filter.belief().pose.position() - robot.position()).norm(), 3.0 * sigma);
  // It taught nothing of where all patches together hang.
  EXPECT_GT(filter.belief().position_sigma(), 0.98 * sigma);
}

/// How the picture of the ceiling moves when the camera does by @p step, well measured.
ImageShift shift_of(const Pose2& step) {
  ImageShift shift;
  shift.shift = step.position() / up_camera().rise_m();
  shift.turn = step.theta;
  shift.covariance = 1e-8 * Eigen::Matrix3d::Identity();
  return shift;
}

TEST(CeilingFilter, BelievesTheFlowThatTheOdometryBearsOutAndNoOther) {
  CeilingCamera camera = up_camera();
  camera.rMc.translation() = Eigen::Vector3d(0.0, 0.0, 0.5);
  CeilingFilterParams params;
  params.max_speed_mps = 1.0;
  CeilingFilter filter(camera, {}, params);
  const Pose2 start{0.2, 0.1, 0.0};
  const OdometryIncrement u{{}, Stamp::from_seconds(0.2), 0.0, 0.1, 0.0};
  const auto after = [&](const auto&... motion) {
    filter.reset({}, near(start, 1e-3, 1e-3));
    filter.predict(motion...);
    return filter.belief();
  };
  // The odometry's σ over that way is ten times the flow's, which has nearly all the weight.
  EXPECT_NEAR(after(u, shift_of({0.11, 0.0, 0.0})).pose.x, 0.31, 3e-4);
  EXPECT_NEAR(after(u, shift_of({-0.3, 0.1, 0.2})).pose.x, 0.30, 1e-9);
  const Belief fast = after(shift_of({0.3, 0.0, 0.0}), u.to, std::vector<PatchImage>{});
  EXPECT_NEAR(fast.pose.x, 0.2, 1e-9);
  EXPECT_GT(fast.position_sigma(), 0.05);
}

/// A picture that is levelled wrong by a tilt sees a turn on the spot as a shift, too.
TEST(CeilingFilter, ATurnUnderATiltIsNoShift) {
  CeilingCamera camera = up_camera();
  camera.rMc.translation() = Eigen::Vector3d(0.0, 0.0, 0.5);
  const CeilingCameraErrors errors{0.02, -0.03, 0.0};
  CeilingFilterParams params;
  params.max_speed_mps = 5.0;
  CeilingFilter filter(camera, {}, params);
  filter.reset({}, near({}, 1e-4, 1e-4));
  filter.place({Pose2{}, errors, {}});
  // A patch above, as it is seen before and after the turn, by the camera that is thought level.
  constexpr double kTurn = 0.1;
  const Eigen::Vector2d o(-errors.tilt_y, errors.tilt_x);
  ImageShift seen = shift_of({0.0, 0.0, kTurn});
  seen.shift = o - Eigen::Rotation2Dd(kTurn) * o;
  filter.predict(seen, Stamp::from_seconds(0.04), {});
  EXPECT_LT(filter.belief().pose.position().norm(), 1e-9);
  // That it is so is what the camera's images say.
  const Pose2 turned{0.0, 0.0, kTurn};
  const PatchImage before = image_of(camera, errors, {}, {0.0, 0.0, 0.0});
  const PatchImage after = image_of(camera, errors, turned, {0.0, 0.0, 0.0});
  const Eigen::Vector2d m1 = on_ceiling(camera, before)->q / camera.rise_m();
  const Eigen::Vector2d m2 = on_ceiling(camera, after)->q / camera.rise_m();
  EXPECT_LT((m2 - Eigen::Rotation2Dd(-kTurn) * (m1 - seen.shift)).norm(), 1e-4);
}

TEST(CeilingFilter, ALonePatchAfterAWidePredictionIsNotBelievedBeforeAnotherAgrees) {
  CeilingFilterParams params;
  params.max_speed_mps = 1.2;
  CeilingFilter filter(up_camera(), {}, params);
  const Pose2 robot{0.2, 0.1, 0.4};
  const auto begin = [&] {
    filter.reset({}, near(robot, 0.002, 0.002));
    filter.predict_unknown(Stamp::from_seconds(0.3));
  };
  // One that is none of the grid's, turned by a right angle.
  begin();
  const PatchImage spurious = image_of(up_camera(), {}, robot, {0.25, 0.2, 0.5 * kPi});
  ASSERT_EQ(filter.update({spurious}), CeilingUpdate::fused);
  EXPECT_GT(std::abs(filter.belief().pose.theta - robot.theta), 1.0);
  EXPECT_EQ(filter.belief().status, BeliefStatus::ambiguous);
  // One of the grid's, and then two.
  begin();
  const auto images = images_about(up_camera(), {}, robot);
  ASSERT_GT(images.size(), 1U);
  ASSERT_EQ(filter.update({images.front()}), CeilingUpdate::fused);
  EXPECT_EQ(filter.belief().status, BeliefStatus::ambiguous);
  filter.update(images);
  EXPECT_EQ(filter.belief().status, BeliefStatus::tracking);
}

TEST(CeilingFilter, OnePatchTooManyIsNoKidnapping) {
  CeilingFilter filter(up_camera(), {}, {});
  const Pose2 robot{0.2, 0.1, 0.4};
  filter.reset({}, near(robot, 0.002, 0.002));
  const PatchImage spurious = image_of(up_camera(), {}, robot, {0.4, 0.3, 0.9});
  for (int i = 0; i < 10; ++i) EXPECT_EQ(filter.update({spurious}), CeilingUpdate::gated);
  EXPECT_EQ(filter.belief().status, BeliefStatus::tracking);
  auto elsewhere = images_about(up_camera(), {}, {0.5, 0.5, 0.9});
  ASSERT_GT(elsewhere.size(), 1U);
  for (int i = 0; i < 3; ++i) filter.update(elsewhere);
  EXPECT_EQ(filter.belief().status, BeliefStatus::ambiguous);
}

/// Strips look the same after half a turn.
TEST(CeilingFilter, WithoutMarksAHeadingThatIsHardlyKnownStaysOpenByHalfATurn) {
  CeilingGrid strips;
  strips.polarity = false;
  const Pose2 robot{0.2, 0.1, 0.4};
  std::vector<PatchImage> images = images_about(up_camera(), {}, robot);
  for (PatchImage& image : images) image.forward_log_odds = 0.0;
  for (const double off : {0.3, 0.5 * kPi, 0.9 * kPi}) {
    CeilingFilter filter(up_camera(), strips, {});
    Pose2 believed = robot;
    believed.theta = wrap_angle(robot.theta + off);
    filter.reset({}, near(believed, 0.3, kPi));
    for (int i = 1; i <= 5; ++i) {
      filter.predict_unknown(Stamp::from_seconds(0.001 * i));
      filter.update(images);
    }
    const Belief& belief = filter.belief();
    EXPECT_EQ(belief.status, BeliefStatus::ambiguous) << off;
    double nearest = 10.0;
    for (const PoseHypothesis& one : belief.hypotheses)
      nearest = std::min(nearest, difference(one.pose, robot).norm());
    EXPECT_LT(nearest, 0.02) << off;
  }
  // A heading that is known leaves nothing open.
  CeilingFilter sure(up_camera(), strips, {});
  sure.reset({}, near(robot, 0.05, from_deg(5.0)));
  sure.update(images);
  EXPECT_EQ(sure.belief().status, BeliefStatus::tracking);
}

TEST(CeilingFilter, IsAmbiguousWithTheTruthAmongItsHypothesesAfterDrivingUnseenForHalfAPitch) {
  CeilingFilter filter(up_camera(), {}, {});
  filter.reset({}, near({0.0, 0.0, 0.0}, 0.01, 0.01));
  ASSERT_EQ(filter.update(images_about(up_camera(), {}, {0.0, 0.0, 0.0})), CeilingUpdate::fused);
  ASSERT_EQ(filter.belief().status, BeliefStatus::tracking);
  filter.predict_unknown(Stamp::from_seconds(2.5));
  const Pose2 robot{0.6, 0.0, 0.0};
  ASSERT_EQ(filter.update(images_about(up_camera(), {}, robot)), CeilingUpdate::fused);
  EXPECT_EQ(filter.belief().status, BeliefStatus::ambiguous);
  const auto& all = filter.belief().hypotheses;
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const PoseHypothesis& one) {
    return (one.pose.position() - robot.position()).norm() < 0.01 && one.weight > 0.1;
  }));
}

/// Weight of the hypotheses that lie in another column than @p truth.
double weight_in_other_columns(const Belief& belief, const Pose2& truth) {
  double weight = 0.0;
  for (const PoseHypothesis& one : belief.hypotheses)
    if (std::abs(one.pose.x - truth.x) > 0.5) weight += one.weight;
  return weight;
}

TEST(CeilingFilter, PatchesBeyondTheGridsEdgeSettleWhichCellItIs) {
  // The last column is x = 1. Whoever were a cell to the right would see patches at x = 2.
  CeilingGrid grid;
  grid.extent = CeilingGrid::Extent{{-20.0, -20.0}, {1.0, 20.0}};
  for (const bool edge : {false, true}) {
    CeilingFilter filter(up_camera(), edge ? grid : CeilingGrid{}, {});
    filter.reset({}, near({0.0, 0.0, 0.0}, 0.01, 0.01));
    filter.update(images_about(up_camera(), {}, {0.0, 0.0, 0.0}, grid));
    filter.predict_unknown(Stamp::from_seconds(3.75));
    const Pose2 robot{0.0, 0.0, 0.0};
    ASSERT_EQ(filter.update(images_about(up_camera(), {}, robot, grid)), CeilingUpdate::fused);
    double right = 0.0;
    for (const PoseHypothesis& one : filter.belief().hypotheses)
      if (one.pose.x > 0.5) right += one.weight;
    if (edge)
      EXPECT_LT(right, 1e-3);
    else
      EXPECT_GT(right, 0.01);
  }
}

TEST(CeilingFilter, ColumnsThatAreMissingAtTheGridsEdgeSettleWhichCellItIs) {
  CeilingGrid grid;
  grid.extent = CeilingGrid::Extent{{-20.0, -20.0}, {1.0, 20.0}};
  CeilingFilter filter(up_camera(), grid, {});
  const Pose2 start{0.0, 0.0, from_deg(90.0)};
  filter.reset({}, near(start, 0.01, 0.01));
  filter.update(images_about(up_camera(), {}, start, grid));
  filter.predict_unknown(Stamp::from_seconds(4.0));
  // The camera shows x from 0.4 to 2.3: of two columns in sight the right one does not exist.
  const Pose2 robot{1.3, 0.0, from_deg(90.0)};
  ASSERT_EQ(filter.update(images_about(up_camera(), {}, robot, grid)), CeilingUpdate::fused);
  EXPECT_NEAR(filter.belief().pose.x, robot.x, 1e-3);
  EXPECT_LT(weight_in_other_columns(filter.belief(), robot), 0.05);
}

TEST(CeilingFilter, AMappedGapSettlesWhichCellItIs) {
  CeilingGrid grid;
  grid.gaps = {{{0.9, -0.1}, {1.1, 1.1}}};  // the patches of (1, 0) and (1, 1)
  for (const bool mapped : {true, false}) {
    CeilingFilter filter(up_camera(), mapped ? grid : CeilingGrid{}, {});
    const Pose2 start{-0.6, 0.5, 0.0};
    filter.reset({}, near(start, 0.01, 0.01));
    filter.update(images_about(up_camera(), {}, start, grid));
    filter.predict_unknown(Stamp::from_seconds(4.0));
    const Pose2 robot{0.2, 0.5, 0.0};
    ASSERT_EQ(filter.update(images_about(up_camera(), {}, robot, grid)), CeilingUpdate::fused);
    if (mapped)
      EXPECT_LT(weight_in_other_columns(filter.belief(), robot), 0.03);
    else
      EXPECT_GT(weight_in_other_columns(filter.belief(), robot), 0.2);
  }
}

/// Tracks, is put down elsewhere, and drives on past gaps by its odometry; the beliefs from then
/// on.
std::vector<std::pair<Belief, Pose2>> kidnapped_under(const CeilingGrid& grid) {
  CeilingFilterParams params;
  params.odometry = {0.02, 0.01, 0.02};
  CeilingFilter filter(up_camera(), grid, params);
  Pose2 robot{2.2, 3.1, 0.3};
  filter.reset({}, near(robot, 1e-2, 1e-2));
  std::vector<std::pair<Belief, Pose2>> beliefs;
  for (int i = 0; i < 260; ++i) {
    if (i == 10) robot = {9.4, 7.6, -2.0};
    filter.update(images_about(up_camera(), {}, robot, grid));
    if (i >= 10) beliefs.emplace_back(filter.belief(), robot);
    const OdometryIncrement u{filter.belief().stamp, Stamp::from_seconds(0.1 * (i + 1)), 0.005,
                              0.05, 0.005};
    robot = move(robot, u);
    filter.predict(u);
  }
  return beliefs;
}

int tracking_elsewhere(const std::vector<std::pair<Belief, Pose2>>& beliefs) {
  return static_cast<int>(std::count_if(beliefs.begin(), beliefs.end(), [](const auto& one) {
    return one.first.status == BeliefStatus::tracking &&
           (one.first.pose.position() - one.second.position()).norm() > 0.5;
  }));
}

CeilingGrid grid_with_gaps() {
  CeilingGrid grid;
  grid.gaps = {{{1, 1}, {1, 2}}, {{4, 6}, {5, 6}}, {{8, 5}, {8, 5}}, {{9, 8}, {10, 9}},
               {{6, 2}, {6, 3}}, {{2, 9}, {3, 9}}, {{7, 8}, {7, 8}}, {{10, 4}, {11, 4}}};
  return grid;
}

TEST(CeilingFilter, PutDownElsewhereInAHallItFindsItselfByTheGaps) {
  CeilingGrid grid = grid_with_gaps();
  grid.extent = CeilingGrid::Extent{{0, 0}, {12, 12}};
  const auto beliefs = kidnapped_under(grid);
  EXPECT_LE(tracking_elsewhere(beliefs), 3);
  const auto& [last, truth] = beliefs.back();
  EXPECT_EQ(last.status, BeliefStatus::tracking);
  EXPECT_LT((last.pose.position() - truth.position()).norm(), 0.02);
}

TEST(CeilingFilter, PutDownElsewhereUnderAGridWithoutEdgeItIsNeverSureAgain) {
  const auto beliefs = kidnapped_under(grid_with_gaps());
  EXPECT_LE(tracking_elsewhere(beliefs), 3);
  EXPECT_EQ(beliefs.back().first.status, BeliefStatus::ambiguous);
  EXPECT_GE(beliefs.back().first.lost_probability, 0.5);
}

TEST(CeilingFilter, APatchWhoseTwoImagesDisagreeIsForgotten) {
  CeilingGrid grid;
  grid.placement_m = 0.005;
  CeilingFilterParams params;
  params.tilt_sigma = from_deg(1.0);
  params.max_speed_mps = 1.5;
  CeilingFilter filter(up_camera(), grid, params);
  Pose2 robot{0.1, 0.2, 0.0};
  filter.reset({}, near(robot, 0.03, 0.03));
  for (int i = 0; i < 12; ++i) {
    filter.predict_unknown(Stamp::from_seconds(0.125 * i));
    std::vector<PatchImage> images{image_of(up_camera(), {}, robot, {0.0, 0.0, 0.0}),
                                   image_of(up_camera(), {}, robot, {1.0, 0.0, 0.0})};
    // What the border leaves of it, read the wrong way round: 24 mm along it.
    if (i == 5) images[1].uv += Eigen::Vector2d(6.0, 0.0);
    filter.update(images);
    const Eigen::Vector3d off = difference(filter.belief().pose, robot);
    EXPECT_LT(off.head<2>().norm(), 0.03) << i;
    EXPECT_LT(std::abs(filter.camera_errors().tilt_x), from_deg(2.0)) << i;
    EXPECT_LT(std::abs(filter.camera_errors().tilt_y), from_deg(2.0)) << i;
    robot = compose(robot, {0.02, 0.0, 0.0});
  }
}

TEST(CeilingFilter, OnePatchThatContradictsIsDoubtByTheSecondAndAnotherOneAtOnce) {
  CeilingFilterParams params;
  params.max_speed_mps = 0.3;
  const Pose2 robot{0.1, 0.2, 0.0};
  const auto seconds_until_doubted = [&](double period_s, bool another) {
    CeilingFilter filter(up_camera(), {}, params);
    filter.reset({}, near(robot, 1e-3, 1e-3));
    filter.update(images_about(up_camera(), {}, robot));
    for (int i = 1; i < 200; ++i) {
      const Stamp now = Stamp::from_seconds(period_s * i);
      filter.predict({filter.belief().stamp, now, 0.0, 0.0, 0.0});
      const double y = another && i % 2 == 0 ? -0.3 : 0.4;
      EXPECT_EQ(filter.update({image_of(up_camera(), {}, robot, {0.3, y, 1.0})}),
                CeilingUpdate::gated);
      if (filter.belief().status != BeliefStatus::tracking) return now.seconds();
    }
    return 1e9;
  };
  EXPECT_NEAR(seconds_until_doubted(0.04, false), 1.92, 0.05);
  EXPECT_NEAR(seconds_until_doubted(0.2, false), 2.0, 0.05);
  EXPECT_LT(seconds_until_doubted(0.2, true), 0.9);
}

TEST(CeilingFilter, AFallenPatchIsNoEvidenceAgainInEveryFrame) {
  CeilingGrid grid;
  grid.extent = CeilingGrid::Extent{{-20.0, -20.0}, {1.0, 20.0}};
  CeilingFilter filter(up_camera(), grid, {});
  const Pose2 robot{-0.4, 0.0, 0.0};
  filter.reset({}, near({0.0, 0.0, 0.0}, 0.01, 0.01));
  filter.predict_unknown(Stamp::from_seconds(4.0));
  std::vector<PatchImage> images = images_about(up_camera(), {}, robot, grid);
  images.pop_back();
  filter.update(images);
  const double once = weight_in_other_columns(filter.belief(), robot);
  for (int i = 0; i < 50; ++i) {
    filter.predict(
        {filter.belief().stamp, Stamp::from_seconds(4.0 + 0.04 * (i + 1)), 0.0, 0.0, 0.0});
    filter.update(images);
  }
  EXPECT_NEAR(weight_in_other_columns(filter.belief(), robot), once, 0.1);
}

TEST(CeilingFilter, KeepsAFalsePatchOut) {
  CeilingFilter filter(up_camera(), {}, {});
  const Pose2 robot{0.3, 0.2, 0.5};
  filter.reset({}, near(robot, 0.02, 0.02));
  std::vector<PatchImage> images = images_about(up_camera(), {}, robot);
  images.push_back(image_of(up_camera(), {}, robot, {0.25, 0.3, 1.0}));
  ASSERT_EQ(filter.update(images), CeilingUpdate::fused);
  EXPECT_LT((filter.belief().pose.position() - robot.position()).norm(), 1e-3);
}

TEST(CeilingFlow, TheRobotsMotionIsTakenFromTheCamerasAboutIt) {
  const CeilingCamera camera = up_camera();
  const Pose2 motion{0.05, -0.02, 0.1};
  // Where the camera goes when the robot does so, in ceiling distances.
  const Eigen::Vector2d c = camera.rMc.translation().head<2>();
  ImageShift shift;
  shift.turn = motion.theta;
  shift.shift = (motion.position() + Eigen::Rotation2Dd(motion.theta) * c - c) / camera.rise_m();
  const Pose2 found = robot_motion(camera, shift);
  EXPECT_LT(difference(found, motion).norm(), 1e-12);
}

}  // namespace
}  // namespace vigia::localization

#include "vigia/localization/ceiling_localizer.hpp"

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"

namespace vigia::localization {
namespace {

const Pose2 kUnderPatches{0.2, 0.1, 0.3};
constexpr double kCeilingTick_s = 0.04;

class CeilingLocalizerTest : public ::testing::Test {
 protected:
  CeilingLocalizerTest() {
    for (CeilingLocalizer* localizer : {&prompt_, &late_})
      localizer->reset({}, Prior{kUnderPatches, Eigen::Vector3d(4e-4, 4e-4, 4e-4).asDiagonal()});
  }

  /// What the camera shows from @p robot of the patches about the origin.
  Observation seen_from(const Pose2& robot, Stamp stamp) const {
    PatchesObservation seen;
    seen.shot.stamp = stamp;
    const Eigen::Isometry3d cMw = (to_isometry(robot) * camera_.rMc).inverse();
    for (std::int64_t i = -1; i <= 1; ++i) {
      for (std::int64_t j = -1; j <= 1; ++j) {
        const Eigen::Vector2d p = cell_centre({}, {i, j});
        PatchImage& image = seen.patches.emplace_back();
        image.uv = *project(camera_.model, cMw * Eigen::Vector3d(p.x(), p.y(), 2.7));
        image.angle = wrap_angle(-robot.theta);
        image.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
        image.forward_log_odds = 100.0;
        if (!in_image(camera_.model, image.uv)) seen.patches.pop_back();
      }
    }
    return seen;
  }
  static OdometryIncrement step(int tick) {
    return {Stamp::from_seconds(kCeilingTick_s * (tick - 1)),
            Stamp::from_seconds(kCeilingTick_s * tick), 0.01, 0.02, 0.0};
  }

  static CeilingCamera camera() {
    CeilingCamera camera;
    Intrinsics pinhole;
    pinhole.px = pinhole.py = 554.26;
    camera.model = pinhole;
    camera.rMc.translation().z() = 0.5;
    return camera;
  }

  CeilingCamera camera_ = camera();
  CeilingLocalizer prompt_{camera_, {}, {}};
  CeilingLocalizer late_{camera_, {}, {}};
};

TEST_F(CeilingLocalizerTest, AFrameThatComesLateIsFusedWhereItWasExposed) {
  Pose2 robot = kUnderPatches;
  std::optional<Observation> waiting;
  for (int tick = 1; tick <= 5; ++tick) {
    robot = move(robot, step(tick));
    prompt_.predict(step(tick));
    late_.predict(step(tick));
    if (tick != 2) continue;
    waiting = seen_from(robot, step(tick).to);
    EXPECT_EQ(prompt_.update(*waiting).status, UpdateStatus::fused);
  }
  EXPECT_EQ(late_.update(*waiting).status, UpdateStatus::fused);
  EXPECT_LT(difference(late_.belief().pose, prompt_.belief().pose).norm(), 1e-9);
  EXPECT_LT((late_.belief().covariance - prompt_.belief().covariance).norm(), 1e-12);
  EXPECT_LT(difference(late_.belief().pose, robot).norm(), 1e-6);
}

TEST_F(CeilingLocalizerTest, AFrameFromBeforeItsMemoryIsRefused) {
  for (int tick = 1; tick <= 40; ++tick) late_.predict(step(tick));
  EXPECT_EQ(late_.update(seen_from(kUnderPatches, Stamp::from_seconds(0.1))).status,
            UpdateStatus::too_late);
}

TEST_F(CeilingLocalizerTest, OnceLostItStaysLostUntilItIsToldWhereItIs) {
  prompt_.predict(step(1));
  prompt_.lose();
  EXPECT_EQ(prompt_.belief().status, BeliefStatus::lost);
  EXPECT_EQ(prompt_.update(seen_from(kUnderPatches, step(1).to)).status, UpdateStatus::no_prior);
  prompt_.reset(step(1).to, Prior{kUnderPatches, Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal()});
  EXPECT_EQ(prompt_.update(seen_from(kUnderPatches, step(1).to)).status, UpdateStatus::fused);
}

TEST_F(CeilingLocalizerTest, AFlowTakesOdometrysErrorOut) {
  Pose2 robot = kUnderPatches;
  Stamp from = Stamp::from_seconds(0.0);
  CeilingLocalizer deaf(camera_, {}, {}, false);
  deaf.reset({}, Prior{kUnderPatches, Eigen::Vector3d(4e-4, 4e-4, 4e-4).asDiagonal()});
  for (int tick = 1; tick <= 20; ++tick) {
    OdometryIncrement truth = step(tick);
    truth.trans *= 1.1;
    robot = move(robot, truth);
    for (CeilingLocalizer* localizer : {&prompt_, &deaf}) localizer->predict(step(tick));
    if (tick % 2 != 0) continue;
    // A frame every second tick, delivered at once.
    FlowObservation flow;
    flow.from = from;
    flow.shot.stamp = from = step(tick).to;
    OdometryIncrement first = step(tick - 1);
    first.trans *= 1.1;
    flow.shift = seen_shift(camera_, move(move({}, first), truth));
    flow.shift.covariance = Eigen::Vector3d(1e-9, 1e-9, 1e-9).asDiagonal();
    EXPECT_EQ(prompt_.update(flow).status, UpdateStatus::fused);
    EXPECT_EQ(deaf.update(flow).status, UpdateStatus::unsupported);
  }
  EXPECT_LT((prompt_.belief().pose.position() - robot.position()).norm(), 3e-3);
  EXPECT_GT((deaf.belief().pose.position() - robot.position()).norm(), 3e-2);
}

TEST_F(CeilingLocalizerTest, AFlowBetweenTimesThatItHasNotIsTooLate) {
  prompt_.predict(step(1));
  FlowObservation flow;
  flow.from = Stamp::from_seconds(0.01);
  flow.shot.stamp = step(1).to;
  EXPECT_EQ(prompt_.update(flow).status, UpdateStatus::too_late);
}

TEST_F(CeilingLocalizerTest, ImagesOfLandmarksAreUnsupported) {
  EXPECT_EQ(prompt_.update(EllipseObservation{}).status, UpdateStatus::unsupported);
}

}  // namespace
}  // namespace vigia::localization

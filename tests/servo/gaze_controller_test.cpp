#include "vigia/servo/gaze_controller.hpp"

#include "head_bench.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/servo/base_motion.hpp"

namespace vigia::servo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDiscRadius = 0.1;

Landmark disc_at(LandmarkId id, const Vector3d& centre_w, double normal_yaw) {
  return {id, wall_mount(centre_w, normal_yaw), DiscShape{kDiscRadius}};
}

/// The controller closed over the bench, with a tracker that sees any disc within the image.
class GazeControllerTest : public ::testing::Test {
 protected:
  GazeControllerTest()
      : gaze_(bench_.geometry, bench_.limits, bench_.zoom, GazeParams{}),
        motion_({bench_.base_limits, bench_.tick_s}) {
    landmarks_ = LandmarkMap({disc_at(1, {4.0, 1.0, 1.6}, kPi), disc_at(2, {-4.0, 0.5, 1.6}, 0.0)});
    bench_.zoom = test_zoom();
  }

  GazeOrder order_for(LandmarkId id, double expires_s = 60.0) const {
    GazeOrder order;
    order.look = 1;
    order.landmark = id;
    order.issued = bench_.now;
    order.expires = bench_.now + Duration::from_seconds(expires_s);
    return order;
  }

  Belief belief() const {
    Belief belief;
    belief.stamp = bench_.now;
    belief.pose = compose(bench_.pose, belief_error_);
    belief.covariance = covariance_;
    return belief;
  }

  std::optional<GazeSighting> look(LandmarkId id) const {
    const Landmark* landmark = landmarks_.find(id);
    if (landmark == nullptr || hidden_) return std::nullopt;
    const auto uv = bench_.pixel(landmark->centre_w());
    if (!uv || !in_image(bench_.intrinsics(), *uv, 10.0)) return std::nullopt;
    const double range = bench_.in_camera(landmark->centre_w()).norm();
    return GazeSighting{*uv, bench_.intrinsics().px * kDiscRadius / range};
  }

  /// One tick of the loop; the sighting answers the previous tick's request.
  GazeOutput tick() {
    std::optional<GazeSighting> sighting;
    if (request_ != TrackRequest::none && gaze_.current())
      sighting = look(gaze_.current()->landmark);
    const BaseRates expected = motion_.expect(odometry_, drive_);
    const Belief believed = belief();
    const GazeOutput output = gaze_.step(
        {bench_.now, bench_.head, expected, believed, landmarks_, bench_.intrinsics(), sighting});
    request_ = output.request;
    const Pose2 before = bench_.pose;
    bench_.advance(drive_, output.command);
    odometry_ = {(bench_.pose.position() - before.position()).norm() / bench_.tick_s,
                 wrap_angle(bench_.pose.theta - before.theta) / bench_.tick_s};
    last_ = output;
    return output;
  }

  /// Ticks until an event; none when there was none within @p seconds.
  GazeEvent run_to_event(double seconds) {
    const Stamp end = bench_.now + Duration::from_seconds(seconds);
    while (bench_.now < end) {
      const GazeOutput output = tick();
      if (output.event != GazeEvent::none) return output.event;
    }
    return GazeEvent::none;
  }

  /// Ticks until the state is reached; whether it was within @p seconds.
  bool run_to_state(GazeState state, double seconds) {
    const Stamp end = bench_.now + Duration::from_seconds(seconds);
    while (gaze_.state() != state && bench_.now < end) tick();
    return gaze_.state() == state;
  }

  void run(double seconds) {
    const Stamp end = bench_.now + Duration::from_seconds(seconds);
    while (bench_.now < end) tick();
  }

  double error_px(LandmarkId id) const {
    const auto uv = bench_.pixel(landmarks_.find(id)->centre_w());
    const Intrinsics camera = bench_.intrinsics();
    return uv ? (*uv - Vector2d(camera.u0, camera.v0)).norm() : 1e9;
  }

  HeadBench bench_;
  GazeController gaze_;
  BaseMotion motion_;
  LandmarkMap landmarks_;
  Pose2 belief_error_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  BaseRates drive_;
  BaseRates odometry_;
  TrackRequest request_ = TrackRequest::none;
  GazeOutput last_;
  bool hidden_ = false;
};

TEST_F(GazeControllerTest, IdleKeepsTheHeadStillAndAsksForNothing) {
  drive_ = {0.3, 0.2};
  for (int i = 0; i < 50; ++i) {
    const GazeOutput output = tick();
    EXPECT_EQ(output.command.angles.pan, 0.0);
    EXPECT_EQ(output.command.angles.tilt, 0.0);
    EXPECT_EQ(output.command.zoom_mm_s, 0.0);
    EXPECT_EQ(output.request, TrackRequest::none);
    EXPECT_EQ(output.event, GazeEvent::none);
  }
  EXPECT_EQ(gaze_.state(), GazeState::idle);
}

TEST_F(GazeControllerTest, AnOrderRunsThroughSlewAcquireTrackAndReleasesAfterTheDwell) {
  gaze_.order(order_for(1));
  EXPECT_EQ(gaze_.state(), GazeState::slew);
  EXPECT_EQ(tick().request, TrackRequest::none);
  ASSERT_TRUE(run_to_state(GazeState::acquire, 5.0));
  EXPECT_EQ(last_.request, TrackRequest::acquire);
  ASSERT_EQ(run_to_event(1.0), GazeEvent::acquired);
  EXPECT_EQ(gaze_.state(), GazeState::track);
  EXPECT_EQ(last_.request, TrackRequest::track);
  const Stamp acquired = bench_.now;
  ASSERT_EQ(run_to_event(3.0), GazeEvent::released);
  EXPECT_NEAR((bench_.now - acquired).seconds(), 1.0, 0.5 * bench_.tick_s);
  EXPECT_EQ(gaze_.state(), GazeState::idle);
  EXPECT_FALSE(gaze_.current());
  EXPECT_EQ(last_.request, TrackRequest::none);
}

TEST_F(GazeControllerTest, TheSlewTakesLittleLongerThanTheLimitsDemand) {
  bench_.head.zoom_mm = 12.0;
  gaze_.order(order_for(2));
  const HeadAngles aim = aim_at(bench_.geometry, landmarks_.find(2)->centre_w());
  // From rest to rest under 1.5 rad/s and 8 rad/s².
  const double least = std::abs(aim.pan) / 1.5 + 1.5 / 8.0;
  const Stamp start = bench_.now;
  ASSERT_TRUE(run_to_state(GazeState::acquire, 10.0));
  EXPECT_LT((bench_.now - start).seconds(), least + 0.3);
}

TEST_F(GazeControllerTest, ZoomIsPresetSoThatTheDiscHasTheOrderedSizeWhenAcquired) {
  gaze_.order(order_for(1));
  ASSERT_EQ(run_to_event(10.0), GazeEvent::acquired);
  const auto sighting = look(1);
  ASSERT_TRUE(sighting);
  EXPECT_NEAR(std::log(sighting->radius_px / 24.0), 0.0, GazeParams{}.settle_focal + 1e-3);
}

TEST_F(GazeControllerTest, APlannedZoomStaysAsItIsWhileTheLandmarkIsWatched) {
  GazeOrder order = order_for(1);
  order.zoom_mm = 12.0;
  order.dwell_s = 20.0;
  gaze_.order(order);
  ASSERT_TRUE(run_to_state(GazeState::track, 5.0));
  // Between 8 px and half of half the image the size is the plan's business.
  for (int i = 0; i < 100; ++i) {
    tick();
    ASSERT_NEAR(bench_.head.zoom_mm, 12.0, 12.0 * GazeParams{}.settle_focal);
  }
}

TEST_F(GazeControllerTest, APlannedZoomGivesWayWhereTheLandmarkWouldBeTooSmallOrTooLarge) {
  for (const auto& [x, zoom] : {std::pair(-12.0, 8.0), std::pair(3.2, 48.0)}) {
    bench_.pose = {x, 1.0, 0.0};
    GazeOrder order = order_for(1);
    order.zoom_mm = zoom;
    gaze_.order(order);
    ASSERT_TRUE(run_to_state(GazeState::track, 8.0)) << x;
    const auto sighting = look(1);
    ASSERT_TRUE(sighting);
    const double slack = std::exp(GazeParams{}.settle_focal + 1e-3);
    EXPECT_GE(sighting->radius_px * slack, GazeParams{}.planned_min_px) << x;
    EXPECT_LE(sighting->radius_px, slack * GazeParams{}.planned_max * 240.0) << x;
    gaze_.cancel();
  }
}

TEST_F(GazeControllerTest, IdleItWaitsWhereItIsToldTo) {
  GazeOrder waiting = order_for(2);
  waiting.zoom_mm = 12.0;
  gaze_.rest_at(waiting);
  run(4.0);
  EXPECT_EQ(gaze_.state(), GazeState::idle);
  EXPECT_EQ(request_, TrackRequest::none);
  EXPECT_NEAR(bench_.head.zoom_mm, 12.0, 0.05);
  EXPECT_LT(error_px(2), 5.0);
  // The order that was waited for begins to acquire at once.
  gaze_.order(waiting);
  tick();
  EXPECT_EQ(gaze_.state(), GazeState::acquire);
  gaze_.cancel();
  gaze_.rest_at(std::nullopt);
  tick();
  EXPECT_EQ(last_.command.angles.pan, 0.0);
  EXPECT_EQ(last_.command.zoom_mm_s, 0.0);
}

TEST_F(GazeControllerTest, HeadAndZoomMeetAMovingLandmarkWhereItWillBe) {
  drive_ = {0.3, 0.1};
  run(2.0);
  gaze_.order(order_for(1));
  ASSERT_EQ(run_to_event(5.0), GazeEvent::acquired);
  // Seen in the first frame after arrival, within the slew's tolerance and a tick of its motion.
  EXPECT_LT(error_px(1), bench_.intrinsics().px * from_deg(GazeParams{}.settle_deg + 0.5));
}

TEST_F(GazeControllerTest, TheSlewSettlesOnALandmarkThatATurningBaseSweepsPast) {
  for (const double w : {-0.8, -0.3, 0.3, 0.8}) {
    bench_.pose = {};
    bench_.head = {};
    drive_ = {0.0, w};
    run(0.6);
    gaze_.order(order_for(1));
    EXPECT_EQ(run_to_event(1.5), GazeEvent::acquired) << "turning at " << w << " rad/s";
  }
}

TEST_F(GazeControllerTest, TracksWithinHalfAPixelWhileDrivingThoughTheBeliefIsOff) {
  belief_error_ = {0.05, -0.05, from_deg(2.0)};
  drive_ = {0.3, 0.1};
  run(1.0);
  GazeOrder order = order_for(1);
  order.dwell_s = 4.0;
  gaze_.order(order);
  ASSERT_EQ(run_to_event(5.0), GazeEvent::acquired);
  run(1.5);
  double sum = 0.0;
  int count = 0;
  while (gaze_.state() == GazeState::track) {
    // In pixels of the 700 px camera, whatever the zoom.
    const double error = error_px(1) * 700.0 / bench_.intrinsics().px;
    sum += error * error;
    ++count;
    tick();
  }
  EXPECT_EQ(last_.event, GazeEvent::released);
  EXPECT_LE(std::sqrt(sum / count), 0.5);
}

TEST_F(GazeControllerTest, AnUncertainBeliefZoomsOutUntilTheLandmarkIsSureToBeInTheImage) {
  GazeOrder order = order_for(1);
  order.radius_px = 80.0;
  const double sigma = from_deg(4.0);
  covariance_(2, 2) = sigma * sigma;
  gaze_.order(order);
  ASSERT_TRUE(run_to_state(GazeState::acquire, 10.0));
  EXPECT_GT(bench_.intrinsics().height * 0.5, bench_.intrinsics().px * std::tan(3.0 * sigma));
  // A sure belief zooms in to the ordered size.
  covariance_.setZero();
  gaze_.order(order);
  ASSERT_TRUE(run_to_state(GazeState::acquire, 10.0));
  EXPECT_LT(bench_.intrinsics().height * 0.5, bench_.intrinsics().px * std::tan(3.0 * sigma));
}

TEST_F(GazeControllerTest, TheHeadTakesTheLongWayRoundRatherThanThroughThePansStop) {
  // The landmark lies behind, just beyond the stop from where the head is.
  landmarks_ = LandmarkMap({disc_at(3, {-4.0, -0.5, 1.6}, 0.0)});
  bench_.head.angles.pan = from_deg(175.0);
  gaze_.order(order_for(3));
  tick();
  EXPECT_LT(last_.command.angles.pan, 0.0);
  EXPECT_EQ(run_to_event(8.0), GazeEvent::acquired);
  EXPECT_LT(bench_.head.angles.pan, 0.0);
}

TEST_F(GazeControllerTest, ALandmarkTrackedAcrossThePansStopIsLostAndFoundOnTheOtherSide) {
  bench_.head.angles.pan = from_deg(165.0);
  landmarks_ = LandmarkMap({disc_at(3, {-4.0, 0.5, 1.6}, 0.0)});
  drive_ = {0.0, -0.3};
  GazeOrder order = order_for(3);
  order.dwell_s = 30.0;
  gaze_.order(order);
  ASSERT_EQ(run_to_event(5.0), GazeEvent::acquired);
  EXPECT_GT(bench_.head.angles.pan, 0.0);
  ASSERT_EQ(run_to_event(10.0), GazeEvent::lost);
  ASSERT_TRUE(run_to_state(GazeState::slew, 1.0));
  ASSERT_EQ(run_to_event(8.0), GazeEvent::acquired);
  EXPECT_LT(bench_.head.angles.pan, 0.0);
}

TEST_F(GazeControllerTest, ABlinkShorterThanTheGraceDoesNotLoseTheTarget) {
  drive_ = {0.3, 0.1};
  GazeOrder order = order_for(1);
  order.dwell_s = 3.0;
  gaze_.order(order);
  ASSERT_EQ(run_to_event(5.0), GazeEvent::acquired);
  run(1.0);
  hidden_ = true;
  run(0.36);
  EXPECT_EQ(gaze_.state(), GazeState::track);
  EXPECT_EQ(last_.request, TrackRequest::track);
  // The prediction by the base's motion has kept it centred meanwhile.
  EXPECT_LT(error_px(1), 5.0);
  hidden_ = false;
  EXPECT_EQ(run_to_event(5.0), GazeEvent::released);
}

TEST_F(GazeControllerTest, ATargetUnseenForTheGraceIsLostAndFoundAgainWhereItWas) {
  GazeOrder order = order_for(1);
  order.dwell_s = 2.0;
  gaze_.order(order);
  ASSERT_EQ(run_to_event(5.0), GazeEvent::acquired);
  run(0.5);
  hidden_ = true;
  ASSERT_EQ(run_to_event(1.0), GazeEvent::lost);
  EXPECT_EQ(gaze_.state(), GazeState::lost);
  EXPECT_EQ(last_.request, TrackRequest::acquire);
  run(0.4);
  EXPECT_EQ(gaze_.state(), GazeState::lost);
  hidden_ = false;
  ASSERT_EQ(run_to_event(0.2), GazeEvent::acquired);
  const Stamp again = bench_.now;
  // The dwell begins anew.
  ASSERT_EQ(run_to_event(5.0), GazeEvent::released);
  EXPECT_NEAR((bench_.now - again).seconds(), 2.0, 0.5 * bench_.tick_s);
}

TEST_F(GazeControllerTest, ALostTargetIsSearchedForAndThenGivenUp) {
  gaze_.order(order_for(1));
  ASSERT_EQ(run_to_event(5.0), GazeEvent::acquired);
  hidden_ = true;
  ASSERT_EQ(run_to_event(1.0), GazeEvent::lost);
  ASSERT_TRUE(run_to_state(GazeState::search, 1.5));
  const Stamp start = bench_.now;
  ASSERT_EQ(run_to_event(10.0), GazeEvent::expired);
  EXPECT_NEAR((bench_.now - start).seconds(), GazeParams{}.search_s, 2.0 * bench_.tick_s);
  EXPECT_EQ(gaze_.state(), GazeState::idle);
}

TEST_F(GazeControllerTest, SearchFindsALandmarkThatTheBeliefMisplaces) {
  // 14° of heading error against half fields of 4° to 5° at the aim's zoom.
  belief_error_ = {0.0, 0.0, from_deg(14.0)};
  GazeOrder order = order_for(1);
  order.radius_px = 60.0;
  gaze_.order(order);
  ASSERT_TRUE(run_to_state(GazeState::search, 8.0));
  EXPECT_EQ(run_to_event(GazeParams{}.search_s), GazeEvent::acquired);
  EXPECT_EQ(gaze_.state(), GazeState::track);
}

TEST_F(GazeControllerTest, TheSearchSpiralLeavesNoGapWiderThanTheField) {
  hidden_ = true;
  gaze_.order(order_for(1));
  ASSERT_TRUE(run_to_state(GazeState::search, 8.0));
  const HeadAngles aim = aim_at(bench_.geometry, landmarks_.find(1)->centre_w());
  std::vector<HeadAngles> seen;
  double widest = 0.0;
  while (gaze_.state() == GazeState::search) {
    seen.push_back({bench_.head.angles.pan - aim.pan, bench_.head.angles.tilt - aim.tilt});
    widest = std::max(widest, std::hypot(seen.back().pan, seen.back().tilt));
    tick();
  }
  const double half_field = std::atan(240.0 / bench_.intrinsics().px);
  EXPECT_GT(widest, half_field);
  for (double r = 0.0; r < widest; r += 0.2 * half_field) {
    for (double angle = 0.0; angle < 2.0 * kPi; angle += 0.3) {
      const HeadAngles probe{r * std::cos(angle), r * std::sin(angle)};
      double nearest = 1e9;
      for (const HeadAngles& s : seen)
        nearest =
            std::min(nearest, std::max(std::abs(s.pan - probe.pan), std::abs(s.tilt - probe.tilt)));
      EXPECT_LT(nearest, half_field) << "at radius " << r << ", angle " << angle;
    }
  }
}

TEST_F(GazeControllerTest, AnOrderThatFindsNothingExpires) {
  hidden_ = true;
  gaze_.order(order_for(1, 2.5));
  const Stamp start = bench_.now;
  ASSERT_EQ(run_to_event(10.0), GazeEvent::expired);
  EXPECT_NEAR((bench_.now - start).seconds(), 2.5, 2.0 * bench_.tick_s);
  EXPECT_EQ(gaze_.state(), GazeState::idle);
  EXPECT_FALSE(gaze_.current());
}

TEST_F(GazeControllerTest, AnOrderExpiresDuringTheSlewToo) {
  gaze_.order(order_for(2, 0.5));
  ASSERT_EQ(run_to_event(10.0), GazeEvent::expired);
  EXPECT_EQ(gaze_.state(), GazeState::idle);
}

TEST_F(GazeControllerTest, WhatIsTrackedIsWatchedBeyondTheExpiry) {
  GazeOrder order = order_for(1, 2.5);
  order.dwell_s = 4.0;
  gaze_.order(order);
  ASSERT_EQ(run_to_event(2.5), GazeEvent::acquired);
  EXPECT_EQ(run_to_event(6.0), GazeEvent::released);
}

TEST_F(GazeControllerTest, ATargetLostAfterTheExpiryIsNotSearchedFor) {
  GazeOrder order = order_for(1, 2.0);
  order.dwell_s = 10.0;
  gaze_.order(order);
  ASSERT_EQ(run_to_event(2.0), GazeEvent::acquired);
  run(2.0);
  hidden_ = true;
  ASSERT_EQ(run_to_event(1.0), GazeEvent::lost);
  EXPECT_EQ(run_to_event(0.05), GazeEvent::expired);
}

TEST_F(GazeControllerTest, ANewOrderReplacesTheOldOneInEveryState) {
  const auto replaces = [this](GazeState state) {
    hidden_ = false;
    gaze_.order(order_for(1));
    if (state == GazeState::acquire || state == GazeState::search) hidden_ = true;
    if (state == GazeState::lost) {
      run_to_state(GazeState::track, 10.0);
      hidden_ = true;
    }
    if (state == GazeState::idle) gaze_.cancel();
    EXPECT_TRUE(run_to_state(state, 10.0)) << to_string(state);
    hidden_ = false;
    GazeOrder order = order_for(2);
    order.look = 7;
    gaze_.order(order);
    EXPECT_EQ(gaze_.state(), GazeState::slew) << to_string(state);
    EXPECT_EQ(gaze_.current()->look, 7) << to_string(state);
    EXPECT_EQ(run_to_event(10.0), GazeEvent::acquired) << to_string(state);
    // A sighting of the old landmark does not count for the new one: the head is at the new one.
    EXPECT_LT(error_px(2), 240.0) << to_string(state);
  };
  for (const GazeState state : {GazeState::idle, GazeState::slew, GazeState::acquire,
                                GazeState::track, GazeState::lost, GazeState::search})
    replaces(state);
}

TEST_F(GazeControllerTest, ASightingOfTheOldOrderDoesNotCountForTheNewOne) {
  gaze_.order(order_for(1));
  ASSERT_EQ(run_to_event(5.0), GazeEvent::acquired);
  gaze_.order(order_for(2));
  const GazeOutput output = tick();  // brings the answer to the old request
  EXPECT_EQ(output.event, GazeEvent::none);
  EXPECT_EQ(gaze_.state(), GazeState::slew);
}

TEST_F(GazeControllerTest, CancelStopsTheHeadAndDropsTheOrder) {
  gaze_.order(order_for(2));
  run(0.5);
  gaze_.cancel();
  EXPECT_EQ(gaze_.state(), GazeState::idle);
  const GazeOutput output = tick();
  EXPECT_EQ(output.command.angles.pan, 0.0);
  EXPECT_EQ(output.event, GazeEvent::none);
}

TEST_F(GazeControllerTest, AnOrderForALandmarkThatTheMapDoesNotHoldExpiresAtOnce) {
  gaze_.order(order_for(99));
  EXPECT_EQ(tick().event, GazeEvent::expired);
  EXPECT_EQ(gaze_.state(), GazeState::idle);
}

TEST_F(GazeControllerTest, ABeliefThatPutsTheRobotIntoTheLandmarkStillGivesFiniteRates) {
  gaze_.order(order_for(1));
  ASSERT_EQ(run_to_event(5.0), GazeEvent::acquired);
  landmarks_ = LandmarkMap({disc_at(1, {4.0, 1.0, 1.0}, kPi)});
  belief_error_ = {3.85, 1.0, 0.0};
  for (int i = 0; i < 100; ++i) {
    const GazeOutput output = tick();
    EXPECT_TRUE(std::isfinite(output.command.angles.pan));
    EXPECT_TRUE(std::isfinite(output.command.angles.tilt));
    EXPECT_TRUE(std::isfinite(output.command.zoom_mm_s));
  }
}

TEST_F(GazeControllerTest, AJumpOfTheBeliefSendsTheHeadBackToTheSlew) {
  hidden_ = true;
  gaze_.order(order_for(1));
  ASSERT_TRUE(run_to_state(GazeState::acquire, 5.0));
  belief_error_ = {0.0, 0.0, from_deg(60.0)};
  tick();
  EXPECT_EQ(gaze_.state(), GazeState::slew);
}

}  // namespace
}  // namespace vigia::servo

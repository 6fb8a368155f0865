#include "vigia/localization/field_localizer.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

FieldMap middle_size_field() {
  MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/fields/12x8.yaml"), "file");
  return read_field_map(reader.map("field"));
}

/// What a robot there sees within 4 m, exactly.
FieldObservation seen_from(const FieldMap& field, const Pose2& pose, Stamp stamp) {
  FieldObservation seen;
  seen.shot.stamp = seen.scan.stamp = stamp;
  const Pose2 rMw = inverse(pose);
  for (int i = 0; i < 60; ++i) {
    std::vector<LineCrossing> crossings;
    const double angle = 2.0 * kPi * i / 60.0;
    for (const FieldLine& line : field.lines)
      cross_line(line, pose.position(), unit_vector(angle), 4.0, crossings);
    for (const LineCrossing& crossing : crossings)
      seen.scan.points.push_back(
          polar_point(angle + rMw.theta, crossing.range_m, 0.002, 0.005 * crossing.range_m));
  }
  return seen;
}

Prior prior_at(const Pose2& pose) {
  return {pose, Eigen::Vector3d(0.01, 0.01, 0.003).asDiagonal()};
}

const Pose2 kStart{-2.0, 1.0, 0.4};

std::unique_ptr<FieldLocalizer> tracker(const FieldMap& field) {
  return make_field_tracker(field, {});
}

TEST(FieldLocalizer, ALateScanIsCarriedToThePresent) {
  const FieldMap field = middle_size_field();
  const auto localizer = tracker(field);
  localizer->reset({}, prior_at(kStart));
  const FieldObservation seen = seen_from(field, kStart, {});
  Pose2 pose = kStart;
  for (int i = 0; i < 5; ++i) {
    const OdometryIncrement u{Stamp::from_seconds(0.04 * i), Stamp::from_seconds(0.04 * (i + 1)),
                              0.05, 0.06, 0.05};
    pose = move(pose, u);
    localizer->predict(u);
  }
  EXPECT_EQ(localizer->update(seen).status, UpdateStatus::fused);
  EXPECT_LT((localizer->belief().pose.position() - pose.position()).norm(), 0.003);
  EXPECT_LT(std::abs(wrap_angle(localizer->belief().pose.theta - pose.theta)), 0.003);
}

TEST(FieldLocalizer, AScanOlderThanWhatIsRememberedIsTooLate) {
  const FieldMap field = middle_size_field();
  const auto localizer = tracker(field);
  localizer->reset({}, prior_at(kStart));
  for (int i = 0; i < 30; ++i)
    localizer->predict({Stamp::from_seconds(0.1 * i), Stamp::from_seconds(0.1 * (i + 1))});
  EXPECT_EQ(localizer->update(seen_from(field, kStart, {})).status, UpdateStatus::too_late);
}

TEST(FieldLocalizer, LandmarksAreUnsupportedAndAScanOfNothingIsDegenerate) {
  const auto localizer = tracker(middle_size_field());
  localizer->reset({}, prior_at(kStart));
  EXPECT_EQ(localizer->update(EllipseObservation{}).status, UpdateStatus::unsupported);
  EXPECT_EQ(localizer->update(FieldObservation{}).status, UpdateStatus::degenerate);
}

TEST(FieldLocalizer, FindsItselfAgainAfterItWasToldThatItIsLost) {
  const FieldMap field = middle_size_field();
  const auto localizer = tracker(field);
  localizer->reset({}, prior_at(kStart));
  localizer->lose();
  EXPECT_EQ(localizer->belief().status, BeliefStatus::lost);
  localizer->update(seen_from(field, kStart, {}));
  // Lines alone cannot tell the two halves apart.
  ASSERT_EQ(localizer->belief().status, BeliefStatus::ambiguous);
  double nearest = 1.0;
  for (const PoseHypothesis& hypothesis : localizer->belief().hypotheses)
    nearest = std::min(nearest, (hypothesis.pose.position() - kStart.position()).norm());
  EXPECT_LT(nearest, 0.02);
}

TEST(FieldScan, CarriedToAnotherFrameItShowsTheSamePlaces) {
  const FieldMap field = middle_size_field();
  const Pose2 there{-1.5, 0.6, -0.7};
  FieldScan scan = seen_from(field, kStart, {}).scan;
  scan.goals.push_back({FieldColour::blue, 0.3, 2.0, 0.01, 0.1});
  const FieldScan same = carried(scan, compose(inverse(there), kStart), Stamp::from_seconds(1.0));
  EXPECT_EQ(same.stamp, Stamp::from_seconds(1.0));
  for (const FieldPoint& point : same.points) {
    const Eigen::Isometry3d wMr = to_isometry(there);
    const Eigen::Vector3d p = wMr * Eigen::Vector3d(point.p_r.x(), point.p_r.y(), 0.0);
    double nearest = 1.0;
    for (const FieldLine& line : field.lines)
      nearest = std::min(nearest, distance_to_line(line, p.head<2>()));
    EXPECT_LT(nearest, 1e-9);
  }
  const Eigen::Vector2d goal = kStart.position() + 2.0 * unit_vector(kStart.theta + 0.3);
  const Eigen::Vector2d again =
      there.position() + same.goals[0].range_m * unit_vector(there.theta + same.goals[0].bearing);
  EXPECT_LT((goal - again).norm(), 1e-12);
}

}  // namespace
}  // namespace vigia::localization

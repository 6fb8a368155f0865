#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/sim/params.hpp"

namespace vigia::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

FloorPlan room() {
  return FloorPlan({{0, 0}, {10, 0}, {10, 6}, {0, 6}}, 2.8, {},
                   {Obstacle{{{4, 0}, {5, 0}, {5, 1}, {4, 1}}, 0.2},
                    Obstacle{{{8, 2}, {9, 2}, {9, 3}, {8, 3}}, 0.8}});
}

/// The same by a fan of thin rays, which knows nothing of sectors.
double by_rays(const FloorPlan& plan, const std::vector<Pillar>& pillars, const Eigen::Vector2d& p,
               double direction, double cone, double reach_m, double above_m) {
  double nearest = reach_m;
  constexpr int kRays = 2000;
  for (int i = 0; i <= kRays; ++i) {
    const double angle = direction + cone * (1.0 * i / kRays - 0.5);
    const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
    if (const auto hit = plan.cast(p, ray, nearest, above_m)) nearest = hit->distance_m;
    for (const Pillar& pillar : pillars) {
      const Eigen::Vector2d to = pillar.centre - p;
      const double along = ray.dot(to);
      const double off2 = to.squaredNorm() - along * along;
      const double chord2 = pillar.radius_m * pillar.radius_m - off2;
      if (pillar.height_m > above_m && along > 0.0 && chord2 >= 0.0)
        nearest = std::min(nearest, along - std::sqrt(chord2));
    }
  }
  return nearest;
}

TEST(RangeRing, ABeamHearsTheNearestThingInItsCone) {
  const FloorPlan plan = room();
  RandomStream random(1, "beams");
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d p(random.uniform(0.5, 7.5), random.uniform(1.2, 5.5));
    const std::vector<Pillar> pillars{
        {{random.uniform(0.5, 9.5), random.uniform(0.5, 5.5)}, 0.25, 1.75}};
    if ((pillars.front().centre - p).norm() < 0.3) continue;
    const double direction = random.uniform(-kPi, kPi);
    const double cone = from_deg(random.uniform(1.0, 40.0));
    const double rays = by_rays(plan, pillars, p, direction, cone, 4.0, 0.3);
    const double exact = nearest_in_cone(plan, pillars, p, direction, cone, 4.0, 0.3).value_or(4.0);
    EXPECT_LE(exact, rays + 1e-9);
    // Two neighbouring rays of the fan may pass a corner by 4 m · 40° / 2000.
    EXPECT_GT(exact, rays - 4.0 * from_deg(40.0) / 2000.0 * 3.0) << "beam " << i;
  }
}

TEST(RangeRing, WhatIsLowerThanTheRingGivesNoEcho) {
  const FloorPlan plan = room();
  const Eigen::Vector2d p(4.5, 2.0);
  const double down = from_deg(-90);
  EXPECT_NEAR(*nearest_in_cone(plan, {}, p, down, from_deg(15), 4.0, 0.3), 2.0, 1e-9);
  EXPECT_NEAR(*nearest_in_cone(plan, {}, p, down, from_deg(15), 4.0, 0.1), 1.0, 1e-9);
  EXPECT_FALSE(nearest_in_cone(plan, {}, p, from_deg(180), from_deg(15), 4.0, 0.3));
}

TEST(RangeRing, ItsReadingsHaveTheNoiseAndTheDropoutOfTheFile) {
  RangeRingParams params;
  params.sigma_m = 0.02;
  params.sigma_relative = 0.01;
  params.dropout = 0.1;
  RangeRing ring(params, 5);
  const FloorPlan plan = room();
  const Pose2 pose{2.0, 3.0, from_deg(90)};
  constexpr int kScans = 4000;
  double mean = 0.0;
  double square = 0.0;
  int echoes = 0;
  for (int i = 0; i < kScans; ++i) {
    const RangeScan scan = ring.scan({i}, pose, plan, {});
    ASSERT_EQ(scan.readings.size(), 24U);
    // Beam 6 looks at 90° of the base, which is along −x: the wall at x = 0.
    const RangeReading& reading = scan.readings[6];
    EXPECT_NEAR(reading.bearing, from_deg(90), 1e-12);
    if (!reading.echo) {
      EXPECT_EQ(reading.range_m, params.reach_m);
      continue;
    }
    ++echoes;
    mean += reading.range_m - 2.0;
    square += (reading.range_m - 2.0) * (reading.range_m - 2.0);
  }
  constexpr double kSigmas = 4.5;
  const double variance = 0.02 * 0.02 + 0.02 * 0.02;
  EXPECT_LT(std::abs(mean / echoes), kSigmas * std::sqrt(variance / echoes));
  EXPECT_LT(std::abs(square / echoes / variance - 1.0), kSigmas * std::sqrt(2.0 / echoes));
  EXPECT_LT(std::abs(echoes - 0.9 * kScans), kSigmas * std::sqrt(0.1 * 0.9 * kScans));
}

TEST(RangeRing, TheSameSeedReadsTheSame) {
  RangeRing a({}, 7);
  RangeRing b({}, 7);
  const auto first = a.scan({}, {3, 3, 1}, room(), {});
  const auto second = b.scan({}, {3, 3, 1}, room(), {});
  for (std::size_t i = 0; i < first.readings.size(); ++i)
    EXPECT_EQ(first.readings[i].range_m, second.readings[i].range_m);
}

TEST(RangeRing, SaysWhatIsWrongInItsFile) {
  MapReader reader(parse_config("version: 1\nrange_ring: {cone_deg: 400}\n", "robot.yaml"),
                   "robot");
  try {
    RangeRingParams params;
    read_params(reader.map("range_ring"), params);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("robot.yaml:2:"), HasSubstr("cone_deg")));
  }
}

}  // namespace
}  // namespace vigia::sim

#include "vigia/tracking/goal_corner_finder.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "vigia/core/config.hpp"
#include "vigia/core/goal_corner.hpp"
#include "vigia/core/random.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::tracking {
namespace {

constexpr double kHeight_m = 0.06;
constexpr double kBaseline_m = 0.03;

/// The MiroSot field of the configuration, seen by the pair of its robot.
struct GoalScene {
  explicit GoalScene(int scale = 1) {
    MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/worlds/mirosot.yaml"), "world");
    world = read_world_map(reader);
    scene = std::make_unique<sim::Scene>(world, sim::read_appearance(reader, world), 5);
    camera = {
        320 * scale,         240 * scale, 277.128 * scale, 277.128 * scale, 160.0 * scale - 0.5,
        120.0 * scale - 0.5, 0.0};
    imaging.colour = true;
    imaging.samples = 16;
  }

  /// @p side: +1 the left camera, −1 the right.
  Eigen::Isometry3d wMc(const Pose2& robot, double side) const {
    Eigen::Isometry3d rMc(Eigen::Translation3d(0.0, 0.5 * side * kBaseline_m, kHeight_m));
    rMc.linear() = head_from_camera();
    return Ground().place(robot) * rMc;
  }
  std::unique_ptr<imaging::Frame> expose(const Pose2& robot, double side, int number) const {
    return scene->expose(wMc(robot, side), camera, Stamp{number}, imaging, side > 0.0 ? 0 : 1);
  }
  /// Column of a corner, where it is well inside the image and before the camera.
  std::optional<double> column(const Pose2& robot, double side, const GoalCorner& corner) const {
    const Eigen::Vector2d p = *goal_corner_place(*world.field, corner);
    const Eigen::Vector3d p_c = wMc(robot, side).inverse() * Eigen::Vector3d(p.x(), p.y(), 0.025);
    if (p_c.z() < 0.1) return std::nullopt;
    const auto uv = project(camera, p_c);
    if (!uv || uv->x() < 16.0 || uv->x() > camera.width - 17.0) return std::nullopt;
    return uv->x();
  }

  WorldMap world;
  std::unique_ptr<sim::Scene> scene;
  Intrinsics camera;
  sim::ImagingParams imaging;
};

const GoalCorner kCorners[] = {{FieldColour::yellow, true},
                               {FieldColour::yellow, false},
                               {FieldColour::blue, true},
                               {FieldColour::blue, false}};

/// What became of the corners that both images show.
struct CornerTally {
  int shown = 0;
  int found = 0;
  int matched = 0;
  int false_ones = 0;
  double square = 0.0;  ///< px², of both columns
  double square_disparity = 0.0;
  double chi_square = 0.0;  ///< of both columns
  double worst = 0.0;
};

void tally_view(const GoalScene& scene, const GoalCornerFinder& finder, const Pose2& robot,
                int number, CornerTally& tally) {
  const auto left = scene.expose(robot, 1.0, number);
  const auto right = scene.expose(robot, -1.0, number);
  const GoalCornerScan scan = finder.find(*left);
  std::vector<bool> used(scan.corners.size(), false);
  for (const GoalCorner& corner : kCorners) {
    const auto u_left = scene.column(robot, 1.0, corner);
    const auto u_right = scene.column(robot, -1.0, corner);
    if (!u_left || !u_right) continue;
    ++tally.shown;
    for (std::size_t i = 0; i < scan.corners.size(); ++i) {
      const GoalCornerImage& seen = scan.corners[i];
      if (seen.colour != corner.goal || seen.colour_on_right != corner.left ||
          std::abs(seen.u - *u_left) > 2.0)
        continue;
      used[i] = true;
      ++tally.found;
      const auto same = finder.find_same(*right, seen, {2.0, 140.0});
      if (!same) continue;
      ++tally.matched;
      const double e_left = seen.u - *u_left;
      const double e_right = same->u - *u_right;
      tally.square += e_left * e_left + e_right * e_right;
      tally.square_disparity += (e_left - e_right) * (e_left - e_right);
      tally.chi_square +=
          std::pow(e_left / seen.sigma_px, 2) + std::pow(e_right / same->sigma_px, 2);
      tally.worst = std::max({tally.worst, std::abs(e_left), std::abs(e_right)});
    }
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    const double u = scan.corners[i].u;
    if (!used[i] && u > 16.0 && u < scene.camera.width - 17.0) ++tally.false_ones;
  }
}

CornerTally tally_views(const GoalScene& scene, std::uint64_t seed, int views) {
  GoalCornerParams params;
  params.first_row = static_cast<int>(scene.camera.v0) - 4;
  const GoalCornerFinder finder(params);
  RandomStream random(seed, "views");
  CornerTally tally;
  for (int i = 0; i < views; ++i) {
    const Pose2 robot{random.uniform(-0.6, 0.6), random.uniform(-0.55, 0.55),
                      random.uniform(-kPi, kPi)};
    tally_view(scene, finder, robot, i + 1, tally);
  }
  return tally;
}

void report(const char* what, const CornerTally& tally) {
  const double n = 2.0 * tally.matched;
  std::printf(
      "%s: shown %d found %d matched %d false %d rms %.4f px, disparity %.4f px, worst %.3f, "
      "NEES a column %.2f\n",
      what, tally.shown, tally.found, tally.matched, tally.false_ones, std::sqrt(tally.square / n),
      std::sqrt(tally.square_disparity / tally.matched), tally.worst, tally.chi_square / n);
}

TEST(GoalCornerFinder, FindsTheCornersOfRenderedGoalsInBothImages) {
  const GoalScene scene;
  const CornerTally tally = tally_views(scene, 11, 24);
  report("QVGA", tally);
  EXPECT_EQ(tally.shown, 9);
  EXPECT_EQ(tally.matched, tally.shown);
  EXPECT_EQ(tally.false_ones, 0);
  EXPECT_LT(tally.worst, 0.15);
}

}  // namespace
}  // namespace vigia::tracking

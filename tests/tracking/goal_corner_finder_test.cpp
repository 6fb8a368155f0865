#include "vigia/tracking/goal_corner_finder.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "vigia/core/config.hpp"
#include "vigia/core/goal_corner.hpp"
#include "vigia/core/random.hpp"
#include "vigia/core/world_map.hpp"
#include "vigia/imaging/image_frame.hpp"
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
  const CornerTally tally = tally_views(scene, 11, 300);
  report("QVGA", tally);
  EXPECT_GT(tally.shown, 60);
}

/// A goal between white walls, drawn by OpenCV at eight times the size and scaled down: @p edges
/// are the columns where it begins and ends, multiples of 1/8 px at its middle row.
struct DrawnGoal {
  double left = 90.25;
  double right = 210.625;
  double lean = 0.0;                ///< px a row
  cv::Scalar colour{34, 182, 222};  ///< B G R
  double blur_px = 0.7;
  double noise = 4.0;
  double gamma = 1.0;
  double light = 1.0;

  static constexpr int kFine = 8;
  static constexpr int kTop = 122;
  static constexpr int kBottom = 142;

  imaging::ImageFrame frame(std::uint64_t seed) const {
    cv::Mat fine(240 * kFine, 320 * kFine, CV_8UC3, cv::Scalar(96, 104, 110));
    const auto quad = [&](double l, double r, int top, int bottom, const cv::Scalar& ink) {
      const double middle = 0.5 * (kTop + kBottom);
      std::vector<cv::Point> corners;
      for (const auto& [u, v] : {std::pair(l, top), {r, top}, {r, bottom}, {l, bottom}})
        corners.emplace_back(cvRound((u + lean * (v - middle) + 0.5) * kFine),
                             cvRound((v + 0.5) * kFine));
      // Filled polygons hold their right and lower rims.
      corners[1].x -= 1;
      corners[2].x -= 1;
      corners[2].y -= 1;
      corners[3].y -= 1;
      cv::fillConvexPoly(fine, corners, ink);
    };
    quad(-0.5, 319.5, kTop, kBottom, cv::Scalar(215, 218, 216));
    quad(left, right, kTop, kBottom, colour);
    quad(-0.5, 319.5, kBottom, 239, cv::Scalar(30, 52, 26));
    cv::Mat small;
    cv::resize(fine, small, {320, 240}, 0.0, 0.0, cv::INTER_AREA);
    cv::Mat3f light_map;
    small.convertTo(light_map, CV_32FC3, light / 255.0);
    cv::GaussianBlur(light_map, light_map, {}, blur_px);
    cv::pow(light_map, 1.0 / gamma, light_map);
    light_map *= 255.0;
    cv::RNG random(seed);
    cv::Mat3f grain(light_map.size());
    random.fill(grain, cv::RNG::NORMAL, 0.0, noise);
    light_map += grain;
    cv::Mat3b bytes;
    light_map.convertTo(bytes, CV_8UC3);
    vpImage<vpRGBa> picture(240, 320);
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u)
        picture[static_cast<unsigned>(v)][static_cast<unsigned>(u)] =
            vpRGBa(bytes(v, u)[2], bytes(v, u)[1], bytes(v, u)[0]);
    return imaging::ImageFrame(picture);
  }
};

/// Columns of both edges in @p count noisy pictures of goals at changing places.
struct DrawnTally {
  int edges = 0;
  int found = 0;
  int others = 0;
  double bias = 0.0;
  double square = 0.0;
  double chi_square = 0.0;

  double mean() const { return bias / found; }
  double rms() const { return std::sqrt(square / found); }
  double nees() const { return chi_square / found; }
};

DrawnTally tally_drawn(DrawnGoal goal, int count) {
  DrawnTally tally;
  RandomStream random(21, "places");
  const GoalCornerFinder finder;
  for (int i = 0; i < count; ++i) {
    goal.left = 60.0 + static_cast<double>(random.index(400)) / 8.0;
    goal.right = goal.left + 60.0 + static_cast<double>(random.index(400)) / 8.0;
    const GoalCornerScan scan = finder.find(goal.frame(static_cast<std::uint64_t>(i + 1)));
    tally.edges += 2;
    for (const GoalCornerImage& corner : scan.corners) {
      const double middle = 0.5 * (DrawnGoal::kTop + DrawnGoal::kBottom) - 0.5;
      const double truth =
          (corner.colour_on_right ? goal.left : goal.right) + goal.lean * (corner.v - middle);
      const double error = corner.u - truth;
      if (std::abs(error) > 2.0) {
        ++tally.others;
        continue;
      }
      ++tally.found;
      tally.bias += (corner.colour_on_right ? 1.0 : -1.0) * error;
      tally.square += error * error;
      tally.chi_square += std::pow(error / corner.sigma_px, 2);
    }
  }
  return tally;
}

void report(const char* what, const DrawnTally& tally) {
  std::printf("%s: %d of %d edges, %d others, bias %.4f rms %.4f px NEES %.2f\n", what, tally.found,
              tally.edges, tally.others, tally.mean(), tally.rms(), tally.nees());
}

TEST(GoalCornerFinder, FindsTheEdgesOfDrawnGoalsToAFewHundredthsOfAPixel) {
  for (const bool yellow : {true, false}) {
    for (const double blur : {0.4, 0.7, 1.2}) {
      DrawnGoal goal;
      goal.blur_px = blur;
      if (!yellow) goal.colour = cv::Scalar(190, 66, 24);
      const DrawnTally tally = tally_drawn(goal, 100);
      report(yellow ? "drawn yellow" : "drawn blue", tally);
    }
  }
  DrawnGoal goal;
  goal.lean = 0.03;
  report("lean", tally_drawn(goal, 100));
  goal.lean = 0.0;
  goal.gamma = 2.2;
  report("gamma", tally_drawn(goal, 100));
  goal.gamma = 1.0;
  goal.light = 0.5;
  report("half light", tally_drawn(goal, 100));
  goal.light = 1.3;
  report("overexposed", tally_drawn(goal, 100));
  goal.light = 1.0;
  goal.noise = 12.0;
  report("noise 12", tally_drawn(goal, 100));
}

}  // namespace
}  // namespace vigia::tracking

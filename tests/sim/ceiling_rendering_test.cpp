#include "sim/room.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/random.hpp"
#include "vigia/sim/ceiling_scene.hpp"

namespace vigia::sim {
namespace {

constexpr double kCeiling_m = 2.7;

WorldMap wide_hall() {
  WorldMap world;
  world.plan = FloorPlan({{-500, -500}, {500, -500}, {500, 500}, {-500, 500}}, kCeiling_m, {}, {});
  return world;
}

CeilingScene patched(const CeilingTruth& truth) {
  Appearance look;
  look.contrast = 0.0;
  return {wide_hall(), look, truth, 3};
}

ImagingParams imaging_of(double noise_sigma) {
  ImagingParams params;
  params.noise_sigma = noise_sigma;
  return params;
}

/// Half a metre above the ground, looking up.
Eigen::Isometry3d upward(double x, double y, double heading_deg) {
  return to_isometry(Pose2{x, y, from_deg(heading_deg)}, 0.5);
}

TEST(CeilingRendering, APatchHasItsAreaAndItsMiddleWhereTheRuleHangsIt) {
  for (const bool polarity : {false, true}) {
    CeilingTruth truth;
    truth.grid.polarity = polarity;
    truth.grid.placement_m = 0.01;
    truth.grid.placement_turn = 0.05;
    const CeilingScene scene = patched(truth);
    const Eigen::Isometry3d wMc = upward(123.1, -211.8, 40.0);
    const vpImage<unsigned char> image =
        imaging::grey_image(*scene.expose(wMc, camera(554.26), {}, imaging_of(0.0)));
    const Pose2 patch = *true_patch(truth, {123, -212});
    double sum = 0.0;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    const auto uv = project(camera(554.26), wMc.inverse() * Eigen::Vector3d(patch.x, patch.y, 2.7));
    for (unsigned v = 0; v < image.getHeight(); ++v) {
      for (unsigned u = 0; u < image.getWidth(); ++u) {
        if ((Eigen::Vector2d(u, v) - *uv).norm() > 20.0) continue;
        const double share = (190.0 - image[v][u]) / (190.0 - truth.patch_grey);
        sum += share;
        middle += share * Eigen::Vector2d(u, v);
      }
    }
    const double per_m = 554.26 / 2.2;
    const double whole = 0.09 * 0.03 * (polarity ? 1.0 - 1.0 / 9.0 : 1.0) * per_m * per_m;
    EXPECT_NEAR(sum, whole, 0.01 * whole) << polarity;
    // Without its tongue's sides, the patch's centroid lies behind its middle.
    const double behind = polarity ? 0.09 * per_m * (1.0 / 9.0) / (8.0 / 9.0) * 5.0 / 12.0 : 0.0;
    EXPECT_NEAR((middle / sum - *uv).norm(), behind, 0.05) << polarity;
  }
}

TEST(CeilingRendering, WindowsAreCropsOfTheFullFrame) {
  CeilingTruth truth;
  truth.lamp_pitch_m = 2.0;
  truth.spurious = 0.5;
  const CeilingScene scene = patched(truth);
  const auto frame = [&] {
    return scene.expose(upward(0.4, 0.3, 20.0), camera(554.26), {}, imaging_of(4.0));
  };
  const vpImage<unsigned char> whole = imaging::grey_image(*frame());
  RandomStream random(6, "windows");
  for (int i = 0; i < 50; ++i) {
    const imaging::Window window{static_cast<int>(random.index(600)),
                                 static_cast<int>(random.index(440)), 40, 40};
    std::vector<unsigned char> part(1600);
    frame()->read_grey(window, part.data(), 40);
    for (int v = 0; v < 40; ++v)
      for (int u = 0; u < 40; ++u)
        ASSERT_EQ(part[static_cast<std::size_t>(v * 40 + u)],
                  whole[static_cast<unsigned>(window.v + v)][window.u + u]);
  }
}

/// Grey levels about the picture's middle, each less the mean of its neighbours in eight
/// directions.
std::vector<double> fine_texture(const CeilingScene& scene, double x, double y) {
  constexpr unsigned kHalf = 40;
  constexpr unsigned kStep = 6;
  const vpImage<unsigned char> image =
      imaging::grey_image(*scene.expose(upward(x, y, 0.0), camera(554.26), {}, imaging_of(0.0)));
  std::vector<double> texture;
  for (unsigned v = 240 - kHalf; v < 240 + kHalf; ++v) {
    for (unsigned u = 320 - kHalf; u < 320 + kHalf; ++u) {
      double around = 0.0;
      for (const unsigned dv : {v - kStep, v, v + kStep})
        for (const unsigned du : {u - kStep, u, u + kStep}) around += image[dv][du] / 9.0;
      texture.push_back(image[v][u] - around);
    }
  }
  return texture;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ab = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += a[i] * b[i];
    aa += a[i] * a[i];
    bb += b[i] * b[i];
  }
  return ab / std::sqrt(aa * bb);
}

TEST(CeilingRendering, TheTextureUnderAPatchIsNotThatUnderItsNeighbours) {
  for (const double pitch_m : {0.3, 0.8, 1.0, 1.5, 3.0}) {
    CeilingTruth truth;
    truth.grid.pitch_m = pitch_m;
    truth.missing = 1.0;
    const CeilingScene scene(wide_hall(), {}, truth, 3);
    const auto here = fine_texture(scene, 0.0, 0.0);
    ASSERT_GT(correlation(here, here), 0.99);
    for (const int cells : {1, 2, 3, 4}) {
      EXPECT_LT(correlation(here, fine_texture(scene, cells * pitch_m, 0.0)), 0.5)
          << pitch_m << ' ' << cells;
      EXPECT_LT(correlation(here, fine_texture(scene, 0.0, cells * pitch_m)), 0.5)
          << pitch_m << ' ' << cells;
    }
  }
}

TEST(CeilingRule, HangsPatchesWithTheShareOfGapsAndTheErrorsThatItStates) {
  CeilingTruth truth;
  truth.missing = 0.1;
  truth.spurious = 0.05;
  truth.grid.placement_m = 0.005;
  int hang = 0;
  int extra = 0;
  double square = 0.0;
  constexpr int kSide = 100;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      extra += spurious_patch(truth, {i, j}) ? 1 : 0;
      const auto patch = true_patch(truth, {i, j});
      if (!patch) continue;
      ++hang;
      square += (patch->position() - cell_centre(truth.grid, {i, j})).squaredNorm();
    }
  }
  // Four standard errors of 10,000 cells.
  EXPECT_NEAR(hang, 9000, 4 * 30);
  EXPECT_NEAR(extra, 500, 4 * 22);
  EXPECT_NEAR(std::sqrt(0.5 * square / hang), 0.005, 4 * 0.005 / std::sqrt(4.0 * hang));
}

TEST(CeilingRule, HangsNothingBeyondItsExtent) {
  CeilingTruth truth;
  truth.grid.extent = CeilingGrid::Extent{{0.0, 0.0}, {10.0, 5.0}};
  EXPECT_TRUE(true_patch(truth, {10, 5}));
  EXPECT_FALSE(true_patch(truth, {11, 5}));
  EXPECT_FALSE(true_patch(truth, {3, -1}));
}

}  // namespace
}  // namespace vigia::sim

#include "sim/room.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/random.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {
namespace {

UnifiedOmni mirror() {
  UnifiedOmni model;
  model.xi = 0.9;
  model.px = 210.0;
  model.py = -210.0;
  model.max_angle = from_deg(115.0);
  return model;
}

/// A mirror that looks down.
Eigen::Isometry3d mirror_pose_in_room(double x, double y, double height = 1.0) {
  Eigen::Isometry3d wMc(Eigen::Translation3d(x, y, height));
  wMc.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  return wMc;
}

ImagingParams without_noise() {
  ImagingParams params;
  params.noise_sigma = 0.0;
  return params;
}

TEST(MirrorRendering, ShowsInEveryDirectionWhatAPinholeShowsThere) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, "contrast: 0, clutter_per_m2: 0"), 3);
  const Eigen::Isometry3d wMc = mirror_pose_in_room(4.0, 4.0);
  const CameraModel model = mirror();
  const auto image = imaging::grey_image(*scene.expose(wMc, model, {}, without_noise()));
  RandomStream random(4, "pixels");
  int compared = 0;
  int different = 0;
  while (compared < 300) {
    const int u = static_cast<int>(random.index(640));
    const int v = static_cast<int>(random.index(480));
    const auto direction = ray(model, {u, v});
    if (!direction) continue;
    ++compared;
    // A pinhole at the same place that looks along the ray.
    const Eigen::Vector3d z_w = wMc.linear() * *direction;
    Eigen::Isometry3d along(Eigen::Translation3d(wMc.translation()));
    along.linear() =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), z_w).toRotationMatrix();
    unsigned char grey = 0;
    scene.expose(along, camera(700), {}, without_noise())->read_grey({320, 240, 1, 1}, &grey, 1);
    const int seen = image[static_cast<unsigned>(v)][static_cast<unsigned>(u)];
    if (std::abs(seen - grey) > 3) ++different;
  }
  // Pixels across an edge.
  EXPECT_LE(different, 6);
}

TEST(MirrorRendering, ADiscLiesWhereTheModelProjectsIt) {
  const WorldMap world = test_room();
  const Scene scene(world,
                    appearance_of(world,
                                  "disc_grey: 0, plate_grey: 255, wall_grey: 255, contrast: 0, "
                                  "clutter_per_m2: 0"),
                    3);
  const CameraModel model = mirror();
  for (const auto& [x, y] : {std::pair{10.5, 3.4}, {10.8, 2.2}, {11.0, 3.0}}) {
    const Eigen::Isometry3d wMc = mirror_pose_in_room(x, y, 1.65);
    const auto image = imaging::grey_image(*scene.expose(wMc, model, {}, without_noise()));
    // The centroid of the dense projection of the disc's points, by solid angle in the image.
    const Eigen::Isometry3d cMl = wMc.inverse() * world.landmarks.find(0)->wMl;
    double area = 0.0;
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    constexpr int kPoints = 2000;
    const auto outline = [&](int i) {
      const double angle = 2.0 * kPi * i / kPoints;
      return *project(model,
                      cMl * Eigen::Vector3d(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0));
    };
    const Eigen::Vector2d origin = outline(0);
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector2d a = outline(i) - origin;
      const Eigen::Vector2d b = outline(i + 1) - origin;
      const double cross = a.x() * b.y() - a.y() * b.x();
      area += 0.5 * cross;
      centre += cross * (a + b) / 6.0;
    }
    centre = centre / area + origin;
    double dark = 0.0;
    Eigen::Vector2d seen = Eigen::Vector2d::Zero();
    const int reach = static_cast<int>(std::sqrt(std::abs(area))) + 3;
    for (int v = -reach; v <= reach; ++v) {
      for (int u = -reach; u <= reach; ++u) {
        const int column = static_cast<int>(std::lround(centre.x())) + u;
        const int row = static_cast<int>(std::lround(centre.y())) + v;
        const double share =
            1.0 - image[static_cast<unsigned>(row)][static_cast<unsigned>(column)] / 255.0;
        dark += share;
        seen += share * Eigen::Vector2d(column, row);
      }
    }
    EXPECT_LT((seen / dark - centre).norm(), 0.02);
    EXPECT_NEAR(dark / std::abs(area), 1.0, 0.02);
  }
}

TEST(MirrorRendering, BeyondTheMirrorsEdgeThereIsNoLight) {
  const WorldMap world = test_room();
  const Scene scene(world, appearance_of(world, ""), 3);
  UnifiedOmni narrow = mirror();
  narrow.max_angle = from_deg(100.0);  // 284 px, well inside the picture
  const CameraModel model = narrow;
  const auto image =
      imaging::grey_image(*scene.expose(mirror_pose_in_room(4.0, 4.0), model, {}, without_noise()));
  int dark = 0;
  for (int v = 0; v < 480; v += 3) {
    for (int u = 0; u < 640; u += 3) {
      const int grey = image[static_cast<unsigned>(v)][static_cast<unsigned>(u)];
      if (!ray(model, {u, v})) {
        ++dark;
        ASSERT_EQ(grey, 0) << u << ", " << v;
      } else {
        ASSERT_GT(grey, 0) << u << ", " << v;
      }
    }
  }
  EXPECT_GT(dark, 1000);
}

}  // namespace
}  // namespace vigia::sim

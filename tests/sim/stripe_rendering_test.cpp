#include "sim/room.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "vigia/core/camera_model.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {
namespace {

/// A hall with nothing but white stripes on a black floor or ceiling.
WorldMap hall() {
  WorldMap world;
  world.plan = FloorPlan({{0, 0}, {20, 0}, {20, 14}, {0, 14}}, 4.0, {}, {});
  return world;
}

Appearance bare(const std::vector<Stripe>& stripes) {
  Appearance look;
  look.contrast = 0.0;
  look.wall_grey = look.floor_grey = look.ceiling_grey = 0.0;
  look.stripes = stripes;
  return look;
}

ImagingParams clean(double blur_px = 0.0) {
  ImagingParams params;
  params.noise_sigma = 0.0;
  params.blur_px = blur_px;
  return params;
}

Intrinsics small_camera(double focal_px, double kdu) {
  return {160, 120, focal_px, focal_px, 79.5, 59.5, kdu};
}

UnifiedOmni small_mirror() {
  UnifiedOmni mirror;
  mirror.width = 160;
  mirror.height = 120;
  mirror.xi = 0.95;
  mirror.px = 55.0;
  mirror.py = -55.0;
  mirror.u0 = 79.5;
  mirror.v0 = 59.5;
  mirror.max_angle = from_deg(100.0);
  return mirror;
}

/// A mirror 0.9 m above the floor that looks down.
Eigen::Isometry3d mirror_pose(double x, double y, double yaw) {
  Eigen::Isometry3d wMc(Eigen::Translation3d(x, y, 0.9));
  wMc.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
  return wMc;
}

struct Patch {
  Stripe stripe;
  double height_m;
};

/// Whether a ray of the camera meets the stripe, by geometry alone.
bool meets(const Patch& patch, const Eigen::Isometry3d& wMc, const Eigen::Vector3d& ray_c) {
  const Eigen::Vector3d direction = wMc.linear() * ray_c;
  const double depth = (patch.height_m - wMc.translation().z()) / direction.z();
  if (!(depth > 0.0)) return false;
  const Eigen::Vector2d p = (wMc.translation() + depth * direction).head<2>();
  const Eigen::Vector2d along = (patch.stripe.to - patch.stripe.from).normalized();
  const Eigen::Vector2d d = p - patch.stripe.from;
  const double s = along.dot(d);
  const double across = along.x() * d.y() - along.y() * d.x();
  return s >= 0.0 && s <= (patch.stripe.to - patch.stripe.from).norm() &&
         std::abs(across) <= 0.5 * patch.stripe.width_m;
}

/// Share of a pixel that the stripe covers, by @p n × @p n rays.
double sampled_share(const Patch& patch, const Eigen::Isometry3d& wMc, const CameraModel& model,
                     int u, int v, int n) {
  int hits = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const auto r = ray(model, {u - 0.5 + (i + 0.5) / n, v - 0.5 + (j + 0.5) / n});
      if (r && meets(patch, wMc, *r)) ++hits;
    }
  }
  return static_cast<double>(hits) / (n * n);
}

struct Comparison {
  double worst = 0.0;  ///< largest difference of a pixel's share
  double sum = 0.0;    ///< of the shares as rendered
  double sampled = 0.0;
};

Comparison compare(const Stripe& stripe, const Eigen::Isometry3d& wMc, const CameraModel& model) {
  const WorldMap world = hall();
  const Patch patch{stripe, stripe.on_ceiling ? world.plan.ceiling_m() : 0.0};
  const Scene scene(world, std::make_shared<const Appearance>(bare({stripe})), 1);
  const auto image = imaging::grey_image(*scene.expose(wMc, model, {}, clean()));
  constexpr int kSamples = 24;
  Comparison result;
  for (int v = 0; v < image_height(model); ++v) {
    for (int u = 0; u < image_width(model); ++u) {
      const double seen = image[static_cast<unsigned>(v)][static_cast<unsigned>(u)] / 235.0;
      const double share = sampled_share(patch, wMc, model, u, v, kSamples);
      result.worst = std::max(result.worst, std::abs(seen - share));
      result.sum += seen;
      result.sampled += share;
    }
  }
  return result;
}

// A grey level is 1/235 of a share; the samples leave half a row of 24 along a side.
constexpr double kTolerance = 0.5 / 235.0 + 0.5 / 24.0 + 0.002;

TEST(StripeRendering, ALongThinLineIsExactFromUnderTheCameraToItsFarEnd) {
  // Ten metres long and five centimetres wide: 10 px wide nearby, a quarter of a pixel at its end;
  // it begins behind the camera.
  const Stripe line{{1.0, 6.1}, {19.0, 7.4}, 0.05, 235.0, false};
  const Comparison result = compare(line, camera_at(4.0, 6.5, 5.0, -30.0), small_camera(140, 0.0));
  EXPECT_LT(result.worst, kTolerance);
  EXPECT_GT(result.sum, 100.0);
  EXPECT_NEAR(result.sum / result.sampled, 1.0, 0.005);
}

TEST(StripeRendering, FollowsTheLensInDistortedImages) {
  const Stripe line{{1.0, 6.1}, {19.0, 7.4}, 0.05, 235.0, false};
  const Comparison result = compare(line, camera_at(4.0, 5.0, 40.0, -25.0), small_camera(140, 0.2));
  EXPECT_LT(result.worst, kTolerance + 0.01);
  EXPECT_NEAR(result.sum / result.sampled, 1.0, 0.005);
}

TEST(StripeRendering, IsACurveInAMirrorAndAsExact) {
  const Stripe line{{1.0, 6.1}, {19.0, 8.4}, 0.12, 235.0, false};
  for (const double yaw : {0.0, 0.7}) {
    const Comparison result = compare(line, mirror_pose(8.0, 6.0, yaw), small_mirror());
    EXPECT_LT(result.worst, kTolerance + 0.02) << yaw;
    EXPECT_GT(result.sum, 50.0);
    EXPECT_NEAR(result.sum / result.sampled, 1.0, 0.005);
  }
}

TEST(StripeRendering, HangsOnTheCeilingAsWell) {
  const Stripe line{{1.0, 6.1}, {19.0, 7.4}, 0.06, 235.0, true};
  const Comparison result = compare(line, camera_at(4.0, 6.5, 5.0, 40.0), small_camera(140, 0.0));
  EXPECT_LT(result.worst, kTolerance);
  EXPECT_GT(result.sum, 50.0);
  EXPECT_NEAR(result.sum / result.sampled, 1.0, 0.005);
}

TEST(StripeRendering, TheOpticalBlurKeepsTheLight) {
  const WorldMap world = hall();
  const Stripe line{{6.0, 6.0}, {8.0, 7.0}, 0.03, 235.0, false};
  const Scene scene(world, std::make_shared<const Appearance>(bare({line})), 1);
  const auto light = [&](double blur_px) {
    const auto image = imaging::grey_image(
        *scene.expose(camera_at(4.0, 6.2, 5.0, -25.0), small_camera(140, 0.0), {}, clean(blur_px)));
    double sum = 0.0;
    for (unsigned i = 0; i < image.getSize(); ++i) sum += image.bitmap[i];
    return sum;
  };
  EXPECT_NEAR(light(0.7) / light(0.0), 1.0, 0.01);
}

}  // namespace
}  // namespace vigia::sim

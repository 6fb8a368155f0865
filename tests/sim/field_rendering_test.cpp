#include "sim/room.hpp"
#include "sim/soccer.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/camera_model.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"
#include "vigia/sim/camera_errors.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {
namespace {

constexpr double kBlur_px = 0.7;

/// A mirror 0.75 m above the floor that looks down.
Eigen::Isometry3d mirror_over_field(double x, double y, double yaw) {
  Eigen::Isometry3d wMc(Eigen::Translation3d(x, y, 0.75));
  wMc.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()))
                     .toRotationMatrix();
  return wMc;
}

ImagingParams coloured(double noise_sigma) {
  ImagingParams params;
  params.noise_sigma = noise_sigma;
  params.blur_px = kBlur_px;
  params.colour = true;
  return params;
}

/// Whether a point of the floor is painted. Lines that end on others go on to their far edge.
bool painted(const FieldMap& field, const Eigen::Vector2d& p) {
  for (const FieldLine& line : field.lines) {
    const LineOffset offset = line_offset(line, p);
    const double half = 0.5 * line.width_m;
    const double beyond = line.kind == FieldLine::Kind::segment ? half : 0.0;
    if (std::abs(offset.distance_m) <= half && offset.inside_m >= -beyond) return true;
  }
  return false;
}

/// Where a pixel's ray meets the floor; far away where it does not.
Eigen::Vector2d floor_point(const CameraModel& model, const Eigen::Isometry3d& wMc,
                            const Eigen::Vector2d& uv) {
  const auto seen = ray(model, uv);
  const Eigen::Vector3d r = seen ? Eigen::Vector3d(wMc.linear() * *seen) : Eigen::Vector3d::UnitZ();
  if (r.z() >= -1e-6) return {1e6, 1e6};
  return (wMc.translation() - wMc.translation().z() / r.z() * r).head<2>();
}

/// Share of paint under the Gaussian of blur and pixel square about a pixel, by a grid of rays.
double sampled_share(const FieldMap& field, const CameraModel& model, const Eigen::Isometry3d& wMc,
                     const Eigen::Vector2d& uv) {
  const double sigma = std::sqrt(kBlur_px * kBlur_px + 1.0 / 12.0);
  constexpr int kSteps = 24;
  double sum = 0.0;
  double norm = 0.0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const Eigen::Vector2d off(3.5 * i / kSteps, 3.5 * j / kSteps);
      const double weight = std::exp(-0.5 * off.squaredNorm());
      norm += weight;
      if (painted(field, floor_point(model, wMc, uv + sigma * off))) sum += weight;
    }
  }
  return sum / norm;
}

/// Whether it lies on the carpet, and what its pixel blurs together as well.
bool on_carpet(const FieldMap& field, const Eigen::Vector2d& p) {
  const double margin = 0.5 * field.margin_m;
  return std::abs(p.x()) < 0.5 * field.length_m + margin &&
         std::abs(p.y()) < 0.5 * field.width_m + margin;
}

/// What is wrong with the paint of pixels on lines of one kind.
struct PaintError {
  double square = 0.0;
  double greatest = 0.0;
  int count = 0;

  void add(double error) {
    square += error * error;
    greatest = std::max(greatest, std::abs(error));
    ++count;
  }
  double rms() const { return std::sqrt(square / count); }
};

class PaintOfField : public ::testing::TestWithParam<const char*> {};

TEST_P(PaintOfField, HasALinesShareOfAPixelUnderItsBlur) {
  WorldMap world = field_world(GetParam());
  world.field->goals.clear();
  world.field->posts.clear();
  const auto look = appearance_of(world, "contrast: 0, carpet_grey: 0, line_grey: 250");
  const Scene scene(world, look, 3);
  const CameraModel model = soccer_mirror();
  RandomStream random(5, "pixels");
  PaintError straight;
  PaintError round;
  while (straight.count + round.count < 400) {
    const double x = random.uniform(-0.45, 0.45) * world.field->length_m;
    const double y = random.uniform(-0.45, 0.45) * world.field->width_m;
    const Eigen::Isometry3d wMc = mirror_over_field(x, y, random.uniform(-kPi, kPi));
    const FieldLine& line = world.field->lines[random.index(world.field->lines.size())];
    const Eigen::Vector2d on = line.at(random.uniform(0.0, line.length_m()));
    const double range = (on - wMc.translation().head<2>()).norm();
    const auto uv = project(model, wMc.inverse() * Eigen::Vector3d(on.x(), on.y(), 0.0));
    if (!uv || range < 0.3 || range > 8.0 || !in_image(model, *uv, 3.0)) continue;
    const int u = static_cast<int>(std::lround(uv->x() + random.uniform(-2.0, 2.0)));
    const int v = static_cast<int>(std::lround(uv->y() + random.uniform(-2.0, 2.0)));
    if (!on_carpet(*world.field, floor_point(model, wMc, {u, v}))) continue;
    unsigned char grey = 0;
    scene.expose(wMc, model, {}, coloured(0.0))->read_grey({u, v, 1, 1}, &grey, 1);
    const double error = grey / 250.0 - sampled_share(*world.field, model, wMc, {u, v});
    (line.kind == FieldLine::Kind::segment ? straight : round).add(error);
  }
  EXPECT_LT(straight.rms(), 0.008);
  EXPECT_LT(straight.greatest, 0.08);
  // Arcs are taken for straight within a pixel, and to end on the middle of the other line.
  EXPECT_LT(round.rms(), 0.06);
  EXPECT_LT(round.greatest, 0.25);
}

INSTANTIATE_TEST_SUITE_P(Fields, PaintOfField,
                         ::testing::Values("field-12x8", "field-16x10", "field-msl"));

TEST(FieldRendering, WindowsAndRunsAreCropsOfTheFullFrame) {
  const WorldMap world = field_world("field-12x8");
  const Scene scene(world, appearance_of(world, "adverts: 30, spectators: 10"), 3);
  Exposure exposure{{{mirror_over_field(-2.0, 1.0, 0.4), {}}}, std::nullopt};
  Person& other = exposure.instants.front().people.emplace_back();
  other.position = {-1.0, 2.5};
  other.figure = Figure::robot;
  const CameraModel model = soccer_mirror();
  const auto frame = [&] { return scene.expose(exposure, model, {}, coloured(4.0)); };
  const vpImage<vpRGBa> whole = imaging::colour_image(*frame());
  RandomStream random(6, "windows");
  std::vector<imaging::Run> runs;
  for (int i = 0; i < 200; ++i) {
    const int u = static_cast<int>(random.index(600));
    runs.push_back(
        {static_cast<int>(random.index(480)), u, u + 1 + static_cast<int>(random.index(39))});
  }
  std::vector<vpRGBa> read(imaging::pixels_in(runs));
  frame()->read_colour_runs(runs, read.data());
  const vpRGBa* next = read.data();
  for (const imaging::Run& run : runs)
    for (int u = run.u_begin; u < run.u_end; ++u, ++next) {
      const vpRGBa& pixel = whole[static_cast<unsigned>(run.v)][static_cast<unsigned>(u)];
      ASSERT_EQ(next->R, pixel.R) << u << ", " << run.v;
      ASSERT_EQ(next->G, pixel.G) << u << ", " << run.v;
      ASSERT_EQ(next->B, pixel.B) << u << ", " << run.v;
    }
}

TEST(FieldRendering, GoalsAndPostsHaveTheirColoursWhereTheyStand) {
  const WorldMap world = field_world("field-12x8");
  const Scene scene(world, appearance_of(world, ""), 3);
  const CameraModel model = soccer_mirror();
  const Eigen::Isometry3d wMc = mirror_over_field(0.5, 0.3, 1.0);
  const vpImage<vpRGBa> image = imaging::colour_image(*scene.expose(wMc, model, {}, coloured(0.0)));
  const auto at = [&](const Eigen::Vector2d& p, double z) {
    const auto uv = project(model, wMc.inverse() * Eigen::Vector3d(p.x(), p.y(), z));
    return image[static_cast<unsigned>(std::lround(uv->y()))]
                [static_cast<unsigned>(std::lround(uv->x()))];
  };
  const auto is = [](const vpRGBa& pixel, FieldColour colour) {
    return colour == FieldColour::yellow ? pixel.R > pixel.B + 60 && pixel.G > pixel.B + 60
                                         : pixel.B > pixel.R + 60 && pixel.B > pixel.G + 60;
  };
  for (const FieldGoal& goal : world.field->goals)
    for (const double along : {0.2, 0.5, 0.8}) {
      const Eigen::Vector2d p = goal.from + along * (goal.to - goal.from);
      EXPECT_TRUE(is(at(p, 0.3), goal.colour)) << to_string(goal.colour) << along;
    }
  for (const CornerPost& post : world.field->posts) {
    const bool yellow = post.outer == FieldColour::yellow;
    // The near side, which lies a radius before the axis.
    const Eigen::Vector2d near =
        post.at - 0.8 * post.radius_m * (post.at - Eigen::Vector2d(0.5, 0.3)).normalized();
    EXPECT_TRUE(is(at(near, 0.15), post.outer));
    EXPECT_TRUE(is(at(near, 0.5), yellow ? FieldColour::blue : FieldColour::yellow));
  }
}

TEST(FieldRendering, TheCarpetIsGreenAndItsLinesAreWhite) {
  const WorldMap world = field_world("field-16x10");
  const Scene scene(world, appearance_of(world, ""), 3);
  const Eigen::Isometry3d wMc = mirror_over_field(1.0, 0.0, 0.0);
  const auto frame = scene.expose(wMc, soccer_mirror(), {}, coloured(0.0));
  const auto at = [&](double x, double y) {
    const auto uv = project(soccer_mirror(), wMc.inverse() * Eigen::Vector3d(x, y, 0.0));
    vpRGBa pixel;
    frame->read_colour(
        {static_cast<int>(std::lround(uv->x())), static_cast<int>(std::lround(uv->y())), 1, 1},
        &pixel, 1);
    return pixel;
  };
  const vpRGBa carpet = at(1.3, 0.7);
  EXPECT_GT(carpet.G, 2 * carpet.R);
  EXPECT_GT(carpet.G, 2 * carpet.B - 20);
  const vpRGBa line = at(0.0, 0.4);  // the halfway line
  EXPECT_GT(line.R, 190);
  EXPECT_GT(line.B, 190);
}

TEST(MirrorErrors, AreThoseOfAnOmnidirectionalCameraAlone) {
  DisturbanceParams disturbances;
  disturbances.mirror = MirrorParams{0.01, from_deg(0.5), 1.0};
  const CameraErrors errors(disturbances, 7);
  Camera mirror;
  mirror.mount = FixedMount{};
  mirror.optics = CameraModel(soccer_mirror());
  const auto truth = std::get<UnifiedOmni>(errors.true_model(soccer_mirror()));
  EXPECT_NE(truth.px, 204.0);
  EXPECT_EQ(truth.px, -truth.py);
  EXPECT_NE(truth.u0, soccer_mirror().u0);
  const auto mount = std::get<FixedMount>(errors.true_mount(mirror));
  EXPECT_GT(Eigen::AngleAxisd(mount.rMc.linear()).angle(), 1e-4);
  EXPECT_TRUE(mount.rMc.translation().isZero());
  Camera pinhole = mirror;
  pinhole.optics = CameraModel(Intrinsics{});
  EXPECT_TRUE(std::get<FixedMount>(errors.true_mount(pinhole)).rMc.isApprox(FixedMount{}.rMc));
  EXPECT_EQ(std::get<Intrinsics>(errors.true_model(Intrinsics{})).px, Intrinsics{}.px);
}

}  // namespace
}  // namespace vigia::sim

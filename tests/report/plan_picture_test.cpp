#include "vigia/report/plan_picture.hpp"

#include "map_view.hpp"
#include "support/process.hpp"
#include "support/temp_dir.hpp"
#include "synthetic_drive.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::report {
namespace {

using Eigen::Vector2d;
using ::testing::HasSubstr;
using vigia::testing::read_text;

// The room of 12 × 7 m with 0.45 m round it fills the page's width but for 84 and 30 pixels; it
// begins at 96, and axes and legend take 62 and 42 below it.
constexpr double kScale = (1600.0 - 84.0 - 30.0) / 12.9;
const int kHeight = static_cast<int>(std::ceil(96.0 + 7.9 * kScale + 62.0 + 42.0));

Vector2d pixel_of(const Vector2d& p_w) {
  return {84.0 + (p_w.x() + 0.45) * kScale, 96.0 + (7.45 - p_w.y()) * kScale};
}

unsigned rgb(const vpRGBa& p) {
  return (unsigned{p.R} << 16U) | (unsigned{p.G} << 8U) | p.B;
}

unsigned rgb(const Colour& c) {
  const auto byte = [](double x) { return static_cast<unsigned>(std::lround(255.0 * x)); };
  return (byte(c.r) << 16U) | (byte(c.g) << 8U) | byte(c.b);
}

class PlanPictureTest : public ::testing::Test {
 protected:
  vpImage<vpRGBa> draw(const PlanPicture& plan) const {
    draw_plan(plan, dir_.path() / "plan.png");
    return imaging::colour_image(imaging::read_image(dir_.path() / "plan.png"));
  }
  static unsigned colour_at(const vpImage<vpRGBa>& image, const Vector2d& p_w) {
    const Vector2d p = pixel_of(p_w);
    return rgb(image[static_cast<unsigned>(p.y())][static_cast<unsigned>(p.x())]);
  }
  /// Pixels within @p radius_m of a place that two pictures show differently.
  static int changed_about(const vpImage<vpRGBa>& a, const vpImage<vpRGBa>& b, const Vector2d& p_w,
                           double radius_m) {
    const Vector2d centre = pixel_of(p_w);
    int changed = 0;
    for (unsigned v = 0; v < a.getHeight(); ++v)
      for (unsigned u = 0; u < a.getWidth(); ++u)
        if ((Vector2d(u + 0.5, v + 0.5) - centre).norm() < radius_m * kScale &&
            rgb(a[v][u]) != rgb(b[v][u]))
          ++changed;
    return changed;
  }

  vigia::testing::TempDir dir_;
  WorldMap world_ = test::synthetic_world();
  /// Along y = 1.9 m, three areas of two metres.
  PlanPicture plan_{world_,
                    "a plan",
                    "made input of a test",
                    Path({{2.0, 1.9}, {8.0, 1.9}}),
                    {4.0},
                    0.5,
                    {{0.0, 2.0, {{3.0, 1.9}}, 0, "0: L0"},
                     {2.0, 4.0, {{5.0, 1.9}}, 2, "1: L2"},
                     {4.0, 6.0, {{7.0, 1.9}}, std::nullopt, "2: –"}}};
};

TEST_F(PlanPictureTest, IsAPageOfTheRoomsShape) {
  const auto image = draw(plan_);
  EXPECT_EQ(image.getWidth(), 1600U);
  EXPECT_EQ(image.getHeight(), static_cast<unsigned>(kHeight));
  EXPECT_EQ(rgb(image[1][1]), rgb(palette::kWhite));
}

TEST_F(PlanPictureTest, ShowsEveryLandmarkWhereItHangsInItsColour) {
  const auto image = draw(plan_);
  for (const Landmark& landmark : world_.landmarks.all())
    EXPECT_EQ(colour_at(image, landmark.centre_w().head<2>()),
              rgb(landmark_colour(world_.landmarks, landmark.id)))
        << landmark.id;
}

TEST_F(PlanPictureTest, ShowsAreasByTurnsAndATurnPoint) {
  const auto image = draw(plan_);
  EXPECT_EQ(colour_at(image, {2.4, 1.9}), rgb(palette::kBlue));
  EXPECT_EQ(colour_at(image, {4.4, 1.9}), rgb(palette::kMuted));
  EXPECT_EQ(colour_at(image, {6.4, 1.9}), rgb(palette::kBlue));
  EXPECT_EQ(colour_at(image, {6.0, 1.9}), rgb(palette::kVermillion));
  // A bar across the path where the second area begins, and a white dot at each position.
  EXPECT_EQ(colour_at(image, {4.0, 1.98}), rgb(palette::kInk));
  for (const double x : {3.0, 5.0, 7.0})
    EXPECT_EQ(colour_at(image, {x, 1.9}), rgb(palette::kWhite)) << x;
}

TEST_F(PlanPictureTest, ShowsASightLineToTheLandmarkOfAnAreaAndNoneWithout) {
  const auto with = draw(plan_);
  plan_.areas[1].chosen.reset();
  const auto without = draw(plan_);
  const Vector2d position(5.0, 1.9);
  const Vector2d landmark = world_.landmarks.find(2)->centre_w().head<2>();
  for (const double t : {0.3, 0.5, 0.7})
    EXPECT_GT(changed_about(with, without, position + t * (landmark - position), 0.1), 10) << t;
  EXPECT_EQ(changed_about(with, without, {3.0, 0.9}, 0.2), 0);
}

TEST_F(PlanPictureTest, ShowsAControlPositionsDisc) {
  const auto with = draw(plan_);
  plan_.areas[2].positions.clear();
  const auto without = draw(plan_);
  EXPECT_NE(colour_at(with, {7.3, 1.6}), colour_at(without, {7.3, 1.6}));
  EXPECT_EQ(colour_at(with, {7.3, 1.2}), colour_at(without, {7.3, 1.2}));
}

TEST_F(PlanPictureTest, SaysWhatTheAreasAreCalled) {
  const auto with = draw(plan_);
  plan_.areas[2].label.clear();
  EXPECT_GT(changed_about(with, draw(plan_), {7.0, 1.9}, 1.0), 100);
}

TEST_F(PlanPictureTest, TheSamePlanGivesTheSameBytesInEveryFormat) {
  for (const std::string ending : {".png", ".svg", ".pdf"}) {
    draw_plan(plan_, dir_.path() / ("first" + ending));
    draw_plan(plan_, dir_.path() / ("second" + ending));
    const std::string first = read_text(dir_.path() / ("first" + ending));
    EXPECT_GT(first.size(), 1000U) << ending;
    EXPECT_TRUE(first == read_text(dir_.path() / ("second" + ending))) << ending;
  }
}

TEST_F(PlanPictureTest, AnUnknownEndingIsAnError) {
  try {
    draw_plan(plan_, dir_.path() / "plan.bmp");
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("plan.bmp: a picture's name ends in .png, .svg or .pdf"));
  }
}

}  // namespace
}  // namespace vigia::report

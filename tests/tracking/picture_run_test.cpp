#include "vigia/tracking/picture_run.hpp"

#include "disc_scene.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"

namespace vigia::tracking::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kPictures = "/usr/share/visp-images-data/ViSP-images";

#define VIGIA_NEEDS_PICTURES() \
  if (!fs::exists(kPictures)) GTEST_SKIP() << "visp-images-data is not installed"

int found(const PictureResult& result) {
  return static_cast<int>(std::count_if(
      result.rows.begin(), result.rows.end(),
      [](const PictureRow& row) { return row.feature.status == FeatureStatus::found; }));
}

std::vector<PictureResult> run(const std::string& tracker, const std::vector<fs::path>& files) {
  std::vector<PictureResult> results;
  run_pictures(tracker, files, [&](const PictureResult& result, const imaging::ImageFrame&) {
    results.push_back(result);
  });
  return results;
}

std::vector<fs::path> numbered(const fs::path& folder, const std::string& stem, int digits,
                               int first, int last, int step) {
  std::vector<fs::path> files;
  for (int k = first; k <= last; k += step) {
    std::string number = std::to_string(k);
    number.insert(0, static_cast<std::size_t>(digits) - number.size(), '0');
    files.push_back(kPictures / folder / (stem + number + ".pgm"));
  }
  return files;
}

class RealPictures : public ::testing::TestWithParam<const char*> {};

TEST_P(RealPictures, AllThirtySixCirclesOfTheGridAreFoundAndNothingElse) {
  VIGIA_NEEDS_PICTURES();
  for (const PictureResult& result :
       run(GetParam(), numbered("calibration", "grid36-", 2, 1, 4, 1))) {
    EXPECT_EQ(found(result), 36) << result.image;
    EXPECT_EQ(result.rows.size(), 36U) << result.image;
  }
}

TEST_P(RealPictures, TheEllipseIsFound) {
  VIGIA_NEEDS_PICTURES();
  const auto results = run(GetParam(), {kPictures / "ellipse" / "ellipse.pgm"});
  ASSERT_EQ(found(results[0]), 1);
  const Ellipse& e = results[0].rows[0].feature.ellipse;
  EXPECT_NEAR(e.u, 146.3, 1.0);
  EXPECT_NEAR(e.v, 142.2, 1.0);
  EXPECT_NEAR(e.a, 67.9, 1.0);
  EXPECT_NEAR(e.b, 35.6, 1.0);
  EXPECT_LT(results[0].rows[0].feature.contrast, 0.0);
}

INSTANTIATE_TEST_SUITE_P(All, RealPictures, ::testing::Values("disc", "ellipse", "correlation"),
                         [](const auto& test) { return std::string(test.param); });

TEST(RealDots, AllFiveDotsOfTheMovingTargetAreFollowedThroughTheSequence) {
  VIGIA_NEEDS_PICTURES();
  const auto results = run("disc", numbered("mire-2", "image.", 4, 1, 500, 1));
  ASSERT_EQ(results.size(), 500U);
  ASSERT_EQ(found(results[0]), 5);
  int sightings = 0;
  int renumbered = 0;
  for (const PictureResult& result : results) {
    sightings += found(result);
    for (const PictureRow& row : result.rows) renumbered += row.target > 5 ? 1 : 0;
  }
  EXPECT_EQ(renumbered, 0);
  EXPECT_GT(sightings, 99 * 25);
}

TEST(RealDots, WhatTheMovingEdgesFindLiesOnADot) {
  VIGIA_NEEDS_PICTURES();
  const auto files = numbered("mire-2", "image.", 4, 1, 500, 1);
  const auto edges = run("ellipse", files);
  const auto discs = run("disc", files);
  int sightings = 0;
  int beside = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (found(discs[i]) < 5) continue;  // of a dot that is not there nothing can be said
    for (const PictureRow& row : edges[i].rows) {
      if (row.feature.status != FeatureStatus::found) continue;
      ++sightings;
      const Ellipse& e = row.feature.ellipse;
      const bool on_a_dot =
          std::any_of(discs[i].rows.begin(), discs[i].rows.end(), [&](const PictureRow& disc) {
            const Ellipse& d = disc.feature.ellipse;
            return disc.feature.status == FeatureStatus::found &&
                   std::hypot(d.u - e.u, d.v - e.v) < 3.0 && std::abs(d.a - e.a) < 0.15 * d.a + 1.0;
          });
      beside += on_a_dot ? 0 : 1;
    }
  }
  EXPECT_GT(sightings, 1000);
  EXPECT_LE(beside, sightings / 100);
}

TEST(RealDots, NoTwoTargetsOfACrowdedSequenceAreTheSameDot) {
  VIGIA_NEEDS_PICTURES();
  // The dots lie nearer to each other than some move from picture to picture.
  const auto results = run("disc", numbered("cube", "image.", 4, 0, 79, 1));
  int sightings = 0;
  for (const PictureResult& result : results)
    for (const PictureRow& row : result.rows) {
      if (row.feature.status != FeatureStatus::found) continue;
      ++sightings;
      const Ellipse& e = row.feature.ellipse;
      const auto doubles =
          std::count_if(result.rows.begin(), result.rows.end(), [&](const PictureRow& other) {
            return other.feature.status == FeatureStatus::found &&
                   std::hypot(other.feature.ellipse.u - e.u, other.feature.ellipse.v - e.v) < 1.0;
          });
      EXPECT_EQ(doubles, 1) << result.image << " target " << row.target;
    }
  EXPECT_GT(sightings, 0);
}

TEST(RealDots, TheFourDotsOfTheTestTargetAreFound) {
  VIGIA_NEEDS_PICTURES();
  EXPECT_EQ(found(run("disc", {kPictures / "mire" / "mire.pgm"})[0]), 4);
}

TEST(RealEllipse, TheSequenceOfACutEllipseIsFollowedByMovingEdges) {
  VIGIA_NEEDS_PICTURES();
  const auto results = run("ellipse", numbered("ellipse-1", "image.", 4, 1, 50, 1));
  int pictures = 0;
  for (const PictureResult& result : results) pictures += found(result) == 1 ? 1 : 0;
  EXPECT_GE(pictures, 45);
}

TEST(PictureRun, ATargetKeepsItsNumberAndAnotherSceneIsSearchedAnew) {
  RandomStream random(51, "pictures");
  DiscScene scene;
  PictureRun run("disc");
  const PictureResult first = run.next("1", scene.expose({40.0, 50.0, 12.0, 10.0, 0.0}, random));
  ASSERT_EQ(found(first), 1);
  EXPECT_EQ(first.rows[0].target, 1);
  EXPECT_EQ(run.next("2", scene.expose({46.0, 50.0, 12.0, 10.0, 0.0}, random)).rows[0].target, 1);
  scene.width = 140;
  const PictureResult third = run.next("3", scene.expose({100.0, 40.0, 20.0, 15.0, 0.0}, random));
  ASSERT_EQ(found(third), 1);
  EXPECT_EQ(third.rows[0].target, 2);
}

TEST(PictureRun, AnUnknownTrackerAndAMissingFileAreInputErrors) {
  EXPECT_THROW(PictureRun("dots"), InputError);
  EXPECT_THROW(run("disc", {"/nowhere/picture.png"}), InputError);
}

TEST(PictureRun, TheTableHasAsManyFieldsAsItsHeader) {
  PictureRow row;
  row.image = "a, \"b\".png";
  row.target = 3;
  const auto commas = [](const std::string& text) {
    return std::count(text.begin(), text.end(), ',');
  };
  EXPECT_EQ(commas(picture_csv_line(row)), commas(picture_csv_header()) + 1);
  EXPECT_THAT(picture_csv_line(row), ::testing::StartsWith("\"a, \"\"b\"\".png\",3,not_found,"));
  row.image = "a.png";
  row.feature.status = FeatureStatus::found;
  row.feature.ellipse = {10.5, 20.25, 5.0, 4.0, 0.1};
  EXPECT_EQ(commas(picture_csv_line(row)), commas(picture_csv_header()));
  EXPECT_THAT(picture_csv_line(row), ::testing::StartsWith("a.png,3,found,10.5000,20.2500,5.0000"));
}

TEST(PictureRun, TheOverlayMarksTheOutlineAndLeavesTheRestAlone) {
  PictureResult result;
  PictureRow row;
  row.target = 1;
  row.feature.status = FeatureStatus::found;
  row.feature.ellipse = {50.0, 50.0, 30.0, 30.0, 0.0};
  result.rows.push_back(row);
  vpImage<vpRGBa> picture(100, 100, vpRGBa(128, 128, 128));
  draw_overlay(result, picture);
  EXPECT_TRUE(picture[50][20].R > 200 && picture[50][20].B < 80);
  EXPECT_TRUE(picture[30][40] == vpRGBa(128, 128, 128));
}

}  // namespace
}  // namespace vigia::tracking::testing

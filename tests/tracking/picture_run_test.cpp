#include "vigia/tracking/picture_run.hpp"

#include "disc_scene.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::tracking::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kPictures = "/usr/share/visp-images-data/ViSP-images";

#define VIGIA_NEEDS_PICTURES() \
  if (!fs::exists(kPictures)) GTEST_SKIP() << "visp-images-data is not installed"

PictureRunParams params_for(const std::string& tracker) {
  PictureRunParams params;
  params.tracker = tracker;
  return params;
}

/// The rows of one picture.
struct PictureResult {
  fs::path image;
  std::vector<PictureRow> rows;
};

int found(const PictureResult& result) {
  return static_cast<int>(std::count_if(
      result.rows.begin(), result.rows.end(),
      [](const PictureRow& row) { return row.feature.status == FeatureStatus::found; }));
}

std::vector<PictureResult> run(const std::string& tracker, const std::vector<fs::path>& files) {
  PictureRun pictures(params_for(tracker));
  std::vector<PictureResult> results;
  for (const fs::path& file : files)
    results.push_back({file, pictures.next(imaging::read_image(file))});
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
  // Four views that are no sequence.
  for (const fs::path& file : numbered("calibration", "grid36-", 2, 1, 4, 1)) {
    const PictureResult result = run(GetParam(), {file})[0];
    EXPECT_EQ(found(result), 36) << file;
    EXPECT_EQ(result.rows.size(), 36U) << file;
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

struct HeldDots {
  const char* tracker;
  int least;  ///< of 2,500 sights of a dot; moving edges don't hold the flattest small dots
};

class MovingDots : public ::testing::TestWithParam<HeldDots> {};

TEST_P(MovingDots, FiveDotsKeepFiveNumbersThroughTheSequence) {
  VIGIA_NEEDS_PICTURES();
  const auto results = run(GetParam().tracker, numbered("mire-2", "image.", 4, 1, 500, 1));
  ASSERT_EQ(results.size(), 500U);
  ASSERT_EQ(found(results[0]), 5);
  int sightings = 0;
  int renumbered = 0;
  for (const PictureResult& result : results) {
    sightings += found(result);
    for (const PictureRow& row : result.rows) renumbered += row.target > 5 ? 1 : 0;
  }
  EXPECT_EQ(renumbered, 0);
  EXPECT_GE(sightings, GetParam().least);
}

INSTANTIATE_TEST_SUITE_P(All, MovingDots,
                         ::testing::Values(HeldDots{"disc", 2475}, HeldDots{"ellipse", 2375}),
                         [](const auto& test) { return std::string(test.param.tracker); });

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

/// A picture of dark discs, with noise.
imaging::ImageFrame picture_of(const std::vector<Ellipse>& discs, RandomStream& random,
                               int width = 200, int height = 120, double noise = 4.0) {
  SyntheticImage image(width, height, 200.0);
  for (const Ellipse& disc : discs) image.paint_ellipse(disc, 50.0);
  return imaging::ImageFrame(image.expose(noise, random));
}

/// The row of the disc at (u, v), or null.
const PictureRow* row_at(const std::vector<PictureRow>& rows, double u, double v) {
  for (const PictureRow& row : rows)
    if (row.feature.status == FeatureStatus::found &&
        std::hypot(row.feature.ellipse.u - u, row.feature.ellipse.v - v) < 1.0)
      return &row;
  return nullptr;
}

class Sequences : public ::testing::TestWithParam<const char*> {};

TEST_P(Sequences, ANewcomerIsReportedInTheFirstPictureInWhichItIsWhole) {
  RandomStream random(52, "newcomer");
  PictureRun run(params_for(GetParam()));
  for (int k = 0; k < 12; ++k) {
    // The second disc enters from the left: whole from k = 5 on.
    const double u = -20.0 + 8.0 * k;
    const auto rows =
        run.next(picture_of({{140.0, 60.0, 15.0, 13.0, 0.2}, {u, 60.0, 14.0, 12.0, 0.0}}, random));
    const PictureRow* first = row_at(rows, 140.0, 60.0);
    ASSERT_NE(first, nullptr) << k;
    EXPECT_EQ(first->target, 1) << k;
    if (u < 19.0) continue;
    const PictureRow* second = row_at(rows, u, 60.0);
    ASSERT_NE(second, nullptr) << k;
    EXPECT_EQ(second->target, 2) << k;
  }
}

TEST_P(Sequences, ADiscThatIsCoveredForTenPicturesKeepsItsNumber) {
  RandomStream random(53, "covered");
  PictureRun run(params_for(GetParam()));
  int seen_again = 0;
  for (int k = 0; k < 30; ++k) {
    const double u = 30.0 + 4.0 * k;
    const bool covered = k >= 8 && k < 18;
    const auto rows = run.next(picture_of(
        covered ? std::vector<Ellipse>{} : std::vector<Ellipse>{{u, 60.0, 14.0, 12.0, 0.0}},
        random));
    if (covered) continue;
    const PictureRow* row = row_at(rows, u, 60.0);
    ASSERT_NE(row, nullptr) << k;
    EXPECT_EQ(row->target, 1) << k;
    seen_again += k >= 18 ? 1 : 0;
  }
  EXPECT_EQ(seen_again, 12);
}

TEST_P(Sequences, ADiscIsHeldAtTwentyPixelsAPicture) {
  RandomStream random(54, "fast");
  PictureRun run(params_for(GetParam()));
  for (int k = 0; k < 20; ++k) {
    const double u = 40.0 + 20.0 * k;
    const auto rows = run.next(picture_of({{u, 60.0, 8.5, 8.0, 0.0}}, random, 480));
    const PictureRow* row = row_at(rows, u, 60.0);
    ASSERT_NE(row, nullptr) << k;
    EXPECT_EQ(row->target, 1) << k;
  }
}

TEST_P(Sequences, ADiscIsHeldAtTwoPixelsAPictureBetweenSearches) {
  RandomStream random(55, "slow");
  PictureRunParams params = params_for(GetParam());
  params.every = 1000;
  PictureRun run(params);
  for (int k = 0; k < 40; ++k) {
    const double u = 40.0 + 2.0 * k;
    const auto rows = run.next(picture_of({{u, 60.0, 15.0, 13.0, 0.3}}, random));
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].target, 1);
    ASSERT_EQ(rows[0].feature.status, FeatureStatus::found) << k;
    EXPECT_NEAR(rows[0].feature.ellipse.u, u, 0.9) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Sequences, ::testing::Values("disc", "ellipse", "correlation"),
                         [](const auto& test) { return std::string(test.param); });

TEST(PictureRun, ATargetKeepsItsNumberAndAnotherSceneIsSearchedAnew) {
  RandomStream random(51, "pictures");
  PictureRun run(params_for("disc"));
  auto rows = run.next(picture_of({{40.0, 50.0, 12.0, 10.0, 0.0}}, random));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].target, 1);
  EXPECT_EQ(run.next(picture_of({{46.0, 50.0, 12.0, 10.0, 0.0}}, random))[0].target, 1);
  rows = run.next(picture_of({{100.0, 40.0, 20.0, 15.0, 0.0}}, random, 240));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].target, 2);
}

TEST(PictureRun, SearchesNoMoreThanItIsAskedTo) {
  RandomStream random(56, "every");
  PictureRunParams params = params_for("disc");
  params.every = 4;
  PictureRun run(params);
  const std::vector<Ellipse> one{{40.0, 50.0, 12.0, 10.0, 0.0}};
  const std::vector<Ellipse> two{one[0], {150.0, 60.0, 12.0, 10.0, 0.0}};
  EXPECT_EQ(run.next(picture_of(one, random)).size(), 1U);
  for (int k = 1; k < 4; ++k) EXPECT_EQ(run.next(picture_of(two, random)).size(), 1U) << k;
  EXPECT_EQ(run.next(picture_of(two, random)).size(), 2U);
}

TEST(PictureRun, WithAllThatIsExpectedInHandItDoesNotSearch) {
  RandomStream random(57, "expected");
  PictureRunParams params = params_for("disc");
  params.expected = 1;
  PictureRun run(params);
  const std::vector<Ellipse> two{{40.0, 50.0, 12.0, 10.0, 0.0}, {150.0, 60.0, 12.0, 10.0, 0.0}};
  EXPECT_EQ(run.next(picture_of({two[0]}, random)).size(), 1U);
  EXPECT_EQ(run.next(picture_of(two, random)).size(), 1U);
}

TEST(PictureRun, DiscsOutsideTheRadiusRangeAndOfTheOtherPolarityDoNotCount) {
  RandomStream random(58, "limits");
  const auto picture =
      picture_of({{40.0, 50.0, 8.0, 8.0, 0.0}, {120.0, 60.0, 20.0, 19.0, 0.0}}, random);
  PictureRunParams params = params_for("disc");
  params.min_radius_px = 12.0;
  auto rows = PictureRun(params).next(picture);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_NEAR(rows[0].feature.ellipse.u, 120.0, 0.5);
  params.min_radius_px = 3.0;
  params.max_radius_px = 12.0;
  rows = PictureRun(params).next(picture);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_NEAR(rows[0].feature.ellipse.u, 40.0, 0.5);
  params.polarity = Polarity::bright;
  EXPECT_TRUE(PictureRun(params).next(picture).empty());
}

TEST(PictureRun, AnUnknownTrackerAndAMissingFileAreInputErrors) {
  EXPECT_THROW(PictureRun(params_for("dots")), InputError);
  EXPECT_THROW(run("disc", {"/nowhere/picture.png"}), InputError);
}

TEST(PictureRun, TheTableHasAsManyFieldsAsItsHeader) {
  const auto commas = [](const std::string& text) {
    return std::count(text.begin(), text.end(), ',');
  };
  EllipseFeature feature;
  EXPECT_EQ(commas(ellipse_csv_fields(feature)), commas(ellipse_csv_header()));
  EXPECT_THAT(ellipse_csv_fields(feature), ::testing::StartsWith("not_found,"));
  feature.status = FeatureStatus::found;
  feature.ellipse = {10.5, 20.25, 5.0, 4.0, 0.1};
  feature.covariance(0, 2) = feature.covariance(2, 0) = 0.25;
  EXPECT_EQ(commas(ellipse_csv_fields(feature)), commas(ellipse_csv_header()));
  EXPECT_THAT(ellipse_csv_fields(feature),
              ::testing::StartsWith("found,10.5000,20.2500,5.0000,4.0000,5.730,1.0000"));
  EXPECT_THAT(ellipse_csv_fields(feature), ::testing::HasSubstr(",0.0000,0.2500,0.0000,"));
}

TEST(PictureRun, TheOverlayMarksTheOutlineAndLeavesTheRestAlone) {
  std::vector<PictureRow> rows(1);
  rows[0].target = 1;
  rows[0].feature.status = FeatureStatus::found;
  rows[0].feature.ellipse = {50.0, 50.0, 30.0, 30.0, 0.0};
  vpImage<vpRGBa> picture(100, 100, vpRGBa(128, 128, 128));
  draw_overlay(rows, picture);
  EXPECT_TRUE(picture[50][20].R > 200 && picture[50][20].B < 80);
  EXPECT_TRUE(picture[30][40] == vpRGBa(128, 128, 128));
}

TEST(PictureRun, NumbersOfNeighboursStayOffEachOthersDiscs) {
  // A grid of small discs with little more room between them than a number takes.
  std::vector<PictureRow> rows;
  for (int k = 0; k < 9; ++k) {
    PictureRow row;
    row.target = 10 + k;
    row.feature.status = FeatureStatus::found;
    row.feature.ellipse = {50.0 + 50.0 * (k % 3), 50.0 + 50.0 * (k / 3), 10.0, 10.0, 0.0};
    rows.push_back(row);
  }
  vpImage<vpRGBa> picture(200, 200, vpRGBa(128, 128, 128));
  draw_overlay(rows, picture);
  for (const PictureRow& row : rows) {
    // Between the cross, whose arms are 3 px, and the outline nothing is drawn.
    const auto u = static_cast<unsigned>(row.feature.ellipse.u);
    const auto v = static_cast<unsigned>(row.feature.ellipse.v);
    for (const unsigned corner : {v - 4, v + 4}) {
      EXPECT_TRUE(picture[corner][u - 4] == vpRGBa(128, 128, 128)) << row.target;
      EXPECT_TRUE(picture[corner][u + 4] == vpRGBa(128, 128, 128)) << row.target;
    }
  }
}

}  // namespace
}  // namespace vigia::tracking::testing

#include "vigia/core/path.hpp"

#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"

namespace vigia {
namespace {

Path corner_path() {
  return Path({{0.0, 0.0}, {3.0, 0.0}, {3.0, 0.0}, {3.0, 4.0}});
}

TEST(Path, DropsRepeatedNeighbours) {
  EXPECT_EQ(corner_path().points().size(), 3U);
  EXPECT_EQ(corner_path().stations(), (std::vector<double>{0.0, 3.0, 7.0}));
  EXPECT_DOUBLE_EQ(corner_path().length(), 7.0);
}

TEST(Path, NeedsTwoDistinctFinitePoints) {
  EXPECT_THROW(Path({{1.0, 1.0}}), std::invalid_argument);
  EXPECT_THROW(Path({{1.0, 1.0}, {1.0, 1.0}}), std::invalid_argument);
  EXPECT_THROW(Path({{1.0, 1.0}, {std::nan(""), 1.0}}), std::invalid_argument);
}

TEST(Path, IsEmptyBeforeItHasPoints) {
  EXPECT_TRUE(Path().empty());
  EXPECT_EQ(Path().length(), 0.0);
  EXPECT_THROW(Path().at(0.0), std::logic_error);
}

TEST(Path, GivesThePointAtAStationClampedToItsEnds) {
  const Path path = corner_path();
  EXPECT_EQ(path.at(1.5), Eigen::Vector2d(1.5, 0.0));
  EXPECT_EQ(path.at(5.0), Eigen::Vector2d(3.0, 2.0));
  EXPECT_EQ(path.at(-1.0), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(path.at(99.0), Eigen::Vector2d(3.0, 4.0));
}

TEST(Path, HeadsAtACornerAlongTheSegmentThatBeginsThere) {
  const Path path = corner_path();
  EXPECT_DOUBLE_EQ(path.heading(2.999), 0.0);
  EXPECT_DOUBLE_EQ(path.heading(3.0), kPi / 2.0);
  EXPECT_DOUBLE_EQ(path.heading(7.0), kPi / 2.0);
}

TEST(Path, ProjectsOntoTheNearestStationInTheWindow) {
  const Path path = corner_path();
  EXPECT_DOUBLE_EQ(path.project({1.0, 0.5}, 0.0, 7.0), 1.0);
  EXPECT_DOUBLE_EQ(path.project({2.5, 3.0}, 0.0, 7.0), 6.0);
  EXPECT_DOUBLE_EQ(path.project({2.5, 3.0}, 0.0, 2.0), 2.0);
  EXPECT_DOUBLE_EQ(path.project({1.0, 0.5}, 4.0, 7.0), 4.0);
  EXPECT_DOUBLE_EQ(path.project({9.0, 9.0}, -5.0, 50.0), 7.0);
  EXPECT_THROW((void)path.project({0.0, 0.0}, 2.0, 1.0), std::invalid_argument);
}

TEST(Path, StaysOnItsOwnBranchWhereItComesBackOnItself) {
  const Path there_and_back({{0.0, 0.0}, {5.0, 0.0}, {5.0, 0.2}, {0.0, 0.2}});
  EXPECT_NEAR(there_and_back.project({2.0, 0.15}, 1.0, 4.0), 2.0, 1e-12);
  EXPECT_NEAR(there_and_back.project({2.0, 0.05}, 6.0, 10.2), 8.2, 1e-12);
}

TEST(Path, ResamplesBySpacingAndKeepsCornersAndEnds) {
  const Path dense = corner_path().resampled(0.7);
  EXPECT_NEAR(dense.length(), 7.0, 1e-12);
  for (const double corner : {0.0, 3.0, 7.0}) {
    bool kept = false;
    for (const double s : dense.stations()) kept = kept || std::abs(s - corner) < 1e-9;
    EXPECT_TRUE(kept) << corner;
  }
  for (std::size_t i = 1; i < dense.stations().size(); ++i)
    EXPECT_LE(dense.stations()[i] - dense.stations()[i - 1], 0.7 + 1e-9);
  EXPECT_EQ(dense.points().size(), 12U);  // 0, ten multiples of 0.7 with the end, and the corner
  EXPECT_THROW((void)corner_path().resampled(0.0), std::invalid_argument);
}

}  // namespace
}  // namespace vigia

#include "vigia/report/live_map.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace vigia::report {
namespace {

/// How many pixels of a picture are about that blue, the colour of the belief.
int blue_pixels(const vpImage<vpRGBa>& image) {
  int count = 0;
  for (unsigned v = 0; v < image.getHeight(); ++v)
    for (unsigned u = 0; u < image.getWidth(); ++u)
      if (image[v][u].B > image[v][u].R + 60) ++count;
  return count;
}

class ALiveMap : public ::testing::Test {
 protected:
  WorldMap world_{"room", FloorPlan({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, 2.8, {}, {}), {}, {}};
  LiveMap map_{world_, Path({{1.0, 1.0}, {7.0, 5.0}}), 0.3, 320, 240};
  Belief belief_;
};

TEST_F(ALiveMap, HasTheSizeThatWasAskedFor) {
  const auto picture = map_.picture(belief_, std::nullopt);
  EXPECT_EQ(picture.getWidth(), 320U);
  EXPECT_EQ(picture.getHeight(), 240U);
}

TEST_F(ALiveMap, ShowsTheTrackThatGrowsAndTheEllipseOfTheBelief) {
  belief_.pose = {4.0, 3.0, 0.0};
  belief_.covariance = 1e-8 * Eigen::Matrix3d::Identity();
  map_.move({1.0, 1.0, 0.0}, {1.0, 1.0, 0.0});
  const int before = blue_pixels(map_.picture(belief_, std::nullopt));
  map_.move({4.0, 3.0, 0.0}, {4.0, 3.0, 0.0});
  const int moved = blue_pixels(map_.picture(belief_, std::nullopt));
  EXPECT_GT(moved, before + 100);
  belief_.covariance.diagonal() << 0.25, 0.25, 0.01;
  EXPECT_GT(blue_pixels(map_.picture(belief_, std::nullopt)), moved + 100);
}

}  // namespace
}  // namespace vigia::report

#include "noise_smoothing.hpp"

#include "synthetic_image.hpp"

#include <gtest/gtest.h>

namespace vigia::tracking::testing {
namespace {

TEST(NoiseSmoothing, TheNoiseOfAPictureIsMeasuredBesideEdgesAndASlopeOfLight) {
  RandomStream random(71, "noise level");
  SyntheticImage image(640, 480, 130.0);
  image.add_texture(4.0, 71);
  image.paint_clutter(40, {}, random);
  for (const double noise : {2.0, 4.0, 15.0, 30.0})
    EXPECT_NEAR(noise_level(image.expose(noise, random), {0, 0, 640, 480}), noise, 0.1 * noise);
}

TEST(NoiseSmoothing, AWindowTooSmallToTellHasNoNoise) {
  const vpImage<unsigned char> image(8, 8, 100);
  EXPECT_EQ(noise_level(image, {3, 3, 2, 2}), 0.0);
  EXPECT_EQ(noise_level(image, {0, 0, 8, 8}), 0.0);
}

TEST(NoiseSmoothing, OnlyNoiseThatMakesEdgesIsSmoothed) {
  EXPECT_EQ(smoothing_for(4.0, 30.0), 0.0);
  EXPECT_GE(smoothing_for(8.0, 30.0), 1.0);
  EXPECT_GT(smoothing_for(30.0, 30.0), smoothing_for(15.0, 30.0));
}

TEST(NoiseSmoothing, NothingBesideTheWindowIsReadOrWritten) {
  vpImage<unsigned char> image(20, 20, 255);
  for (unsigned v = 5; v < 15; ++v)
    for (unsigned u = 5; u < 15; ++u) image[v][u] = 40;
  vpImage<unsigned char> out(20, 20, 7);
  smooth(image, {5, 5, 10, 10}, 2.0, out);
  for (unsigned v = 0; v < 20; ++v)
    for (unsigned u = 0; u < 20; ++u)
      EXPECT_EQ(out[v][u], v >= 5 && v < 15 && u >= 5 && u < 15 ? 40 : 7);
}

}  // namespace
}  // namespace vigia::tracking::testing

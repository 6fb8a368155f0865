#include "disc_scene.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "vigia/tracking/disc_tracker.hpp"

namespace vigia::tracking::testing {
namespace {

std::vector<EllipseFeature> search(const SyntheticImage& image, RandomStream& random,
                                   Polarity polarity = Polarity::dark) {
  const imaging::ImageFrame frame(image.expose(4.0, random));
  imaging::Canvas canvas = canvas_of(frame);
  DiscTrackerParameters parameters;
  parameters.polarity = polarity;
  return DiscTracker(parameters).find_all(canvas);
}

bool among(const std::vector<EllipseFeature>& features, const Ellipse& disc) {
  return std::any_of(features.begin(), features.end(), [&](const EllipseFeature& feature) {
    return std::hypot(feature.ellipse.u - disc.u, feature.ellipse.v - disc.v) < 0.3 &&
           std::abs(feature.ellipse.a - disc.a) < 0.3 && std::abs(feature.ellipse.b - disc.b) < 0.3;
  });
}

TEST(DiscSearch, EveryDiscIsFoundInAFullFrameOfClutter) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    RandomStream random(seed, "clutter");
    SyntheticImage image(640, 480, 190.0);
    image.add_texture(4.0, seed);
    const std::vector<Ellipse> discs{{90.3, 120.6, 30.0, 22.0, 0.5},
                                     {330.7, 90.2, 15.0, 15.0, 0.0},
                                     {520.1, 350.8, 12.0, 5.0, -0.9},
                                     {220.4, 380.5, 6.0, 5.5, 1.2},
                                     {440.6, 200.3, 55.0, 40.0, 0.1}};
    image.paint_clutter(50, discs, random);
    for (const Ellipse& disc : discs) image.paint_ellipse(disc, 70.0);
    const std::vector<EllipseFeature> features = search(image, random);
    for (const Ellipse& disc : discs)
      EXPECT_TRUE(among(features, disc)) << "seed " << seed << ", radius " << disc.a;
  }
}

TEST(DiscSearch, ThingsThatAreNoDiscsAreRejected) {
  RandomStream random(7, "no discs");
  SyntheticImage image(640, 480, 190.0);
  image.paint_rectangle(60, 60, 40, 40, 0.3, 60.0);
  image.paint_rectangle(160, 60, 24, 24, 0.0, 60.0);
  image.paint_rectangle(260, 60, 60, 25, 0.8, 60.0);
  image.paint_ring({360, 60, 25, 25, 0}, 0.5, 60.0);
  image.paint_ring({460, 60, 25, 20, 0.4}, 0.3, 60.0);
  image.paint_half_disc({60, 180, 30, 30, 0}, 0.2, 60.0);
  image.paint_half_disc({160, 180, 14, 14, 0}, 1.4, 60.0);
  image.paint_ellipse({300, 180, 40, 9, 0.5}, 60.0);
  for (int k = 0; k < 6; ++k) image.paint_blob(80.0 + 95.0 * k, 300.0, 26.0, 60.0, random);
  image.paint_ellipse({5, 420, 20, 20, 0}, 60.0);
  image.paint_ellipse({630, 240, 30, 25, 0}, 60.0);
  image.paint_ellipse({320, 478, 16, 16, 0}, 60.0);
  for (const EllipseFeature& feature : search(image, random))
    ADD_FAILURE() << "found at " << feature.ellipse.u << ", " << feature.ellipse.v << " with a "
                  << feature.ellipse.a << " and b " << feature.ellipse.b;
}

TEST(DiscSearch, PolaritySelectsDarkBrightOrBoth) {
  RandomStream random(8, "polarity");
  SyntheticImage image(200, 120, 130.0);
  const Ellipse dark{60.2, 60.7, 14.0, 12.0, 0.3};
  const Ellipse bright{140.6, 58.1, 13.0, 13.0, 0.0};
  image.paint_ellipse(dark, 50.0);
  image.paint_ellipse(bright, 220.0);
  const auto darks = search(image, random, Polarity::dark);
  ASSERT_EQ(darks.size(), 1U);
  EXPECT_TRUE(among(darks, dark));
  EXPECT_GT(darks[0].contrast, 0.0);
  const auto brights = search(image, random, Polarity::bright);
  ASSERT_EQ(brights.size(), 1U);
  EXPECT_TRUE(among(brights, bright));
  EXPECT_LT(brights[0].contrast, 0.0);
  EXPECT_EQ(search(image, random, Polarity::either).size(), 2U);
}

TEST(DiscSearch, AnEmptyFrameHoldsNothing) {
  RandomStream random(9, "empty");
  SyntheticImage image(640, 480, 190.0);
  image.add_texture(4.0, 9);
  EXPECT_TRUE(search(image, random).empty());
}

TEST(DiscSearch, AFrameSmallerThanADiscHoldsNothing) {
  RandomStream random(10, "tiny");
  for (const int size : {1, 2, 5, 9}) {
    const SyntheticImage image(size, size, 190.0);
    EXPECT_TRUE(search(image, random, Polarity::either).empty()) << size;
  }
}

}  // namespace
}  // namespace vigia::tracking::testing

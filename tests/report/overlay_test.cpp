#include "vigia/report/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace vigia::report {
namespace {

using imaging::Overlay;

using Image = vpImage<vpRGBa>;

Image plain(unsigned char grey, unsigned width = 640, unsigned height = 480) {
  return Image(height, width, vpRGBa(grey, grey, grey));
}

double luminance(const vpRGBa& p) {
  return 0.2126 * p.R + 0.7152 * p.G + 0.0722 * p.B;
}

// The pixels that the overlay changed.
struct Changed {
  unsigned count = 0;
  double mean_u = 0.0;
  double mean_v = 0.0;
  double darkest = 255.0;
  double lightest = 0.0;
};

Changed changed(const Image& before, const Image& after) {
  Changed result;
  for (unsigned v = 0; v < before.getHeight(); ++v)
    for (unsigned u = 0; u < before.getWidth(); ++u) {
      const vpRGBa& p = after[v][u];
      if (p.R == before[v][u].R && p.G == before[v][u].G && p.B == before[v][u].B) continue;
      ++result.count;
      result.mean_u += u;
      result.mean_v += v;
      result.darkest = std::min(result.darkest, luminance(p));
      result.lightest = std::max(result.lightest, luminance(p));
    }
  result.mean_u /= std::max(1U, result.count);
  result.mean_v /= std::max(1U, result.count);
  return result;
}

TEST(Overlay, EmptyOneLeavesTheImageAsItWas) {
  const Image before = plain(120);
  Image after = before;
  draw_overlay(after, {});
  EXPECT_EQ(changed(before, after).count, 0U);
}

TEST(Overlay, MeasuredEllipseIsCentredOnItsPixel) {
  const Image before = plain(120);
  Image after = before;
  Overlay overlay;
  overlay.measured = Ellipse{300.0, 200.0, 40.0, 25.0, 0.4};
  draw_overlay(after, overlay);
  const Changed marks = changed(before, after);
  EXPECT_GT(marks.count, 200U);
  // A shift of half a pixel, Cairo's centre convention, would show.
  EXPECT_NEAR(marks.mean_u, 300.0, 0.1);
  EXPECT_NEAR(marks.mean_v, 200.0, 0.1);
}

TEST(Overlay, TextStandsOutOnBlackAndOnWhite) {
  for (const int ground : {0, 128, 255}) {
    const Image before = plain(static_cast<unsigned char>(ground));
    Image after = before;
    Overlay overlay;
    overlay.lines = {"t 12.4 s  track  L3", "zoom 22 mm  error 0.31 px"};
    draw_overlay(after, overlay);
    const Changed marks = changed(before, after);
    EXPECT_GT(marks.count, 500U);
    const double contrast =
        std::max(std::abs(marks.lightest - ground), std::abs(marks.darkest - ground));
    EXPECT_GT(contrast, 120.0) << ground;
  }
}

TEST(Overlay, PartsOutsideTheImageOrNotFiniteAreLeftOut) {
  const Image before = plain(120, 320, 240);
  Image after = before;
  Overlay overlay;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  overlay.measured = Ellipse{nan, 10.0, 5.0, 5.0, 0.0};
  overlay.predicted = Ellipse{-5000.0, 10.0, 5.0, 5.0, 0.0};
  overlay.principal_point = Eigen::Vector2d(1e5, 1e5);
  draw_overlay(after, overlay);
  EXPECT_EQ(changed(before, after).count, 0U);
}

TEST(Overlay, SameInputGivesTheSamePixels) {
  Overlay overlay;
  overlay.measured = Ellipse{100.2, 90.7, 20.0, 15.0, 0.4};
  overlay.predicted = Ellipse{104.0, 93.0, 21.0, 15.0, 0.4};
  overlay.principal_point = Eigen::Vector2d(159.5, 119.5);
  overlay.lines = {"t 1.0 s"};
  Image first = plain(90, 320, 240);
  Image second = first;
  draw_overlay(first, overlay);
  draw_overlay(second, overlay);
  EXPECT_EQ(changed(first, second).count, 0U);
}

}  // namespace
}  // namespace vigia::report

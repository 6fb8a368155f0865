#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/imaging/canvas.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::imaging {
namespace {

bool operator==(const Window& a, const Window& b) {
  return a.u == b.u && a.v == b.v && a.width == b.width && a.height == b.height;
}

/// A picture whose pixels tell where they are; never the sentinel.
ImageFrame ramp(unsigned height, unsigned width) {
  vpImage<unsigned char> image(height, width);
  for (unsigned v = 0; v < height; ++v)
    for (unsigned u = 0; u < width; ++u)
      image[v][u] = static_cast<unsigned char>((7 * v + u) % 251);
  return ImageFrame(image);
}

bool holds(const Canvas& canvas, const Window& window) {
  const auto truth = grey_image(canvas.frame());
  for (int v = 0; v < canvas.frame().height(); ++v) {
    for (int u = 0; u < canvas.frame().width(); ++u) {
      const auto row = static_cast<unsigned>(v);
      const auto column = static_cast<unsigned>(u);
      const unsigned char expected =
          contains(window, {u, v, 1, 1}) ? truth[row][column] : Canvas::kSentinel;
      if (canvas.image()[row][column] != expected) return false;
    }
  }
  return true;
}

TEST(Window, IntersectionOfDisjointOnesIsEmpty) {
  EXPECT_TRUE(intersect({0, 0, 10, 10}, {10, 0, 5, 5}).empty());
  EXPECT_TRUE(intersect({0, 0, 10, 10}, {4, 6, 10, 10}) == (Window{4, 6, 6, 4}));
}

TEST(Window, UnionIsTheBoundingBoxAndAnEmptyOneCountsForNothing) {
  EXPECT_TRUE(unite({1, 2, 3, 4}, {10, 10, 2, 2}) == (Window{1, 2, 11, 10}));
  EXPECT_TRUE(unite({1, 2, 3, 4}, {50, 50, 0, 3}) == (Window{1, 2, 3, 4}));
  EXPECT_TRUE(unite({50, 50, 0, 3}, {1, 2, 3, 4}) == (Window{1, 2, 3, 4}));
}

TEST(Window, ContainsItselfAndEveryEmptyOne) {
  const Window window{3, 4, 5, 6};
  EXPECT_TRUE(contains(window, window));
  EXPECT_TRUE(contains(window, {100, 100, 0, 0}));
  EXPECT_FALSE(contains(window, {3, 4, 6, 6}));
}

TEST(Canvas, HoldsRunsBesideItsRectangleUntilTheNextFrame) {
  const ImageFrame frame = ramp(40, 50);
  const auto truth = grey_image(frame);
  Canvas canvas;
  canvas.attach(frame);
  canvas.require(std::vector<imaging::Run>{{5, 10, 14}, {6, 30, 31}});
  EXPECT_TRUE(canvas.computed().empty());
  EXPECT_EQ(canvas.image()[5][10], truth[5][10]);
  EXPECT_EQ(canvas.image()[5][13], truth[5][13]);
  EXPECT_EQ(canvas.image()[5][14], Canvas::kSentinel);
  EXPECT_EQ(canvas.image()[6][30], truth[6][30]);
  canvas.require(Window{8, 4, 10, 3});
  EXPECT_EQ(canvas.image()[6][9], truth[6][9]);
  canvas.attach(frame);
  EXPECT_TRUE(holds(canvas, {}));
}

TEST(Canvas, HoldsTheSentinelWhereNothingIsComputed) {
  const ImageFrame frame = ramp(40, 50);
  Canvas canvas;
  canvas.attach(frame);
  EXPECT_TRUE(holds(canvas, {}));
  canvas.require({10, 12, 8, 6});
  EXPECT_TRUE(holds(canvas, {10, 12, 8, 6}));
}

TEST(Canvas, GrowsToTheBoundingBoxOfWhatWasAskedFor) {
  const ImageFrame frame = ramp(40, 50);
  for (const Window& second : {Window{2, 3, 4, 4}, Window{30, 20, 9, 9}, Window{12, 1, 3, 38},
                               Window{1, 13, 48, 2}, Window{-5, -5, 100, 100}}) {
    Canvas canvas;
    canvas.attach(frame);
    canvas.require({10, 12, 8, 6});
    canvas.require(second);
    const Window expected = unite({10, 12, 8, 6}, intersect(second, {0, 0, 50, 40}));
    EXPECT_TRUE(canvas.computed() == expected);
    EXPECT_TRUE(holds(canvas, expected));
  }
}

TEST(Canvas, ForgetsEverythingWithANewExposure) {
  const ImageFrame frame = ramp(40, 50);
  const ImageFrame smaller = ramp(20, 30);
  Canvas canvas;
  canvas.attach(frame);
  canvas.require({10, 12, 8, 6});
  canvas.attach(frame);
  EXPECT_TRUE(holds(canvas, {}));
  canvas.require({10, 12, 8, 6});
  canvas.attach(smaller);
  EXPECT_TRUE(holds(canvas, {}));
}

TEST(Canvas, SaysWhenAResultTouchesTheEdgeOfWhatIsComputed) {
  const ImageFrame frame = ramp(40, 50);
  Canvas canvas;
  canvas.attach(frame);
  canvas.require({0, 10, 20, 20});
  EXPECT_FALSE(canvas.leaves_computed({0, 12, 10, 10}));  // the frame's own border is no edge
  EXPECT_TRUE(canvas.leaves_computed({5, 10, 10, 10}));   // first computed row
  EXPECT_TRUE(canvas.leaves_computed({5, 12, 15, 10}));   // last computed column
  EXPECT_TRUE(canvas.leaves_computed({5, 12, 30, 10}));
  EXPECT_FALSE(canvas.leaves_computed({5, 12, 14, 10}));
}

TEST(ImageFrame, AWindowIsTheCropOfThePicture) {
  const ImageFrame frame = ramp(40, 50);
  std::vector<unsigned char> pixels(5 * 4, 0);
  frame.read_grey({7, 9, 3, 4}, pixels.data(), 5);
  for (int v = 0; v < 4; ++v)
    for (int u = 0; u < 5; ++u)
      EXPECT_EQ(pixels[static_cast<std::size_t>(5 * v + u)],
                u < 3 ? (7 * (9 + v) + 7 + u) % 251 : 0);
}

}  // namespace
}  // namespace vigia::imaging

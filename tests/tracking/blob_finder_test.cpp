#include "blob_finder.hpp"

#include <gtest/gtest.h>

namespace vigia::tracking {
namespace {

/// A light picture with a dark bar @p width px wide at its right side.
vpImage<unsigned char> bar_at_the_side(unsigned width) {
  vpImage<unsigned char> image(24, 32, 200);
  for (unsigned v = 0; v < image.getHeight(); ++v)
    for (unsigned u = image.getWidth() - width; u < image.getWidth(); ++u) image[v][u] = 40;
  return image;
}

TEST(BlobFinder, ReadsNothingBeyondThePictureWhereANarrowChordEndsAtItsSide) {
  for (unsigned width = 1; width <= 8; ++width) {
    vpImage<unsigned char> narrow = bar_at_the_side(width);
    BlobFinderParameters parameters;
    parameters.min_axis_px = 1.5;
    parameters.row_step = 1;
    BlobFinder finder(parameters);
    const auto alone = finder.find(narrow, {0, 0, 32, 24}).size();
    // The same window of a wider picture, dark beyond it. (In the narrow one a read beyond the last
    // row is the sanitizers' to find.)
    vpImage<unsigned char> wide(24, 40, 40);
    wide.insert(narrow, vpImagePoint(0, 0));
    EXPECT_EQ(finder.find(wide, {0, 0, 32, 24}).size(), alone) << width;
  }
}

}  // namespace
}  // namespace vigia::tracking

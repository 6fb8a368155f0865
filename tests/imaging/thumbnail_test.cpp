#include "vigia/imaging/thumbnail.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/imaging/image_frame.hpp"

namespace vigia::imaging {
namespace {

ImageFrame two_ramps(unsigned width, unsigned height) {
  vpImage<vpRGBa> image(height, width);
  for (unsigned v = 0; v < height; ++v)
    for (unsigned u = 0; u < width; ++u)
      image[v][u] = vpRGBa(static_cast<unsigned char>(u), static_cast<unsigned char>(v), 7);
  return ImageFrame(std::move(image));
}

TEST(Thumbnail, HoldsTheMeansOfEveryThirdRow) {
  const auto small = thumbnail(two_ramps(61, 30), 24);
  ASSERT_EQ(small.getWidth(), 20U);
  ASSERT_EQ(small.getHeight(), 10U);
  EXPECT_EQ(small[2][5].R, 16);
  EXPECT_EQ(small[2][5].G, 7);
  EXPECT_EQ(small[2][5].B, 7);
}

TEST(Thumbnail, LeavesASmallFrameAsItIs) {
  const auto small = thumbnail(two_ramps(20, 10), 24);
  EXPECT_EQ(small.getWidth(), 20U);
  EXPECT_EQ(small[9][19].R, 19);
}

TEST(Thumbnail, HasAWidth) {
  EXPECT_THROW(thumbnail(two_ramps(20, 10), 0), std::invalid_argument);
}

TEST(EncodedJpeg, IsReadAgainAsAlmostTheSamePicture) {
  vpImage<vpRGBa> image(40, 60, vpRGBa(200, 90, 30));
  const auto again = colour_image(decode_picture(encode_jpeg(image, 90), "the picture"));
  ASSERT_EQ(again.getWidth(), 60U);
  EXPECT_NEAR(again[20][30].R, 200, 4);
  EXPECT_NEAR(again[20][30].G, 90, 4);
  EXPECT_NEAR(again[20][30].B, 30, 4);
}

}  // namespace
}  // namespace vigia::imaging

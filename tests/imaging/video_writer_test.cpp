#include "vigia/imaging/video_writer.hpp"

#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/videoio.hpp>

#include "vigia/core/error.hpp"

namespace vigia::imaging {
namespace {

using ::testing::HasSubstr;

constexpr int kPictures = 60;

/// Ever lighter and redder.
vpImage<vpRGBa> shade(int i) {
  const auto level = static_cast<unsigned char>(4 * i);
  return {48, 64, vpRGBa(level, static_cast<unsigned char>(level / 2), 0)};
}

void write_shades(const std::filesystem::path& file) {
  const auto video = write_video(file, 64, 48, 25.0);
  for (int i = 0; i < kPictures; ++i) video->add(shade(i));
  video->finish();
}

TEST(VideoWriter, WritesEveryPictureInItsColours) {
  const vigia::testing::TempDir dir;
  write_shades(dir.path() / "shades.mp4");
  cv::VideoCapture video((dir.path() / "shades.mp4").string());
  EXPECT_DOUBLE_EQ(video.get(cv::CAP_PROP_FPS), 25.0);
  cv::Mat bgr;
  int i = 0;
  for (; video.read(bgr); ++i) {
    const auto middle = bgr.at<cv::Vec3b>(24, 32);
    EXPECT_NEAR(middle[2], 4 * i, 8) << i;
    EXPECT_NEAR(middle[0], 0, 8) << i;
  }
  EXPECT_EQ(i, kPictures);
}

TEST(VideoWriter, PutsTheIndexBeforeThePictures) {
  const vigia::testing::TempDir dir;
  write_shades(dir.path() / "shades.mp4");
  const std::string bytes = vigia::testing::read_text(dir.path() / "shades.mp4");
  const auto index = bytes.find("moov");
  ASSERT_NE(index, std::string::npos);
  EXPECT_LT(index, bytes.find("mdat"));
}

TEST(VideoWriter, SaysWhereItCannotWrite) {
  try {
    write_video("/no/such/folder/shades.mp4", 64, 48, 25.0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot write /no/such/folder/shades.mp4"));
  }
}

}  // namespace
}  // namespace vigia::imaging

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

#include "vigia/core/error.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::imaging {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ImageFile : public ::testing::Test {
 protected:
  void SetUp() override {
    dir_ = fs::temp_directory_path() /
           ("vigia_image_" + std::to_string(::getpid()) + "_" +
            ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(dir_);
    image_.resize(31, 47);
    for (unsigned i = 0; i < image_.getSize(); ++i)
      image_.bitmap[i] = vpRGBa(static_cast<unsigned char>(i * 7), static_cast<unsigned char>(i),
                                static_cast<unsigned char>(i * 3));
  }
  void TearDown() override { fs::remove_all(dir_); }

  static std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  fs::path file_of(const std::string& name, const std::string& bytes) const {
    std::ofstream(dir_ / name, std::ios::binary) << bytes;
    return dir_ / name;
  }
  static std::string error_of(const fs::path& file) {
    try {
      read_image(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path dir_;
  vpImage<vpRGBa> image_;
};

TEST_F(ImageFile, APngComesBackAsItWasWritten) {
  write_png(dir_ / "a.png", image_);
  auto back = colour_image(read_image(dir_ / "a.png"));
  EXPECT_TRUE(back == image_);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_), fs::directory_iterator()), 1);
}

TEST_F(ImageFile, EveryTruncationIsAnErrorThatNamesTheFile) {
  const cv::Mat mat(31, 47, CV_8UC3, cv::Scalar(10, 200, 90));
  for (const std::string extension : {"png", "jpg", "ppm", "pgm"}) {
    const fs::path whole = dir_ / ("whole." + extension);
    cv::Mat picture = mat;
    if (extension == "pgm") picture = cv::Mat(31, 47, CV_8UC1, cv::Scalar(10));
    ASSERT_TRUE(cv::imwrite(whole.string(), picture));
    EXPECT_EQ(error_of(whole), "no error");
    const std::string bytes = bytes_of(whole);
    for (std::size_t keep = 3; keep < bytes.size(); keep += 1 + bytes.size() / 97) {
      const fs::path cut = file_of("cut." + extension, bytes.substr(0, keep));
      EXPECT_THAT(error_of(cut), HasSubstr("cut." + extension)) << keep << " of " << bytes.size();
    }
    const fs::path cut = file_of("cut." + extension, bytes.substr(0, bytes.size() - 1));
    EXPECT_THAT(error_of(cut), HasSubstr("ends early"));
  }
}

TEST_F(ImageFile, AMissingEmptyOrForeignFileIsAnError) {
  EXPECT_THAT(error_of(dir_ / "none.png"), HasSubstr("No such file"));
  EXPECT_THAT(error_of(file_of("empty.png", "")), HasSubstr("empty"));
  EXPECT_THAT(error_of(file_of("text.png", "this is no picture")), HasSubstr("no picture"));
  EXPECT_THAT(error_of(dir_), HasSubstr("directory"));
}

TEST_F(ImageFile, WritingBelowARegularFileIsAnErrorAndLeavesNothing) {
  file_of("file", "x");
  EXPECT_THROW(write_png(dir_ / "file" / "a.png", image_), InputError);
  EXPECT_THROW(write_png(dir_ / "missing" / "a.png", image_), InputError);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir_), fs::directory_iterator()), 1);
}

TEST_F(ImageFile, AFullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  fs::create_symlink("/dev/full", dir_ / "a.png.part");
  EXPECT_THROW(write_png(dir_ / "a.png", image_), InputError);
  EXPECT_FALSE(fs::exists(dir_ / "a.png"));
}

}  // namespace
}  // namespace vigia::imaging

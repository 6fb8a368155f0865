#include "disc_scene.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "vigia/tracking/picture_run.hpp"

namespace vigia::tracking::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kStored = "/usr/share/visp-images-data/ViSP-images";
const fs::path kEllipse = kStored / "ellipse" / "ellipse.pgm";
const fs::path kGrid = kStored / "calibration" / "grid36-01.pgm";

PictureRunParams hard_params_for(const std::string& tracker) {
  PictureRunParams params;
  params.tracker = tracker;
  return params;
}

std::vector<EllipseFeature> find_in(const vpImage<unsigned char>& picture,
                                    const std::string& tracker) {
  const imaging::ImageFrame frame(picture);
  imaging::Canvas canvas = canvas_of(frame);
  return make_picture_tracker(hard_params_for(tracker))->find_all(canvas);
}

vpImage<unsigned char> grey_picture(const fs::path& file) {
  return imaging::grey_image(imaging::read_image(file));
}

/// Every grey value g at (u, v) becomes change(u, v, g).
vpImage<unsigned char> altered(vpImage<unsigned char> picture,
                               const std::function<double(double, double, double)>& change) {
  for (unsigned v = 0; v < picture.getHeight(); ++v)
    for (unsigned u = 0; u < picture.getWidth(); ++u)
      picture[v][u] = static_cast<unsigned char>(
          std::clamp(std::floor(change(u, v, picture[v][u]) + 0.5), 0.0, 255.0));
  return picture;
}

vpImage<unsigned char> with_noise(const vpImage<unsigned char>& picture, double noise,
                                  RandomStream& random) {
  return altered(picture, [&](double, double, double g) { return g + noise * random.normal(); });
}

bool is_the_ellipse(const EllipseFeature& feature) {
  const Ellipse& e = feature.ellipse;
  return std::abs(e.u - 146.3) < 1.0 && std::abs(e.v - 142.2) < 1.0 && std::abs(e.a - 67.9) < 1.0 &&
         std::abs(e.b - 35.6) < 1.0;
}

class HardPictures : public ::testing::TestWithParam<const char*> {
 protected:
  static void SetUpTestSuite() {
    if (!fs::exists(kStored)) GTEST_SKIP() << "visp-images-data is not installed";
  }
};

class NoisyDiscs : public ::testing::TestWithParam<const char*> {};

TEST_P(NoisyDiscs, AreFoundAndNothingElseIs) {
  RandomStream random(61, "noisy discs");
  for (const double radius : {25.0, 45.0, 68.0})
    for (const double contrast : {135.0, 180.0, 240.0}) {
      const Ellipse disc{110.3, 108.6, radius, 0.8 * radius, 0.4};
      SyntheticImage image(220, 220, 127.5 + 0.5 * contrast);
      image.paint_ellipse(disc, 127.5 - 0.5 * contrast);
      const auto features = find_in(image.expose(30.0, random), GetParam());
      ASSERT_EQ(features.size(), 1U) << radius << ", " << contrast;
      EXPECT_NEAR(features[0].ellipse.u, disc.u, 1.5);
      EXPECT_NEAR(features[0].ellipse.v, disc.v, 1.5);
      EXPECT_NEAR(features[0].ellipse.a, disc.a, 1.5);
    }
}

TEST_P(NoisyDiscs, AreFollowedFromPictureToPicture) {
  RandomStream random(65, "noisy sequence");
  PictureRun pictures(hard_params_for(GetParam()));
  for (int k = 0; k < 8; ++k) {
    const Ellipse disc{90.3 + 3.0 * k, 108.6 - k, 40.0, 33.0, 0.4};
    SyntheticImage image(220, 220, 200.0);
    image.paint_ellipse(disc, 50.0);
    const auto rows = pictures.next(imaging::ImageFrame(image.expose(30.0, random)));
    ASSERT_EQ(rows.size(), 1U) << k;
    EXPECT_EQ(rows[0].feature.status, FeatureStatus::found) << k;
    EXPECT_EQ(rows[0].target, 1) << k;
    EXPECT_NEAR(rows[0].feature.ellipse.u, disc.u, 1.5) << k;
  }
}

TEST_P(NoisyDiscs, NoiseAloneHoldsNone) {
  RandomStream random(62, "noise alone");
  for (const double noise : {15.0, 30.0, 50.0})
    EXPECT_TRUE(find_in(SyntheticImage(640, 480, 128.0).expose(noise, random), GetParam()).empty())
        << noise;
}

INSTANTIATE_TEST_SUITE_P(All, NoisyDiscs, ::testing::Values("disc", "ellipse", "correlation"),
                         [](const auto& test) { return std::string(test.param); });

class NoisyCentres : public ::testing::TestWithParam<const char*> {};

struct Pulls {
  int found = 0;
  double mean_square = 0.0;  ///< of the centres' errors in their stated standard deviations
};

/// Of discs between the levels 127.5 ± half the contrast.
Pulls pulls_of(const std::string& tracker, double radius, double contrast, double noise,
               int pictures) {
  RandomStream random(63, "noisy centres");
  Pulls out;
  for (int k = 0; k < pictures; ++k) {
    const int size = static_cast<int>(2.0 * radius) + 60;
    SyntheticImage image(size, size, 127.5 + 0.5 * contrast);
    const Ellipse disc{0.5 * size + random.uniform(0.0, 1.0), 0.5 * size + random.uniform(0.0, 1.0),
                       radius, 0.87 * radius, random.uniform(-1.5, 1.5)};
    image.paint_ellipse(disc, 127.5 - 0.5 * contrast);
    for (const EllipseFeature& feature : find_in(image.expose(noise, random), tracker)) {
      ++out.found;
      out.mean_square += std::pow(feature.ellipse.u - disc.u, 2) / feature.covariance(0, 0) +
                         std::pow(feature.ellipse.v - disc.v, 2) / feature.covariance(1, 1);
    }
  }
  out.mean_square /= 2.0 * out.found;
  return out;
}

TEST_P(NoisyCentres, AreOffAsTheirCovarianceSays) {
  constexpr int kPictures = 150;
  // Levels so far from 0 and 255 that hardly a pixel is cut off.
  constexpr double kNoise = 15.0;
  for (const double to_noise : {4.5, 8.0}) {
    const Pulls pulls = pulls_of(GetParam(), 30.0, to_noise * kNoise, kNoise, kPictures);
    ASSERT_GE(pulls.found, kPictures * 98 / 100) << to_noise;
    ASSERT_LE(pulls.found, kPictures);
    const double standard_error = std::sqrt(2.0 / (2.0 * pulls.found));
    EXPECT_NEAR(pulls.mean_square, 1.0, 0.05 + 3.5 * standard_error) << to_noise;
  }
}

TEST_P(NoisyCentres, AreNotMuchFurtherOffWhereHalfTheNoiseIsCutOff) {
  constexpr int kPictures = 100;
  const Pulls pulls = pulls_of(GetParam(), 45.0, 250.0, 30.0, kPictures);
  ASSERT_EQ(pulls.found, kPictures);
  EXPECT_LT(pulls.mean_square, 1.6);
}

INSTANTIATE_TEST_SUITE_P(All, NoisyCentres, ::testing::Values("disc", "correlation"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(HardPictures, TheEllipseIsFoundInStrongNoise) {
  RandomStream random(64, "noisy ellipse");
  for (int k = 0; k < 10; ++k) {
    const auto features = find_in(with_noise(grey_picture(kEllipse), 30.0, random), GetParam());
    ASSERT_EQ(features.size(), 1U) << k;
    EXPECT_TRUE(is_the_ellipse(features[0])) << k;
  }
}

TEST_P(HardPictures, TheEllipseIsFoundWhereTheLightFallsOffToTwoFifths) {
  const vpImage<unsigned char> picture = grey_picture(kEllipse);
  const double width = picture.getWidth() - 1.0;
  const double height = picture.getHeight() - 1.0;
  const auto to_right = [&](double u, double, double g) { return g * (1.0 - 0.6 * u / width); };
  const auto to_left = [&](double u, double, double g) { return g * (0.4 + 0.6 * u / width); };
  const auto to_bottom = [&](double, double v, double g) { return g * (1.0 - 0.6 * v / height); };
  for (const auto& light :
       {altered(picture, to_right), altered(picture, to_left), altered(picture, to_bottom)}) {
    const auto features = find_in(light, GetParam());
    ASSERT_EQ(features.size(), 1U);
    EXPECT_TRUE(is_the_ellipse(features[0]));
  }
}

TEST_P(HardPictures, TheCirclesOfTheGridAreFoundInABlurredPicture) {
  vpImage<unsigned char> picture = grey_picture(kGrid);
  cv::Mat whole(static_cast<int>(picture.getHeight()), static_cast<int>(picture.getWidth()), CV_8U,
                picture.bitmap);
  cv::GaussianBlur(whole, whole, cv::Size(), 2.5);
  EXPECT_EQ(find_in(picture, GetParam()).size(), 36U);
}

INSTANTIATE_TEST_SUITE_P(All, HardPictures, ::testing::Values("disc", "ellipse", "correlation"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace vigia::tracking::testing

#include "vigia/tracking/patch_finder.hpp"

#include "tracking/ceiling_scene.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "vigia/core/angle.hpp"
#include "vigia/core/random.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::tracking {
namespace {

constexpr int kFrames = 60;

/// What became of the patches of some frames.
struct PatchTally {
  int whole = 0;  ///< well inside the frame
  int missed = 0;
  int measured = 0;
  int false_ones = 0;
  int reversed = 0;
  int cut = 0;
  Eigen::Vector3d square = Eigen::Vector3d::Zero();    ///< along, across, angle
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();  ///< claimed
  double chi_square = 0.0;                             ///< of whole patches
  double cut_chi_square = 0.0;
};

void compare(const CeilingScene& scene, const Pose2& robot, const PatchScan& scan,
             PatchTally& tally) {
  std::vector<bool> used(scan.patches.size(), false);
  const CeilingCell middle = nearest_cell(scene.truth.grid, robot.position());
  for (std::int64_t i = middle.i - 3; i <= middle.i + 3; ++i) {
    for (std::int64_t j = middle.j - 3; j <= middle.j + 3; ++j) {
      const auto patch = sim::true_patch(scene.truth, {i, j});
      if (!patch) continue;
      const Eigen::Vector2d uv = scene.image_of(robot, *patch, 0.0);
      const Eigen::Vector2d along = scene.image_of(robot, *patch, 1e-3) - uv;
      const double angle = std::atan2(along.y(), along.x());
      const bool whole = in_image(scene.camera, uv, 14.0);
      tally.whole += whole ? 1 : 0;
      bool found = false;
      for (std::size_t k = 0; k < scan.patches.size(); ++k) {
        const PatchImage& seen = scan.patches[k];
        if ((seen.uv - uv).norm() > 5.0) continue;
        found = used[k] = true;
        Eigen::Vector3d error;
        error << seen.uv - uv, wrap_angle(seen.angle - angle);
        if (std::abs(error.z()) > 0.5 * kPi) {
          error.z() = wrap_angle(error.z() + kPi);
          tally.reversed += seen.cut ? 0 : 1;
        }
        const double chi = error.dot(seen.covariance.ldlt().solve(error));
        if (seen.cut) {
          ++tally.cut;
          tally.cut_chi_square += chi;
          continue;
        }
        ++tally.measured;
        tally.chi_square += chi;
        const Eigen::Matrix2d R = Eigen::Rotation2Dd(-angle).toRotationMatrix();
        const Eigen::Vector2d local = R * error.head<2>();
        tally.square += Eigen::Vector3d(local.x(), local.y(), error.z()).cwiseAbs2();
        const Eigen::Matrix2d claimed = R * seen.covariance.topLeftCorner<2, 2>() * R.transpose();
        tally.variance += Eigen::Vector3d(claimed(0, 0), claimed(1, 1), seen.covariance(2, 2));
      }
      tally.missed += whole && !found ? 1 : 0;
    }
  }
  for (const bool known : used) tally.false_ones += known ? 0 : 1;
}

PatchTally tally_frames(const CeilingScene& scene) {
  PatchFinderParams params;
  params.length_px = scene.truth.grid.length_m / 2.2 * scene.camera.px;
  params.width_px = scene.truth.grid.width_m / 2.2 * scene.camera.px;
  params.polarity = scene.truth.grid.polarity;
  const PatchFinder finder(params);
  RandomStream random(1, "poses");
  PatchTally tally;
  for (int k = 0; k < kFrames; ++k) {
    const Pose2 robot{random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-kPi, kPi)};
    compare(scene, robot, finder.find(*scene.expose(robot, k)), tally);
  }
  return tally;
}

TEST(PatchFinder, MeasuresEveryPatchToTheBoundThatItsCovarianceStates) {
  for (const bool polarity : {true, false}) {
    sim::CeilingTruth truth;
    truth.grid.polarity = polarity;
    const PatchTally tally = tally_frames(CeilingScene(truth, 0.0));
    ASSERT_GT(tally.measured, 200);
    EXPECT_EQ(tally.missed, 0);
    EXPECT_EQ(tally.false_ones, 0);
    EXPECT_EQ(polarity ? tally.reversed : 0, 0);
    // Four standard errors of a mean square of n normal numbers.
    const double slack = 4.0 * std::sqrt(2.0 / tally.measured);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(tally.square[i] / tally.variance[i], 1.0, slack) << polarity << i;
    // The bound of σ 4, contrast 135, blur 0.7 px.
    EXPECT_LT(std::sqrt(tally.variance[0] / tally.measured), 0.016);
    EXPECT_LT(std::sqrt(tally.variance[1] / tally.measured), 0.009);
    EXPECT_LT(std::sqrt(tally.variance[2] / tally.measured), 0.0016);
  }
}

/// A frame in a share of its light, with the sensor's noise.
vpImage<unsigned char> dimmed(const imaging::Frame& frame, double light, double noise,
                              std::uint64_t seed) {
  vpImage<unsigned char> image = imaging::grey_image(frame);
  RandomStream random(seed, "dim");
  for (unsigned i = 0; i < image.getSize(); ++i) {
    const double grey = light * image.bitmap[i] + noise * random.normal();
    image.bitmap[i] = static_cast<unsigned char>(std::clamp(std::lround(grey), 0L, 255L));
  }
  return image;
}

TEST(PatchFinder, FindsPatchesInLittleLight) {
  const CeilingScene scene({}, 1.0);
  PatchFinderParams params;
  params.length_px = scene.truth.grid.length_m / 2.2 * scene.camera.px;
  params.width_px = scene.truth.grid.width_m / 2.2 * scene.camera.px;
  const PatchFinder finder(params);
  for (const double light : {0.15, 0.4}) {
    RandomStream random(4, "poses");
    PatchTally tally;
    for (int k = 0; k < 20; ++k) {
      const Pose2 robot{random.uniform(-40, 40), random.uniform(-40, 40),
                        random.uniform(-kPi, kPi)};
      const auto image = dimmed(*scene.expose(robot, k), light, 2.0, static_cast<std::uint64_t>(k));
      compare(scene, robot, finder.find(imaging::ImageFrame(image)), tally);
    }
    ASSERT_GT(tally.whole, 60);
    EXPECT_EQ(tally.missed, 0) << light;
    EXPECT_EQ(tally.false_ones, 0) << light;
    EXPECT_EQ(tally.reversed, 0) << light;
    EXPECT_LT(tally.chi_square / (3.0 * tally.measured), 1.5) << light;
  }
}

/// Dark slots with round ends, of a patch's size, as in a perforated ceiling.
vpImage<unsigned char> slots(double turn, std::uint64_t seed) {
  constexpr int kFine = 4;
  cv::Mat fine(kFine * 480, kFine * 640, CV_32F, cv::Scalar(190.0));
  const Eigen::Vector2d along(std::cos(turn), std::sin(turn));
  for (int u = 40; u < 620; u += 50) {
    for (int v = 40; v < 460; v += 50) {
      const Eigen::Vector2d a = Eigen::Vector2d(u, v) - 7.5 * along;
      const Eigen::Vector2d b = Eigen::Vector2d(u, v) + 7.5 * along;
      const auto at = [&](const Eigen::Vector2d& p) {
        return cv::Point(static_cast<int>(std::lround(kFine * p.x())),
                         static_cast<int>(std::lround(kFine * p.y())));
      };
      cv::line(fine, at(a), at(b), cv::Scalar(60.0), kFine * 7);
    }
  }
  cv::Mat light;
  cv::resize(fine, light, {640, 480}, 0.0, 0.0, cv::INTER_AREA);
  cv::GaussianBlur(light, light, {}, 0.6);
  RandomStream random(seed, "slots");
  vpImage<unsigned char> image(480, 640);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u)
      image[static_cast<unsigned>(v)][static_cast<unsigned>(u)] = static_cast<unsigned char>(
          std::clamp(std::lround(light.at<float>(v, u) + 3.0 * random.normal()), 0L, 255L));
  return image;
}

TEST(PatchFinder, TakesNoSlotForAPatchWithAMark) {
  for (const double turn : {0.0, 0.4, 1.2}) {
    const auto image = slots(turn, 5);
    EXPECT_TRUE(PatchFinder().find(imaging::ImageFrame(image)).patches.empty()) << turn;
  }
}

TEST(PatchFinder, StatesCovariancesThatAreSome) {
  sim::CeilingTruth truth;
  const CeilingScene scene(truth, 2.0);
  RandomStream random(9, "poses");
  int seen = 0;
  for (int k = 0; k < 40; ++k) {
    const Pose2 robot{random.uniform(-40, 40), random.uniform(-40, 40), 0.0};
    for (const PatchImage& patch : PatchFinder().find(*scene.expose(robot, k)).patches) {
      ++seen;
      EXPECT_EQ(Eigen::LLT<Eigen::Matrix3d>(patch.covariance).info(), Eigen::Success);
    }
  }
  EXPECT_GT(seen, 100);
}

TEST(PatchFinder, SaysOfCutPatchesWhatTheyStillTell) {
  const PatchTally tally = tally_frames(CeilingScene({}, 0.0));
  ASSERT_GT(tally.cut, 10);
  EXPECT_LT(tally.cut_chi_square / (3 * tally.cut), 1.0 + 4.0 * std::sqrt(2.0 / (3 * tally.cut)));
}

TEST(PatchFinder, FindsPatchesBesideLampsAndJoints) {
  sim::CeilingTruth truth;
  truth.lamp_pitch_m = 3.0;
  const PatchTally tally = tally_frames(CeilingScene(truth, 1.0));
  EXPECT_LE(tally.missed, 2);
  EXPECT_EQ(tally.false_ones, 0);
  EXPECT_EQ(tally.reversed, 0);
  EXPECT_LT(tally.chi_square / (3 * tally.measured), 2.0);
}

/// How an independent picture looks.
struct PictureLook {
  double texture = 0.0;     ///< of the ceiling, grey levels; two pixels share it
  double gamma = 1.0;       ///< of the camera: the blur is in light, the noise in grey levels
  double gain_slope = 0.0;  ///< of the light, relative, across the picture
  double glare = 0.0;       ///< light that is added, grey levels: of a spot beside the patch
  double blur_px = 0.7;
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();  ///< while it was exposed, px
};

/// As if the camera had moved at one speed while it exposed.
void smear(cv::Mat& light, const Eigen::Vector2d& motion) {
  constexpr int kSteps = 200;
  constexpr int kReach = 12;
  cv::Mat kernel = cv::Mat::zeros(2 * kReach + 1, 2 * kReach + 1, CV_32F);
  for (int k = 0; k < kSteps; ++k) {
    const Eigen::Vector2d p =
        Eigen::Vector2d::Constant(kReach) + ((k + 0.5) / kSteps - 0.5) * motion;
    const int u = static_cast<int>(p.x());
    const int v = static_cast<int>(p.y());
    const auto du = static_cast<float>(p.x() - u);
    const auto dv = static_cast<float>(p.y() - v);
    kernel.at<float>(v, u) += (1.0F - du) * (1.0F - dv) / kSteps;
    kernel.at<float>(v, u + 1) += du * (1.0F - dv) / kSteps;
    kernel.at<float>(v + 1, u) += (1.0F - du) * dv / kSteps;
    kernel.at<float>(v + 1, u + 1) += du * dv / kSteps;
  }
  cv::filter2D(light, light, -1, kernel);
}

/// Not the renderer's: sixteen samples a pixel and side, mixed in light.
vpImage<unsigned char> drawn_picture(const Eigen::Vector2d& uv, double angle,
                                     const PatchFinderParams& params, const PictureLook& look,
                                     RandomStream& random) {
  constexpr int kSide = 72;
  constexpr int kSamples = 16;
  cv::Mat cover(kSide, kSide, CV_32F);
  cv::Mat ground(kSide, kSide, CV_32F);
  cv::Mat noise(kSide, kSide, CV_32F);
  const double length = params.length_px;
  const double width = params.width_px;
  for (int v = 0; v < kSide; ++v) {
    for (int u = 0; u < kSide; ++u) {
      int inside = 0;
      for (int k = 0; k < kSamples * kSamples; ++k) {
        const double du = u + (k % kSamples + 0.5) / kSamples - 0.5 - uv.x();
        const double dv = v + (k / kSamples + 0.5) / kSamples - 0.5 - uv.y();
        const double x = std::cos(angle) * du + std::sin(angle) * dv;
        const double y = std::abs(std::cos(angle) * dv - std::sin(angle) * du);
        const bool tongue = x > length / 3.0;
        if (std::abs(x) < 0.5 * length && y < (tongue ? width / 6.0 : 0.5 * width)) ++inside;
      }
      cover.at<float>(v, u) = static_cast<float>(inside) / (kSamples * kSamples);
      ground.at<float>(v, u) = static_cast<float>(random.normal());
      noise.at<float>(v, u) = static_cast<float>(4.0 * random.normal());
    }
  }
  cv::GaussianBlur(ground, ground, {}, 2.0);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(ground, mean, sigma);
  ground = (190.0 + ground * (look.texture / sigma[0])) / 255.0;
  cv::pow(ground, look.gamma, ground);
  cv::Mat picture = ground.mul(1.0 - cover) + std::pow(55.0 / 255.0, look.gamma) * cover;
  for (int v = 0; v < kSide; ++v) {
    for (int u = 0; u < kSide; ++u) {
      float& light = picture.at<float>(v, u);
      light *= static_cast<float>(1.0 + look.gain_slope * (u - 36) / kSide);
      light += static_cast<float>(look.glare / 255.0 *
                                  std::exp(-0.5 * ((u - 5.0) * (u - 5.0) + v * v) / 1600.0));
    }
  }
  cv::GaussianBlur(picture, picture, {}, look.blur_px);
  if (look.motion.norm() > 0.0) smear(picture, look.motion);
  cv::pow(picture, 1.0 / look.gamma, picture);
  picture = 255.0 * picture + noise;
  vpImage<unsigned char> image(kSide, kSide);
  for (int v = 0; v < kSide; ++v)
    for (int u = 0; u < kSide; ++u)
      image[v][u] = cv::saturate_cast<unsigned char>(picture.at<float>(v, u));
  return image;
}

/// Of whole patches in such pictures.
struct PictureTally {
  int found = 0;
  double chi_square = 0.0;  ///< a degree of freedom
  double square_px = 0.0;   ///< of the positions' errors
};
PictureTally tally_pictures(const PictureLook& look, int pictures) {
  PatchFinderParams params;
  params.length_px = 22.68;
  params.width_px = 7.56;
  PatchFinder finder(params);
  RandomStream random(7, "texture");
  PictureTally tally;
  for (int i = 0; i < pictures; ++i) {
    const Eigen::Vector2d uv(random.uniform(33.0, 39.0), random.uniform(33.0, 39.0));
    const double angle = random.uniform(-kPi, kPi);
    const auto image = drawn_picture(uv, angle, params, look, random);
    const PatchScan scan = finder.find(imaging::ImageFrame(image));
    if (scan.patches.size() != 1) continue;
    const PatchImage& patch = scan.patches.front();
    Eigen::Vector3d error;
    error << patch.uv - uv, wrap_angle(patch.angle - angle);
    tally.chi_square += error.dot(patch.covariance.ldlt().solve(error)) / 3.0;
    tally.square_px += error.head<2>().squaredNorm();
    ++tally.found;
  }
  tally.chi_square /= std::max(1, tally.found);
  tally.square_px /= std::max(1, tally.found);
  return tally;
}

TEST(PatchFinder, StatesItsErrorsWhateverTheCeilingsTexture) {
  constexpr int kPictures = 150;
  const PictureTally plain = tally_pictures({}, kPictures);
  EXPECT_EQ(plain.found, kPictures);
  EXPECT_NEAR(plain.chi_square, 1.0, 0.25);
  // Residuals taken for white, 4.4; with their correlation by one factor, 0.76 and 0.042 px.
  PictureLook look;
  look.texture = 5.0;
  const PictureTally textured = tally_pictures(look, kPictures);
  EXPECT_GE(textured.found, kPictures - 1);
  EXPECT_NEAR(textured.chi_square, 1.0, 0.3);
  EXPECT_LT(std::sqrt(textured.square_px), 0.037);
}

/// A hundred patches, next to all found, with the errors that they state and no more than
/// @p most_px rms.
void expect_honest(const PictureLook& look, double most_px) {
  constexpr int kPictures = 100;
  const PictureTally tally = tally_pictures(look, kPictures);
  EXPECT_GE(tally.found, kPictures - 2);
  EXPECT_NEAR(tally.chi_square, 1.0, 0.3);
  EXPECT_LT(std::sqrt(tally.square_px), most_px);
}

TEST(PatchFinder, FitsTheCamerasResponse) {
  PictureLook look;
  look.gamma = 2.2;
  look.blur_px = 1.5;
  expect_honest(look, 0.04);  // edges taken for symmetric, χ² 3.4 and 0.21 px
}

TEST(PatchFinder, FitsLightThatChangesAlongThePatch) {
  PictureLook gain;
  gain.gain_slope = 0.4;
  PictureLook glare;
  glare.glare = 100.0;  // saturates a part of the ceiling
  for (const PictureLook& look : {gain, glare}) {
    SCOPED_TRACE(look.glare);
    expect_honest(look, 0.03);
  }
}

TEST(PatchFinder, FitsTheMotionThatSmearsAPatch) {
  PictureLook look;
  look.motion = {5.0, 2.5};
  expect_honest(look, 0.03);  // edges taken for alike, χ² 2.2 and 0.056 px
}

/// Two pictures beside one another.
vpImage<unsigned char> side_by_side(const vpImage<unsigned char>& left,
                                    const vpImage<unsigned char>& right) {
  vpImage<unsigned char> both(left.getHeight(), left.getWidth() + right.getWidth());
  both.insert(left, {0.0, 0.0});
  both.insert(right, {0.0, static_cast<double>(left.getWidth())});
  return both;
}

TEST(PatchFinder, BelievesInAFarMotionWhereTwoPatchesAgreeOnIt) {
  constexpr int kPictures = 40;
  PatchFinderParams params;
  params.length_px = 22.68;
  params.width_px = 7.56;
  const PatchFinder finder(params);
  RandomStream random(13, "smeared");
  std::size_t agreed = 0;
  std::size_t alone = 0;
  std::size_t contradicted = 0;
  int reversed = 0;
  for (int i = 0; i < kPictures; ++i) {
    const double direction = random.uniform(-kPi, kPi);
    const auto draw = [&](double angle, double towards) {
      PictureLook look;
      look.motion = 12.0 * Eigen::Vector2d(std::cos(towards), std::sin(towards));
      const Eigen::Vector2d uv(random.uniform(33.0, 39.0), random.uniform(33.0, 39.0));
      return drawn_picture(uv, angle, params, look, random);
    };
    // Across their motion: there is nothing at full contrast.
    const double angle = direction + 0.5 * kPi + random.uniform(-0.5, 0.5);
    const auto one = draw(angle, direction);
    const auto like_it = draw(angle, direction);
    const auto unlike_it = draw(angle + 0.5 * kPi, direction + 0.5 * kPi);
    const PatchScan scan = finder.find(imaging::ImageFrame(side_by_side(one, like_it)));
    agreed += scan.patches.size();
    for (const PatchImage& patch : scan.patches)
      reversed += std::abs(wrap_angle(patch.angle - angle)) > 0.5 ? 1 : 0;
    alone += finder.find(imaging::ImageFrame(one)).patches.size();
    contradicted += finder.find(imaging::ImageFrame(side_by_side(one, unlike_it))).patches.size();
  }
  EXPECT_GE(agreed, 2U * kPictures - 4U);
  EXPECT_EQ(reversed, 0);
  EXPECT_LE(alone, 2U);
  EXPECT_LE(contradicted, 4U);
}

/// A ceiling with nothing on it but dark and bright spots as large as a patch is wide.
vpImage<unsigned char> spotted_ceiling(double texture, double neighbours_px, RandomStream& random) {
  constexpr int kHeight = 480;
  constexpr int kWidth = 640;
  cv::Mat ground(kHeight, kWidth, CV_32F);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) ground.at<float>(v, u) = static_cast<float>(random.normal());
  cv::GaussianBlur(ground, ground, {}, neighbours_px);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(ground, mean, sigma);
  ground = 190.0 + ground * (texture / sigma[0]);
  cv::GaussianBlur(ground, ground, {}, 0.7);
  vpImage<unsigned char> image(kHeight, kWidth);
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u)
      image[v][u] =
          cv::saturate_cast<unsigned char>(ground.at<float>(v, u) + 4.0 * random.normal());
  return image;
}

TEST(PatchFinder, TakesNoDarkSpotOfATexturedCeilingForAPatch) {
  constexpr int kPictures = 6;
  for (const bool polarity : {true, false}) {
    PatchFinderParams params;
    params.polarity = polarity;
    const PatchFinder finder(params);
    RandomStream random(9, "spots");
    std::size_t found = 0;
    int looked_at = 0;
    for (int i = 0; i < kPictures; ++i) {
      const auto image = spotted_ceiling(20.0, 3.0, random);
      const PatchScan scan = finder.find(imaging::ImageFrame(image));
      found += scan.patches.size();
      looked_at += scan.rejected;
    }
    EXPECT_EQ(found, 0U);  // before, 41 and 20
    EXPECT_GT(looked_at, 100);
  }
}

TEST(PatchFinder, FindsPatchesInDarkNoisyPictures) {
  PatchFinderParams params;
  params.length_px = 22.68;
  params.width_px = 7.56;
  const PatchFinder finder(params);
  RandomStream random(11, "dark");
  int found = 0;
  constexpr int kPictures = 40;
  for (int i = 0; i < kPictures; ++i) {
    const Eigen::Vector2d uv(random.uniform(33.0, 39.0), random.uniform(33.0, 39.0));
    auto image = drawn_picture(uv, random.uniform(-kPi, kPi), params, {}, random);
    // Two fifths of the light, and twice the noise.
    for (unsigned int v = 0; v < image.getHeight(); ++v)
      for (unsigned int u = 0; u < image.getWidth(); ++u)
        image[v][u] = cv::saturate_cast<unsigned char>(0.4 * image[v][u] + 8.0 * random.normal());
    const PatchScan scan = finder.find(imaging::ImageFrame(image));
    found += scan.patches.size() == 1 ? 1 : 0;
  }
  EXPECT_EQ(found, kPictures);
}

}  // namespace
}  // namespace vigia::tracking

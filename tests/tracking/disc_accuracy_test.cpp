#include "disc_scene.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/tracking/disc_tracker.hpp"

namespace vigia::tracking::testing {
namespace {

constexpr double kSigmas = 3.5;  // standard errors that a statistic may be off

struct Statistics {
  int count = 0;
  double centre_square = 0.0;  ///< per axis, summed over both
  double a_error = 0.0;
  double a_square = 0.0;
  double b_error = 0.0;
  double b_square = 0.0;
  double nees = 0.0;  ///< of (u, v, log a), summed

  double centre_rms() const { return std::sqrt(centre_square / (2.0 * count)); }
};

Statistics measure(const DiscScene& scene, double a, double b, int images, std::uint64_t seed) {
  RandomStream random(seed, "accuracy");
  Statistics out;
  for (int k = 0; k < images; ++k) {
    const Ellipse disc{49.0 + random.uniform(0.0, 1.0), 49.0 + random.uniform(0.0, 1.0), a, b,
                       random.uniform(-1.5, 1.5)};
    const imaging::ImageFrame frame = scene.expose(disc, random);
    imaging::Canvas canvas = canvas_of(frame);
    DiscTracker tracker;
    const EllipseFeature feature = tracker.acquire(canvas, prediction_near(disc, 2.0, random));
    if (feature.status != FeatureStatus::found) continue;
    ++out.count;
    const Ellipse& e = feature.ellipse;
    Eigen::Vector3d error(e.u - disc.u, e.v - disc.v, std::log(e.a / disc.a));
    out.centre_square += error.head<2>().squaredNorm();
    out.a_error += e.a - a;
    out.a_square += (e.a - a) * (e.a - a);
    out.b_error += e.b - b;
    out.b_square += (e.b - b) * (e.b - b);
    Eigen::Matrix3d covariance = feature.covariance.topLeftCorner<3, 3>();
    covariance.row(2) /= e.a;
    covariance.col(2) /= e.a;
    out.nees += error.dot(covariance.inverse() * error);
  }
  return out;
}

TEST(DiscAccuracy, TheCentreOfADiscReachesTheCramerRaoBound) {
  const DiscScene scene;
  constexpr int kImages = 500;
  const Statistics statistics = measure(scene, 15.0, 15.0, kImages, 1);
  ASSERT_EQ(statistics.count, kImages);
  const double relative_error = 1.0 / std::sqrt(2.0 * 2.0 * kImages);
  const double bound = centre_bound(15.0, scene.contrast, scene.noise, scene.blur);
  EXPECT_LT(statistics.centre_rms(), bound * (1.02 + kSigmas * relative_error));
  EXPECT_GT(statistics.centre_rms(), bound * (1.0 - kSigmas * relative_error));
}

TEST(DiscAccuracy, TheCovarianceTellsTheTrueErrorForRoundAndForSlantingDiscs) {
  for (const double b : {15.0, 12.0, 7.5}) {
    constexpr int kImages = 300;
    const Statistics statistics = measure(DiscScene{}, 15.0, b, kImages, 2);
    ASSERT_EQ(statistics.count, kImages) << b;
    const double nees = statistics.nees / (3.0 * kImages);
    // A circle's semi-axes are the ends of a noisy vector; 0.05 more is what is left of that.
    const double standard_error = std::sqrt(2.0 / (3.0 * kImages));
    EXPECT_NEAR(nees, 1.0, 0.05 + kSigmas * standard_error) << b;
  }
}

TEST(DiscAccuracy, TheSemiAxesAreUnbiasedToAHundredthOfAPixel) {
  for (const double b : {13.0, 7.5}) {
    constexpr int kImages = 300;
    const Statistics statistics = measure(DiscScene{}, 15.0, b, kImages, 3);
    ASSERT_EQ(statistics.count, kImages);
    const double n = statistics.count;
    const auto limit = [n](double square) { return 0.01 + kSigmas * std::sqrt(square / n / n); };
    EXPECT_LT(std::abs(statistics.a_error / n), limit(statistics.a_square)) << b;
    EXPECT_LT(std::abs(statistics.b_error / n), limit(statistics.b_square)) << b;
  }
}

TEST(DiscAccuracy, SmallAndLargeDiscsKeepAnHonestCovariance) {
  for (const double a : {5.0, 40.0}) {
    DiscScene scene;
    constexpr int kImages = 200;
    const Statistics statistics = measure(scene, a, 0.9 * a, kImages, 4);
    ASSERT_EQ(statistics.count, kImages) << a;
    EXPECT_NEAR(statistics.nees / (3.0 * kImages), 1.0,
                0.05 + kSigmas * std::sqrt(2.0 / (3.0 * kImages)))
        << a;
  }
}

TEST(DiscAccuracy, ABlurredDiscIsMeasuredAsWellAsItsBlurAllows) {
  DiscScene scene;
  scene.blur = 1.6;
  constexpr int kImages = 300;
  const Statistics statistics = measure(scene, 15.0, 15.0, kImages, 5);
  ASSERT_EQ(statistics.count, kImages);
  const double relative_error = 1.0 / std::sqrt(2.0 * 2.0 * kImages);
  EXPECT_LT(statistics.centre_rms(), centre_bound(15.0, scene.contrast, scene.noise, scene.blur) *
                                         (1.03 + kSigmas * relative_error));
}

}  // namespace
}  // namespace vigia::tracking::testing

#include "disc_scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/tracking/picture_run.hpp"

namespace vigia::tracking::testing {
namespace {

/// What a room adds to the nominal scene: r 15 px, contrast 150, noise 4, blur 0.7 px.
struct HardLight {
  std::string name;
  double slope = 0.0;  ///< of the light, in grey levels of the ground per 100 px
  double exposure = 1.0;
};

struct HardLightResult {
  int found = 0;
  double nees = 0.0;        ///< of the centre, per degree of freedom
  double size_error = 0.0;  ///< mean of log size
};

HardLightResult measure_hard(const HardLight& light, const std::string& tracker, int pictures) {
  constexpr double kGround = 200.0;
  RandomStream random(71, "hard light");
  PictureRunParams params;
  params.tracker = tracker;
  HardLightResult out;
  for (int k = 0; k < pictures; ++k) {
    const Ellipse disc{49.0 + random.uniform(0.0, 1.0), 49.0 + random.uniform(0.0, 1.0), 15.0,
                       15.0 * random.uniform(0.85, 1.0), random.uniform(-1.5, 1.5)};
    SyntheticImage image(100, 100, kGround);
    image.paint_ellipse(disc, 50.0);
    image.slope_light(light.slope / kGround / 100.0, random.uniform(-kPi, kPi));
    image.expose_longer(light.exposure);
    const imaging::ImageFrame frame(image.expose(4.0, random));
    imaging::Canvas canvas = canvas_of(frame);
    for (const EllipseFeature& feature : make_picture_tracker(params)->find_all(canvas)) {
      const Ellipse& e = feature.ellipse;
      const Eigen::Vector2d error(e.u - disc.u, e.v - disc.v);
      if (error.norm() > 3.0) continue;
      ++out.found;
      out.nees += 0.5 * error.dot(feature.covariance.topLeftCorner<2, 2>().ldlt().solve(error));
      out.size_error += 0.5 * std::log(e.a * e.b / (disc.a * disc.b));
    }
  }
  out.nees /= std::max(1, out.found);
  out.size_error /= std::max(1, out.found);
  return out;
}

class HardLights : public ::testing::TestWithParam<HardLight> {};

TEST_P(HardLights, CentresAreOffAsTheirCovarianceSays) {
  constexpr int kPictures = 150;
  for (const char* tracker : {"disc", "correlation"}) {
    const HardLightResult result = measure_hard(GetParam(), tracker, kPictures);
    EXPECT_GE(result.found, kPictures * 90 / 100) << tracker;
    EXPECT_LE(result.found, kPictures) << tracker;
    // Upwards by 3.5 standard errors of χ²₂/2 over 150 pictures; a covariance may be wide.
    EXPECT_LT(result.nees, 1.5 + 3.5 * std::sqrt(1.0 / kPictures)) << tracker;
    EXPECT_GT(result.nees, 0.5) << tracker;
    EXPECT_LT(std::abs(result.size_error), 0.002) << tracker;
  }
}

INSTANTIATE_TEST_SUITE_P(All, HardLights,
                         ::testing::Values(HardLight{"plain"}, HardLight{"slope_10", 10.0},
                                           HardLight{"slope_24", 24.0}, HardLight{"slope_40", 40.0},
                                           HardLight{"clipped_ground", 0.0, 1.4}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace vigia::tracking::testing

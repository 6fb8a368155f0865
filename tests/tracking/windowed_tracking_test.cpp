#include "disc_scene.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace vigia::tracking::testing {
namespace {

// A disc that wanders through clutter, is hidden for a while and drifts over the border.
std::vector<imaging::ImageFrame> sequence() {
  RandomStream random(41, "sequence");
  SyntheticImage room(320, 240, 190.0);
  room.add_texture(3.0, 41);
  room.paint_clutter(15, {{160.0, 120.0, 45.0, 45.0, 0.0}}, random);
  std::vector<imaging::ImageFrame> frames;
  for (int k = 0; k < 40; ++k) {
    SyntheticImage image = room;
    const double u = k < 28 ? 150.0 + 1.5 * k : 192.0 + 11.0 * (k - 28);
    const double v = 118.0 + 6.0 * std::sin(0.4 * k);
    image.paint_ellipse({u, v, 16.0 + 0.1 * k, 13.0, 0.1 * k}, 70.0);
    if (k >= 12 && k < 15) image.paint_rectangle(u - 15.0, v, 20.0, 60.0, 0.1, 120.0);
    frames.emplace_back(image.expose(4.0, random));
  }
  return frames;
}

std::vector<EllipseFeature> run(const char* name, const std::vector<imaging::ImageFrame>& frames,
                                bool everything) {
  const auto tracker = make_ellipse_tracker(name);
  imaging::Canvas canvas;
  std::vector<EllipseFeature> features;
  EllipsePrediction prediction;
  prediction.ellipse = {152.0, 116.0, 16.3, 13.0, 0.05};
  prediction.centre_covariance = Eigen::Matrix2d::Identity() * 9.0;
  for (const imaging::ImageFrame& frame : frames) {
    canvas.attach(frame);
    if (everything) canvas.require(frame.full());
    features.push_back(features.empty() ? tracker->acquire(canvas, prediction)
                                        : tracker->track(canvas));
    tracker->expect_motion({features.size() > 28 ? 11.0 : 1.5, 0.0});
  }
  return features;
}

class WindowedTracking : public ::testing::TestWithParam<const char*> {};

TEST_P(WindowedTracking, EqualsFullFrameTrackingBitForBit) {
  const std::vector<imaging::ImageFrame> frames = sequence();
  const auto windowed = run(GetParam(), frames, false);
  const auto full = run(GetParam(), frames, true);
  ASSERT_EQ(windowed.size(), full.size());
  int found = 0;
  for (std::size_t k = 0; k < full.size(); ++k) {
    const EllipseFeature& a = windowed[k];
    const EllipseFeature& b = full[k];
    EXPECT_EQ(a.status, b.status) << "frame " << k;
    found += a.status == FeatureStatus::found ? 1 : 0;
    if (a.status != FeatureStatus::found) continue;
    EXPECT_EQ(a.ellipse.u, b.ellipse.u) << "frame " << k;
    EXPECT_EQ(a.ellipse.v, b.ellipse.v) << "frame " << k;
    EXPECT_EQ(a.ellipse.a, b.ellipse.a) << "frame " << k;
    EXPECT_EQ(a.ellipse.b, b.ellipse.b) << "frame " << k;
    EXPECT_EQ(a.ellipse.psi, b.ellipse.psi) << "frame " << k;
    EXPECT_TRUE((a.covariance.array() == b.covariance.array()).all()) << "frame " << k;
    EXPECT_EQ(a.score, b.score) << "frame " << k;
    EXPECT_EQ(a.contrast, b.contrast) << "frame " << k;
  }
  EXPECT_GE(found, 25);
  EXPECT_LT(found, static_cast<int>(full.size()));
}

INSTANTIATE_TEST_SUITE_P(All, WindowedTracking, ::testing::Values("disc", "ellipse", "correlation"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace vigia::tracking::testing

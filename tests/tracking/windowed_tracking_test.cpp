#include "disc_scene.hpp"

#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace vigia::tracking::testing {
namespace {

constexpr double kSmall = 1.0;
constexpr double kLarge = 2.2;  // beyond which a disc's inside is not read

// A disc that wanders through clutter, is hidden for a while and drifts over the border.
std::vector<imaging::ImageFrame> sequence(double size) {
  RandomStream random(41, "sequence");
  SyntheticImage room(320, 240, 190.0);
  room.add_texture(3.0, 41);
  room.paint_clutter(15, {{160.0, 120.0, 45.0, 45.0, 0.0}}, random);
  std::vector<imaging::ImageFrame> frames;
  for (int k = 0; k < 40; ++k) {
    SyntheticImage image = room;
    const double u = k < 28 ? 150.0 + 1.5 * k : 192.0 + 11.0 * (k - 28);
    const double v = 118.0 + 6.0 * std::sin(0.4 * k);
    image.paint_ellipse({u, v, size * (16.0 + 0.1 * k), size * 13.0, 0.1 * k}, 70.0);
    if (k >= 12 && k < 15)
      image.paint_rectangle(u - size * 15.0, v, size * 20.0, size * 60.0, 0.1, 120.0);
    frames.emplace_back(image.expose(4.0, random));
  }
  return frames;
}

/// A picture that counts the pixels that are asked of it.
class CountingFrame : public imaging::Frame {
 public:
  CountingFrame(const imaging::Frame& frame, std::ptrdiff_t& pixels)
      : frame_(frame), pixels_(pixels) {}

  int width() const override { return frame_.width(); }
  int height() const override { return frame_.height(); }
  void read_grey(const imaging::Window& window, unsigned char* out,
                 std::ptrdiff_t stride) const override {
    pixels_ += static_cast<std::ptrdiff_t>(window.width) * window.height;
    frame_.read_grey(window, out, stride);
  }
  void read_colour(const imaging::Window& window, vpRGBa* out,
                   std::ptrdiff_t stride) const override {
    frame_.read_colour(window, out, stride);
  }

 private:
  const imaging::Frame& frame_;
  std::ptrdiff_t& pixels_;
};

std::vector<EllipseFeature> run(const char* name, const std::vector<imaging::ImageFrame>& frames,
                                double size, bool everything) {
  const auto tracker = make_ellipse_tracker(name);
  imaging::Canvas canvas;
  std::vector<EllipseFeature> features;
  EllipsePrediction prediction;
  prediction.ellipse = {152.0, 116.0, size * 16.3, size * 13.0, 0.05};
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

class WindowedTracking : public ::testing::TestWithParam<std::tuple<const char*, double>> {};

TEST_P(WindowedTracking, EqualsFullFrameTrackingBitForBit) {
  const auto [name, size] = GetParam();
  const std::vector<imaging::ImageFrame> frames = sequence(size);
  const auto windowed = run(name, frames, size, false);
  const auto full = run(name, frames, size, true);
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
  EXPECT_GE(found, size == kSmall ? 25 : 20);
  EXPECT_LT(found, static_cast<int>(full.size()));
}

INSTANTIATE_TEST_SUITE_P(All, WindowedTracking,
                         ::testing::Combine(::testing::Values("disc", "ellipse", "correlation"),
                                            ::testing::Values(kSmall, kLarge)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param)) +
                                  (std::get<1>(test.param) == kSmall ? "Small" : "Large");
                         });

TEST(DiscTracker, ReadsOfALargeDiscThatMovesAsExpectedItsOutlineAlone) {
  RandomStream random(43, "sequence");
  SyntheticImage room(320, 240, 190.0);
  const auto tracker = make_ellipse_tracker("disc");
  EllipsePrediction prediction;
  prediction.ellipse = {150.0, 118.0, 60.0, 50.0, 0.3};
  prediction.centre_covariance = Eigen::Matrix2d::Identity();
  imaging::Canvas canvas;
  for (int k = 0; k < 3; ++k) {
    SyntheticImage image = room;
    image.paint_ellipse({150.0 + k, 118.0, 60.0, 50.0, 0.3}, 70.0);
    const imaging::ImageFrame picture(image.expose(4.0, random));
    std::ptrdiff_t pixels = 0;
    const CountingFrame frame(picture, pixels);
    canvas.attach(frame);
    const auto feature = k == 0 ? tracker->acquire(canvas, prediction) : tracker->track(canvas);
    ASSERT_EQ(feature.status, FeatureStatus::found);
    EXPECT_NEAR(feature.ellipse.u, 150.0 + k, 0.05);
    // A band of 11 px along 350 px of outline; the disc's rectangle has 13,000.
    if (k > 0) {
      EXPECT_LT(pixels, 4500);
    }
    tracker->expect_motion({1.0, 0.0});
  }
}

}  // namespace
}  // namespace vigia::tracking::testing

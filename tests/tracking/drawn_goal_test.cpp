#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "vigia/core/random.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/tracking/goal_corner_finder.hpp"

namespace vigia::tracking {
namespace {

/// A goal between white walls, drawn by OpenCV at eight times the size and scaled down: @p edges
/// are the columns where it begins and ends, multiples of 1/8 px at its middle row.
struct DrawnGoal {
  double left = 90.25;
  double right = 210.625;
  double lean = 0.0;                ///< px a row
  cv::Scalar colour{34, 182, 222};  ///< B G R
  double blur_px = 0.7;
  double noise = 4.0;
  double gamma = 1.0;
  double light = 1.0;

  static constexpr int kFine = 8;
  static constexpr int kTop = 122;
  static constexpr int kBottom = 142;

  imaging::ImageFrame frame(std::uint64_t seed) const {
    cv::Mat fine(240 * kFine, 320 * kFine, CV_8UC3, cv::Scalar(96, 104, 110));
    const auto quad = [&](double l, double r, int top, int bottom, const cv::Scalar& ink) {
      const double middle = 0.5 * (kTop + kBottom);
      std::vector<cv::Point> corners;
      for (const auto& [u, v] : {std::pair(l, top), {r, top}, {r, bottom}, {l, bottom}})
        corners.emplace_back(cvRound((u + lean * (v - middle) + 0.5) * kFine),
                             cvRound((v + 0.5) * kFine));
      // Filled polygons hold their right and lower rims.
      corners[1].x -= 1;
      corners[2].x -= 1;
      corners[2].y -= 1;
      corners[3].y -= 1;
      cv::fillConvexPoly(fine, corners, ink);
    };
    quad(-0.5, 319.5, kTop, kBottom, cv::Scalar(215, 218, 216));
    quad(left, right, kTop, kBottom, colour);
    quad(-0.5, 319.5, kBottom, 239, cv::Scalar(30, 52, 26));
    cv::Mat small;
    cv::resize(fine, small, {320, 240}, 0.0, 0.0, cv::INTER_AREA);
    cv::Mat3f light_map;
    small.convertTo(light_map, CV_32FC3, light / 255.0);
    cv::GaussianBlur(light_map, light_map, {}, blur_px);
    cv::pow(light_map, 1.0 / gamma, light_map);
    light_map *= 255.0;
    cv::RNG random(seed);
    cv::Mat3f grain(light_map.size());
    random.fill(grain, cv::RNG::NORMAL, 0.0, noise);
    light_map += grain;
    cv::Mat3b bytes;
    light_map.convertTo(bytes, CV_8UC3);
    vpImage<vpRGBa> picture(240, 320);
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u)
        picture[static_cast<unsigned>(v)][static_cast<unsigned>(u)] =
            vpRGBa(bytes(v, u)[2], bytes(v, u)[1], bytes(v, u)[0]);
    return imaging::ImageFrame(picture);
  }
};

/// Columns of both edges in @p count noisy pictures of goals at changing places.
struct DrawnTally {
  int edges = 0;
  int found = 0;
  int others = 0;
  double bias = 0.0;
  double square = 0.0;
  double chi_square = 0.0;

  double mean() const { return bias / found; }
  double rms() const { return std::sqrt(square / found); }
  double nees() const { return chi_square / found; }
};

DrawnTally tally_drawn(DrawnGoal goal, int count) {
  DrawnTally tally;
  RandomStream random(21, "places");
  const GoalCornerFinder finder;
  for (int i = 0; i < count; ++i) {
    goal.left = 60.0 + static_cast<double>(random.index(400)) / 8.0;
    goal.right = goal.left + 60.0 + static_cast<double>(random.index(400)) / 8.0;
    const GoalCornerScan scan = finder.find(goal.frame(static_cast<std::uint64_t>(i + 1)));
    tally.edges += 2;
    for (const GoalCornerImage& corner : scan.corners) {
      const double middle = 0.5 * (DrawnGoal::kTop + DrawnGoal::kBottom) - 0.5;
      const double truth =
          (corner.colour_on_right ? goal.left : goal.right) + goal.lean * (corner.v - middle);
      const double error = corner.u - truth;
      if (std::abs(error) > 2.0) {
        ++tally.others;
        continue;
      }
      ++tally.found;
      tally.bias += (corner.colour_on_right ? 1.0 : -1.0) * error;
      tally.square += error * error;
      tally.chi_square += std::pow(error / corner.sigma_px, 2);
    }
  }
  return tally;
}

TEST(DrawnGoal, HasItsEdgesToTwoHundredthsOfAPixelWhateverTheBlur) {
  for (const bool yellow : {true, false}) {
    for (const double blur : {0.4, 0.7, 1.2}) {
      DrawnGoal goal;
      goal.blur_px = blur;
      if (!yellow) goal.colour = cv::Scalar(190, 66, 24);
      const DrawnTally tally = tally_drawn(goal, 40);
      EXPECT_EQ(tally.found, tally.edges) << blur;
      EXPECT_EQ(tally.others, 0) << blur;
      EXPECT_LT(tally.rms(), 0.025) << blur;
      // 80 edges of one degree of freedom each: σ of the mean 0.16.
      EXPECT_LT(tally.nees(), 1.0 + 4.0 * 0.16) << blur;
    }
  }
}

TEST(DrawnGoal, MayLeanBeDarkAndNoisy) {
  DrawnGoal leaning;
  leaning.lean = 0.03;
  DrawnGoal dark;
  dark.light = 0.5;
  DrawnGoal noisy;
  noisy.noise = 12.0;
  for (const DrawnGoal& goal : {leaning, dark, noisy}) {
    const DrawnTally tally = tally_drawn(goal, 40);
    EXPECT_EQ(tally.found, tally.edges);
    EXPECT_EQ(tally.others, 0);
    EXPECT_LT(tally.rms(), 0.05);
    EXPECT_LT(tally.nees(), 1.35 + 4.0 * 0.21);
  }
}

/// A response that is not linear moves an edge towards its darker side: in both images of a pair
/// alike, but by more than the fit can know.
TEST(DrawnGoal, HasItsEdgesMovedByTheResponseToLight) {
  DrawnGoal goal;
  goal.gamma = 2.2;
  const DrawnTally gamma = tally_drawn(goal, 40);
  EXPECT_EQ(gamma.found, gamma.edges);
  EXPECT_GT(gamma.mean(), 0.1);
  EXPECT_LT(gamma.mean(), 0.3);
  EXPECT_LT(gamma.rms() - gamma.mean(), 0.02);
}

}  // namespace
}  // namespace vigia::tracking

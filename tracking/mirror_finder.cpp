#include "vigia/tracking/mirror_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <opencv2/imgproc.hpp>

namespace vigia::tracking {
namespace {

constexpr int kOutlineAngles = 180;

struct Circle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0.0;
  double support = 0.0;  ///< share of the outline that has its step there
};

Eigen::Vector2d outline_direction(int k) {
  const double angle = 2.0 * kPi * k / kOutlineAngles;
  return {std::cos(angle), std::sin(angle)};
}

double grey_at(const cv::Mat1b& grey, const Eigen::Vector2d& uv) {
  const int u = static_cast<int>(std::lround(uv.x()));
  const int v = static_cast<int>(std::lround(uv.y()));
  if (u < 0 || v < 0 || u >= grey.cols || v >= grey.rows) return -1.0;
  return grey(v, u);
}

/// The strongest step of brightness on each direction from the middle, near the circle.
std::vector<Eigen::Vector2d> outline_points(const cv::Mat1b& grey, const Circle& circle,
                                            double reach) {
  constexpr double kLeastStep = 12.0;  // levels over two pixels
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < kOutlineAngles; ++k) {
    const Eigen::Vector2d direction = outline_direction(k);
    double strongest = kLeastStep;
    double at = 0.0;
    for (double r = circle.radius - reach; r <= circle.radius + reach; r += 0.5) {
      const double inner = grey_at(grey, circle.centre + (r - 1.0) * direction);
      const double outer = grey_at(grey, circle.centre + (r + 1.0) * direction);
      if (inner < 0.0 || outer < 0.0 || std::abs(outer - inner) <= strongest) continue;
      strongest = std::abs(outer - inner);
      at = r;
    }
    if (at > 0.0) points.emplace_back(circle.centre + at * direction);
  }
  return points;
}

/// The circle through points by least squares of x² + y² = 2 a x + 2 b y + c.
Circle circle_through(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector3d row(2.0 * p.x(), 2.0 * p.y(), 1.0);
    normal += row * row.transpose();
    right += p.squaredNorm() * row;
  }
  const Eigen::Vector3d x = normal.ldlt().solve(right);
  return {x.head<2>(), std::sqrt(std::max(0.0, x.z() + x.head<2>().squaredNorm()))};
}

/// Fits the circle to its outline again and again, without the points that lie off it.
Circle refined(const cv::Mat1b& grey, Circle circle) {
  constexpr double kOff = 0.015;  // of the radius
  for (const double reach : {0.10, 0.06, 0.03}) {
    const std::vector<Eigen::Vector2d> points =
        outline_points(grey, circle, std::max(3.0, reach * circle.radius));
    std::vector<Eigen::Vector2d> near = points;
    for (int trim = 0; trim < 4 && near.size() >= 12; ++trim) {
      const Circle fitted = circle_through(near);
      circle.centre = fitted.centre;
      circle.radius = fitted.radius;
      const double off = std::max(1.0, (trim < 2 ? 3.0 : 1.0) * kOff * circle.radius);
      near.clear();
      for (const Eigen::Vector2d& p : points)
        if (std::abs((p - circle.centre).norm() - circle.radius) <= off) near.push_back(p);
    }
    circle.support = static_cast<double>(near.size()) / kOutlineAngles;
  }
  return circle;
}

/// Shares of carpet on circles of the picture about a middle, one a pixel of radius: of green of
/// some brightness.
std::vector<double> carpet_shares(const vpImage<vpRGBa>& colour, const FieldPalette& palette,
                                  const MirrorImage& mirror, double min_value) {
  std::vector<double> shares;
  for (int r = 0; r <= static_cast<int>(mirror.outer_px); ++r) {
    int carpet = 0;
    for (int k = 0; k < kOutlineAngles; ++k) {
      const Eigen::Vector2d uv = mirror.centre + r * outline_direction(k);
      const int u = static_cast<int>(std::lround(uv.x()));
      const int v = static_cast<int>(std::lround(uv.y()));
      if (u < 0 || v < 0 || u >= static_cast<int>(colour.getWidth()) ||
          v >= static_cast<int>(colour.getHeight()))
        continue;
      const vpRGBa& pixel = colour[static_cast<unsigned>(v)][u];
      carpet += palette(pixel) == FieldClass::green && pixel.G >= min_value ? 1 : 0;
    }
    shares.push_back(static_cast<double>(carpet) / kOutlineAngles);
  }
  return shares;
}

/// Of the shares within a few places of each the one that comes first by @p before.
template <typename Before>
std::vector<double> extremes(const std::vector<double>& shares, Before before) {
  constexpr std::ptrdiff_t kThin = 4;  // px to either side
  std::vector<double> out;
  const auto count = static_cast<std::ptrdiff_t>(shares.size());
  for (std::ptrdiff_t r = 0; r < count; ++r)
    out.push_back(*std::min_element(shares.begin() + std::max<std::ptrdiff_t>(0, r - kThin),
                                    shares.begin() + std::min(count, r + kThin + 1), before));
  return out;
}

/// The shares without gaps of a few pixels of radius: a circle that is painted about the robot is
/// thin.
std::vector<double> without_thin_circles(const std::vector<double>& shares) {
  return extremes(extremes(shares, std::greater<>()), std::less<>());
}

cv::Mat1b small_grey(const imaging::Frame& frame, double scale) {
  vpImage<unsigned char> image = imaging::grey_image(frame);
  const cv::Mat1b whole(frame.height(), frame.width(), image.bitmap);
  cv::Mat1b small;
  cv::resize(whole, small, {}, scale, scale, scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::GaussianBlur(small, small, {}, 1.0);
  return small;
}

std::vector<Circle> candidate_circles(const cv::Mat1b& grey) {
  constexpr double kSmallest = 0.2;  // of the picture's shorter side
  constexpr double kLargest = 0.6;
  constexpr std::size_t kMost = 6;
  const int side = std::min(grey.rows, grey.cols);
  std::vector<cv::Vec3f> found;
  cv::HoughCircles(grey, found, cv::HOUGH_GRADIENT, 2.0, side / 40.0, 90.0, 30.0,
                   static_cast<int>(kSmallest * side), static_cast<int>(kLargest * side));
  std::vector<Circle> circles;
  for (std::size_t i = 0; i < std::min(found.size(), kMost); ++i)
    circles.push_back({Eigen::Vector2d(found[i][0], found[i][1]), found[i][2]});
  return circles;
}

}  // namespace

std::optional<MirrorImage> find_mirror(const imaging::Frame& frame, const FieldPalette& palette) {
  constexpr double kWorkingSide = 360.0;  // px
  constexpr double kLeastSupport = 0.5;
  constexpr double kLeastGreen = 0.5;  // of the greenest circle
  const double scale = std::min(1.0, kWorkingSide / std::min(frame.width(), frame.height()));
  const cv::Mat1b grey = small_grey(frame, scale);
  const vpImage<vpRGBa> colour = imaging::colour_image(frame);
  std::optional<MirrorImage> best;
  double best_score = 0.0;
  for (const Circle& candidate : candidate_circles(grey)) {
    const Circle circle = refined(grey, candidate);
    // Of circles about one middle the outer one is the mirror's rim.
    const double score = circle.support * circle.radius;
    if (circle.support < kLeastSupport || score <= best_score) continue;
    MirrorImage mirror;
    mirror.centre = (circle.centre + Eigen::Vector2d(0.5, 0.5)) / scale - Eigen::Vector2d(0.5, 0.5);
    mirror.outer_px = circle.radius / scale;
    const std::vector<double> shares = carpet_shares(colour, palette, mirror, 0.0);
    if (*std::max_element(shares.begin(), shares.end()) < kLeastGreen) continue;
    best_score = score;
    best = mirror;
  }
  return best;
}

double robot_radius(const imaging::Frame& frame, const MirrorImage& mirror,
                    const FieldPalette& palette) {
  constexpr double kLeastShare = 0.7;         // of the greenest circle's carpet
  constexpr double kLeastLight = 0.6;         // of the carpet's
  constexpr std::ptrdiff_t kCameraShare = 6;  // of the mirror's radius
  const std::vector<double> shares =
      without_thin_circles(carpet_shares(imaging::colour_image(frame), palette, mirror,
                                         kLeastLight * palette.colours().green_mean.maxCoeff()));
  // In the very middle the mirror shows the camera, whose glass may be green.
  const auto from = shares.begin() + static_cast<std::ptrdiff_t>(shares.size()) / kCameraShare;
  const auto greenest = std::max_element(from, shares.end());
  auto r = greenest - shares.begin();
  while (r > 0 && shares[static_cast<std::size_t>(r)] >= kLeastShare * *greenest) --r;
  return static_cast<double>(r);
}

}  // namespace vigia::tracking

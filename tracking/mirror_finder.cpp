#include "vigia/tracking/mirror_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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

/// Shares of green on circles of the frame about a middle, one a pixel of radius.
std::vector<double> green_shares(const vpImage<vpRGBa>& colour, const FieldPalette& palette,
                                 const Eigen::Vector2d& centre, double radius) {
  std::vector<double> shares;
  for (int r = 0; r <= static_cast<int>(radius); ++r) {
    int green = 0;
    for (int k = 0; k < kOutlineAngles; ++k) {
      const Eigen::Vector2d uv = centre + r * outline_direction(k);
      const int u = static_cast<int>(std::lround(uv.x()));
      const int v = static_cast<int>(std::lround(uv.y()));
      if (u < 0 || v < 0 || u >= static_cast<int>(colour.getWidth()) ||
          v >= static_cast<int>(colour.getHeight()))
        continue;
      green += palette(colour[static_cast<unsigned>(v)][u]) == FieldClass::green ? 1 : 0;
    }
    shares.push_back(static_cast<double>(green) / kOutlineAngles);
  }
  return shares;
}

/// From the greenest circle inwards to where less than half is green. In the very middle the mirror
/// shows the camera, whose glass may be green.
double body_radius(const std::vector<double>& shares) {
  constexpr std::ptrdiff_t kCameraShare = 6;
  const auto from = shares.begin() + static_cast<std::ptrdiff_t>(shares.size()) / kCameraShare;
  auto r = std::max_element(from, shares.end()) - shares.begin();
  while (r > 0 && shares[static_cast<std::size_t>(r)] >= 0.5) --r;
  return static_cast<double>(r + 1);
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
    const std::vector<double> shares =
        green_shares(colour, palette, mirror.centre, mirror.outer_px);
    if (*std::max_element(shares.begin(), shares.end()) < kLeastGreen) continue;
    mirror.inner_px = body_radius(shares);
    best_score = score;
    best = mirror;
  }
  return best;
}

}  // namespace vigia::tracking

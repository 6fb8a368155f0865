#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace vigia::tracking::testing {

/// A field under a parabolic mirror, rendered by formulas of its own: a point of the floor at the
/// distance d of the mirror's foot is seen at the radius f tan(θ/2), θ = atan(d/h), in its own
/// direction. The mirror is level; what lies beyond its edge is black.
struct MirrorScene {
  int width = 640;
  int height = 480;
  double focal_px = 230.0;  ///< f
  double u0 = 321.3;
  double v0 = 238.2;
  double height_m = 0.75;
  double edge_px = 236.0;
  double body_px = 40.0;                         ///< the robot's own body
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< of the mirror over the field, m
  double heading = 0.0;                          ///< of the image's u axis in the field, rad

  struct Stripe {
    Eigen::Vector2d a;
    Eigen::Vector2d b;
    double width_m;
    cv::Vec3f paint;
  };
  struct Ring {
    Eigen::Vector2d centre;
    double radius_m;  ///< of the middle of its stripe
    double width_m;
    cv::Vec3f paint;
  };
  struct Box {
    Eigen::Vector2d low;
    Eigen::Vector2d high;
    double height_m;
    cv::Vec3f paint;
    std::optional<cv::Vec3f> upper;  ///< paint of its upper half
  };
  std::vector<Stripe> stripes;
  std::vector<Ring> rings;
  std::vector<Box> boxes;  ///< upright, without a top: goals, posts, robots
  Eigen::Vector2d carpet_low = {-7.0, -5.0};
  Eigen::Vector2d carpet_high = {7.0, 5.0};

  /// The floor point that is seen at a place of the image, field frame; nothing above the horizon.
  std::optional<Eigen::Vector2d> floor_at(double u, double v) const;
  /// Linear reflectance at a place of the image, R G B.
  cv::Vec3f colour_at(double u, double v) const;
  /// The picture in linear light, 16×16 jittered samples in every pixel that has an edge.
  cv::Mat3f render() const;

  /// Radii at which a ray enters and leaves a white stripe or ring of the floor.
  struct Crossing {
    double inner_px;
    double outer_px;
  };
  std::vector<Crossing> crossings(double angle) const;

 private:
  bool has_edge(int u, int v) const;
};

const cv::Vec3f kCarpet(0.05F, 0.28F, 0.06F);
const cv::Vec3f kWhitePaint(0.80F, 0.82F, 0.80F);
const cv::Vec3f kYellowPaint(0.75F, 0.60F, 0.05F);
const cv::Vec3f kBluePaint(0.04F, 0.12F, 0.60F);
const cv::Vec3f kBlackPaint(0.02F, 0.02F, 0.02F);

/// A field of 12×8 m: boundary, halfway line, centre circle, goal areas, a yellow goal at −x and a
/// blue one at +x, corner posts.
MirrorScene field_scene();

}  // namespace vigia::tracking::testing

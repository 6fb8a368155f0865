#pragma once

#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

#include "vigia/core/colour_pattern.hpp"
#include "vigia/core/random.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::tracking::testing {

/// Linear reflectance (red, green, blue) of a place in a sheet's plane (m, y up), nothing beside
/// the sheet.
using Print = std::function<std::optional<cv::Vec3f>(double x, double y)>;

/// The inks of a printer as linear reflectances, by DotColour.
using Inks = std::array<cv::Vec3f, 4>;
Inks strong_inks();
Inks pale_inks();
/// Inks of another printer: each channel off by up to @p spread.
Inks varied(Inks inks, float spread, RandomStream& random);

Print print_of_pattern(const PatternShape& shape, const Inks& inks);
/// A tag whose fields are @p black, @p side_m wide, with a white rim of @p quiet_zone fields.
Print print_of_tag(const std::vector<std::vector<bool>>& black, double side_m, double quiet_zone);
/// A white sheet of @p width_m with discs at given places, and with rings: (x, y, radius, hole).
struct PrintedDisc {
  double x, y, radius, hole;
  cv::Vec3f ink;
};
Print print_of_discs(double width_m, std::vector<PrintedDisc> discs);

/// A flat sheet seen through a pinhole: the homography from its plane to the image.
struct SheetView {
  Eigen::Matrix3d iHl = Eigen::Matrix3d::Identity();
  int width = 0;
  int height = 0;

  Eigen::Vector2d operator()(const Eigen::Vector2d& p_l) const;
  /// The centre of the ellipse that a circle of the plane makes.
  Eigen::Vector2d circle_centre(const Eigen::Vector2d& centre_l, double radius) const;
};

/// A sheet of @p width_m that would be @p width_px wide seen from the front, its normal at @p slant
/// to the line of sight towards @p direction, rolled, its centre at @p centre; @p focal px.
SheetView view_of_sheet(double width_m, double width_px, double slant, double direction,
                        double roll, double focal, const Eigen::Vector2d& centre, int width,
                        int height);

/// What a camera does to light, in the order in which it happens.
struct PhotoParams {
  int fine = 3;             ///< samples a pixel across and down
  double blur_px = 0.7;     ///< Gaussian σ, before the response
  double defocus_px = 0.0;  ///< diameter of the disc of confusion
  double motion_px = 0.0;   ///< length of a straight motion during the exposure
  double motion_angle = 0.0;
  cv::Vec2d red_shift{0, 0};  ///< of the channel against green, px
  cv::Vec2d blue_shift{0, 0};
  cv::Vec3f light{1, 1, 1};        ///< on the left and, going linearly over to,
  cv::Vec3f other_light{1, 1, 1};  ///< on the right; 1: white paper is at @p white
  cv::Vec2d light_slope{0, 0};     ///< relative change a px
  double vignetting = 0.0;         ///< loss at the corners
  struct Glare {
    double u, v, radius, strength;
  };
  std::vector<Glare> glares;
  double haze = 0.0;       ///< added everywhere
  double white = 0.65;     ///< exposure: linear signal of a reflectance of 1; above 1 it clips
  double raw_noise = 0.0;  ///< σ of the linear signal at full scale; it grows with the light
  bool bayer = false;
  enum class Response { linear, srgb } response = Response::linear;
  double noise = 0.0;  ///< σ in grey levels after the response
  int jpeg = 0;        ///< quality; 0: none
};

/// A round or square sticker on the sheet.
struct Sticker {
  Eigen::Vector2d centre_l;
  double radius_m;
  bool round;
  cv::Vec3f ink;
};

/// A wall with clutter in linear light, @p fine times as large as the picture.
cv::Mat3f plain_wall(int width, int height, int fine, const cv::Vec3f& grey);
cv::Mat3f cluttered_wall(int width, int height, int fine, int pieces, RandomStream& random);

/// Lays a sheet on a wall: sampled at jittered places of a grid.
void lay_sheet(cv::Mat3f& wall, int fine, const SheetView& view, const Print& print,
               const std::vector<Sticker>& stickers, RandomStream& random);

/// The picture of a scene.
vpImage<vpRGBa> photograph(const cv::Mat3f& scene, const PhotoParams& params, RandomStream& random);
vpImage<unsigned char> grey_photograph(const cv::Mat3f& scene, const PhotoParams& params,
                                       RandomStream& random);

}  // namespace vigia::tracking::testing

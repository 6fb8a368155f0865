#pragma once

#include "pixel_row.hpp"

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/field_map.hpp"

namespace vigia::sim {

/// A field's lines and arcs as they are painted, all in one colour on one surface at the height of
/// the floor. A straight piece is carried on by half a line's width where its end meets another
/// line, so that corners are whole.
class FieldPaint {
 public:
  explicit FieldPaint(const FieldMap& map);

  const std::vector<FieldLine>& lines() const { return lines_; }
  /// Indices of the lines whose paint may lie within @p reach_m of a point of the floor.
  FieldDistance::Candidates near(const Eigen::Vector2d& p, double reach_m) const;

 private:
  std::vector<FieldLine> lines_;
  std::vector<FieldDistance> by_reach_;  ///< the shortest first
  std::vector<std::uint16_t> all_;
};

/// The paint as one exposure sees it. A pixel's share is the integral of the paint over a Gaussian
/// whose variance is that of optical blur and pixel square together. The sides of a line are
/// planes through the camera's centre (an arc's are tangent to its cone at the pixel's ray), so
/// that the distance from the pixel to a side, f/|∂f/∂(u,v)| of the plane's f = n·ray, is right to
/// second order also where a pixel covers decimetres of floor and several lines.
class FieldPaintView {
 public:
  FieldPaintView(const FieldPaint& paint, const Eigen::Isometry3d& cMw, const CameraModel& model,
                 double blur_px);

  /// The share of paint of the row's pixels whose winner is @p surface; 0 elsewhere.
  void coverage(PixelRow& row, ViewId surface) const;

 private:
  /// What of a line is the same for every pixel.
  struct Straight {
    Eigen::Vector3f across;  ///< metres beside the centre line, times w
    Eigen::Vector3f along;   ///< metres past the beginning, times w
    float half_width;
    float length;
  };
  struct Round {
    Eigen::Vector3f x;  ///< from the centre, times w
    Eigen::Vector3f y;
    float radius;
    float half_width;
    Eigen::Vector2f begin;  ///< unit vector to its beginning
    Eigen::Vector2f end;    ///< to its end
    bool closed;
    bool reflex;  ///< more than half a circle
  };
  struct Pixel;
  struct Strip;

  Pixel pixel_at(int u, int v, const Eigen::Vector3f& ray) const;
  float share_of(Pixel& pixel) const;
  std::optional<Strip> strip_of(const Straight& line, const Pixel& pixel) const;
  std::optional<Strip> strip_of(const Round& line, const Pixel& pixel) const;

  const FieldPaint* paint_;
  const CameraModel* model_;
  float sigma_px_;
  float height_m_;           ///< of the camera above the floor
  Eigen::Vector3f floor_x_;  ///< a ray r meets the floor at (floor_x·r, floor_y·r)/(floor_w·r)
  Eigen::Vector3f floor_y_;
  Eigen::Vector3f floor_w_;
  std::vector<Straight> straight_;  ///< by the line's index; of arcs unused
  std::vector<Round> round_;        ///< of straight lines unused
};

}  // namespace vigia::sim

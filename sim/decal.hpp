#pragma once

#include "rays.hpp"

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/imaging/frame.hpp"
#include "vigia/imaging/tag_bitmap.hpp"
#include "vigia/sim/appearance.hpp"

namespace vigia::sim {

enum class DecalShape { disc, square_plate, tag, blob, ellipse, ring, square, half_disc };

/// Something painted flat on a surface, in frame d: z the surface's outward normal, size_m half its
/// width.
struct Decal {
  DecalShape shape = DecalShape::disc;
  Eigen::Isometry3d wMd = Eigen::Isometry3d::Identity();
  double size_m = 0.1;
  float grey = 60.0F;
  bool blurred = false;                         ///< exact coverage and optical blur: landmarks
  std::size_t surface = 0;                      ///< index of the surface that carries it
  std::array<float, 3> tint{1.0F, 1.0F, 1.0F};  ///< red, green, blue of grey 1; luma 1
  imaging::TagBitmap fields{};                  ///< of a tag
};

/// A decal as one exposure sees it. coverage of a pixel is the share of grey that it takes.
class DecalView {
 public:
  /// Empty box when the decal has no image in the frame.
  DecalView(const Decal& decal, const Eigen::Isometry3d& cMw, const CameraModel& model,
            double blur_px);

  const imaging::Window& box() const { return box_; }
  const Decal& decal() const { return *decal_; }

  /// Coverage of pixels of @p window will be asked for.
  void expect(const imaging::Window& window);

  /// Coverage of @p count pixels of row @p v from @p u on, which lie in the box and in an expected
  /// window. Landmarks are computed together for what was expected; a pixel's coverage does not
  /// depend on that.
  void coverage(int u, int v, int count, const Rays& rays, float* out);

 private:
  void compute_blurred();
  bool within_square(const imaging::Window& window) const;
  std::vector<float> square_coverage(const imaging::Window& window) const;

  const Decal* decal_;
  const CameraModel* model_;
  double blur_px_;
  imaging::Window box_;
  Eigen::Matrix3d dHray_ = Eigen::Matrix3d::Identity();    ///< ray → decal, size_m = 1
  Eigen::Matrix2d dxy_duv_ = Eigen::Matrix2d::Identity();  ///< at the decal's centre
  imaging::Window expected_;                               ///< of the box
  std::vector<float> blurred_;  ///< of what is expected and blur_margin() round it; or nothing yet
};

}  // namespace vigia::sim

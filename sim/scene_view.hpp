#pragma once

#include "decal.hpp"
#include "light_rows.hpp"
#include "limb_grid.hpp"
#include "pixel_row.hpp"
#include "scene_content.hpp"
#include "tile_grid.hpp"

#include <optional>
#include <vector>

#include "vigia/sim/exposure.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {

inline constexpr int kGrey = -1;  ///< instead of a colour channel

/// What one instant of an exposure sees, before noise and rounding. The arithmetic of a pixel
/// depends on its (u, v), on the tile of the frame's grid that it lies in, and on the exposure;
/// never on what else is asked for.
class SceneView {
 public:
  SceneView(const SceneContent& content, const Exposure::Instant& instant,
            const std::optional<LightNow>& light, const CameraModel& model,
            const ImagingParams& params);

  PixelRow row_of(int most) const;
  /// Pixels of @p window will be asked for; must come before them.
  void expect(const imaging::Window& window);
  /// Finds what the pixels that @p row has taken show: rays, winner, depth, and the grey of
  /// surfaces and solids.
  void see(PixelRow& row);
  /// The levels of a channel (or of kGrey) of pixels that see() has seen.
  void expose(PixelRow& row, int channel, float* levels);

 private:
  void find_surfaces(const Eigen::Isometry3d& cMw);
  void find_marks(const Eigen::Isometry3d& cMw);
  void find_stripes(const std::vector<StripeMark>& marks, const Eigen::Isometry3d& cMw);
  void see_surfaces(PixelRow& row);
  void see_row_of_tiles(const Piece& piece, PixelRow& row);
  void see_tile(const Tile& tile, int first, int length, PixelRow& row);
  void see_one(ViewId id, int first, int length, PixelRow& row);
  void see_nearest(const Tile& tile, int first, int length, PixelRow& row);
  void see_solids(PixelRow& row);
  void see_field(PixelRow& row) const;
  const std::array<float, 3>& tint_of(ViewId winner) const;
  void tint(const PixelRow& row, int channel, float* levels) const;
  void paint_stripes(PixelRow& row, int channel, float* levels);
  void paint_field(PixelRow& row, int channel, float* levels) const;
  void paint_decals(PixelRow& row, int channel, float* levels);
  void mix(std::size_t surface, const std::array<float, 3>& tint, float grey, int channel, int at,
           int count, PixelRow& row, float* levels) const;
  void shine(const PixelRow& row, float* levels) const;

  const SceneContent& content_;
  Eigen::Isometry3d wMc_;
  CameraModel model_;
  double blur_px_;
  std::vector<SurfaceView> surfaces_;
  std::vector<int> view_of_surface_;
  std::vector<StripeMark> ceiling_marks_;
  std::vector<StripeView> stripes_;
  std::vector<DecalView> decals_;
  LimbGrid limbs_;
  std::optional<FieldPaintView> field_;
  std::optional<LightRows> light_;
  TileGrid tiles_;
};

}  // namespace vigia::sim

#pragma once

#include "body_view.hpp"
#include "decal.hpp"
#include "field_paint.hpp"
#include "lamp.hpp"
#include "stripe_view.hpp"
#include "surface.hpp"
#include "texture.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "vigia/core/world_map.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/sim/ceiling_truth.hpp"

namespace vigia::sim {

/// What a scene is made of: surfaces with texture, and what is painted on them.
struct SceneContent {
  SceneContent(const WorldMap& world, const Appearance& look, std::uint64_t noise_seed);

  std::uint64_t seed;  ///< of the pixels' noise
  float light;
  NoiseTile tile;
  std::vector<Surface> surfaces;
  std::vector<StripeMark> stripes;  ///< under the decals
  std::vector<Decal> decals;        ///< in the order in which they are painted
  std::vector<BodyPart> solids;     ///< that stand about and do not move
  /// The lines of a field, over everything else on its carpet.
  struct PaintedField {
    FieldPaint paint;
    Ink ink;
    std::size_t carpet;  ///< index of the surface
  };
  std::optional<PaintedField> field;
  /// A ceiling of patches; what of it is seen is found anew for each exposure.
  struct PatchedCeiling {
    CeilingTruth truth;
    double height_m;
    std::size_t surface;
  };
  std::optional<PatchedCeiling> ceiling;

  /// Patches on the ceiling, whose texture does not repeat as they do.
  void hang(const CeilingTruth& truth, const FloorPlan& plan);

 private:
  void hang(const CeilingGrid& grid, const FloorPlan& plan, const Appearance& look);
  void lay_out(const FieldMap& map, const FloorPlan& plan, const Appearance& look);
  void paint(const Stripe& stripe, const WorldMap& world);
  void paint(const Clutter& clutter, const Ground& ground);
  void hang(const Landmark& landmark, const Appearance& look);
  void shine(const std::array<float, 3>& gains);
};

}  // namespace vigia::sim

#pragma once

#include "decal.hpp"
#include "stripe_view.hpp"
#include "surface.hpp"
#include "texture.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include "vigia/core/world_map.hpp"
#include "vigia/sim/appearance.hpp"

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

 private:
  void paint(const Stripe& stripe, double ceiling_m);
  void paint(const Clutter& clutter);
  void hang(const Landmark& landmark, const Appearance& look);
  void shine(const std::array<float, 3>& gains);
};

}  // namespace vigia::sim

#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vigia::sim {

/// A square of smooth noise that tiles the plane: octaves of value noise, zero mean, in ±1, packed
/// so that one load gives the four corners of a cell.
class NoiseTile {
 public:
  static constexpr int kBits = 7;
  static constexpr int kSize = 1 << kBits;

  explicit NoiseTile(std::uint64_t seed);
  const std::uint32_t* data() const { return packed_.data(); }

 private:
  std::vector<std::uint32_t> packed_;
};

/// What is painted along one axis of a surface (skirting, rails, joints): grey levels to add, as a
/// table that repeats or ends at its last entry.
struct Profile {
  static constexpr int kSize = 1024;
  std::array<float, kSize> grey{};
  float per_m = 1.0F;  ///< table entries per metre
  bool repeats = false;
};

/// The look of one surface.
struct Material {
  float base = 128.0F;       ///< grey
  float coarse = 0.0F;       ///< amplitude of the noise of metres, grey
  float fine = 0.0F;         ///< amplitude of the noise of centimetres, grey; fades with distance
  float tiles_per_m = 1.0F;  ///< of the noise of centimetres; a tile of the coarse one has 8
  float offset_s = 0.0F;     ///< where in the tile the surface begins, m
  float offset_t = 0.0F;
  Profile along_s;
  Profile along_t;
  std::array<float, 3> tint{1.0F, 1.0F, 1.0F};  ///< red, green, blue of grey 1; luma 1
};

Material wall_material(double grey, double contrast, double height_m, std::uint64_t seed);
Material obstacle_material(double grey, double contrast, std::uint64_t seed);
Material carpet_material(double grey, double contrast, std::uint64_t seed);
/// Of one colour, with noise of centimetres.
Material plain_material(double grey, double fine, std::uint64_t seed);
Material floor_material(double grey, double contrast, std::uint64_t seed);
Material ceiling_material(double grey, double contrast, std::uint64_t seed);

}  // namespace vigia::sim

#include "landmark_decals.hpp"

#include "lamp.hpp"

namespace vigia::sim {
namespace {

/// Reflectance of the inks for red, green and blue light, as shares of the paper's: those of a
/// printer, none of which is pure.
std::array<float, 3> reflectance(DotColour colour) {
  switch (colour) {
    case DotColour::red:
      return {0.80F, 0.14F, 0.16F};
    case DotColour::green:
      return {0.12F, 0.55F, 0.25F};
    case DotColour::blue:
      return {0.14F, 0.22F, 0.72F};
    case DotColour::black:
      break;
  }
  return {0.12F, 0.12F, 0.12F};
}

Decal painted(DecalShape shape, const Eigen::Isometry3d& wMd, double size_m, double grey) {
  Decal decal;
  decal.shape = shape;
  decal.wMd = wMd;
  decal.size_m = size_m;
  decal.grey = static_cast<float>(grey);
  decal.blurred = true;
  return decal;
}

struct Picture {
  const Landmark& landmark;
  const Appearance& look;
  std::vector<Decal>& decals;

  void operator()(const DiscShape& disc) const {
    decals.push_back(painted(DecalShape::disc, landmark.wMl, disc.radius_m, look.disc_grey));
  }

  void operator()(const PatternShape& pattern) const {
    for (const PatternDot& dot : pattern_dots(pattern)) {
      const Eigen::Isometry3d wMd =
          landmark.wMl * Eigen::Translation3d(dot.centre_l.x(), dot.centre_l.y(), 0.0);
      std::array<float, 3> rgb = reflectance(dot.colour);
      for (float& channel : rgb) channel *= static_cast<float>(look.plate_grey);
      const Ink colour = ink(rgb);
      decals.push_back(painted(DecalShape::disc, wMd, dot.radius_m, 0.0));
      decals.back().grey = colour.grey;
      decals.back().tint = colour.tint;
    }
  }

  void operator()(const TagShape& tag) const {
    decals.push_back(painted(DecalShape::tag, landmark.wMl, 0.5 * tag.side_m, look.disc_grey));
    decals.back().fields = imaging::tag_bitmap(tag.tag);
  }
};

}  // namespace

double sheet_half_width(const Landmark& landmark, const Appearance& look) {
  const double reach = half_width(landmark);
  return disc_radius(landmark) ? reach * look.plate_factor : reach;
}

std::vector<Decal> landmark_decals(const Landmark& landmark, const Appearance& look) {
  const bool round = disc_radius(landmark) && look.plate_shape == PlateShape::disc;
  std::vector<Decal> decals{painted(round ? DecalShape::disc : DecalShape::square_plate,
                                    landmark.wMl, sheet_half_width(landmark, look),
                                    look.plate_grey)};
  std::visit(Picture{landmark, look, decals}, landmark.shape);
  return decals;
}

}  // namespace vigia::sim

#include "read_landmark.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "vigia/core/angle.hpp"

namespace vigia {
namespace {

const std::vector<std::string> kKinds{"disc", "pattern", "tag"};

int read_below(MapReader& reader, const std::string& key, int count) {
  return static_cast<int>(reader.integer(key, {0.0, count - 1.0}));
}

/// The pattern's dots lie apart from each other and on the sheet.
void check_dots(const PatternShape& shape, const MapReader& reader) {
  const double apart = 2.0 * shape.dot_radius_m;
  if (shape.inner_radius_m < shape.centre_radius_m + shape.dot_radius_m)
    throw reader.error("inner_radius_m", "the inner ring's dots touch the centre-point");
  if (shape.outer_radius_m < shape.inner_radius_m + apart)
    throw reader.error("outer_radius_m", "the outer ring's dots touch the inner ring's");
  const double chord = 2.0 * shape.inner_radius_m * std::sin(kPi / kDotsPerRing);
  if (chord < apart) throw reader.error("dot_radius_m", "the inner ring's dots touch each other");
  if (shape.centre_radius_m < 1.2 * shape.dot_radius_m)
    throw reader.error("centre_radius_m",
                       "the centre-point must be at least 1.2 times as large as the other dots");
  if (shape.sheet_half_width_m < shape.outer_radius_m + shape.dot_radius_m)
    throw reader.error("sheet_half_width_m", "the outer ring's dots reach over the sheet's edge");
}

PatternShape read_pattern(MapReader& reader) {
  const Range size{0.002, 2.0};
  PatternShape shape;
  shape.code.floor = read_below(reader, "floor", kFloors);
  shape.code.room = read_below(reader, "room", kRooms);
  shape.code.pattern = read_below(reader, "pattern", kPatterns);
  shape.outer_radius_m = reader.number("outer_radius_m", size, shape.outer_radius_m);
  shape.inner_radius_m = reader.number("inner_radius_m", size, shape.inner_radius_m);
  shape.dot_radius_m = reader.number("dot_radius_m", size, shape.dot_radius_m);
  shape.centre_radius_m = reader.number("centre_radius_m", size, shape.centre_radius_m);
  shape.sheet_half_width_m = reader.number("sheet_half_width_m", size, shape.sheet_half_width_m);
  check_dots(shape, reader);
  return shape;
}

TagShape read_tag(MapReader& reader) {
  TagShape shape;
  shape.tag = read_below(reader, "tag", kTags);
  shape.side_m = reader.number("side_m", {0.01, 2.0});
  return shape;
}

}  // namespace

PlacedLandmark read_landmark(MapReader reader) {
  PlacedLandmark placed{{}, 0.0, false, reader};
  placed.landmark.id = static_cast<LandmarkId>(reader.integer("id", {0.0, 1e6}));
  const std::size_t kind = reader.choice("kind", kKinds);
  const Eigen::Vector3d centre_w = reader.vector3("centre_m", kCoordinate);
  placed.normal_yaw = from_deg(reader.number("normal_deg", {-360.0, 360.0}));
  placed.landmark.wMl = wall_mount(centre_w, placed.normal_yaw);
  if (kind == 0)
    placed.landmark.shape = DiscShape{reader.number("radius_m", {0.005, 2.0})};
  else if (kind == 1)
    placed.landmark.shape = read_pattern(reader);
  else
    placed.landmark.shape = read_tag(reader);
  placed.free_standing = reader.boolean("free_standing", false);
  reader.finish();
  placed.reader = reader;
  return placed;
}

}  // namespace vigia

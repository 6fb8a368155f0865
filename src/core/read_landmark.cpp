#include "read_landmark.hpp"

#include <cmath>
#include <string>

#include "vigia/core/angle.hpp"

namespace vigia {
namespace {

enum class LandmarkKind { disc, pattern, tag };

/// The numbers from 0 on, @p count of them.
Bounds below(int count) {
  return {0.0, count - 1.0};
}

/// The pattern's dots lie apart from each other and on the sheet.
void require_dots_apart(ParamVisitor& v, const PatternShape& shape) {
  const double apart = 2.0 * shape.dot_radius_m;
  v.require(shape.inner_radius_m >= shape.centre_radius_m + shape.dot_radius_m, "inner_radius_m",
            "the inner ring's dots touch the centre-point");
  v.require(shape.outer_radius_m >= shape.inner_radius_m + apart, "outer_radius_m",
            "the outer ring's dots touch the inner ring's");
  const double chord = 2.0 * shape.inner_radius_m * std::sin(kPi / kDotsPerRing);
  v.require(chord >= apart, "dot_radius_m", "the inner ring's dots touch each other");
  v.require(shape.centre_radius_m >= 1.2 * shape.dot_radius_m, "centre_radius_m",
            "the centre-point must be at least 1.2 times as large as the other dots");
  v.require(shape.sheet_half_width_m >= shape.outer_radius_m + shape.dot_radius_m,
            "sheet_half_width_m", "the outer ring's dots reach over the sheet's edge");
}

DiscShape describe_disc(ParamVisitor& v) {
  DiscShape shape;
  v.number("radius_m", shape.radius_m, {0.005, 2.0}, About("of the disc").required());
  return shape;
}

PatternShape describe_pattern(ParamVisitor& v) {
  const Bounds size{0.002, 2.0};
  PatternShape shape;
  v.integer("floor", shape.code.floor, below(kFloors), About("that it shows").required());
  v.integer("room", shape.code.room, below(kRooms), About("that it shows").required());
  v.integer("pattern", shape.code.pattern, below(kPatterns), About("that it shows").required());
  v.number("outer_radius_m", shape.outer_radius_m, size, "of the ring of the outer dots' centres");
  v.number("inner_radius_m", shape.inner_radius_m, size, "of the ring of the inner dots' centres");
  v.number("dot_radius_m", shape.dot_radius_m, size, "of a dot of the rings");
  v.number("centre_radius_m", shape.centre_radius_m, size, "of the centre-point");
  v.number("sheet_half_width_m", shape.sheet_half_width_m, size, "of the square white paper");
  require_dots_apart(v, shape);
  return shape;
}

TagShape describe_tag(ParamVisitor& v) {
  TagShape shape;
  v.integer("tag", shape.tag, below(kTags), About("the AprilTag's number, 36h11").required());
  v.number("side_m", shape.side_m, {0.01, 2.0},
           About("of the black square; its sheet is 1.5 times as wide").required());
  return shape;
}

}  // namespace

void describe(ParamVisitor& v, PlacedLandmark& placed) {
  v.integer("id", placed.landmark.id, {0.0, 1e6}, About("of its own").required());
  auto kind = LandmarkKind::disc;
  v.choice("kind", kind, {"disc", "pattern", "tag"},
           About("a dark disc, a colour pattern or an AprilTag").required());
  Eigen::Vector3d centre_w = Eigen::Vector3d::Zero();
  v.vector("centre_m", centre_w, {kCoordinate.low, kCoordinate.high},
           About("on a face of the building, unless `free_standing`").required());
  v.angle("normal_deg", placed.normal_yaw, {-360.0, 360.0},
          About("the direction it faces, from the world's x axis").required());
  placed.landmark.wMl = wall_mount(centre_w, placed.normal_yaw);
  const auto take = [&](LandmarkKind described, const auto& shape) {
    if (described == kind) placed.landmark.shape = shape;
  };
  v.where(kind == LandmarkKind::disc, "`kind: disc`",
          [&] { take(LandmarkKind::disc, describe_disc(v)); });
  v.where(kind == LandmarkKind::pattern, "`kind: pattern`",
          [&] { take(LandmarkKind::pattern, describe_pattern(v)); });
  v.where(kind == LandmarkKind::tag, "`kind: tag`",
          [&] { take(LandmarkKind::tag, describe_tag(v)); });
  v.boolean("free_standing", placed.free_standing, "needs no face to lie on");
}

}  // namespace vigia

#include "vigia/core/world_map.hpp"

#include "read_field_map.hpp"
#include "read_ground.hpp"
#include "read_landmark.hpp"
#include "world_checks.hpp"

#include "vigia/core/params.hpp"

namespace vigia {
namespace {

const Bounds kPlace{kCoordinate.low, kCoordinate.high};
const Bounds kHeight{0.05, 100.0};
const Bounds kWidth{0.5, 1000.0};

std::vector<Eigen::Vector2d> rectangle(double width, double depth) {
  return {{0.0, 0.0}, {width, 0.0}, {width, depth}, {0.0, depth}};
}

struct Room {
  std::vector<Eigen::Vector2d> outline;
  double height_m = 2.8;
};

void describe(ParamVisitor& v, Room& room) {
  v.number("height_m", room.height_m, kHeight, "of the ceiling and of the walls round the room");
  const bool by_outline = v.given("outline_m", [&] {
    v.points("outline_m", room.outline, kPlace, 3, About("the room's corners in order").required());
  });
  if (by_outline) {
    check_polygon(room.outline, *v.reader(), "outline_m");
    return;
  }
  v.where(true, "no `outline_m`", [&] {
    double width = 0.0;
    double depth = 0.0;
    v.number("width_m", width, kWidth, About("of a room with a corner at the origin").required());
    v.number("depth_m", depth, kWidth, About("of a room with a corner at the origin").required());
    room.outline = rectangle(width, depth);
  });
}

void describe_wall(ParamVisitor& v, const Room& room, std::vector<Wall>& walls) {
  Wall wall;
  wall.height_m = room.height_m;
  v.vector("from_m", wall.a, kPlace, About("where it begins").required());
  v.vector("to_m", wall.b, kPlace, About("where it ends").required());
  v.number("height_m", wall.height_m, kHeight, About("at most the room's").otherwise("the room's"));
  v.require((wall.b - wall.a).norm() >= kShortestWall, "to_m",
            "the wall has no length: it ends where it begins");
  if (const MapReader* reader = v.reader()) {
    check_below_ceiling(wall.height_m, room.height_m, *reader);
    check_segment_in_room(wall.a, wall.b, room.outline, *reader, "to_m");
  }
  walls.push_back(wall);
}

void check_obstacle(const Obstacle& obstacle, const Room& room, const MapReader& reader) {
  check_polygon(obstacle.polygon, reader, "polygon_m");
  check_below_ceiling(obstacle.height_m, room.height_m, reader);
  for (std::size_t i = 0; i < obstacle.polygon.size(); ++i)
    check_segment_in_room(obstacle.polygon[i], obstacle.polygon[(i + 1) % obstacle.polygon.size()],
                          room.outline, reader, "polygon_m");
}

void describe_obstacle(ParamVisitor& v, const Room& room, std::vector<Obstacle>& obstacles) {
  Obstacle obstacle;
  v.points("polygon_m", obstacle.polygon, kPlace, 3, About("its corners in order").required());
  v.number("height_m", obstacle.height_m, kHeight, About("at most the room's").required());
  if (const MapReader* reader = v.reader()) check_obstacle(obstacle, room, *reader);
  obstacles.push_back(obstacle);
}

/// The field's centre is the world's origin; all of it lies in the room.
void describe_field(ParamVisitor& v, WorldMap& world) {
  FieldMap& field = world.field.emplace();
  v.map("field", field, "lines, goals and posts on a carpet about the world's origin");
  if (v.reader() == nullptr) return;
  const Eigen::Vector2d reach(0.5 * field.length_m + field.margin_m,
                              0.5 * field.width_m + field.margin_m);
  const std::vector<Eigen::Vector2d> carpet{
      {-reach.x(), -reach.y()}, {reach.x(), -reach.y()}, reach, {-reach.x(), reach.y()}};
  for (std::size_t i = 0; i < carpet.size(); ++i)
    check_segment_in_room(carpet[i], carpet[(i + 1) % carpet.size()], world.plan.outline(),
                          *v.reader(), "field");
}

}  // namespace

void describe(ParamVisitor& v, WorldMap& world) {
  v.text("name", world.name, "of the world");
  Room room;
  v.map("room", room, "the building's outer walls");
  std::vector<Wall> walls;
  v.each("walls", "walls inside the room", [&] { describe_wall(v, room, walls); });
  std::vector<Obstacle> obstacles;
  v.each("obstacles", "solids on the floor", [&] { describe_obstacle(v, room, obstacles); });
  if (v.reader() != nullptr)
    world.plan = FloorPlan(room.outline, room.height_m, std::move(walls), std::move(obstacles));
  v.given("ground", [&] { describe_ground(v, world.plan, world.ground); });

  std::vector<PlacedLandmark> placed;
  v.each("landmarks", "what the robot looks at; no two overlap or show the same code", [&] {
    describe(v, placed.emplace_back());
    if (v.reader() == nullptr) return;
    placed.back().reader = *v.reader();
    check_mounting(placed.back(), world.plan);
    check_against_earlier(placed);
  });
  std::vector<Landmark> landmarks;
  landmarks.reserve(placed.size());
  for (const PlacedLandmark& entry : placed) {
    landmarks.push_back(entry.landmark);
    landmarks.back().wMl = world.ground.hang(entry.landmark.wMl);
  }
  world.landmarks = LandmarkMap(std::move(landmarks));
  const auto require_flat = [&](const char* key) {
    v.require(world.ground.flat(), key, "needs flat ground: leave `ground` out of this world");
  };
  v.given("field", [&] {
    describe_field(v, world);
    require_flat("field");
  });
  v.given("ceiling", [&] {
    require_flat("ceiling");
    CeilingGrid& grid = world.ceiling.emplace();
    v.map("ceiling", grid, "patches of one colour on a grid through the world's origin");
    grid.height_m = room.height_m;
    if (v.reader() == nullptr || !grid.extent) return;
    const Eigen::Array2d begin = world.plan.min_corner();
    const Eigen::Array2d end = world.plan.max_corner();
    v.require((grid.extent->min.array() <= end).all() && (grid.extent->max.array() >= begin).all(),
              "ceiling", "the grid lies outside of the room: see its min_m and max_m");
  });
}

WorldMap read_world_map(MapReader& reader) {
  WorldMap world;
  ParamReader visitor(reader);
  describe(visitor, world);
  return world;
}

}  // namespace vigia

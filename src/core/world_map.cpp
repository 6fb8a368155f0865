#include "vigia/core/world_map.hpp"

#include "read_landmark.hpp"
#include "world_checks.hpp"

namespace vigia {
namespace {

constexpr Range kHeight{0.05, 100.0};

std::vector<Eigen::Vector2d> rectangle(double width, double depth) {
  return {{0.0, 0.0}, {width, 0.0}, {width, depth}, {0.0, depth}};
}

struct Room {
  std::vector<Eigen::Vector2d> outline;
  double height_m = 0.0;
};

Room read_room(MapReader reader) {
  Room room;
  room.height_m = reader.number("height_m", kHeight, 2.8);
  if (reader.has("outline_m")) {
    room.outline = reader.points2("outline_m", kCoordinate, 3);
    check_polygon(room.outline, reader, "outline_m");
  } else {
    const double width = reader.number("width_m", {0.5, 1000.0});
    room.outline = rectangle(width, reader.number("depth_m", {0.5, 1000.0}));
  }
  reader.finish();
  return room;
}

Wall read_wall(MapReader reader, const Room& room) {
  Wall wall;
  wall.a = reader.vector2("from_m", kCoordinate);
  wall.b = reader.vector2("to_m", kCoordinate);
  wall.height_m = reader.number("height_m", kHeight, room.height_m);
  reader.finish();
  if ((wall.b - wall.a).norm() < kShortestWall)
    throw reader.error("to_m", "the wall has no length: it ends where it begins");
  check_below_ceiling(wall.height_m, room.height_m, reader);
  check_segment_in_room(wall.a, wall.b, room.outline, reader, "to_m");
  return wall;
}

Obstacle read_obstacle(MapReader reader, const Room& room) {
  Obstacle obstacle;
  obstacle.polygon = reader.points2("polygon_m", kCoordinate, 3);
  obstacle.height_m = reader.number("height_m", kHeight);
  reader.finish();
  check_polygon(obstacle.polygon, reader, "polygon_m");
  check_below_ceiling(obstacle.height_m, room.height_m, reader);
  for (std::size_t i = 0; i < obstacle.polygon.size(); ++i)
    check_segment_in_room(obstacle.polygon[i], obstacle.polygon[(i + 1) % obstacle.polygon.size()],
                          room.outline, reader, "polygon_m");
  return obstacle;
}

}  // namespace

WorldMap read_world_map(MapReader& reader) {
  WorldMap world;
  world.name = reader.text("name", "world");
  const Room room = read_room(reader.map("room"));
  std::vector<Wall> walls;
  for (const MapReader& wall : reader.maps("walls")) walls.push_back(read_wall(wall, room));
  std::vector<Obstacle> obstacles;
  for (const MapReader& obstacle : reader.maps("obstacles"))
    obstacles.push_back(read_obstacle(obstacle, room));
  world.plan = FloorPlan(room.outline, room.height_m, std::move(walls), std::move(obstacles));

  std::vector<PlacedLandmark> placed;
  for (const MapReader& landmark : reader.maps("landmarks")) {
    placed.push_back(read_landmark(landmark));
    check_mounting(placed.back(), world.plan);
    check_against_earlier(placed);
  }
  std::vector<Landmark> landmarks;
  landmarks.reserve(placed.size());
  for (const PlacedLandmark& entry : placed) landmarks.push_back(entry.landmark);
  world.landmarks = LandmarkMap(std::move(landmarks));
  return world;
}

}  // namespace vigia

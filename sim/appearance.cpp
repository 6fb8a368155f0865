#include "vigia/sim/appearance.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {
namespace {

const std::vector<std::string> kKinds{"blob", "ellipse", "ring", "square", "half_disc"};

Clutter read_clutter(MapReader& reader, const WorldMap& world) {
  Clutter clutter;
  clutter.kind = static_cast<ClutterKind>(reader.choice("kind", kKinds));
  clutter.centre_w = reader.vector3("centre_m", {-1e4, 1e4});
  if (reader.boolean("on_floor", false)) clutter.place = ClutterPlace::floor;
  if (reader.boolean("on_ceiling", false)) {
    if (clutter.place == ClutterPlace::floor)
      throw reader.error("on_ceiling", "clutter is on the floor or on the ceiling, not on both");
    clutter.place = ClutterPlace::ceiling;
  }
  if (clutter.place == ClutterPlace::face)
    clutter.normal_yaw = from_deg(reader.number("normal_deg", {-360.0, 360.0}));
  clutter.size_m = reader.number("size_m", {0.005, 2.0}, 0.05);
  clutter.turn = from_deg(reader.number("turn_deg", {-360.0, 360.0}, 0.0));
  clutter.grey = reader.number("grey", {0.0, 255.0}, 60.0);
  reader.finish();

  if (clutter.place == ClutterPlace::floor) {
    if (std::abs(clutter.centre_w.z()) > 0.02)
      throw reader.error("centre_m", "clutter on the floor must have height 0");
    return clutter;
  }
  if (clutter.place == ClutterPlace::ceiling) {
    if (std::abs(clutter.centre_w.z() - world.plan.ceiling_m()) > 0.02)
      throw reader.error("centre_m", "clutter on the ceiling must have the room's height");
    return clutter;
  }
  const Eigen::Vector2d normal = unit_vector(clutter.normal_yaw);
  const Eigen::Vector2d p = clutter.centre_w.head<2>();
  const bool on_face =
      std::any_of(world.plan.faces().begin(), world.plan.faces().end(), [&](const Wall& face) {
        const Eigen::Vector2d along = (face.b - face.a).normalized();
        const double s = along.dot(p - face.a);
        return std::abs(along.dot(normal)) < 0.1 && s >= 0.0 && s <= (face.b - face.a).norm() &&
               (p - face.a - s * along).norm() < 0.02 && clutter.centre_w.z() >= 0.0 &&
               clutter.centre_w.z() <= face.height_m;
      });
  if (!on_face)
    throw reader.error("centre_m",
                       "clutter must lie on a face (within 2 cm) whose normal is normal_deg");
  return clutter;
}

Stripe read_stripe(MapReader& reader) {
  Stripe stripe;
  stripe.from = reader.vector2("from_m", {-1e4, 1e4});
  stripe.to = reader.vector2("to_m", {-1e4, 1e4});
  stripe.width_m = reader.number("width_m", {0.001, 10.0}, stripe.width_m);
  stripe.grey = reader.number("grey", {0.0, 255.0}, stripe.grey);
  stripe.on_ceiling = reader.boolean("on_ceiling", stripe.on_ceiling);
  reader.finish();
  if ((stripe.to - stripe.from).norm() < 1e-3)
    throw reader.error("to_m", "the stripe has no length: it ends where it begins");
  return stripe;
}

bool near_landmark(const Eigen::Vector3d& p, const WorldMap& world, double plate_factor) {
  return std::any_of(
      world.landmarks.all().begin(), world.landmarks.all().end(), [&](const Landmark& landmark) {
        const double sheet = (disc_radius(landmark) ? plate_factor : 1.0) * half_width(landmark);
        return (p - landmark.centre_w()).norm() < 1.5 * sheet + 0.25;
      });
}

Clutter random_mark(RandomStream& random) {
  Clutter mark;
  mark.kind = static_cast<ClutterKind>(random.index(kKinds.size()));
  mark.size_m = random.uniform(0.03, 0.10);
  mark.turn = random.uniform(-kPi, kPi);
  mark.grey = random.uniform(45.0, 90.0);
  return mark;
}

/// Marks on both sides of the faces and spots on the floor, so many a square metre, away from the
/// landmarks.
void scatter(const WorldMap& world, double per_m2, Appearance& appearance) {
  RandomStream random(appearance.seed, "clutter");
  for (const Wall& face : world.plan.faces()) {
    const Eigen::Vector2d along = face.b - face.a;
    const double length = along.norm();
    const auto count = std::llround(per_m2 * length * face.height_m);
    for (long long i = 0; i < count; ++i) {
      Clutter mark = random_mark(random);
      const double s = random.uniform(0.0, 1.0);
      const double height = random.uniform(0.0, 1.0);
      const bool left = random.index(2) == 0;
      if (length < 0.5 || face.height_m < 0.5) continue;
      const Eigen::Vector2d p = face.a + along * (0.15 + s * (length - 0.3)) / length;
      mark.centre_w << p, 0.15 + height * (face.height_m - 0.3);
      mark.normal_yaw = std::atan2(along.y(), along.x()) + (left ? 0.5 : -0.5) * kPi;
      if (!near_landmark(mark.centre_w, world, appearance.plate_factor))
        appearance.clutter.push_back(mark);
    }
  }
  const Eigen::Vector2d low = world.plan.min_corner();
  const Eigen::Vector2d size = world.plan.max_corner() - low;
  const auto spots = std::llround(per_m2 * size.x() * size.y());
  for (long long i = 0; i < spots; ++i) {
    Clutter mark = random_mark(random);
    mark.place = ClutterPlace::floor;
    mark.centre_w << low.x() + size.x() * random.uniform(0.0, 1.0),
        low.y() + size.y() * random.uniform(0.0, 1.0), 0.0;
    appearance.clutter.push_back(mark);
  }
}

}  // namespace

std::shared_ptr<const Appearance> read_appearance(MapReader& reader, const WorldMap& world) {
  const Range grey{0.0, 255.0};
  auto appearance = std::make_shared<Appearance>();
  MapReader look = reader.map("appearance");
  appearance->seed = static_cast<std::uint64_t>(look.integer("seed", {0.0, 1e15}, 1));
  appearance->contrast = look.number("contrast", {0.0, 3.0}, appearance->contrast);
  appearance->light = look.number("light", {0.0, 10.0}, appearance->light);
  appearance->light_kelvin =
      look.number("light_kelvin", {1500.0, 20000.0}, appearance->light_kelvin);
  appearance->wall_grey = look.number("wall_grey", grey, appearance->wall_grey);
  appearance->floor_grey = look.number("floor_grey", grey, appearance->floor_grey);
  appearance->ceiling_grey = look.number("ceiling_grey", grey, appearance->ceiling_grey);
  appearance->obstacle_grey = look.number("obstacle_grey", grey, appearance->obstacle_grey);
  appearance->disc_grey = look.number("disc_grey", grey, appearance->disc_grey);
  appearance->plate_grey = look.number("plate_grey", grey, appearance->plate_grey);
  appearance->plate_factor = look.number("plate_factor", {1.05, 10.0}, appearance->plate_factor);
  appearance->plate_shape =
      static_cast<PlateShape>(look.choice("plate_shape", {"square", "disc"}, 0));
  const double per_m2 = look.number("clutter_per_m2", {0.0, 20.0}, 0.25);
  look.finish();
  for (MapReader& item : reader.maps("stripes")) appearance->stripes.push_back(read_stripe(item));
  for (MapReader& item : reader.maps("clutter"))
    appearance->clutter.push_back(read_clutter(item, world));
  scatter(world, per_m2, *appearance);
  return appearance;
}

}  // namespace vigia::sim

#include "vigia/sim/appearance.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"
#include "vigia/sim/params.hpp"
#include "vigia/sim/scene.hpp"

namespace vigia::sim {
namespace {

constexpr double kMinPitch_m = 0.5;  // of what is rendered one by one

const std::vector<std::string> kKinds{"blob", "ellipse", "ring", "square", "half_disc"};
const Bounds kGrey{0.0, 255.0};

/// Whether the mark lies on a face (within 2 cm) whose normal is the mark's.
bool lies_on_a_face(const Clutter& mark, const FloorPlan& plan) {
  const Eigen::Vector2d normal = unit_vector(mark.normal_yaw);
  const Eigen::Vector2d p = mark.centre_w.head<2>();
  return std::any_of(plan.faces().begin(), plan.faces().end(), [&](const Wall& face) {
    const Eigen::Vector2d along = (face.b - face.a).normalized();
    const double s = along.dot(p - face.a);
    return std::abs(along.dot(normal)) < 0.1 && s >= 0.0 && s <= (face.b - face.a).norm() &&
           (p - face.a - s * along).norm() < 0.02 && mark.centre_w.z() >= 0.0 &&
           mark.centre_w.z() <= face.height_m;
  });
}

void describe_place(ParamVisitor& v, Clutter& mark) {
  bool on_floor = mark.place == ClutterPlace::floor;
  bool on_ceiling = mark.place == ClutterPlace::ceiling;
  v.boolean("on_floor", on_floor, "lies on the floor");
  v.boolean("on_ceiling", on_ceiling, "hangs on the ceiling");
  v.require(!on_floor || !on_ceiling, "on_ceiling",
            "clutter is on the floor or on the ceiling, not on both");
  if (on_floor) mark.place = ClutterPlace::floor;
  if (on_ceiling) mark.place = ClutterPlace::ceiling;
  v.where(mark.place == ClutterPlace::face, "neither `on_floor` nor `on_ceiling` is set", [&] {
    v.angle("normal_deg", mark.normal_yaw, {-360.0, 360.0},
            About("the normal of its face, from the world's x axis").required());
  });
}

void require_place(ParamVisitor& v, const WorldMap& world, const Clutter& mark) {
  switch (mark.place) {
    case ClutterPlace::floor:
      v.require(std::abs(mark.centre_w.z()) <= 0.02, "centre_m",
                "clutter on the floor must have height 0");
      return;
    case ClutterPlace::ceiling:
      v.require(std::abs(mark.centre_w.z() - world.plan.ceiling_m()) <= 0.02, "centre_m",
                "clutter on the ceiling must have the room's height");
      return;
    case ClutterPlace::face:
      v.require(lies_on_a_face(mark, world.plan), "centre_m",
                "clutter must lie on a face (within 2 cm) whose normal is normal_deg");
  }
}

void describe_mark(ParamVisitor& v, const WorldMap& world, Clutter& mark) {
  v.choice("kind", mark.kind, kKinds, About("what it looks like").required());
  v.vector("centre_m", mark.centre_w, {-1e4, 1e4},
           About("on a face, on the floor or on the ceiling").required());
  describe_place(v, mark);
  v.number("size_m", mark.size_m, {0.005, 2.0}, "half its greatest width");
  v.angle("turn_deg", mark.turn, {-360.0, 360.0}, "about the normal");
  v.number("grey", mark.grey, kGrey, About("of its surface").in("grey levels"));
  if (v.reader() == nullptr) return;
  require_place(v, world, mark);
}

void describe_surfaces(ParamVisitor& v, Appearance& a) {
  v.integer("seed", a.seed, {0.0, 1e15}, "of textures and random clutter");
  v.number("contrast", a.contrast, {0.0, 3.0}, "of every texture; 0: plain surfaces");
  v.number("light", a.light, {0.0, 10.0}, "gain of the whole picture");
  v.number("light_kelvin", a.light_kelvin, {1500.0, 20000.0}, "colour of the lamp; 6500: white");
  v.number("wall_grey", a.wall_grey, kGrey, "of the walls");
  v.number("floor_grey", a.floor_grey, kGrey, "of the floor");
  v.number("ceiling_grey", a.ceiling_grey, kGrey, "of the ceiling");
  v.number("obstacle_grey", a.obstacle_grey, kGrey,
           "of the obstacles: below 200 they are of wood, from there on painted white");
  v.number("disc_grey", a.disc_grey, kGrey, "of the discs");
  v.number("plate_grey", a.plate_grey, kGrey, "of the sheet round a disc");
  v.number("plate_factor", a.plate_factor, {1.05, 10.0},
           "half the sheet's width over the disc's radius");
  v.choice("plate_shape", a.plate_shape, {"square", "disc"}, "how the sheet round a disc is cut");
  v.number("clutter_per_m2", a.clutter_per_m2, {0.0, 20.0}, "marks scattered at random");
}

void describe_field_looks(ParamVisitor& v, Appearance& a) {
  v.number("carpet_grey", a.carpet_grey, kGrey, "of the field's carpet, which is green");
  v.number("line_grey", a.line_grey, kGrey, "of the field's lines");
  v.integer("adverts", a.adverts, {0, 200}, "boards in bright colours round the field");
  v.integer("spectators", a.spectators, {0, 200}, "people in bright clothes round the field");
}

void describe_ceiling_looks(ParamVisitor& v, const FloorPlan& plan, Appearance& a) {
  v.number("patch_grey", a.patch_grey, kGrey, "of the ceiling's patches");
  v.number("patches_missing", a.patches_missing, {0.0, 1.0}, "share of them that have fallen off");
  v.number("patches_spurious", a.patches_spurious, {0.0, 1.0},
           "share of the cells that have a second patch, anywhere in them");
  v.number("lamp_pitch_m", a.lamp_pitch_m, {0.0, 100.0},
           "between lamps of 1.2 by 0.2 m on the ceiling; 0: none");
  v.require(a.lamp_pitch_m == 0.0 || a.lamp_pitch_m >= kMinPitch_m, "lamp_pitch_m",
            "must be 0, or 0.5 or more");
  v.number("lamp_grey", a.lamp_grey, kGrey, "of those lamps");
  v.number("pipe_pitch_m", a.pipe_pitch_m, {0.0, 100.0},
           "between pipes of 0.1 m along x that hang below the ceiling; 0: none");
  v.require(a.pipe_pitch_m == 0.0 || a.pipe_pitch_m >= kMinPitch_m, "pipe_pitch_m",
            "must be 0, or 0.5 or more");
  v.number("pipe_drop_m", a.pipe_drop_m, {0.0, 5.0}, "of their lower side below the ceiling");
  v.require(a.pipe_pitch_m == 0.0 || a.pipe_drop_m < plan.ceiling_m(), "pipe_drop_m",
            "pipes hang below the floor: pipe_drop_m must be less than the room's height");
}

void describe_stripe(ParamVisitor& v, Stripe& stripe) {
  v.vector("from_m", stripe.from, {-1e4, 1e4}, About("one end").required());
  v.vector("to_m", stripe.to, {-1e4, 1e4}, About("the other end").required());
  v.number("width_m", stripe.width_m, {0.001, 10.0}, "of the line");
  v.number("grey", stripe.grey, kGrey, About("of the paint").in("grey levels"));
  v.boolean("on_ceiling", stripe.on_ceiling, "on the ceiling instead of the floor");
  v.require(v.reader() == nullptr || (stripe.to - stripe.from).norm() >= 1e-3, "to_m",
            "the stripe has no length: it ends where it begins");
}

bool near_landmark(const Eigen::Vector3d& p, const WorldMap& world, double plate_factor) {
  return std::any_of(
      world.landmarks.all().begin(), world.landmarks.all().end(), [&](const Landmark& landmark) {
        const double sheet = (disc_radius(landmark) ? plate_factor : 1.0) * half_width(landmark);
        return (p - world.ground.in_plan(landmark.centre_w())).norm() < 1.5 * sheet + 0.25;
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
void scatter(const WorldMap& world, Appearance& appearance) {
  const double per_m2 = appearance.clutter_per_m2;
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

void describe_appearance(ParamVisitor& v, const WorldMap& world, Appearance& appearance) {
  v.map("appearance", "looks of the building; grey levels are before the light's gain", [&] {
    describe_surfaces(v, appearance);
    v.where(world.field.has_value(), "the world has a `field`",
            [&] { describe_field_looks(v, appearance); });
    v.where(world.ceiling.has_value(), "the world has a `ceiling`",
            [&] { describe_ceiling_looks(v, world.plan, appearance); });
  });
  v.each("stripes", "straight lines painted on the floor or the ceiling",
         [&] { describe_stripe(v, appearance.stripes.emplace_back()); });
  v.each("clutter", "dark marks that are no landmarks",
         [&] { describe_mark(v, world, appearance.clutter.emplace_back()); });
  if (v.reader() != nullptr) scatter(world, appearance);
}

std::shared_ptr<const Appearance> read_appearance(MapReader& reader, const WorldMap& world) {
  auto appearance = std::make_shared<Appearance>();
  ParamReader visitor(reader);
  describe_appearance(visitor, world, *appearance);
  return appearance;
}

}  // namespace vigia::sim

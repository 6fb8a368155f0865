#include "true_world.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vigia/core/plane_geometry.hpp"
#include "vigia/core/random.hpp"

namespace vigia::sim {
namespace {

constexpr double kFromEdge = 0.3;      // m, of clutter on its face
constexpr double kFromLandmark = 0.6;  // m, between the middles
constexpr int kMarkAttempts = 100;

void displace(const MapErrorParams& params, std::uint64_t seed, std::vector<Landmark>& landmarks) {
  RandomStream random(seed, "map error");
  for (Landmark& landmark : landmarks) {
    const double x = params.sigma_m * random.normal();
    const double y = params.sigma_m * random.normal();
    const double turn = params.turn * random.normal();
    landmark.wMl = landmark.wMl * Eigen::Translation3d(x, y, 0.0) *
                   Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY());
  }
}

void remove(const MissingLandmarksParams& params, std::uint64_t seed,
            std::vector<Landmark>& landmarks) {
  RandomStream random(seed, "missing landmarks");
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    if (random.uniform(0.0, 1.0) < params.probability) missing.push_back(i);
  const std::size_t limit = landmarks.size() / static_cast<std::size_t>(params.at_most_one_in);
  std::shuffle(missing.begin(), missing.end(), random.engine());
  if (missing.size() > limit) missing.resize(limit);
  std::sort(missing.rbegin(), missing.rend());
  for (const std::size_t i : missing)
    landmarks.erase(landmarks.begin() + static_cast<std::ptrdiff_t>(i));
}

/// Places on the walls, at a height where landmarks hang, away from landmarks and from each other.
class WallPlaces {
 public:
  WallPlaces(const WorldMap& world, RandomStream& random) : world_(world), random_(random) {
    for (const Landmark& landmark : world.landmarks.all())
      taken_.push_back(world.ground.in_plan(landmark.centre_w()));
    for (const Wall& face : world.plan.faces())
      if (face.height_m > 1.5 && (face.b - face.a).norm() > 2.0 * kFromEdge)
        faces_.push_back(&face);
  }

  /// A place with the direction of its outward normal; false when the walls are full.
  bool draw(Clutter& mark) {
    for (int attempt = 0; attempt < kMarkAttempts && !faces_.empty(); ++attempt) {
      const Wall& face = *faces_[random_.index(faces_.size())];
      const Eigen::Vector2d along = (face.b - face.a).normalized();
      const double s = random_.uniform(kFromEdge, (face.b - face.a).norm() - kFromEdge);
      const double z = random_.uniform(1.2, std::min(2.2, face.height_m - 0.2));
      const bool left = random_.index(2) == 0;
      mark.centre_w << face.a + s * along, z;
      mark.normal_yaw = std::atan2(along.y(), along.x()) + (left ? 0.5 : -0.5) * kPi;
      const Eigen::Vector2d before = mark.centre_w.head<2>() + 0.1 * unit_vector(mark.normal_yaw);
      const bool free = world_.plan.clearance(before) > 0.0 &&
                        std::all_of(taken_.begin(), taken_.end(), [&](const Eigen::Vector3d& p) {
                          return (p - mark.centre_w).norm() > kFromLandmark;
                        });
      if (!free) continue;
      taken_.push_back(mark.centre_w);
      return true;
    }
    return false;
  }

 private:
  const WorldMap& world_;
  RandomStream& random_;
  std::vector<Eigen::Vector3d> taken_;
  std::vector<const Wall*> faces_;
};

Clutter dark_mark(RandomStream& random, const Appearance& look) {
  static constexpr std::array<ClutterKind, 4> kRound{ClutterKind::disc, ClutterKind::blob,
                                                     ClutterKind::ring, ClutterKind::ellipse};
  Clutter mark;
  mark.kind = kRound[random.index(kRound.size())];
  mark.size_m = random.uniform(0.04, 0.09);
  mark.turn = random.uniform(-kPi, kPi);
  mark.grey = look.disc_grey + random.uniform(-15.0, 25.0);
  return mark;
}

Clutter plate(RandomStream& random, const Appearance& look) {
  Clutter mark;
  mark.kind = ClutterKind::square;
  mark.size_m = random.uniform(0.10, 0.18);
  mark.grey = look.plate_grey + random.uniform(-25.0, 10.0);
  return mark;
}

}  // namespace

WorldMap true_world(const WorldMap& map, const DisturbanceParams& disturbances,
                    std::uint64_t seed) {
  std::vector<Landmark> landmarks = map.landmarks.all();
  if (disturbances.map_error) displace(*disturbances.map_error, seed, landmarks);
  if (disturbances.missing_landmarks) remove(*disturbances.missing_landmarks, seed, landmarks);
  const auto& ramps = disturbances.ramp_error;
  return {map.name,
          map.plan,
          ramps ? map.ground.with_steeper_ramps(ramps->steeper) : map.ground,
          LandmarkMap(std::move(landmarks)),
          map.field,
          map.ceiling};
}

Appearance true_appearance(const Appearance& appearance, const WorldMap& world,
                           const DisturbanceParams& disturbances, std::uint64_t seed) {
  Appearance look = appearance;
  if (!disturbances.clutter) return look;
  RandomStream random(seed, "look-alikes");
  WallPlaces places(world, random);
  for (int i = 0; i < disturbances.clutter->plates; ++i) {
    Clutter sheet = plate(random, look);
    if (!places.draw(sheet)) return look;
    Clutter mark = dark_mark(random, look);
    // A round disc in the middle of a plate would be a landmark.
    if (mark.kind == ClutterKind::disc) mark.kind = ClutterKind::half_disc;
    mark.size_m = 0.6 * sheet.size_m;
    mark.centre_w = sheet.centre_w;
    mark.normal_yaw = sheet.normal_yaw;
    look.clutter.push_back(sheet);
    look.clutter.push_back(mark);
  }
  for (int i = 0; i < disturbances.clutter->marks; ++i) {
    Clutter mark = dark_mark(random, look);
    if (!places.draw(mark)) return look;
    look.clutter.push_back(mark);
  }
  return look;
}

}  // namespace vigia::sim

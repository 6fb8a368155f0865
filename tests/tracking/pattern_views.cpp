#include "tracking/pattern_views.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "vigia/core/angle.hpp"
#include "vigia/core/config.hpp"
#include "vigia/sim/appearance.hpp"

namespace vigia::tracking::testing {

LandmarkHall::LandmarkHall(const decltype(Landmark::shape)& shape, const std::string& keys) {
  world_.name = "hall";
  world_.plan = FloorPlan({{0, 0}, {10, 0}, {10, 16}, {0, 16}}, 2.8, {}, {});
  Landmark landmark;
  landmark.id = 1;
  landmark.wMl = wall_mount({0.0, 8.0, 2.15}, 0.0);
  landmark.shape = shape;
  world_.landmarks = LandmarkMap({landmark});
  MapReader reader(parse_config("version: 1\nappearance: {" + keys + "}\n", "test"), "world");
  scene_ = std::make_unique<sim::Scene>(world_, sim::read_appearance(reader, world_), 5);
}

vpImage<vpRGBa> LandmarkHall::picture(const Eigen::Isometry3d& wMc, const Intrinsics& intrinsics,
                                      const sim::ImagingParams& params, std::int64_t stamp) const {
  return imaging::colour_image(*scene_->expose(wMc, intrinsics, {stamp}, params));
}

Eigen::Isometry3d look_at(const Landmark& landmark, double distance, double angle, double turn,
                          double roll, const Eigen::Vector2d& offset,
                          const Intrinsics& intrinsics) {
  const Eigen::Vector3d eye_l =
      distance * Eigen::Vector3d(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                                 std::cos(angle));
  const Eigen::Vector3d eye = landmark.wMl * eye_l;
  Eigen::Isometry3d wMc = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d z = (landmark.centre_w() - eye).normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  wMc.linear() << x, z.cross(x), z;
  wMc.translation() = eye;
  // Turned so that the landmark lies on the ray of the offset.
  const Eigen::Vector3d ray(offset.x() / intrinsics.px, offset.y() / intrinsics.py, 1.0);
  wMc.linear() = wMc.linear() * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()) *
                 Eigen::Quaterniond::FromTwoVectors(ray, Eigen::Vector3d::UnitZ());
  return wMc;
}

PatternView random_view(const Landmark& landmark, RandomStream& random) {
  constexpr double kRim = 0.125;  // m from the centre to the outer dots' far rims
  for (;;) {
    const double distance = random.uniform(1.25, 8.0);
    const bool frontal = random.uniform(0.0, 1.0) < 0.2;
    const double angle = from_deg(frontal ? random.uniform(0.0, 5.0) : random.uniform(25.0, 65.0));
    const double turn = random.uniform(-kPi, kPi);
    const double fill = random.uniform(0.5, 0.95);
    const double roll = from_deg(random.uniform(-15.0, 15.0));
    const double height = landmark.centre_w().z() + distance * std::sin(angle) * std::sin(turn);
    if (height < 0.3 || height > 2.6) continue;
    PatternView view;
    view.intrinsics.px = std::clamp(fill * 240.0 * distance / kRim, 720.0, 8640.0);
    view.intrinsics.py = view.intrinsics.px;
    const double room = 240.0 - view.intrinsics.px * kRim / distance * 1.1;
    const double off = std::max(0.0, room);
    const Eigen::Vector2d offset(random.uniform(-off, off), random.uniform(-off, off));
    view.wMc = look_at(landmark, distance, angle, turn, roll, offset, view.intrinsics);
    return view;
  }
}

PatternShape pattern_of(const PatternCode& code) {
  PatternShape shape;
  shape.code = code;
  return shape;
}

PatternCode random_code(RandomStream& random) {
  return {static_cast<int>(random.index(kFloors)), static_cast<int>(random.index(kRooms)),
          static_cast<int>(random.index(kPatterns))};
}

sim::ImagingParams colour_params(double noise, double blur) {
  sim::ImagingParams params;
  params.noise_sigma = noise;
  params.blur_px = blur;
  params.colour = true;
  return params;
}

Eigen::Vector2d dot_image(const Landmark& landmark, const PatternDot& dot,
                          const PatternView& view) {
  constexpr int kPoints = 720;
  const Eigen::Isometry3d cMl = view.wMc.inverse(Eigen::Isometry) * landmark.wMl;
  const auto outline = [&](int i) {
    const double angle = 2.0 * kPi * i / kPoints;
    const Eigen::Vector2d p =
        dot.centre_l + dot.radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    return *project(view.intrinsics, cMl * Eigen::Vector3d(p.x(), p.y(), 0.0));
  };
  const Eigen::Vector2d origin = outline(0);
  double area = 0.0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d a = outline(i) - origin;
    const Eigen::Vector2d b = outline(i + 1) - origin;
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += 0.5 * cross;
    centre += cross * (a + b) / 6.0;
  }
  return origin + centre / area;
}

void cover(vpImage<vpRGBa>& image, const Eigen::Vector2d& spot, double reach, double noise,
           RandomStream& random) {
  const double level[3] = {random.uniform(0.0, 255.0), random.uniform(0.0, 255.0),
                           random.uniform(0.0, 255.0)};
  const Eigen::Vector2d centre =
      spot + reach * Eigen::Vector2d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
  const bool round = random.index(2) == 0;
  const double ratio = random.uniform(0.6, 1.6);
  const auto byte = [&](double value) {
    return static_cast<unsigned char>(std::clamp(value + noise * random.normal(), 0.0, 255.0));
  };
  const int width = static_cast<int>(image.getWidth());
  const int height = static_cast<int>(image.getHeight());
  for (int v = std::max(0, static_cast<int>(centre.y() - 2.0 * reach));
       v < std::min(height, static_cast<int>(centre.y() + 2.0 * reach)); ++v)
    for (int u = std::max(0, static_cast<int>(centre.x() - 2.0 * reach));
         u < std::min(width, static_cast<int>(centre.x() + 2.0 * reach)); ++u) {
      const Eigen::Vector2d d((u - centre.x()) * ratio, v - centre.y());
      if ((round ? d.norm() : d.cwiseAbs().maxCoeff()) > reach * 1.2) continue;
      vpRGBa& pixel = image[static_cast<unsigned>(v)][u];
      pixel.R = byte(level[0]);
      pixel.G = byte(level[1]);
      pixel.B = byte(level[2]);
    }
}

namespace {

constexpr int kViewsPerHall = 20;

void count(const imaging::Frame& frame, const PatternCode& code, ReadingRates& rates) {
  ++rates.views;
  bool right = false;
  for (const PointsFeature& feature : make_point_tracker("pattern", {})->find_all(frame)) {
    if (!feature.code) continue;
    if (std::get<PatternCode>(*feature.code) == code)
      right = true;
    else
      ++rates.wrong;
  }
  if (right) ++rates.right;
}

void cover_dots(vpImage<vpRGBa>& image, const LandmarkHall& hall, const PatternView& view,
                double noise, RandomStream& random) {
  const auto& shape = std::get<PatternShape>(hall.landmark().shape);
  const std::vector<PatternDot> dots = pattern_dots(shape);
  const double px_per_m =
      view.intrinsics.px / (hall.landmark().centre_w() - view.wMc.translation()).norm();
  for (std::size_t hidden = random.index(3); hidden > 0; --hidden) {
    const PatternDot& dot = dots[random.index(dots.size())];
    cover(image, dot_image(hall.landmark(), dot, view), dot.radius_m * px_per_m, noise, random);
  }
}

}  // namespace

ReadingRates read_clean_views(int views, std::uint64_t seed) {
  RandomStream random(seed, "clean views");
  ReadingRates rates;
  while (rates.views < views) {
    const PatternCode code = random_code(random);
    const LandmarkHall hall(pattern_of(code));
    for (int i = 0; i < kViewsPerHall && rates.views < views; ++i) {
      const PatternView view = random_view(hall.landmark(), random);
      const auto frame =
          hall.scene().expose(view.wMc, view.intrinsics, {rates.views}, colour_params());
      count(*frame, code, rates);
    }
  }
  return rates;
}

ReadingRates read_hard_views(int views, std::uint64_t seed) {
  RandomStream random(seed, "hard views");
  ReadingRates rates;
  while (rates.views < views) {
    const PatternCode code = random_code(random);
    const LandmarkHall hall(pattern_of(code),
                            "light_kelvin: " + std::to_string(random.uniform(3000.0, 9000.0)));
    for (int i = 0; i < kViewsPerHall && rates.views < views; ++i) {
      const PatternView view = random_view(hall.landmark(), random);
      vpImage<vpRGBa> image = hall.picture(
          view.wMc, view.intrinsics, colour_params(8.0, random.uniform(0.7, 3.0)), rates.views);
      cover_dots(image, hall, view, 8.0, random);
      count(imaging::ImageFrame(std::move(image)), code, rates);
    }
  }
  return rates;
}

}  // namespace vigia::tracking::testing

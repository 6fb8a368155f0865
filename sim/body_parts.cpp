#include "body_view.hpp"
#include "lamp.hpp"

#include <cmath>

#include "vigia/core/angle.hpp"

namespace vigia::sim {
namespace {

using Eigen::Vector3d;

struct Clothes {
  float shirt;
  float shirt_pattern;
  float trousers;
  float shoes;
  float skin;
  float hair;
};

constexpr std::array<Clothes, 4> kClothes{{{176.0F, 14.0F, 62.0F, 36.0F, 168.0F, 44.0F},
                                           {88.0F, 20.0F, 128.0F, 52.0F, 148.0F, 96.0F},
                                           {132.0F, 8.0F, 84.0F, 30.0F, 156.0F, 34.0F},
                                           {58.0F, 10.0F, 72.0F, 60.0F, 176.0F, 120.0F}}};

/// In the frame of a person: x where he faces, y to his left, z up; unit: his height, and across
/// his radius.
class Figure3d {
 public:
  explicit Figure3d(const Person& person)
      : turn_(Eigen::AngleAxisd(person.heading, Vector3d::UnitZ()).toRotationMatrix()),
        foot_w_(person.position.x(), person.position.y(), person.floor_m),
        scale_(person.radius_m, person.radius_m, person.height_m) {}

  void ball(const Vector3d& centre, const Vector3d& radii, float grey) {
    BodyPart part;
    part.round = true;
    part.A = radii.cwiseInverse().asDiagonal() * to_figure();
    part.c = foot_w_ + turn_ * scale_.cwiseProduct(centre);
    part.grey = grey;
    parts.push_back(part);
  }

  /// From the middle of its lower end to that of its upper, which are ellipses that lie level.
  void limb(const Vector3d& low, const Vector3d& high, double front, double side, double taper,
            float grey, float pattern) {
    BodyPart part;
    Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
    shear(0, 2) = -(high.x() - low.x()) / (high.z() - low.z());
    shear(1, 2) = -(high.y() - low.y()) / (high.z() - low.z());
    const Vector3d size(front, side, high.z() - low.z());
    part.A = size.cwiseInverse().asDiagonal() * shear * to_figure();
    part.c = foot_w_ + turn_ * scale_.cwiseProduct(low);
    part.taper = taper;
    part.grey = grey;
    part.pattern = pattern;
    parts.push_back(part);
  }

  std::vector<BodyPart> parts;

 private:
  Eigen::Matrix3d to_figure() const {
    return scale_.cwiseInverse().asDiagonal() * turn_.transpose();
  }

  Eigen::Matrix3d turn_;
  Vector3d foot_w_;
  Vector3d scale_;
};

/// Colours of bright clothes, at a body's shading.
const std::array<std::array<float, 3>, 8> kBrightClothes{{{215.0F, 45.0F, 45.0F},
                                                          {235.0F, 205.0F, 60.0F},
                                                          {45.0F, 85.0F, 215.0F},
                                                          {240.0F, 240.0F, 240.0F},
                                                          {60.0F, 160.0F, 80.0F},
                                                          {235.0F, 130.0F, 45.0F},
                                                          {120.0F, 60.0F, 150.0F},
                                                          {50.0F, 50.0F, 55.0F}}};

void dye(BodyPart& part, const Ink& colour) {
  part.grey = colour.grey;
  part.tint = colour.tint;
}

const Ink& bright_ink(int look) {
  static const std::array<Ink, 8> kInks = [] {
    std::array<Ink, 8> inks;
    for (std::size_t i = 0; i < inks.size(); ++i) inks[i] = ink(kBrightClothes[i]);
    return inks;
  }();
  return kInks[static_cast<std::size_t>(look) % kInks.size()];
}

/// A dark robot, wider below than above; its marker, when it has one, on top.
std::vector<BodyPart> robot_parts(const Person& robot) {
  Figure3d figure(robot);
  const bool marked = robot.figure == Figure::robot;
  const double deck = marked ? 0.62 : 1.0;
  figure.limb({0.0, 0.0, 0.03}, {0.0, 0.0, deck}, 1.0, 1.0, -0.1, 40.0F, 12.0F);
  figure.ball({0.0, 0.0, deck}, {0.9, 0.9, 0.02}, 58.0F);
  if (!marked) return figure.parts;
  figure.limb({0.0, 0.0, deck}, {0.0, 0.0, 0.84}, 0.5, 0.5, 0.0, 36.0F, 6.0F);
  figure.limb({0.0, 0.0, 0.84}, {0.0, 0.0, 0.98}, 0.55, 0.55, 0.0, 0.0F, 0.0F);
  const bool cyan = robot.look % 2 == 0;
  dye(figure.parts.back(), ink(cyan ? std::array<float, 3>{40.0F, 190.0F, 210.0F}
                                    : std::array<float, 3>{215.0F, 50.0F, 170.0F}));
  figure.ball({0.0, 0.0, 0.98}, {0.55, 0.55, 0.02}, 40.0F);
  return figure.parts;
}

std::vector<BodyPart> person_parts(const Person& person) {
  constexpr double kStride = 1.3;  // m, of a double step
  const Clothes& wears = kClothes[static_cast<std::size_t>(person.look) % kClothes.size()];
  const double swing = person.walking ? std::sin(2.0 * kPi * person.walked_m / kStride) : 0.0;
  Figure3d figure(person);
  for (const double side : {1.0, -1.0}) {
    const double step = 0.8 * swing * side;
    figure.ball({step + 0.18, 0.36 * side, 0.02}, {0.52, 0.20, 0.028}, wears.shoes);
    figure.limb({step, 0.34 * side, 0.03}, {0.0, 0.28 * side, 0.49}, 0.22, 0.20, 0.4,
                wears.trousers, 0.3F * wears.shirt_pattern);
    figure.limb({-0.6 * step, 0.84 * side, 0.43}, {0.0, 0.72 * side, 0.80}, 0.14, 0.14, 0.5,
                wears.shirt, wears.shirt_pattern);
    figure.ball({-0.65 * step, 0.85 * side, 0.41}, {0.16, 0.12, 0.03}, wears.skin);
  }
  figure.limb({0.0, 0.0, 0.47}, {0.0, 0.0, 0.81}, 0.42, 0.62, 0.2, wears.shirt,
              wears.shirt_pattern);
  figure.ball({0.0, 0.0, 0.81}, {0.48, 0.80, 0.045}, wears.shirt);
  figure.limb({0.0, 0.0, 0.82}, {0.06, 0.0, 0.90}, 0.22, 0.22, 0.0, wears.skin, 0.0F);
  figure.ball({0.08, 0.0, 0.920}, {0.38, 0.31, 0.068}, wears.skin);
  figure.ball({-0.02, 0.0, 0.940}, {0.40, 0.34, 0.060}, wears.hair);
  return figure.parts;
}

/// Somebody whose shirt and trousers are of two bright colours.
std::vector<BodyPart> coloured_parts(const Person& person) {
  const Clothes& wears = kClothes[static_cast<std::size_t>(person.look) % kClothes.size()];
  std::vector<BodyPart> parts = person_parts(person);
  for (BodyPart& part : parts) {
    if (part.grey == wears.shirt) dye(part, bright_ink(person.look));
    if (part.grey == wears.trousers) dye(part, bright_ink(person.look / 8));
  }
  return parts;
}

}  // namespace

std::vector<BodyPart> body_parts(const Person& person) {
  switch (person.figure) {
    case Figure::person:
      return person_parts(person);
    case Figure::coloured_person:
      return coloured_parts(person);
    case Figure::robot:
    case Figure::chassis:
      break;
  }
  return robot_parts(person);
}

}  // namespace vigia::sim

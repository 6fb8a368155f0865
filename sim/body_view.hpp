#pragma once

#include "rays.hpp"
#include "surface.hpp"

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "vigia/imaging/frame.hpp"
#include "vigia/sim/body.hpp"

namespace vigia::sim {

/// A limb: in its own coordinates q = A (p − c) the unit sphere, or the cone frustum
/// qx² + qy² = (1 + taper·qz)² with qz in [0, 1].
struct BodyPart {
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  bool round = false;
  double taper = 0.0;
  float grey = 100.0F;
  float pattern = 0.0F;                         ///< grey levels of the cloth's pattern
  std::array<float, 3> tint{1.0F, 1.0F, 1.0F};  ///< red, green, blue of grey 1; luma 1
};

/// The limbs of a person: shoes, legs, trunk, arms, neck, head and hair; or the solids of a robot.
/// All of them lie within radius_m of the figure's axis but for the feet in the middle of a long
/// stride.
std::vector<BodyPart> body_parts(const Person& person);

/// A limb as one exposure sees it.
class BodyPartView {
 public:
  BodyPartView(const BodyPart& part, const Eigen::Isometry3d& wMc, const CameraModel& model);

  /// Whole pixels round the image in a perspective picture, clipped to the frame; may be empty. In
  /// any other picture the frame.
  const imaging::Window& box() const { return box_; }
  /// Whether a ray of the box may come near enough to meet it.
  bool may_meet(const RayBox& box) const { return maximum(middle_, box) >= cos_radius_; }
  const std::array<float, 3>& tint() const { return tint_; }

  /// Where rays meet the limb nearer than inverse depth nearest[i]: takes nearest[i],
  /// sets hit[i] to 1 and grey[i].
  void paint(const Rays& rays, int count, float* nearest, float* grey, unsigned char* hit) const;

 private:
  struct Constants {
    std::array<float, 9> ray;     ///< direction in the limb's coordinates from the ray
    std::array<float, 3> origin;  ///< of the rays in the limb's coordinates
    std::array<float, 9> normal;  ///< from the limb's gradient to camera axes
    std::array<float, 3> up;      ///< the world's z in camera axes
    float taper;
    float round;  ///< 1 for a sphere, 0 for a frustum
    float grey;
    float pattern;
  };
  template <bool kPerspective>
  static void paint_row(const Constants& constants, const Rays& rays, int count, float* nearest,
                        float* grey, unsigned char* hit);
  static void paint_perspective(const Constants& constants, const Rays& rays, int count,
                                float* nearest, float* grey, unsigned char* hit);
  static void paint_any(const Constants& constants, const Rays& rays, int count, float* nearest,
                        float* grey, unsigned char* hit);

  /// Of a cone of unit rays that holds it: its axis, and the cosine of its opening.
  void enclose(const BodyPart& part, const Eigen::Isometry3d& cMw);

  Constants constants_;
  Linear middle_;
  float cos_radius_ = -2.0F;  ///< every ray
  std::array<float, 3> tint_;
  imaging::Window box_;
};

}  // namespace vigia::sim

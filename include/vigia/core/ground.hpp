#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vigia/core/pose.hpp"

namespace vigia {

/// A flat piece of ground as a map describes it: a convex polygon of the plan, level or a ramp.
struct GroundPiece {
  std::vector<Eigen::Vector2d> polygon;
  double slope = 0.0;   ///< above the horizontal, rad
  double uphill = 0.0;  ///< direction in the plan in which it rises, rad
};

/// The same with its place in the world: plan coordinates (x, y, 0) are those of frame g.
struct GroundPatch {
  std::vector<Eigen::Vector2d> polygon;  ///< counter-clockwise
  Eigen::Isometry3d wMg = Eigen::Isometry3d::Identity();
};

/// Where wheels touch the ground: ahead and behind by half of one, left and right by half of the
/// other.
struct WheelStance {
  double base_m = 0.4;
  double track_m = 0.4;
};

/// What the robot stands on: lifts a planar pose, in plan coordinates, into the world. Flat at
/// z = 0, one plane in space, or a sheet of flat pieces that is folded along level edges.
///
/// Plan coordinates of a folded sheet are metric along its slopes: the plan is the sheet laid out
/// flat. A robot that stands across a fold touches it in the four points of its stance: its frame
/// lies in their middle, its x axis points from the rear one to the front one, and its y axis as
/// near to that from the right one to the left one as a right angle allows.
class Ground {
 public:
  Ground() = default;
  /// A plane: plan coordinates (x, y) are those of frame g, its z the plane's normal.
  explicit Ground(const Eigen::Isometry3d& wMg) : wMg_(wMg) {}
  /// A folded sheet. The first piece is where its plan coordinates say; each further one is hinged
  /// to an earlier one along a level edge that both share.
  /// @throws std::invalid_argument for a piece that is not convex or hinged to no earlier one
  explicit Ground(const std::vector<GroundPiece>& pieces);

  /// The same ground under a robot with these wheels.
  Ground under(const WheelStance& stance) const;
  /// The same ground with each ramp steeper by @p steeper, rad, and what is hinged to its end
  /// higher or lower with it. Ground without ramps stays as it is.
  Ground with_steeper_ramps(double steeper) const;

  /// wMr of a robot whose wheels stand there.
  Eigen::Isometry3d place(const Pose2& pose) const {
    if (wMg_) return *wMg_ * to_isometry(pose);
    return patches_.empty() ? to_isometry(pose) : place_on_patches(pose);
  }
  /// ∂place/∂(x, y, θ) as (δp, δφ) in world axes: p + δp, Exp(δφ) · R.
  Eigen::Matrix<double, 6, 3> dplace_dpose(const Pose2& pose) const;

  /// A point so high above the ground's point p: above a plane along its normal, above a folded
  /// sheet along the vertical.
  Eigen::Vector3d lift(const Eigen::Vector2d& p, double height_m) const;
  /// The inverse of lift(): plan coordinates of a point of the world, its height the third.
  Eigen::Vector3d in_plan(const Eigen::Vector3d& p_w) const;
  /// wMl of what hangs upright on a vertical wall, from its frame in plan coordinates with heights
  /// above the ground (wall_mount()).
  Eigen::Isometry3d hang(const Eigen::Isometry3d& gMl) const;
  /// wMg of the plane under a point of the world.
  Eigen::Isometry3d frame_under(const Eigen::Vector3d& p_w) const;

  /// Whether plan and world coordinates are the same.
  bool flat() const { return !wMg_ && patches_.empty(); }
  /// Of a folded sheet; empty for any other ground.
  const std::vector<GroundPatch>& patches() const { return patches_; }
  /// The patch on which a point of the plan lies, or else the nearest one. The sheet is folded.
  std::size_t patch_at(const Eigen::Vector2d& p) const;

 private:
  struct Contacts;
  Eigen::Isometry3d place_on_patches(const Pose2& pose) const;
  Contacts contacts(const Pose2& pose) const;

  std::optional<Eigen::Isometry3d> wMg_;
  std::vector<GroundPatch> patches_;
  WheelStance stance_;
};

}  // namespace vigia

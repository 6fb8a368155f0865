#pragma once

#include <Eigen/Core>

namespace vigia::tracking {

/// A target's image at constant velocity, px and pictures.
class TargetMotion {
 public:
  explicit TargetMotion(const Eigen::Vector2d& seen) : seen_(seen) {}

  /// Where it is expected in the picture after @ref pass().
  Eigen::Vector2d predicted() const { return seen_ + unseen_ * velocity_; }
  /// How far from there it may be, for an image of @p size px: the velocity is unknown after one
  /// sight and grows old when the target is hidden.
  double reach(double size) const;
  const Eigen::Vector2d& velocity() const { return velocity_; }
  int unseen() const { return unseen_; }

  /// Another picture begins.
  void pass() { ++unseen_; }
  /// It is seen in this picture.
  void see(const Eigen::Vector2d& at);

 private:
  Eigen::Vector2d seen_;
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();
  bool moving_ = false;  ///< the velocity is known
  int unseen_ = 0;       ///< pictures since it was seen
};

}  // namespace vigia::tracking

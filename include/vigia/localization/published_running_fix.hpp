#pragma once

#include <array>

#include <Eigen/Core>

namespace vigia::localization {

/// Bais eqs. 4–8 as printed, kept to be compared with: running_fix() is what works everywhere.

enum class PublishedFixStatus {
  found,
  circles_do_not_meet,
  divides_by_zero,  ///< eq. 4, where the robot moved along Y
};

struct PublishedFix {
  PublishedFixStatus status = PublishedFixStatus::circles_do_not_meet;
  std::array<Eigen::Vector2d, 2> positions{};  ///< by the signs + and − of eq. 6
};

/// Eqs. 1–6: range @p r1 of the landmark before and @p r2 after the displacement @p d_w.
PublishedFix published_running_fix(const Eigen::Vector2d& landmark_w, double r1, double r2,
                                   const Eigen::Vector2d& d_w);

/// Eq. 7, for a corner of the yellow goal: α₁ − α₂ by arctan, which is right where the landmark's x
/// is greater than the robot's.
double published_heading_yellow(const Eigen::Vector2d& landmark_w, const Eigen::Vector2d& p_w,
                                const Eigen::Vector2d& landmark_r);

/// Eq. 8, for a corner of the blue goal, whose x is taken for zero: 180° − (α₁ + α₂).
double published_heading_blue(const Eigen::Vector2d& landmark_w, const Eigen::Vector2d& p_w,
                              const Eigen::Vector2d& landmark_r);

}  // namespace vigia::localization

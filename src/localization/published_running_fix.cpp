#include "vigia/localization/published_running_fix.hpp"

#include <cmath>

#include "vigia/core/angle.hpp"

namespace vigia::localization {

PublishedFix published_running_fix(const Eigen::Vector2d& landmark_w, double r1, double r2,
                                   const Eigen::Vector2d& d_w) {
  PublishedFix fix;
  const double xl = landmark_w.x();
  const double yl = landmark_w.y();
  const double xv = xl + d_w.x();  // the virtual landmark, eq. 2
  const double yv = yl + d_w.y();
  fix.status = PublishedFixStatus::divides_by_zero;
  if (xl == xv) return fix;
  // Eq. 4.
  const double A = (r1 * r1 - r2 * r2 + xl * xl - xv * xv + yl * yl - yv * yv) / (2.0 * (xl - xv));
  const double B = (yv - yl) / (xl - xv);
  // Eq. 5.
  const double C = B * B + 1.0;
  const double D = 2.0 * A * B - 2.0 * B * xl - 2.0 * yl;
  const double E = A * A + xl * xl - 2.0 * A * xl + yl * yl - r2 * r2;
  fix.status = PublishedFixStatus::circles_do_not_meet;
  const double discriminant = D * D - 4.0 * C * E;
  if (!(discriminant >= 0.0)) return fix;
  fix.status = PublishedFixStatus::found;
  for (std::size_t i = 0; i < 2; ++i) {
    // Eq. 6, then eq. 4.
    const double y = (-D + (i == 0 ? 1.0 : -1.0) * std::sqrt(discriminant)) / (2.0 * C);
    fix.positions.at(i) << A + B * y, y;
  }
  return fix;
}

double published_heading_yellow(const Eigen::Vector2d& landmark_w, const Eigen::Vector2d& p_w,
                                const Eigen::Vector2d& landmark_r) {
  const double alpha1 = std::atan((landmark_w.y() - p_w.y()) / (landmark_w.x() - p_w.x()));
  const double alpha2 = std::atan(landmark_r.y() / landmark_r.x());
  return wrap_angle(alpha1 - alpha2);
}

double published_heading_blue(const Eigen::Vector2d& landmark_w, const Eigen::Vector2d& p_w,
                              const Eigen::Vector2d& landmark_r) {
  const double alpha1 = std::atan((landmark_w.y() - p_w.y()) / p_w.x());
  const double alpha2 = std::atan(landmark_r.y() / landmark_r.x());
  return wrap_angle(kPi - (alpha1 + alpha2));
}

}  // namespace vigia::localization

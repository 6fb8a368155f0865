#include "tum.hpp"

#include <cmath>

#include <fmt/format.h>

namespace vigia::mission {

std::string tum_line(Stamp stamp, const Pose2& pose, const Ground& ground) {
  if (ground.flat())
    return fmt::format("{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", stamp.seconds(), pose.x,
                       pose.y, std::sin(0.5 * pose.theta), std::cos(0.5 * pose.theta));
  return tum_line(stamp, ground.place(pose));
}

std::string tum_line(Stamp stamp, const Eigen::Isometry3d& wMr) {
  const Eigen::Vector3d p = wMr.translation();
  const Eigen::Quaterniond q(wMr.linear());
  return fmt::format("{:.6f} {:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}\n", stamp.seconds(),
                     p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
}

}  // namespace vigia::mission

// Drives a simulated robot for a second and predicts the image of a disc before it.

#include <cmath>
#include <cstdio>

#include <vigia/core/landmark.hpp>
#include <vigia/localization/disc_model.hpp>
#include <vigia/sim/robot.hpp>

int main() {
  using namespace vigia;
  sim::Robot robot(sim::RobotParams{}, Pose2{}, 8.0, 1);
  robot.command({0.2, 0.0}, {});
  robot.advance(Duration::from_seconds(1.0));
  const double x = robot.truth().pose.x;

  const Landmark disc{1, wall_mount({5.0, 0.0, 1.0}, M_PI), DiscShape{0.1}};
  const Eigen::Isometry3d wMc =
      to_isometry(robot.truth().pose) * camera_in_base(HeadGeometry{}, HeadAngles{});
  const Intrinsics intrinsics;
  const auto image = localization::disc_image(disc, intrinsics, wMc);
  if (!image) return 1;
  std::printf("drove %.3f m, sees the disc at (%.1f, %.1f) px\n", x, image->u, image->v);
  return x > 0.0 && x < 0.2 && std::abs(image->u - intrinsics.u0) < 1e-6 ? 0 : 1;
}

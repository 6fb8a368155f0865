#pragma once

#include "stereo_eye.hpp"

#include <cmath>
#include <memory>
#include <optional>

#include <Eigen/Cholesky>

#include "vigia/core/config.hpp"
#include "vigia/core/random.hpp"
#include "vigia/localization/ml_fix_localizer.hpp"
#include "vigia/sim/appearance.hpp"
#include "vigia/sim/scene.hpp"
#include "vigia/sim/simulator.hpp"

namespace vigia::perception {

/// What became of one drive: of the localizer and of the bound along the same images.
struct StereoScore {
  int images = 0;   ///< pairs
  int corners = 0;  ///< in both images
  int wrong = 0;    ///< of them, off by more than 3 px and 6 σ from where the corner truly is
  int fused = 0;
  int gated = 0;
  int lost = 0;  ///< pairs of images after which the localizer was lost
  double square_m2 = 0.0;
  double square_heading = 0.0;
  double nees = 0.0;
  double bound_m2 = 0.0;
  double worst_m = 0.0;
  double odometry_m2 = 0.0;
  double square_px = 0.0;  ///< of both columns of right corners, against the true cameras
  double square_disparity_px = 0.0;
  localization::StereoErrors estimated;
};

/// The MiroSot robot on its field, driven at given rates without a pilot: simulator, pictures,
/// eyes, `ml_fix` and its bound.
struct StereoDrive {
  sim::DisturbanceParams disturbances;
  localization::StereoErrors calibration_sigma;  ///< that the robot assumes
  double start_sigma_m = 0.02;
  double start_sigma = from_deg(3.0);
  double duration_s = 60.0;
  int ticks_per_image = 5;

  StereoScore run(std::uint64_t seed) const;
};

inline StereoScore StereoDrive::run(std::uint64_t seed) const {
  constexpr double kTick_s = 0.04;
  MapReader world_reader(load_config(VIGIA_SOURCE_DIR "/config/worlds/mirosot.yaml"), "world");
  const WorldMap world = read_world_map(world_reader);
  const auto appearance = sim::read_appearance(world_reader, world);
  MapReader robot_reader(load_config(VIGIA_SOURCE_DIR "/config/robots/mirosot.yaml"), "robot");
  const sim::RobotSetup setup = sim::read_robot_setup(robot_reader);
  const Rig rig = setup.rig();
  const StereoCameras cameras = *stereo_cameras(rig);

  RandomStream random(seed, "start");
  const Pose2 told{0.0, -0.35, 0.0};
  const Pose2 start{told.x + start_sigma_m * random.normal(),
                    told.y + start_sigma_m * random.normal(), start_sigma * random.normal()};
  Prior prior{told, Eigen::Matrix3d::Zero()};
  prior.covariance.diagonal() << start_sigma_m * start_sigma_m, start_sigma_m * start_sigma_m,
      start_sigma * start_sigma;
  sim::Simulator simulator(setup, world, appearance, start, seed, disturbances);

  EyeParts parts{world.landmarks, {rig, world.ground}};
  parts.field = &*world.field;
  StereoEye left(parts);
  parts.partner = &left;
  StereoEye right(parts);

  localization::MlFixParams params;
  params.filter.pair = localization::stereo_pair(cameras);
  params.filter.lens = cameras.intrinsics;
  params.filter.calibration_sigma = calibration_sigma;
  params.filter.odometry = setup.robot.odometry;
  localization::MlFixLocalizer localizer(*world.field, params);
  localizer.reset({}, prior);
  localization::CornerFilterParams exact = params.filter;
  exact.gate = 1e12;
  exact.iterations = 1;
  exact.calibration_sigma = {};
  if (disturbances.stereo)
    exact.calibration_sigma = {disturbances.stereo->baseline, disturbances.stereo->vergence,
                               disturbances.stereo->focal};
  localization::CornerFilter bound(*world.field, exact);
  bound.reset({}, {{}, prior.covariance});

  StereoScore score;
  Pose2 dead = prior.pose;
  const int ticks = static_cast<int>(std::lround(duration_s / kTick_s));
  for (int tick = 1; tick <= ticks; ++tick) {
    // Round the middle, with a turn on the spot every twelve seconds.
    const bool turning = tick % 300 >= 240;
    simulator.robot().command(turning ? BaseRates{0.0, 2.0, 0.0} : BaseRates{0.2, 0.571, 0.0}, {});
    const Pose2 before = simulator.robot().truth().pose;
    simulator.advance(Duration::from_seconds(kTick_s));
    const sim::RobotTruth& truth = simulator.robot().truth();
    const OdometryIncrement u = simulator.robot().read_odometry();
    dead = move(dead, u);
    localizer.predict(u);
    bound.relinearise(before);
    bound.predict(chord_increment(before, truth.pose, wrap_angle(truth.pose.theta - before.theta),
                                  u.from, u.to));
    if (tick % ticks_per_image != 0) continue;

    ++score.images;
    Observation seen;
    for (const CameraId id : {cameras.left, cameras.right}) {
      Shot shot;
      shot.stamp = truth.stamp;
      shot.camera = id;
      shot.model = cameras.intrinsics;
      const auto frame = simulator.expose(id);
      auto observed = (id == cameras.left ? left : right).observe({*frame, shot}, {}, std::nullopt);
      if (!observed.empty()) seen = observed.front();
    }
    const auto& pair = std::get<StereoObservation>(seen);
    score.corners += static_cast<int>(pair.corners.size());
    for (const StereoCorner& corner : pair.corners) {
      const Eigen::Vector2d place = *goal_corner_place(*world.field, corner.corner);
      Eigen::Vector2d error;
      for (const bool is_left : {true, false}) {
        const CameraId id = is_left ? cameras.left : cameras.right;
        sim::CameraErrors errors(disturbances, seed, id);
        if (disturbances.stereo) errors.draw_pair(*disturbances.stereo, seed, is_left ? 1.0 : -1.0);
        const Eigen::Isometry3d rMc = mounted_camera(errors.true_mount(rig.at(id)), HeadAngles{});
        const auto uv = project(simulator.true_model(id),
                                Eigen::Vector3d((world.ground.place(truth.pose) * rMc).inverse() *
                                                Eigen::Vector3d(place.x(), place.y(), 0.025)));
        error[is_left ? 0 : 1] =
            uv ? (is_left ? corner.left_uv : corner.right_uv).x() - uv->x() : 1e3;
      }
      if (error.cwiseAbs().maxCoeff() > 3.0) {
        ++score.wrong;
        continue;
      }
      score.square_px += 0.5 * error.squaredNorm();
      score.square_disparity_px += std::pow(error[0] - error[1], 2);
    }
    const auto update = localizer.update(seen);
    if (update.status == localization::UpdateStatus::fused) {
      ++score.fused;
      bound.relinearise(truth.pose);
      bound.update(pair.corners);
    }
    score.gated += update.status == localization::UpdateStatus::gated ? 1 : 0;
    const Belief& belief = localizer.belief();
    score.lost += belief.status == BeliefStatus::tracking ? 0 : 1;
    const Eigen::Vector3d e = difference(belief.pose, truth.pose);
    score.square_m2 += e.head<2>().squaredNorm();
    score.square_heading += e.z() * e.z();
    score.nees += e.dot(belief.covariance.ldlt().solve(e)) / 3.0;
    score.bound_m2 += bound.belief().covariance.topLeftCorner<2, 2>().trace();
    score.worst_m = std::max(score.worst_m, e.head<2>().norm());
    score.odometry_m2 += difference(dead, truth.pose).head<2>().squaredNorm();
  }
  score.estimated = localizer.calibration();
  return score;
}

}  // namespace vigia::perception

#include "vigia/localization/measurement_model.hpp"

#include "localization/points_drive.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace vigia::localization {
namespace {

const Pose2 kModelTruth{4.0, 3.0, 0.2};

MeasurementParams coarse() {
  MeasurementParams params;
  params.sensor.reading_angle = from_deg(0.05);
  params.centre_floor_px = 0.01;
  params.size_floor = 1e-4;
  return params;
}

MeasurementModel room_model(const LandmarkMap& map, const MeasurementParams& params = coarse()) {
  return MeasurementModel(map, {}, params, test::room_plan());
}

/// Disc 4 and pattern 4 of the room as seen from kModelTruth, half a look's bias off.
EllipseObservation ellipse_of_4() {
  RandomStream random(3, "ellipse");
  const Landmark landmark = *test::room_landmarks().find(4);
  const LookBias bias{0.002, -0.003, 0.002};
  const auto shot = test::aimed_shot(landmark, {}, kModelTruth, bias, 1, {});
  return test::observe(landmark, shot, {}, kModelTruth, bias, 0.0, 0.05, random);
}

PointsObservation points_of_4() {
  RandomStream random(3, "points");
  const Landmark landmark = *test::room_points().find(4);
  const LookBias bias{0.002, -0.003, 0.002};
  const auto shot = test::aimed_shot(*test::room_landmarks().find(4), {}, kModelTruth, bias, 1, {});
  return test::observe_points(landmark, shot, {}, to_isometry(kModelTruth), bias, 0.0, 0.05,
                              random);
}

LookState state_at(const Pose2& pose) {
  const Eigen::Vector3d sigma(0.05, 0.05, from_deg(1.0));
  LookState state = initial_state({}, {pose, sigma.cwiseAbs2().asDiagonal()}, coarse().sensor);
  state.look = 1;
  return state;
}

/// Gaussian log density by the dense formula.
double log_density(const Eigen::VectorXd& r, const Eigen::MatrixXd& covariance) {
  const double size = static_cast<double>(r.size());
  return -0.5 * (r.dot(covariance.inverse() * r) + std::log(covariance.determinant()) +
                 size * std::log(2.0 * kPi));
}

/// d f / d(pan, tilt, log focal) by central differences.
template <typename F>
Eigen::MatrixXd bias_differences(const F& f) {
  constexpr double h = 1e-6;
  const Eigen::VectorXd at = f(LookBias{});
  Eigen::MatrixXd J(at.size(), 3);
  J.col(0) = (f(LookBias{h, 0.0, 0.0}) - f(LookBias{-h, 0.0, 0.0})) / (2.0 * h);
  J.col(1) = (f(LookBias{0.0, h, 0.0}) - f(LookBias{0.0, -h, 0.0})) / (2.0 * h);
  J.col(2) = (f(LookBias{0.0, 0.0, h}) - f(LookBias{0.0, 0.0, -h})) / (2.0 * h);
  return J;
}

/// The covariance of pixels @p R with the head's errors added, J of (pan, tilt, log focal).
Eigen::MatrixXd with_readings(const Eigen::MatrixXd& R, const Eigen::MatrixXd& J,
                              const SensorNoise& noise) {
  Eigen::Matrix3d errors = look_covariance(noise);
  errors(0, 0) += noise.reading_angle * noise.reading_angle;
  errors(1, 1) += noise.reading_angle * noise.reading_angle;
  return R + J * errors * J.transpose();
}

TEST(MeasurementModel, ADiscIsLinearisedAsFiniteDifferencesHaveIt) {
  const MeasurementModel model = room_model(test::room_landmarks());
  const auto match = model.match(ellipse_of_4(), *model.map().find(4));
  ASSERT_TRUE(match);
  const auto y_at = [&](const Vector6& x) {
    Eigen::Vector3d y;
    model.linearise(*match, x, [&](const auto& seen) { y = seen.y.template head<3>(); });
    return y;
  };
  const Vector6 x = state_vector({4.02, 2.97, 0.21}, {0.001, 0.001, -0.001});
  Eigen::Matrix<double, 3, 6> H;
  model.linearise(*match, x, [&](const auto& seen) { H = seen.H.template topRows<3>(); });
  for (int i = 0; i < 6; ++i) {
    constexpr double h = 1e-6;
    const Eigen::Vector3d slope =
        (y_at(x - h * Vector6::Unit(i)) - y_at(x + h * Vector6::Unit(i))) / (2.0 * h);
    EXPECT_LT((slope - H.col(i)).norm(), 1e-5 * (1.0 + H.col(i).norm())) << i;
  }
}

TEST(MeasurementModel, ALensThatDoesNotZoomHasNoErrorOfItsFocalLengthAndAFixedCameraNoErrorAtAll) {
  const auto biases_of = [](const CameraMount& mount, const Optics& optics) {
    Camera camera;
    camera.mount = mount;
    camera.optics = optics;
    return MeasurementModel(test::room_landmarks(), {Rig{{camera}}, {}}, coarse()).look_biases(0);
  };
  const Optics lens = CameraModel{Intrinsics{}};
  EXPECT_TRUE(biases_of(HeadGeometry{}, ZoomCalibration{}).isApprox(Eigen::Array3d(1, 1, 1)));
  EXPECT_TRUE(biases_of(HeadGeometry{}, lens).isApprox(Eigen::Array3d(1, 1, 0)));
  EXPECT_TRUE(biases_of(FixedMount{}, ZoomCalibration{}).isZero());
  EXPECT_TRUE(biases_of(FixedMount{}, lens).isZero());
}

TEST(MeasurementModel, TheLikelihoodOfADiscIsTheGaussianWithTheHeadsErrorsMarginalised) {
  const MeasurementModel model = room_model(LandmarkMap({*test::room_landmarks().find(4)}));
  const EllipseObservation seen = ellipse_of_4();
  const Pose2 pose{4.01, 2.99, 0.203};
  const auto image = [&](const LookBias& bias) -> Eigen::VectorXd {
    return predict_disc(*model.map().find(4), seen.shot, {}, pose, bias)->z;
  };
  Eigen::Matrix3d R = measured_disc_covariance(seen);
  R.diagonal() += Eigen::Vector3d(1e-4, 1e-4, 1e-8);
  const double expected =
      log_density(measured_disc(seen) - image({}),
                  with_readings(R, bias_differences(image), model.params().sensor));
  EXPECT_NEAR(*model.log_likelihood(seen, pose), expected, 1e-6 * std::abs(expected));
}

TEST(MeasurementModel, TheLikelihoodOfPointsIsThatOfAllPixelsWithTheHeadsErrorsMarginalised) {
  const MeasurementModel model = room_model(test::room_points());
  const PointsObservation seen = points_of_4();
  const Landmark& landmark = *model.map().find(4);
  const Pose2 pose{4.002, 2.999, 0.201};
  const auto image = [&](const LookBias& bias) -> Eigen::VectorXd {
    const HeadAngles head{seen.shot.head.pan + bias.pan, seen.shot.head.tilt + bias.tilt};
    Intrinsics lens = pinhole(seen.shot);
    lens.px *= std::exp(bias.log_focal);
    lens.py *= std::exp(bias.log_focal);
    const Eigen::Isometry3d wMc = to_isometry(pose) * camera_in_base(HeadGeometry{}, head);
    Eigen::VectorXd uv(2 * static_cast<Eigen::Index>(seen.points.size()));
    Eigen::Index i = 0;
    for (const LandmarkPoint& point : landmark_points(landmark)) {
      uv.segment<2>(i) = predict_point(point, lens, wMc.inverse() * landmark.wMl)->uv;
      i += 2;
    }
    return uv;
  };
  const auto rows = 2 * static_cast<Eigen::Index>(seen.points.size());
  Eigen::VectorXd uv(rows);
  for (Eigen::Index i = 0; i < rows / 2; ++i)
    uv.segment<2>(2 * i) = seen.points[static_cast<std::size_t>(i)].uv;
  const Eigen::MatrixXd R = (0.05 * 0.05 + 0.01 * 0.01) * Eigen::MatrixXd::Identity(rows, rows);
  const double expected =
      log_density(uv - image({}), with_readings(R, bias_differences(image), model.params().sensor));
  EXPECT_NEAR(*model.log_likelihood(seen, pose), expected, 1e-5 * std::abs(expected));
}

TEST(MeasurementModel, ThereIsNoLikelihoodWhereNoLandmarkHasAnImage) {
  const LandmarkMap one({test::disc(1, 4.2, 7.0, 1.6, -90.0)});
  EXPECT_FALSE(room_model(one).log_likelihood(ellipse_of_4(), {4.0, 3.0, kPi}));
  // Behind the partition at x = 6.
  const LandmarkMap hidden({test::disc(1, 4.2, 7.0, 1.6, 0.0)});
  const MeasurementModel open(hidden, {}, coarse());
  const EllipseObservation seen = ellipse_of_4();
  const Pose2 beyond{7.5, 6.6, 1.7};
  EXPECT_TRUE(open.log_likelihood(seen, beyond));
  EXPECT_FALSE(room_model(hidden).log_likelihood(seen, beyond));
}

TEST(MeasurementModel, TheLikelihoodIsGreatestAboutTheTruth) {
  const MeasurementModel discs = room_model(test::room_landmarks());
  const MeasurementModel points = room_model(test::room_points());
  for (const Eigen::Vector3d& off : {Eigen::Vector3d(0.3, 0.0, 0.0), Eigen::Vector3d(0.0, 0.3, 0.0),
                                     Eigen::Vector3d(0.0, 0.0, 0.1)}) {
    const Pose2 away = Pose2::from_vector(kModelTruth.vector() + off);
    EXPECT_GT(*discs.log_likelihood(ellipse_of_4(), kModelTruth),
              *discs.log_likelihood(ellipse_of_4(), away) + 3.0);
    EXPECT_GT(*points.log_likelihood(points_of_4(), kModelTruth),
              *points.log_likelihood(points_of_4(), away) + 3.0);
  }
}

TEST(MeasurementModel, AssociatesAnyKindWithTheLandmarkThatItShows) {
  for (const auto& [map, observation] :
       {std::pair<LandmarkMap, Observation>{test::room_landmarks(), ellipse_of_4()},
        std::pair<LandmarkMap, Observation>{test::room_points(), points_of_4()}}) {
    const Association found = room_model(map).associate(observation, state_at({4.03, 2.98, 0.207}));
    EXPECT_EQ(found.result.status, UpdateStatus::fused);
    EXPECT_EQ(found.result.landmark, 4);
    ASSERT_TRUE(found.match);
    EXPECT_EQ(shot_of(*found.match).look, 1);
  }
}

TEST(MeasurementModel, ADiscIsNoMatchForPointsNorAPatternForAnEllipse) {
  const MeasurementModel model = room_model(test::room_landmarks());
  EXPECT_FALSE(model.match(points_of_4(), *test::room_landmarks().find(4)));
  EXPECT_FALSE(model.match(ellipse_of_4(), *test::room_points().find(4)));
}

TEST(MeasurementModel, WithoutTheSizeADiscTellsTwoDirectionsOnly) {
  MeasurementParams params = coarse();
  params.use_size = false;
  const MeasurementModel model = room_model(test::room_landmarks(), params);
  const auto match = model.match(ellipse_of_4(), *model.map().find(4));
  ASSERT_TRUE(match);
  model.linearise(*match, state_vector(kModelTruth),
                  [](const auto& seen) { EXPECT_GT(seen.R(2, 2), 1e5); });
}

}  // namespace
}  // namespace vigia::localization

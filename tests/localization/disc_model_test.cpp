#include "vigia/localization/disc_model.hpp"

#include "localization/room.hpp"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace vigia::localization {
namespace {

using test::disc;

/// Centre and ln √(ab) of the region that a fine polygon through the disc's rim encloses: the
/// moments of the bent shape itself, whatever lens it was seen through.
struct Region {
  Eigen::Vector2d centroid;
  double log_size;
};

Region traced_region(const Landmark& landmark, const Intrinsics& intrinsics,
                     const Eigen::Isometry3d& wMc) {
  constexpr int kPoints = 20000;
  const auto rim = [&](int i) {
    const double t = 2.0 * kPi * i / kPoints;
    const double R = *disc_radius(landmark);
    const Eigen::Vector3d p_w = landmark.wMl * Eigen::Vector3d(R * cos(t), R * sin(t), 0.0);
    return *project(intrinsics, wMc.inverse() * p_w);
  };
  const Eigen::Vector2d origin = rim(0);
  double twice_area = 0.0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d a = rim(i) - origin;
    const Eigen::Vector2d b = rim(i + 1) - origin;
    const double cross = a.x() * b.y() - a.y() * b.x();
    twice_area += cross;
    moment += cross * (a + b);
  }
  return {origin + moment / (3.0 * twice_area), 0.5 * std::log(0.5 * std::abs(twice_area) / kPi)};
}

/// Centre and axes of the conic through projected rim points (exact without distortion).
Ellipse fitted_conic(const Landmark& landmark, const Intrinsics& intrinsics,
                     const Eigen::Isometry3d& wMc) {
  constexpr int kPoints = 20000;
  const Ellipse guess = *disc_image(landmark, intrinsics, wMc);
  Eigen::Matrix<double, Eigen::Dynamic, 5> rows(kPoints, 5);
  for (int i = 0; i < kPoints; ++i) {
    const double t = 2.0 * kPi * i / kPoints;
    const double R = *disc_radius(landmark);
    const Eigen::Vector3d p_w = landmark.wMl * Eigen::Vector3d(R * cos(t), R * sin(t), 0.0);
    const Eigen::Vector2d d =
        (*project(intrinsics, wMc.inverse() * p_w) - Eigen::Vector2d(guess.u, guess.v)) / guess.a;
    rows.row(i) << d.x() * d.x(), d.x() * d.y(), d.y() * d.y(), d.x(), d.y();
  }
  const Eigen::Matrix<double, 5, 1> q =
      rows.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(kPoints));
  Eigen::Matrix2d A;
  A << q(0), 0.5 * q(1), 0.5 * q(1), q(2);
  const Eigen::Vector2d centre = -0.5 * A.inverse() * q.tail<2>();
  const double level = 1.0 + centre.dot(A * centre);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(A / level);
  const Eigen::Vector2d major = axes.eigenvectors().col(0);
  return {guess.u + guess.a * centre.x(), guess.v + guess.a * centre.y(),
          guess.a / std::sqrt(axes.eigenvalues()(0)), guess.a / std::sqrt(axes.eigenvalues()(1)),
          std::atan(major.y() / major.x())};
}

/// wMc of a camera at @p eye that looks along yaw and pitch.
Eigen::Isometry3d camera_at(const Eigen::Vector3d& eye, double yaw, double pitch) {
  HeadGeometry geometry;
  geometry.mount_r = eye;
  return camera_in_base(geometry, {yaw, pitch});
}

struct Case {
  Landmark landmark;
  Shot shot;
  Pose2 pose;
  LookBias bias;
};

/// A random view of a disc on the wall x = 4, somewhere in the image.
Case random_case(RandomStream& random, double kdu) {
  Case c;
  c.landmark = disc(1, 4.0, 0.0, random.uniform(0.5, 2.0), 180.0);
  c.pose = {random.uniform(-2.0, 2.5), random.uniform(-2.0, 2.0), random.uniform(-kPi, kPi)};
  c.bias = {random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01)};
  c.shot = test::aimed_shot(c.landmark, {}, c.pose, c.bias, 1, {});
  std::get<Intrinsics>(c.shot.model).kdu = kdu;
  const double offset = 100.0 / pinhole(c.shot).px;
  c.shot.head.pan += random.uniform(-2.0 * offset, 2.0 * offset);
  c.shot.head.tilt += random.uniform(-offset, offset);
  return c;
}

Eigen::Vector3d predicted_z(const Case& c, const RigOnGround& on_ground,
                            const Eigen::Matrix<double, 6, 1>& step) {
  const Pose2 pose{c.pose.x + step(0), c.pose.y + step(1), c.pose.theta + step(2)};
  const LookBias bias{c.bias.pan + step(3), c.bias.tilt + step(4), c.bias.log_focal + step(5)};
  return predict_disc(c.landmark, c.shot, on_ground, pose, bias)->z;
}

void expect_jacobians_match(const Case& c, const RigOnGround& on_ground) {
  const auto predicted = predict_disc(c.landmark, c.shot, on_ground, c.pose, c.bias);
  ASSERT_TRUE(predicted);
  Eigen::Matrix<double, 3, 6> analytic;
  analytic << predicted->dz_dpose, predicted->dz_dbias;
  constexpr double kStep = 1e-5;  // central differences: truncation ~1e-10, rounding ~1e-9 relative
  for (Eigen::Index i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Zero();
    step(i) = kStep;
    const Eigen::Vector3d numeric =
        (predicted_z(c, on_ground, step) - predicted_z(c, on_ground, -step)) / (2.0 * kStep);
    for (Eigen::Index row = 0; row < 3; ++row)
      EXPECT_NEAR(analytic(row, i), numeric(row), 1e-6 * (1.0 + std::abs(numeric(row))))
          << "row " << row << ", column " << i;
  }
}

TEST(DiscModel, JacobiansEqualFiniteDifferencesAtTheIdentity) {
  Case c;
  c.landmark = disc(1, 3.0, 0.0, 1.0, 180.0);
  expect_jacobians_match(c, {});
}

TEST(DiscModel, JacobiansEqualFiniteDifferencesAtTinyOffsets) {
  Case c;
  c.landmark = disc(1, 3.0, 0.0, 1.0, 180.0);
  c.pose = {1e-7, -1e-7, 1e-7};
  c.bias = {1e-7, -1e-7, 1e-7};
  std::get<Intrinsics>(c.shot.model).kdu = 1e-7;
  expect_jacobians_match(c, {});
}

TEST(DiscModel, JacobiansEqualFiniteDifferencesAtRandomViews) {
  RandomStream random(1, "jacobians");
  HeadGeometry geometry;
  geometry.mount_yaw = 0.3;
  geometry.camera_offset_h = {0.05, -0.02, 0.03};
  for (int i = 0; i < 200; ++i) {
    const double kdu = i % 3 == 0 ? 0.0 : random.uniform(-0.05, 0.1);
    expect_jacobians_match(random_case(random, kdu), {head_rig(geometry), {}});
  }
}

TEST(DiscModel, JacobiansEqualFiniteDifferencesOnASlope) {
  RandomStream random(3, "slope");
  // The ground turns about the spot where the robot stands, so that the disc stays in view.
  const Eigen::Matrix3d tilt =
      Eigen::AngleAxisd(0.05, Eigen::Vector3d(0.6, 0.8, 0.0)).toRotationMatrix();
  for (int i = 0; i < 100; ++i) {
    const Case c = random_case(random, 0.03);
    const Eigen::Vector3d stand(c.pose.x, c.pose.y, 0.0);
    Eigen::Isometry3d wMg = Eigen::Isometry3d::Identity();
    wMg.linear() = tilt;
    wMg.translation() = stand - tilt * stand;
    expect_jacobians_match(c, {Rig{}, Ground(wMg)});
  }
}

TEST(DiscModel, OfAFixedCameraIsBlindToTheHead) {
  Case c;
  c.landmark = disc(1, 3.0, 0.0, 1.0, 180.0);
  FixedMount mount;
  mount.rMc = camera_in_base(HeadGeometry{}, {0.05, -0.02});
  Camera camera;
  camera.mount = mount;
  const RigOnGround on_ground{{{camera}}, {}};
  expect_jacobians_match(c, on_ground);
  const auto predicted = predict_disc(c.landmark, c.shot, on_ground, c.pose, c.bias);
  ASSERT_TRUE(predicted);
  EXPECT_TRUE(predicted->dz_dbias.leftCols<2>().isZero());
}

TEST(DiscModel, ImageEqualsTheConicThroughTheProjectedRim) {
  RandomStream random(2, "conic");
  for (int i = 0; i < 20; ++i) {
    Case c = random_case(random, 0.0);
    const Eigen::Isometry3d wMc = to_isometry(c.pose) * camera_in_base({}, c.shot.head);
    const auto image = disc_image(c.landmark, pinhole(c.shot), wMc);
    ASSERT_TRUE(image);
    const Ellipse fit = fitted_conic(c.landmark, pinhole(c.shot), wMc);
    EXPECT_NEAR(image->u, fit.u, 1e-7);
    EXPECT_NEAR(image->v, fit.v, 1e-7);
    EXPECT_NEAR(image->a, fit.a, 1e-7);
    EXPECT_NEAR(image->b, fit.b, 1e-7);
    EXPECT_NEAR(std::sin(image->psi - fit.psi), 0.0, 1e-5);
  }
}

TEST(DiscModel, CentreIsNotTheProjectionOfTheDiscsCentre) {
  // PAPERS: about 1.6 px at 59 px radius, here 1.05 m away and 45° oblique.
  const Landmark landmark = disc(1, 1.05, 0.0, 1.0, 225.0, 0.0885);
  const Eigen::Isometry3d wMc = camera_at({0.0, 0.0, 1.0}, 0.0, 0.0);
  const Intrinsics intrinsics;
  const auto image = disc_image(landmark, intrinsics, wMc);
  ASSERT_TRUE(image);
  EXPECT_NEAR(image->a, 59.0, 1.0);
  const Eigen::Vector2d centre = *project(intrinsics, wMc.inverse() * landmark.centre_w());
  const double apart = std::hypot(image->u - centre.x(), image->v - centre.y());
  EXPECT_GT(apart, 1.5);
  EXPECT_LT(apart, 3.0);
  const Region region = traced_region(landmark, intrinsics, wMc);
  EXPECT_NEAR(image->u, region.centroid.x(), 1e-5);
  EXPECT_NEAR(image->v, region.centroid.y(), 1e-5);
}

TEST(DiscModel, LensCurvatureIsModelledToAHundredthOfAPixel) {
  for (const double kdu : {-0.05, 0.05}) {
    for (const double yaw : {0.0, 0.2, -0.37}) {
      // 60 px of radius, up to 280 px off axis.
      const Landmark landmark = disc(1, 1.4, 0.0, 1.1, 200.0, 0.12);
      Intrinsics intrinsics;
      intrinsics.kdu = kdu;
      const Eigen::Isometry3d wMc = camera_at({0.0, 0.0, 1.0}, yaw, -0.05);
      const auto image = disc_image(landmark, intrinsics, wMc);
      ASSERT_TRUE(image);
      const Region region = traced_region(landmark, intrinsics, wMc);
      EXPECT_NEAR(image->u, region.centroid.x(), 0.015);
      EXPECT_NEAR(image->v, region.centroid.y(), 0.015);
      // The area's correction is kdu (a² + b²) / (2 f²) ≈ 4e-4; the next order is 20 kdu r² < 0.2
      // of it.
      const double f = intrinsics.px;
      const double correction =
          0.5 * std::abs(kdu) * (image->a * image->a + image->b * image->b) / (f * f);
      EXPECT_NEAR(0.5 * std::log(image->a * image->b), region.log_size, 0.2 * correction);
    }
  }
}

TEST(DiscModel, PredictionAgreesWithTheImage) {
  RandomStream random(3, "agreement");
  for (int i = 0; i < 50; ++i) {
    const Case c = random_case(random, 0.05);
    const auto predicted = predict_disc(c.landmark, c.shot, {}, c.pose, c.bias);
    Intrinsics intrinsics = pinhole(c.shot);
    intrinsics.px *= std::exp(c.bias.log_focal);
    intrinsics.py *= std::exp(c.bias.log_focal);
    const HeadAngles head{c.shot.head.pan + c.bias.pan, c.shot.head.tilt + c.bias.tilt};
    EllipseObservation seen;
    seen.ellipse =
        *disc_image(c.landmark, intrinsics, to_isometry(c.pose) * camera_in_base({}, head));
    ASSERT_TRUE(predicted);
    EXPECT_TRUE(predicted->z.isApprox(measured_disc(seen), 1e-10));
  }
}

TEST(DiscModel, HasNoImageBehindTheCameraOrFromBehindOrEdgeOn) {
  const Intrinsics intrinsics;
  const Eigen::Isometry3d wMc = camera_at({0.0, 0.0, 1.0}, 0.0, 0.0);
  EXPECT_TRUE(disc_image(disc(1, 2.0, 0.0, 1.0, 180.0), intrinsics, wMc));
  EXPECT_FALSE(disc_image(disc(1, -2.0, 0.0, 1.0, 0.0), intrinsics, wMc));
  EXPECT_FALSE(disc_image(disc(1, 2.0, 0.0, 1.0, 0.0), intrinsics, wMc));
  EXPECT_FALSE(disc_image(disc(1, 2.0, 0.0, 1.0, 90.0), intrinsics, wMc));
  EXPECT_FALSE(disc_image(disc(1, 0.05, 0.0, 1.0, 135.0), intrinsics, wMc));  // cut by the lens
}

TEST(DiscModel, SizeOfAFrontalDiscIsUnbiasedUnlikeItsLongerAxis) {
  // Frontal view: both axes equal; noise of 0.1 px on each, ordered as a tracker orders them.
  constexpr int kDraws = 20000;
  constexpr double kSigma = 0.1;
  RandomStream random(4, "frontal");
  double bias_size = 0.0;
  double bias_longer = 0.0;
  double squares = 0.0;
  EllipseObservation seen;
  seen.covariance *= kSigma * kSigma;
  for (int i = 0; i < kDraws; ++i) {
    const double first = 24.0 + kSigma * random.normal();
    const double second = 24.0 + kSigma * random.normal();
    seen.ellipse.a = std::max(first, second);
    seen.ellipse.b = std::min(first, second);
    const double error = measured_disc(seen)(2) - std::log(24.0);
    bias_size += error / kDraws;
    bias_longer += std::log(seen.ellipse.a / 24.0) / kDraws;
    squares += error * error / kDraws;
  }
  const double variance = measured_disc_covariance(seen)(2, 2);
  const double standard_error = std::sqrt(variance / kDraws);
  EXPECT_LT(std::abs(bias_size), 4.0 * standard_error);  // k = 4
  EXPECT_GT(std::abs(bias_longer), 50.0 * standard_error);
  EXPECT_NEAR(squares / variance, 1.0, 4.0 * std::sqrt(2.0 / kDraws));  // NEES, k = 4
}

}  // namespace
}  // namespace vigia::localization

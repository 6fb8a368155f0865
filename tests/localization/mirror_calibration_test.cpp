#include "vigia/localization/mirror_calibration.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/config.hpp"
#include "vigia/core/random.hpp"

namespace vigia::localization {
namespace {

FieldMap calibration_field() {
  MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/fields/12x8.yaml"), "field");
  return read_field_map(reader.map("field"));
}

MirrorMount nominal_mount() {
  MirrorMount mount;
  mount.mirror.px = 204.0;
  mount.mirror.py = -204.0;
  mount.mirror.max_angle = from_deg(99.0);
  mount.rMc.linear() = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  mount.rMc.translation() = Eigen::Vector3d(0.0, 0.0, 0.75);
  return mount;
}

/// Where a pixel's ray meets the floor, field frame.
std::optional<Eigen::Vector2d> seen_at(const MirrorMount& mount, const Pose2& pose,
                                       const Eigen::Vector2d& uv) {
  const auto direction = ray(mount.mirror, uv);
  if (!direction) return std::nullopt;
  const Eigen::Vector3d d = mount.rMc.linear() * *direction;
  if (d.z() > -0.08) return std::nullopt;  // beyond 9 m
  const Eigen::Vector3d p = mount.rMc.translation() - d * (mount.rMc.translation().z() / d.z());
  return Eigen::Vector2d((to_isometry(pose) * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>());
}

/// The points that rays 3° apart meet on the lines, their middles with an error of @p sigma_px.
MirrorPicture picture_of(const FieldMap& field, const MirrorMount& mount, const Pose2& pose,
                         double sigma_px, RandomStream& random) {
  constexpr double kStep = 0.05;  // px
  MirrorPicture picture;
  for (int k = 0; k < 120; ++k) {
    const double angle = 2.0 * kPi * k / 120;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d middle(319.5, 239.5);
    double entered = 0.0;  // where the ray came upon paint; 0: it lies on none
    bool from_bare = false;
    for (double r = 40.0; r < 235.0; r += kStep) {
      const auto p = seen_at(mount, pose, middle + r * along);
      if (!p) break;
      bool paint = false;
      for (const FieldLine& line : field.lines) {
        const LineOffset off = line_offset(line, *p);
        paint = paint || (std::abs(off.distance_m) <= 0.5 * line.width_m && off.inside_m > 0.0);
      }
      if (paint && entered <= 0.0 && from_bare) entered = r - 0.5 * kStep;
      from_bare = from_bare || !paint;
      if (paint || entered <= 0.0) continue;
      const double error = sigma_px * random.normal();
      // Where lines meet a run is wider than a line is.
      if (r - entered < 12.0)
        picture.points.push_back({middle + (entered + error) * along,
                                  middle + (r - 0.5 * kStep + error) * along, sigma_px});
      entered = 0.0;
    }
  }
  return picture;
}

MirrorVector drawn_change(RandomStream& random) {
  MirrorVector change = MirrorVector::Zero();
  change[0] = 0.01 * random.normal();
  change[1] = random.normal();
  change[2] = random.normal();
  change[3] = from_deg(0.5) * random.normal();
  change[4] = from_deg(0.5) * random.normal();
  return change;
}

std::vector<MirrorPicture> pictures_of(const FieldMap& field, const MirrorMount& mount, int count,
                                       RandomStream& random) {
  std::vector<MirrorPicture> pictures;
  for (int i = 0; i < count; ++i) {
    const Pose2 pose{random.uniform(-4.0, 4.0), random.uniform(-3.0, 3.0),
                     random.uniform(-kPi, kPi)};
    pictures.push_back(picture_of(field, mount, pose, 0.1, random));
  }
  return pictures;
}

/// Squared error over covariance of the five parameters that are estimated.
double nees(const MirrorCalibration& calibration, const MirrorVector& truth) {
  const Eigen::Matrix<double, 5, 1> error = (calibration.change - truth).head<5>();
  return error.dot(calibration.covariance.topLeftCorner<5, 5>().ldlt().solve(error));
}

TEST(MirrorCalibration, ErrsByAsMuchAsItsCovarianceSays) {
  constexpr int kDraws = 24;
  const FieldMap field = calibration_field();
  RandomStream random(11, "mirrors");
  double sum = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const MirrorVector truth = drawn_change(random);
    const auto pictures = pictures_of(field, changed(nominal_mount(), truth), 3, random);
    const MirrorCalibration found = calibrate_mirror(field, nominal_mount(), pictures);
    ASSERT_EQ(found.status, MirrorCalibrationStatus::converged) << draw;
    for (const MirrorPictureFit& fit : found.pictures) EXPECT_TRUE(fit.used) << draw;
    EXPECT_LT(found.sigma(MirrorParameter::tilt_x), from_deg(0.05));
    EXPECT_LT(found.sigma(MirrorParameter::focal), 0.002);
    EXPECT_NEAR(found.misfit, 1.0, 0.35);
    sum += nees(found, truth) / 5.0;
  }
  // χ² of 5 · 24 degrees of freedom: three standard errors.
  EXPECT_NEAR(sum / kDraws, 1.0, 3.0 * std::sqrt(2.0 / (5.0 * kDraws)));
}

TEST(MirrorCalibration, LeavesOutPointsThatLieOnNoLine) {
  const FieldMap field = calibration_field();
  RandomStream random(12, "clutter");
  const MirrorVector truth = drawn_change(random);
  auto pictures = pictures_of(field, changed(nominal_mount(), truth), 3, random);
  for (MirrorPicture& picture : pictures) {
    const std::size_t real = picture.points.size();
    for (std::size_t i = 0; i < real / 4; ++i) {
      const double angle = random.uniform(-kPi, kPi);
      const double r = random.uniform(60.0, 190.0);
      const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
      const Eigen::Vector2d middle(319.5, 239.5);
      picture.points.push_back({middle + r * along, middle + (r + 4.0) * along, 0.1});
    }
  }
  const MirrorCalibration found = calibrate_mirror(field, nominal_mount(), pictures);
  ASSERT_EQ(found.status, MirrorCalibrationStatus::converged);
  EXPECT_LT(nees(found, truth), 20.5);  // the 99.9th percentile of χ² of 5
  for (std::size_t i = 0; i < pictures.size(); ++i)
    EXPECT_LT(found.pictures[i].points_on(), 0.88 * static_cast<double>(pictures[i].points.size()));
}

TEST(MirrorCalibration, FindsMiddleAndTiltByRingsThatAreTheSameAllRound) {
  FieldMap rings;
  for (const double radius : {0.6, 1.2, 1.8, 2.4, 3.0})
    rings.lines.push_back(FieldLine::arc(Eigen::Vector2d::Zero(), radius, 0.0, 2.0 * kPi, 0.06));
  RandomStream random(13, "rings");
  const MirrorVector truth = drawn_change(random);
  MirrorPicture picture =
      picture_of(rings, changed(nominal_mount(), truth), {0.03, -0.02, 0.0}, 0.1, random);
  picture.near = Pose2{};
  const MirrorCalibration found = calibrate_mirror(rings, nominal_mount(), {picture});
  ASSERT_EQ(found.status, MirrorCalibrationStatus::converged);
  EXPECT_LT(nees(found, truth), 20.5);
  EXPECT_LT(found.sigma(MirrorParameter::tilt_x), from_deg(0.3));
  EXPECT_LT((found.pictures[0].pose.position() - Eigen::Vector2d(0.03, -0.02)).norm(), 0.01);
}

TEST(MirrorCalibration, EstimatesXiAndHeightWhereTheyAreOpen) {
  const FieldMap field = calibration_field();
  RandomStream random(14, "open");
  MirrorVector truth = drawn_change(random);
  truth[5] = -0.04;
  truth[6] = 0.02;
  auto pictures = pictures_of(field, changed(nominal_mount(), truth), 4, random);
  MirrorCalibrationParams params;
  params.prior_sigma[5] = 0.5;
  params.prior_sigma[6] = 0.4;
  const MirrorCalibration found = calibrate_mirror(field, nominal_mount(), pictures, params);
  ASSERT_EQ(found.status, MirrorCalibrationStatus::converged);
  const MirrorVector error = found.change - truth;
  EXPECT_LT(error.dot(found.covariance.ldlt().solve(error)), 24.3);  // 99.9 % of χ² of 7
  EXPECT_LT(found.sigma(MirrorParameter::height), 0.01);
}

TEST(MirrorCalibration, LeavesOutAPictureThatShowsAnotherPlace) {
  const FieldMap field = calibration_field();
  RandomStream random(15, "other");
  auto pictures = pictures_of(field, nominal_mount(), 2, random);
  MirrorPicture other;
  for (int i = 0; i < 80; ++i) {
    const double angle = random.uniform(-kPi, kPi);
    const double r = random.uniform(60.0, 190.0);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    other.points.push_back({Eigen::Vector2d(319.5, 239.5) + r * along,
                            Eigen::Vector2d(319.5, 239.5) + (r + 4.0) * along, 0.1});
  }
  pictures.push_back(other);
  const MirrorCalibration found = calibrate_mirror(field, nominal_mount(), pictures);
  ASSERT_EQ(found.status, MirrorCalibrationStatus::converged);
  EXPECT_TRUE(found.pictures[0].used);
  EXPECT_TRUE(found.pictures[1].used);
  EXPECT_FALSE(found.pictures[2].used);
  EXPECT_NEAR(found.change[0], 0.0, 5.0 * found.sigma(MirrorParameter::focal));
}

TEST(MirrorCalibration, IsNoneWithoutAPicture) {
  const FieldMap field = calibration_field();
  EXPECT_EQ(calibrate_mirror(field, nominal_mount(), {}).status,
            MirrorCalibrationStatus::no_picture);
  EXPECT_EQ(calibrate_mirror(field, nominal_mount(), {MirrorPicture{}}).status,
            MirrorCalibrationStatus::no_picture);
}

TEST(FloorDistance, IsThatOfAParabolicMirror) {
  MirrorCalibration calibration;
  calibration.mount = nominal_mount();
  calibration.covariance(0, 0) = 0.01 * 0.01;
  for (const double r : {20.0, 80.0, 140.0, 180.0}) {
    // r = f tan(θ/2), d = h tan θ.
    const auto distance_by = [&](double f) { return 0.75 * std::tan(2.0 * std::atan(r / f)); };
    const auto distance = floor_distance(calibration, r);
    ASSERT_TRUE(distance);
    EXPECT_NEAR(distance->distance_m, distance_by(204.0), 1e-9);
    const double by_sigma = distance_by(204.0 * 0.9999) - distance_by(204.0 * 1.0001);
    EXPECT_NEAR(distance->sigma_m, 50.0 * by_sigma, 1e-4 * distance->sigma_m);
  }
  EXPECT_FALSE(floor_distance(calibration, 210.0));
}

}  // namespace
}  // namespace vigia::localization

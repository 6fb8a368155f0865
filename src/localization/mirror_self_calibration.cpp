#include "vigia/localization/mirror_self_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vigia/core/angle.hpp"
#include "vigia/localization/normal_density.hpp"

namespace vigia::localization {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using ErrorCovariance = Eigen::Matrix<double, kMirrorErrors, kMirrorErrors>;
using PoseByErrors = Eigen::Matrix<double, 3, kMirrorErrors>;

enum MirrorError { kMirrorScale, kTiltX, kTiltY, kCentreU, kCentreV };

constexpr double kOfLineSigmas = 3.0;   // a point farther off is on no line
constexpr double kOtherLine = 0.02;     // density of another line beside the best, at most
constexpr std::size_t kFewestRows = 8;  // points that teach anything about the mirror
constexpr int kCalibrationSteps = 3;
constexpr double kElsewhere_m = 0.25;  // between the filter's place and the localizer's
constexpr double kElsewhereTurn = 0.1;

MirrorErrors initial_sigmas(const MirrorErrorParams& params) {
  MirrorErrors sigmas;
  sigmas << params.scale, params.tilt, params.tilt, params.centre_px, params.centre_px;
  return sigmas;
}

Matrix2d plane_rotation(double theta) {
  return Eigen::Rotation2Dd(theta).toRotationMatrix();
}

}  // namespace

MirrorOnRobot MirrorOnRobot::with(const MirrorErrors& errors) const {
  MirrorOnRobot camera = *this;
  camera.mirror.px *= 1.0 + errors[kMirrorScale];
  camera.mirror.py *= 1.0 + errors[kMirrorScale];
  camera.mirror.u0 += errors[kCentreU];
  camera.mirror.v0 += errors[kCentreV];
  camera.rMc.rotate(Eigen::AngleAxisd(errors[kTiltX], Vector3d::UnitX()) *
                    Eigen::AngleAxisd(errors[kTiltY], Vector3d::UnitY()));
  return camera;
}

std::optional<Vector2d> MirrorOnRobot::pixel_of(const Vector2d& p_r) const {
  return project(CameraModel{mirror},
                 rMc.inverse(Eigen::Isometry) * Vector3d(p_r.x(), p_r.y(), 0.0));
}

std::optional<FloorOfPixel> floor_of_pixel(const MirrorOnRobot& camera, const Vector2d& uv) {
  constexpr double kShallowest = 1e-3;  // rad below the horizon
  const CameraModel model = camera.mirror;
  const auto d_c = ray(model, uv);
  const auto dray_duv = ray_jacobian(model, uv);
  if (!d_c || !dray_duv) return std::nullopt;
  const Eigen::Matrix3d R = camera.rMc.linear();
  const Vector3d d = R * *d_c;
  if (d.z() > -kShallowest) return std::nullopt;
  const Vector3d& eye = camera.rMc.translation();
  // The ray meets the floor at eye + t d.
  const double t = -eye.z() / d.z();
  Eigen::Matrix<double, 2, 3> dp_dd;
  dp_dd << t, 0.0, -t * d.x() / d.z(), 0.0, t, -t * d.y() / d.z();
  const Eigen::Matrix<double, 2, 3> dp_ddc = dp_dd * R;
  const Eigen::Matrix2d dp_duv = dp_ddc * *dray_duv;
  FloorOfPixel floor;
  floor.p_r = (eye + t * d).head<2>();
  // A longer focal length, or a middle farther on, shows at a pixel what was nearer to the old
  // middle.
  floor.dp_derrors.col(kMirrorScale) =
      -dp_duv * (uv - Vector2d(camera.mirror.u0, camera.mirror.v0));
  floor.dp_derrors.col(kTiltX) = dp_ddc * Vector3d::UnitX().cross(*d_c);
  floor.dp_derrors.col(kTiltY) = dp_ddc * Vector3d::UnitY().cross(*d_c);
  floor.dp_derrors.col(kCentreU) = -dp_duv.col(0);
  floor.dp_derrors.col(kCentreV) = -dp_duv.col(1);
  return floor;
}

CorrectedScan carried(const CorrectedScan& scan_b, const Pose2& aMb, Stamp stamp) {
  CorrectedScan carried_scan = scan_b;
  carried_scan.scan = vigia::carried(scan_b.scan, aMb, stamp);
  const Matrix2d R = plane_rotation(aMb.theta);
  for (Matrix2d& covariance : carried_scan.own) covariance = R * covariance * R.transpose();
  for (auto& dp_derrors : carried_scan.dp_derrors) dp_derrors = R * dp_derrors;
  return carried_scan;
}

MirrorSelfCalibration::MirrorSelfCalibration(const FieldModel& model,
                                             const MirrorErrorParams& params,
                                             const OdometryNoise& odometry)
    : model_(&model), params_(params), odometry_(odometry) {
  P_.bottomRightCorner<kMirrorErrors, kMirrorErrors>() =
      initial_sigmas(params_).cwiseAbs2().asDiagonal();
}

void MirrorSelfCalibration::predict(const OdometryIncrement& increment) {
  const MirrorErrors drift = params_.drift * initial_sigmas(params_);
  P_.diagonal().tail<kMirrorErrors>() +=
      (increment.to - increment.from).seconds() * drift.cwiseAbs2();
  if (!placed_) return;
  const Eigen::Matrix3d F = move_jacobian_pose(pose_, increment);
  const Eigen::Matrix3d G = move_jacobian_control(pose_, increment);
  P_.topRows<3>() = (F * P_.topRows<3>()).eval();
  P_.leftCols<3>() = (P_.leftCols<3>() * F.transpose()).eval();
  P_.topLeftCorner<3, 3>() += G * control_covariance(increment, odometry_) * G.transpose();
  pose_ = move(pose_, increment);
}

CorrectedScan MirrorSelfCalibration::corrected(const FieldScan& scan,
                                               const MirrorOnRobot& camera) const {
  const MirrorOnRobot known = camera.with(errors_);
  const ErrorCovariance unknown = covariance();
  CorrectedScan corrected_scan;
  corrected_scan.scan = scan;
  corrected_scan.scan.points.clear();
  for (const FieldPoint& point : scan.points) {
    const auto uv = camera.pixel_of(point.p_r);
    const auto floor = uv ? floor_of_pixel(known, *uv) : std::nullopt;
    if (!floor) continue;
    corrected_scan.scan.points.push_back(
        {floor->p_r,
         point.covariance + floor->dp_derrors * unknown * floor->dp_derrors.transpose()});
    corrected_scan.own.push_back(point.covariance);
    corrected_scan.dp_derrors.push_back(floor->dp_derrors);
  }
  return corrected_scan;
}

/// The points that lie on one line beyond doubt, at a pose and where the errors are @p further than
/// known.
std::vector<MirrorSelfCalibration::Row> MirrorSelfCalibration::rows_of(
    const CorrectedScan& scan, const Pose2& pose, const MirrorErrors& further) const {
  const Matrix2d R = plane_rotation(pose.theta);
  const double floor_variance = model_->params().floor_m * model_->params().floor_m;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < scan.scan.points.size(); ++i) {
    const Eigen::Matrix<double, 2, kMirrorErrors> dw_derrors = R * scan.dp_derrors[i];
    const Vector2d arm = R * scan.scan.points[i].p_r + dw_derrors * further;
    std::optional<Row> row;
    double best = 0.0;
    double others = 0.0;
    for (const std::uint16_t j : model_->distance().near(pose.position() + arm)) {
      const LineOffset at = line_offset(model_->distance().lines()[j], pose.position() + arm);
      if (at.inside_m < 0.0) continue;
      const Vector2d n_r = R.transpose() * at.normal;
      Row candidate{};
      candidate.h << at.normal, at.normal.dot(Vector2d(-arm.y(), arm.x())),
          dw_derrors.transpose() * at.normal;
      candidate.offset_m = at.distance_m;
      candidate.own_variance = n_r.dot(scan.own[i] * n_r) + floor_variance;
      candidate.variance = n_r.dot(scan.scan.points[i].covariance * n_r) + floor_variance;
      candidate.believed_variance = candidate.own_variance + candidate.h.dot(P_ * candidate.h);
      const double density = normal_density(at.distance_m, candidate.believed_variance);
      others += std::min(best, density);
      if (density <= best) continue;
      best = density;
      row = candidate;
    }
    if (row && others < kOtherLine * best &&
        row->offset_m * row->offset_m < kOfLineSigmas * kOfLineSigmas * row->believed_variance)
      rows.push_back(*row);
  }
  return rows;
}

/// How a pose that is matched with one scan moves with the errors.
PoseByErrors MirrorSelfCalibration::sensitivity(const std::vector<Row>& rows) const {
  Eigen::Matrix3d pose = 1e-6 * Eigen::Matrix3d::Identity();
  PoseByErrors mixed = PoseByErrors::Zero();
  for (const Row& row : rows) {
    const Vector3d h = row.h.head<3>() / row.variance;
    pose += h * row.h.head<3>().transpose();
    mixed += h * row.h.tail<kMirrorErrors>().transpose();
  }
  return -pose.ldlt().solve(mixed);
}

/// Starts where the localizer believes itself to be, which the errors have moved.
void MirrorSelfCalibration::place(const Belief& belief, const PoseByErrors& dpose_derrors) {
  const ErrorCovariance unknown = covariance();
  placed_ = true;
  pose_ = belief.pose;
  P_.topLeftCorner<3, 3>() =
      belief.covariance + dpose_derrors * unknown * dpose_derrors.transpose();
  P_.topRightCorner<3, kMirrorErrors>() = dpose_derrors * unknown;
  P_.bottomLeftCorner<kMirrorErrors, 3>() = P_.topRightCorner<3, kMirrorErrors>().transpose();
}

bool MirrorSelfCalibration::elsewhere(const Belief& belief) const {
  const Vector3d off = difference(pose_, belief.pose);
  return off.head<2>().norm() > kElsewhere_m || std::abs(off.z()) > kElsewhereTurn;
}

void MirrorSelfCalibration::update(const CorrectedScan& scan, const Belief& belief) {
  if (belief.status != BeliefStatus::tracking) {
    placed_ = false;
    return;
  }
  const bool starts = !placed_ || elsewhere(belief);
  if (starts) place(belief, PoseByErrors::Zero());
  std::vector<Row> rows = rows_of(scan, pose_, MirrorErrors::Zero());
  if (rows.size() < kFewestRows) {
    if (starts) placed_ = false;
    return;
  }
  if (starts) {
    place(belief, sensitivity(rows));
  } else {
    const Covariance prior = P_.inverse();
    Covariance information = prior;
    State step = State::Zero();
    for (int k = 0; k < kCalibrationSteps; ++k) {
      information = prior;
      State gradient = State::Zero();
      for (const Row& row : rows) {
        const State weighted = row.h / (params_.alike_scans * row.own_variance);
        information += weighted * row.h.transpose();
        gradient -= weighted * (row.offset_m - row.h.dot(step));
      }
      step = information.ldlt().solve(gradient);
      rows = rows_of(scan, Pose2::from_vector(pose_.vector() + step.head<3>()),
                     step.tail<kMirrorErrors>());
      if (rows.size() < kFewestRows) return;
    }
    pose_ = Pose2::from_vector(pose_.vector() + step.head<3>());
    errors_ += step.tail<kMirrorErrors>();
    const Covariance posterior = information.inverse();
    P_ = 0.5 * (posterior + posterior.transpose());
  }
  const PoseByErrors dpose_derrors = sensitivity(rows);
  widening_ = dpose_derrors * covariance() * dpose_derrors.transpose();
}

}  // namespace vigia::localization

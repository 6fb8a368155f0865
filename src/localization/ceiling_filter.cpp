#include "vigia/localization/ceiling_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

constexpr Eigen::Index kCommon = 6;      // states before the patches'
constexpr double kPatchAgrees_m = 0.06;  // two patches of one grid, whatever their errors
constexpr double kDirected = 5.0;        // log-odds
constexpr int kFarthestShift = 6;        // cells that are weighed each way, at most
constexpr double kNegligible = 1e-6;

Eigen::Matrix2d world_to_robot(double theta) {
  return Eigen::Rotation2Dd(-theta).toRotationMatrix();
}

/// Of two directions of a patch, one of which may be turned half round.
double direction_difference(double a, double b, bool directed) {
  const double off = wrap_angle(a - b);
  if (directed || std::abs(off) <= 0.5 * kPi) return off;
  return wrap_angle(off + kPi);
}

}  // namespace

CeilingFilter::CeilingFilter(const CeilingCamera& camera, const CeilingGrid& grid,
                             const CeilingFilterParams& params)
    : camera_(camera), grid_(grid), params_(params) {
  reset({}, anywhere());
}

void CeilingFilter::reset(Stamp stamp, const Prior& prior) {
  stamp_ = stamp;
  x_ = Eigen::VectorXd::Zero(kCommon);
  x_.head<3>() = prior.pose.vector();
  P_ = Eigen::MatrixXd::Zero(kCommon, kCommon);
  P_.topLeftCorner<3, 3>() = prior.covariance;
  P_(3, 3) = P_(4, 4) = params_.tilt_sigma * params_.tilt_sigma;
  P_(5, 5) = params_.height_sigma * params_.height_sigma;
  patches_.clear();
  shifts_ = {{CeilingCell{}, 1.0}};
  gated_ = 0;
  unknown_s_ = 0.0;
  refresh_belief();
}

CeilingCameraErrors CeilingFilter::camera_errors() const {
  return CeilingCameraErrors::from_vector(x_.segment<3>(3));
}

Eigen::Matrix3d CeilingFilter::camera_errors_covariance() const {
  return P_.block<3, 3>(3, 3);
}

void CeilingFilter::move(const Pose2& to, const MotionJacobian& F, const Eigen::Matrix3d& Q) {
  x_.head<3>() = to.vector();
  const Eigen::MatrixXd rows = F * P_.topRows<kCommon>();
  P_.topRows<3>() = rows;
  P_.leftCols<3>().bottomRows(P_.rows() - 3) = rows.rightCols(P_.cols() - 3).transpose();
  const Eigen::Matrix3d pose = rows.leftCols<kCommon>() * F.transpose();
  P_.topLeftCorner<3, 3>() = 0.5 * (pose + pose.transpose()) + Q;
  refresh_belief();
}

void CeilingFilter::predict(const OdometryIncrement& u) {
  const Pose2 from = pose();
  MotionJacobian F = MotionJacobian::Zero();
  F.leftCols<3>() = move_jacobian_pose(from, u);
  const Eigen::Matrix3d G = move_jacobian_control(from, u);
  stamp_ = u.to;
  move(vigia::move(from, u), F, G * control_covariance(u, params_.odometry) * G.transpose());
}

void CeilingFilter::predict(const ImageShift& shift, Stamp to) {
  const Pose2 from = pose();
  const CeilingCamera camera = corrected(camera_, camera_errors());
  const Pose2 motion = robot_motion(camera, shift);
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(from.theta).toRotationMatrix();
  const Eigen::Vector2d step = R * motion.position();
  MotionJacobian F = MotionJacobian::Zero();
  F.leftCols<3>().setIdentity();
  F.block<2, 1>(0, 2) = Eigen::Vector2d(-step.y(), step.x());
  F.block<2, 1>(0, 5) = R * (camera.rise_m() * shift.shift);
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() = camera.rise_m() * R;
  Eigen::Matrix3d covariance = shift.covariance;
  covariance.diagonal().array() += params_.flow_floor * params_.flow_floor;
  stamp_ = to;
  move(compose(from, motion), F, G * covariance * G.transpose());
}

void CeilingFilter::predict_unknown(Stamp to) {
  // The robot may have kept one direction all the time: σ grows as the time, not as its root.
  const double before = unknown_s_;
  unknown_s_ += (to - stamp_).seconds();
  const double reach = 0.5 * params_.max_speed_mps;
  const double turn = 2.0 * params_.max_speed_mps;  // rad/s, of a robot half a metre wide
  const double grown = unknown_s_ * unknown_s_ - before * before;
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  Q.diagonal() << reach * reach * grown, reach * reach * grown, turn * turn * grown;
  MotionJacobian F = MotionJacobian::Zero();
  F.leftCols<3>().setIdentity();
  stamp_ = to;
  move(pose(), F, Q);
}

/// Whether the prediction does not tell by itself which patch is which.
bool CeilingFilter::wide() const {
  return belief_.position_sigma() > 0.1 * grid_.pitch_m || P_(2, 2) > from_deg(8.0) * from_deg(8.0);
}

std::vector<CeilingFilter::Seen> CeilingFilter::see(const std::vector<PatchImage>& patches) const {
  std::vector<Seen> seen;
  for (const PatchImage& patch : patches)
    if (const auto on = on_ceiling(camera_, patch, camera_errors()))
      seen.push_back({*on, patch.forward_log_odds >= kDirected, {}});
  return seen;
}

/// Those that agree with the grid as seen from @p pose, each with its cell.
std::vector<CeilingFilter::Seen> CeilingFilter::associated(const std::vector<Seen>& seen,
                                                           const Pose2& pose) const {
  std::map<CeilingCell, std::pair<double, Seen>> by_cell;
  // Where the pose is one of the patches' the others must agree with it, not with the prediction.
  const double sigmas = wide() ? 0.0 : 3.0;
  const double near = kPatchAgrees_m + 4.0 * grid_.placement_m + sigmas * belief_.position_sigma();
  const double turn_slack = sigmas * std::sqrt(P_(2, 2));
  for (Seen one : seen) {
    const Eigen::Vector2d p = pose.position() + world_to_robot(-pose.theta) * one.patch.q;
    one.cell = nearest_cell(grid_, p);
    const double off = (cell_centre(grid_, one.cell) - p).norm();
    const double turn = direction_difference(-pose.theta, one.patch.psi, one.directed);
    if (off > near + turn_slack * one.patch.q.norm()) continue;
    if (std::abs(turn) > 0.25 + 4.0 * grid_.placement_turn) continue;
    const auto found = by_cell.find(one.cell);
    if (found == by_cell.end())
      by_cell.emplace(one.cell, std::pair{off, one});
    else if (off < found->second.first)
      found->second = {off, one};
  }
  std::vector<Seen> result;
  for (auto& [cell, one] : by_cell) result.push_back(one.second);
  return result;
}

/// The prediction, or where it is wide the pose by one of the patches with which most agree.
Pose2 CeilingFilter::point_of_linearisation(const std::vector<Seen>& seen) const {
  if (!wide()) return pose();
  Pose2 best = pose();
  std::size_t most = 0;
  for (const Seen& reference : seen) {
    const double off = direction_difference(-pose().theta, reference.patch.psi, reference.directed);
    Pose2 at = pose();
    at.theta = wrap_angle(pose().theta + off);
    const Eigen::Vector2d turned = world_to_robot(-at.theta) * reference.patch.q;
    const Eigen::Vector2d p =
        cell_centre(grid_, nearest_cell(grid_, pose().position() + turned)) - turned;
    at.x = p.x();
    at.y = p.y();
    const std::size_t agree = associated(seen, at).size();
    if (agree <= most) continue;
    most = agree;
    best = at;
  }
  return best;
}

/// Keeps the placement errors of the cells in view, forgets the others, admits the new ones.
void CeilingFilter::hold(const std::vector<Seen>& seen) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < kCommon; ++i) kept.push_back(i);
  std::map<CeilingCell, Eigen::Index> places;
  std::vector<CeilingCell> fresh;
  for (const Seen& one : seen) {
    const auto known = patches_.find(one.cell);
    if (known == patches_.end()) {
      fresh.push_back(one.cell);
      continue;
    }
    places[one.cell] = static_cast<Eigen::Index>(kept.size());
    for (Eigen::Index i = 0; i < 3; ++i) kept.push_back(known->second + i);
  }
  const auto old = static_cast<Eigen::Index>(kept.size());
  const Eigen::Index size = old + 3 * static_cast<Eigen::Index>(fresh.size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < old; ++i) {
    x[i] = x_[kept[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < old; ++j)
      P(i, j) = P_(kept[static_cast<std::size_t>(i)], kept[static_cast<std::size_t>(j)]);
  }
  Eigen::Index at = old;
  for (const CeilingCell& cell : fresh) {
    places[cell] = at;
    P(at, at) = P(at + 1, at + 1) = grid_.placement_m * grid_.placement_m;
    P(at + 2, at + 2) = grid_.placement_turn * grid_.placement_turn;
    at += 3;
  }
  x_ = std::move(x);
  P_ = std::move(P);
  patches_ = std::move(places);
}

CeilingFilter::Linearised CeilingFilter::linearise(const std::vector<Seen>& seen,
                                                   const Pose2& at) const {
  const auto rows = 3 * static_cast<Eigen::Index>(seen.size());
  Linearised all{Eigen::VectorXd(rows),
                 Eigen::MatrixXd::Zero(rows, x_.size()),
                 Eigen::MatrixXd::Zero(rows, rows),
                 {}};
  const Eigen::Matrix2d R = world_to_robot(at.theta);
  Eigen::Index row = 0;
  for (const Seen& one : seen) {
    const Eigen::Index place = patches_.at(one.cell);
    const Eigen::Vector2d out = cell_centre(grid_, one.cell) + x_.segment<2>(place) - at.position();
    const Eigen::Vector2d expected = R * out;
    all.y.segment<2>(row) = one.patch.q - expected;
    all.y[row + 2] = direction_difference(one.patch.psi, x_[place + 2] - at.theta, one.directed);
    all.H.block<2, 2>(row, 0) = -R;
    all.H.block<2, 1>(row, 2) = Eigen::Vector2d(expected.y(), -expected.x());
    all.H(row + 2, 2) = -1.0;
    all.H.block<3, 3>(row, 3) = -one.patch.derrors;
    all.H.block<2, 2>(row, place) = R;
    all.H(row + 2, place + 2) = 1.0;
    all.R.block<3, 3>(row, row) = one.patch.covariance;
    row += 3;
  }
  // Linearised at another pose than the mean.
  all.y += all.H.leftCols<3>() * difference(at, pose());
  all.S = all.H * P_ * all.H.transpose() + all.R;
  return all;
}

std::vector<CeilingFilter::Seen> CeilingFilter::gated(const std::vector<Seen>& seen,
                                                      const Linearised& all) const {
  std::vector<Seen> passed;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto row = 3 * static_cast<Eigen::Index>(i);
    const Eigen::Vector3d y = all.y.segment<3>(row);
    const Eigen::Matrix3d S = all.S.block<3, 3>(row, row);
    if (y.dot(S.ldlt().solve(y)) <= params_.gate) passed.push_back(seen[i]);
  }
  return passed;
}

/// Bayes' rule over the shifts by whole cells: each was where the mean is, some cells aside, and
/// the fix is as many cells aside again.
void CeilingFilter::weigh_shifts(const Linearised& all, const std::vector<Seen>& seen,
                                 const Pose2& at) {
  const int reach =
      std::clamp(static_cast<int>(std::ceil(5.0 * belief_.position_sigma() / grid_.pitch_m)), 1,
                 kFarthestShift);
  const Eigen::LDLT<Eigen::MatrixXd> S(all.S);
  const Eigen::Matrix2d R = world_to_robot(at.theta);
  Shifts weighed;
  std::map<CeilingCell, double> moved;
  double least = std::numeric_limits<double>::infinity();
  for (std::int64_t i = -reach; i <= reach; ++i) {
    for (std::int64_t j = -reach; j <= reach; ++j) {
      const Eigen::Vector2d aside = R * cell_centre(grid_, {i, j});
      Eigen::VectorXd y = all.y;
      for (Eigen::Index row = 0; row < y.size(); row += 3) y.segment<2>(row) -= aside;
      const double square = y.dot(S.solve(y));
      moved[{i, j}] = square;
      least = std::min(least, square);
    }
  }
  double sum = 0.0;
  for (const auto& [from, weight] : shifts_) {
    for (const auto& [by, square] : moved) {
      const CeilingCell to{from.i + by.i, from.j + by.j};
      double chance = weight * std::exp(-0.5 * (square - least));
      if (chance < 1e-12) continue;
      for (const Seen& one : seen)
        if (!has_patch(grid_, {one.cell.i + to.i, one.cell.j + to.j})) chance *= params_.spurious;
      weighed[to] += chance;
      sum += chance;
    }
  }
  if (sum <= 0.0) return;
  shifts_.clear();
  for (const auto& [to, weight] : weighed)
    if (weight > kNegligible * sum) shifts_[to] = weight / sum;
}

/// Patches contradict the prediction again and again: it may be anywhere in its cell and the next.
void CeilingFilter::doubt() {
  const double sigma = 0.5 * grid_.pitch_m;
  P_.topRows<3>().setZero();
  P_.leftCols<3>().setZero();
  P_.diagonal().head<3>() << sigma * sigma, sigma * sigma, from_deg(30.0) * from_deg(30.0);
  gated_ = 0;
}

void CeilingFilter::shift_by(const CeilingCell& shift) {
  if (shift == CeilingCell{}) return;
  x_.head<2>() += cell_centre(grid_, shift);
  std::map<CeilingCell, Eigen::Index> patches;
  for (const auto& [cell, place] : patches_) patches[{cell.i + shift.i, cell.j + shift.j}] = place;
  patches_ = std::move(patches);
  Shifts shifts;
  for (const auto& [by, weight] : shifts_) shifts[{by.i - shift.i, by.j - shift.j}] = weight;
  shifts_ = std::move(shifts);
}

CeilingUpdate CeilingFilter::update(const std::vector<PatchImage>& patches) {
  std::vector<Seen> seen = see(patches);
  if (seen.empty()) return CeilingUpdate::none_seen;
  const Pose2 at = point_of_linearisation(seen);
  seen = associated(seen, at);
  hold(seen);
  Linearised all = linearise(seen, at);
  const std::vector<Seen> passed = gated(seen, all);
  if (passed.size() < seen.size()) {
    hold(passed);
    all = linearise(passed, at);
  }
  if (passed.empty()) {
    if (++gated_ >= params_.max_gated) doubt();
    refresh_belief();
    return CeilingUpdate::gated;
  }
  gated_ = 0;
  weigh_shifts(all, passed, at);
  const Eigen::MatrixXd K =
      P_ * all.H.transpose() *
      all.S.ldlt().solve(Eigen::MatrixXd::Identity(all.S.rows(), all.S.cols()));
  x_ += K * all.y;
  x_[2] = wrap_angle(x_[2]);
  // Joseph's form: the placement errors of a perfect grid have no variance at all.
  const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(P_.rows(), P_.cols()) - K * all.H;
  P_ = (left * P_ * left.transpose() + K * all.R * K.transpose()).eval();
  unknown_s_ = 0.0;
  const auto best =
      std::max_element(shifts_.begin(), shifts_.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  shift_by(best->first);
  refresh_belief();
  return CeilingUpdate::fused;
}

void CeilingFilter::relinearise(const Pose2& pose, const CeilingCameraErrors& errors,
                                const std::map<CeilingCell, Eigen::Vector3d>& placement) {
  x_.head<3>() = pose.vector();
  x_.segment<3>(3) = errors.vector();
  for (const auto& [cell, place] : patches_)
    if (const auto found = placement.find(cell); found != placement.end())
      x_.segment<3>(place) = found->second;
  refresh_belief();
}

void CeilingFilter::refresh_belief() {
  belief_.stamp = stamp_;
  belief_.pose = pose();
  belief_.covariance = P_.topLeftCorner<3, 3>();
  belief_.hypotheses.clear();
  const double best = shifts_[CeilingCell{}];
  const bool open = 3.0 * belief_.position_sigma() > 0.5 * grid_.pitch_m;
  belief_.status = best < params_.sure || open ? BeliefStatus::ambiguous : BeliefStatus::tracking;
  belief_.lost_probability = 1.0 - best;
  if (belief_.status == BeliefStatus::tracking) return;
  for (const auto& [shift, weight] : shifts_) {
    const Eigen::Vector2d p = belief_.pose.position() + cell_centre(grid_, shift);
    belief_.hypotheses.push_back({{p.x(), p.y(), belief_.pose.theta}, belief_.covariance, weight});
  }
}

}  // namespace vigia::localization

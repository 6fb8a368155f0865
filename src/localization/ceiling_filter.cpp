#include "vigia/localization/ceiling_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Dense>

#include "vigia/core/angle.hpp"
#include "vigia/core/plane_geometry.hpp"
#include "vigia/localization/chi_square.hpp"
#include "vigia/localization/motion_fusion.hpp"

namespace vigia::localization {
namespace {

constexpr Eigen::Index kCommon = 6;      // states before the patches'
constexpr double kPatchAgrees_m = 0.06;  // two patches of one grid, whatever their errors
constexpr double kDirected = 5.0;        // log-odds
constexpr int kFarthestShift = 6;        // cells that are weighed each way, at most
constexpr double kNegligible = 1e-6;
constexpr std::int64_t kMostCells = 20000;     // that are hypotheses, where it may be anywhere
constexpr std::size_t kMostHypotheses = 2000;  // that are told
constexpr std::ptrdiff_t kMostLacking =
    3;                                  // of patches that a frame lacks for reasons of their own
constexpr double kSpreadDoubt = 0.1;    // by how much less doubt is borne of one cell among all
constexpr double kElsewhere = 0.5;      // chance of being in another cell than any of them
constexpr double kForgotten_px = 40.0;  // beyond the border
constexpr double kPlain_px = 8.0;       // from the border: a patch there should be found
constexpr int kIterations = 5;
constexpr double kSingle_s = 0.64;  // of one patch, which may be none, for a frame with more
constexpr double kAnotherPatch_m = 0.3;
constexpr double kUnseenMotions[] = {4.0, 16.0, 64.0};  // variances of a tick
constexpr double kCalming = 0.9;                        // a tick
constexpr double kLoneDoubt = 0.1;  // that a lone patch which fits a wide prediction is none
constexpr double kFlowSlack_m = 0.01;
constexpr double kTurnPerMetre = 2.0;  // rad, of a robot half a metre wide, at most
constexpr double kAtRest = 1e-7;
constexpr double kPlacementLearnt_m = 1e-3;    // σ of the places below which they are the grid's
constexpr double kTogether = 0.9999;           // of χ² of patches that agree with each other
constexpr int kHeadingWraps = 3;               // turns each way
constexpr double kSlightTurn = from_deg(3.0);  // σ of a fix's heading beside the prediction's

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

void CeilingFilter::reset(Stamp stamp, const Prior& prior, const CeilingCameraErrors& about) {
  stamp_ = stamp;
  x_ = Eigen::VectorXd::Zero(kCommon);
  x_.head<3>() = prior.pose.vector();
  x_.segment<3>(3) = about.vector();
  P_ = Eigen::MatrixXd::Zero(kCommon, kCommon);
  P_.topLeftCorner<3, 3>() = prior.covariance;
  P_(3, 3) = P_(4, 4) = params_.tilt_sigma * params_.tilt_sigma;
  P_(5, 5) = params_.height_sigma * params_.height_sigma;
  patches_.clear();
  anchored_.clear();
  motion_P_.setZero();
  shifts_ = {{CeilingCell{}, 1.0}};
  judged_.clear();
  elsewhere_ = false;
  spread_ = false;
  cells_unsure_ = false;
  gated_ = 0.0;
  contradicts_.reset();
  before_.clear();
  flow_misled_ = false;
  updated_ = stamp;
  unknown_s_ = 0.0;
  flow_alone_s_ = 0.0;
  lively_Q_.setZero();
  lone_.reset();
  turned_ = 0.0;
  flow_trust_ = {};
  refresh_belief();
}

CeilingCameraErrors CeilingFilter::camera_errors() const {
  return CeilingCameraErrors::from_vector(x_.segment<3>(3));
}

Eigen::Matrix3d CeilingFilter::camera_errors_covariance() const {
  return P_.block<3, 3>(3, 3);
}

void CeilingFilter::move(const Motion& motion) {
  x_.head<3>() = motion.to.vector();
  const Eigen::MatrixXd rows = motion.F * P_.topRows<kCommon>();
  P_.topRows<3>() = rows;
  P_.leftCols<3>().bottomRows(P_.rows() - 3) = rows.rightCols(P_.cols() - 3).transpose();
  const Eigen::Matrix3d pose = rows.leftCols<kCommon>() * motion.F.transpose();
  P_.topLeftCorner<3, 3>() = 0.5 * (pose + pose.transpose()) + motion.Q;
  const Eigen::Matrix3d F = motion.F.leftCols<3>();
  motion_P_ = F * motion_P_ * F.transpose() + motion.Q;
  refresh_belief();
}

void CeilingFilter::enliven(const Eigen::Matrix3d& Q) {
  lively_Q_ = Q.trace() > kCalming * lively_Q_.trace() ? Q : kCalming * lively_Q_;
}

/// A step in the robot's frame, turned to the world's axes. What the camera's errors do to it
/// counts as far as the step was seen by the camera: @p seen, a share.
CeilingFilter::Motion CeilingFilter::led_on(const FlowMotion& step,
                                            const Eigen::Matrix3d& seen) const {
  const Pose2 from = pose();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(from.theta).toRotationMatrix();
  Motion motion{compose(from, step.step), MotionJacobian::Zero(), Eigen::Matrix3d::Zero()};
  motion.F.leftCols<3>().setIdentity();
  motion.F(0, 2) = from.y - motion.to.y;
  motion.F(1, 2) = motion.to.x - from.x;
  motion.F.rightCols<3>() = R * seen * step.derrors;
  motion.Q = R * step.covariance * R.transpose();
  return motion;
}

FlowMotion CeilingFilter::seen_motion(const ImageShift& shift) const {
  return flow_motion(camera_, shift, camera_errors(), P_(3, 3) + P_(4, 4), params_.flow_floor);
}

void CeilingFilter::predict(const OdometryIncrement& u) {
  Motion motion{vigia::move(pose(), u), MotionJacobian::Zero(), Eigen::Matrix3d::Zero()};
  motion.F.leftCols<3>() = move_jacobian_pose(pose(), u);
  const Eigen::Matrix3d G = move_jacobian_control(pose(), u);
  motion.Q = G * control_covariance(u, params_.odometry) * G.transpose();
  stamp_ = u.to;
  move(motion);
  enliven(motion.Q);
}

/// Whether a flow shows the ceiling's motion, by the patches of the frames that it joins.
bool CeilingFilter::follows_ceiling(const FlowMotion& flow, const std::vector<PatchImage>& patches,
                                    double dt) {
  std::vector<PatchOnCeiling> now;
  for (const Seen& one : see(patches)) now.push_back(one.patch);
  const double reach_m = params_.max_speed_mps * dt;
  const double reach = kTurnPerMetre * reach_m;
  switch (judge_flow(before_, now, flow, reach_m, reach, params_.gate)) {
    case FlowVerdict::silent:
      break;
    case FlowVerdict::agrees:
      flow_misled_ = false;
      break;
    case FlowVerdict::contradicts:
      flow_misled_ = true;
      break;
  }
  return !flow_misled_;
}

void CeilingFilter::predict(const ImageShift& shift, Stamp to,
                            const std::vector<PatchImage>& patches) {
  const FlowMotion seen = seen_motion(shift);
  const double dt = (to - stamp_).seconds();
  const double reach = params_.max_speed_mps * dt + kFlowSlack_m;
  if (!follows_ceiling(seen, patches, dt)) {
    predict_unknown(to);
    return;
  }
  const bool tells = seen.covariance.topLeftCorner<2, 2>().trace() <
                     unknown_motion(0.0, dt).topLeftCorner<2, 2>().trace();
  if (!tells || seen.step.position().norm() > reach || reach > 0.5 * grid_.pitch_m) {
    predict_unknown(to);
    return;
  }
  flow_alone_s_ += dt;
  stamp_ = to;
  move(led_on(seen, Eigen::Matrix3d::Identity()));
}

bool CeilingFilter::predict(const OdometryIncrement& u, const ImageShift& shift) {
  FlowMotion motion = seen_motion(shift);
  const Eigen::Matrix3d errors = P_.block<3, 3>(3, 3);
  const bool trusted = flow_trust_.holds(u, params_.odometry, motion, errors, params_.gate);
  const auto fused = fuse_motions(u, params_.odometry, motion, params_.gate);
  if (!trusted || !fused) {
    predict(u);
    return false;
  }
  motion.step = fused->step;
  motion.covariance = fused->covariance;
  stamp_ = u.to;
  const Motion fused_motion = led_on(motion, fused->flow_weight);
  move(fused_motion);
  enliven(fused_motion.Q);
  return true;
}

/// Of a robot that may keep one direction all the time: σ grows as the time, not as its root.
Eigen::Matrix3d CeilingFilter::unknown_motion(double from_s, double to_s) const {
  const double reach = params_.max_speed_mps / 3.0;
  const double turn = kTurnPerMetre * params_.max_speed_mps;
  const double grown = to_s * to_s - from_s * from_s;
  return Eigen::Vector3d(reach * reach, reach * reach, turn * turn).asDiagonal() * grown;
}

void CeilingFilter::predict_unknown(Stamp to) {
  const double before = unknown_s_;
  unknown_s_ += (to - stamp_).seconds();
  Motion motion{pose(), MotionJacobian::Zero(), unknown_motion(before, unknown_s_)};
  motion.F.leftCols<3>().setIdentity();
  stamp_ = to;
  move(motion);
}

/// Whether the prediction does not tell by itself which patch is which.
bool CeilingFilter::wide() const {
  return belief_.position_sigma() > 0.1 * grid_.pitch_m || P_(2, 2) > from_deg(8.0) * from_deg(8.0);
}

/// Whether the robot may be half a pitch from the mean.
bool CeilingFilter::open() const {
  return 3.0 * belief_.position_sigma() > 0.5 * grid_.pitch_m;
}

std::vector<CeilingFilter::Seen> CeilingFilter::see(const std::vector<PatchImage>& patches) const {
  std::vector<Seen> seen;
  for (const PatchImage& patch : patches)
    if (const auto on = on_ceiling(camera_, patch, camera_errors()))
      seen.push_back({patch, *on, patch.forward_log_odds >= kDirected, {}});
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
  result.reserve(by_cell.size());
  for (auto& [cell, one] : by_cell) result.push_back(one.second);
  return result;
}

/// The pose that a patch of the nearest cell gives, taken as it is seen or turned.
Pose2 CeilingFilter::placed_by(const Seen& reference, double turn) const {
  const double off = direction_difference(-pose().theta, reference.patch.psi, reference.directed);
  Pose2 at = pose();
  at.theta = wrap_angle(pose().theta + off + turn);
  const Eigen::Vector2d turned = world_to_robot(-at.theta) * reference.patch.q;
  const Eigen::Vector2d p =
      cell_centre(grid_, nearest_cell(grid_, pose().position() + turned)) - turned;
  at.x = p.x();
  at.y = p.y();
  return at;
}

/// Of the prediction, up to a constant; the heading's normal density wrapped round the circle.
double CeilingFilter::log_prior(const Pose2& at) const {
  const Eigen::Vector2d off = at.position() - pose().position();
  Eigen::Matrix2d P = P_.topLeftCorner<2, 2>();
  P.diagonal().array() += kPatchAgrees_m * kPatchAgrees_m;
  const double turn = wrap_angle(at.theta - pose().theta);
  double heading = 0.0;
  for (int k = -kHeadingWraps; k <= kHeadingWraps; ++k) {
    const double wrapped = turn + 2.0 * kPi * k;
    heading += std::exp(-0.5 * wrapped * wrapped / (P_(2, 2) + kSlightTurn * kSlightTurn));
  }
  return std::log(heading + std::numeric_limits<double>::min()) -
         0.5 * off.dot(P.ldlt().solve(off));
}

/// The prediction, or where it is wide the pose by one of the patches with which most agree, of
/// several the likeliest. Patches that do not tell their ends apart are tried both ways.
CeilingFilter::Start CeilingFilter::point_of_linearisation(const std::vector<Seen>& seen) const {
  Start start{pose()};
  if (!wide()) return start;
  struct Candidate {
    Pose2 pose;
    std::size_t agree = 0;
    double log_prior = 0.0;
  };
  std::vector<Candidate> candidates;
  std::size_t most = 1;
  for (const Seen& reference : seen) {
    for (const double turn : {0.0, kPi}) {
      if (turn != 0.0 && reference.directed) continue;
      const Pose2 at = placed_by(reference, turn);
      candidates.push_back({at, associated(seen, at).size(), log_prior(at)});
      most = std::max(most, candidates.back().agree);
    }
  }
  const Candidate* best = nullptr;
  for (const Candidate& one : candidates)
    if (one.agree == most && (best == nullptr || one.log_prior > best->log_prior)) best = &one;
  if (best == nullptr) return start;
  start.pose = best->pose;
  const Candidate* other = nullptr;
  for (const Candidate& one : candidates) {
    const bool turned = std::cos(one.pose.theta - best->pose.theta) < 0.0;
    if (one.agree == most && turned && (other == nullptr || one.log_prior > other->log_prior))
      other = &one;
  }
  if (other == nullptr) return start;
  start.turned = 1.0 / (1.0 + std::exp(best->log_prior - other->log_prior));
  start.about = 0.5 * (best->pose.position() + other->pose.position());
  return start;
}

/// The robot faced the other way than believed, or the fix does, or both and so neither.
void CeilingFilter::note_turn(const Start& start) {
  if (start.turned <= kNegligible) return;
  turned_ = turned_ * (1.0 - start.turned) + (1.0 - turned_) * start.turned;
  turned_about_ = start.about;
}

/// Whether the camera shows all of a cell's patch, @p margin_px from the border or more.
bool CeilingFilter::in_sight(const CeilingCell& cell, const Pose2& at, double margin_px) const {
  const CeilingCamera camera = corrected(camera_, camera_errors());
  const Eigen::Isometry3d cMw = (to_isometry(at) * camera.rMc).inverse();
  const Eigen::Vector2d p = cell_centre(grid_, cell);
  for (const double end : {-0.5, 0.5}) {
    const Eigen::Vector3d p_w(p.x() + end * grid_.length_m, p.y(), camera.ceiling_m);
    const auto uv = project(camera.model, cMw * p_w);
    if (!uv || !in_image(camera.model, *uv, margin_px)) return false;
  }
  return true;
}

/// Keeps the placement errors of the cells in view, forgets the others, admits the new ones.
/// @p afresh: where several shifts of the prediction are possible, a patch's cell may be another
/// than it was.
void CeilingFilter::hold(const std::vector<Seen>& seen, const Pose2& at, bool afresh) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < kCommon; ++i) kept.push_back(i);
  std::map<CeilingCell, Eigen::Index> places;
  cells_unsure_ = afresh && !patches_.empty();
  if (afresh) {
    judged_.clear();
    anchored_.clear();
  } else {
    for (const auto& [cell, place] : patches_) {
      if (!in_sight(cell, at, -kForgotten_px)) {
        anchored_.erase(cell);
        continue;
      }
      places[cell] = static_cast<Eigen::Index>(kept.size());
      for (Eigen::Index i = 0; i < 3; ++i) kept.push_back(place + i);
    }
  }
  std::vector<CeilingCell> fresh;
  for (const Seen& one : seen)
    if (places.count(one.cell) == 0) fresh.push_back(one.cell);
  const auto old = static_cast<Eigen::Index>(kept.size());
  const Eigen::Index size = old + 3 * static_cast<Eigen::Index>(fresh.size());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < old; ++i) {
    x[i] = x_[kept[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < old; ++j)
      P(i, j) = P_(kept[static_cast<std::size_t>(i)], kept[static_cast<std::size_t>(j)]);
  }
  Eigen::Index place = old;
  for (const CeilingCell& cell : fresh) {
    places[cell] = place;
    P(place, place) = P(place + 1, place + 1) = grid_.placement_m * grid_.placement_m;
    P(place + 2, place + 2) = grid_.placement_turn * grid_.placement_turn;
    place += 3;
  }
  x_ = std::move(x);
  P_ = std::move(P);
  patches_ = std::move(places);
}

/// The mean with another pose.
CeilingFilter::Rest CeilingFilter::state_at(const Pose2& pose) const {
  Eigen::VectorXd at = x_;
  at.head<3>() = pose.vector();
  return {at, at};
}

/// H M: a patch's three rows of H have the common states and its own placement alone, so that the
/// product takes as many numbers a patch as it has, not as the state has.
Eigen::MatrixXd CeilingFilter::by_rows(const std::vector<Seen>& seen, const Eigen::MatrixXd& H,
                                       const Eigen::MatrixXd& M) const {
  Eigen::MatrixXd product(H.rows(), M.cols());
  Eigen::Index row = 0;
  for (const Seen& one : seen) {
    const Eigen::Index place = patches_.at(one.cell);
    product.middleRows<3>(row).noalias() = H.block<3, kCommon>(row, 0) * M.topRows<kCommon>();
    product.middleRows<3>(row).noalias() += H.block<3, 3>(row, place) * M.middleRows<3>(place);
    row += 3;
  }
  return product;
}

const Eigen::VectorXd& CeilingFilter::point_of(const Seen& one, const Rest& rest) const {
  return anchored_.count(one.cell) > 0 ? rest.moved : rest.at;
}

/// What a patch lacks of its place in the robot's frame, and the derivatives of that place.
struct CeilingFilter::PatchRows {
  Eigen::Vector3d y = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, kCommon> common = Eigen::Matrix<double, 3, kCommon>::Zero();
  Eigen::Matrix3d own = Eigen::Matrix3d::Identity();  ///< a rotation
};

CeilingFilter::PatchRows CeilingFilter::rows_of(const CeilingCell& cell,
                                                const PatchOnCeiling& patch, bool directed,
                                                const Eigen::VectorXd& at) const {
  const double theta = at[2];
  const Eigen::Matrix2d R = world_to_robot(theta);
  const Eigen::Index place = patches_.at(cell);
  const Eigen::Vector2d out = cell_centre(grid_, cell) + at.segment<2>(place) - at.head<2>();
  const Eigen::Vector2d expected = R * out;
  PatchRows rows;
  rows.y.head<2>() = patch.q - expected;
  rows.y[2] = direction_difference(patch.psi, at[place + 2] - theta, directed);
  rows.common.topLeftCorner<2, 2>() = -R;
  rows.common.block<2, 1>(0, 2) = Eigen::Vector2d(expected.y(), -expected.x());
  rows.common(2, 2) = -1.0;
  rows.common.rightCols<3>() = -patch.derrors;
  rows.own.topLeftCorner<2, 2>() = R;
  return rows;
}

CeilingFilter::Linearised CeilingFilter::linearise(const std::vector<Seen>& seen,
                                                   const Rest& rest) const {
  const auto rows = 3 * static_cast<Eigen::Index>(seen.size());
  Linearised all{Eigen::VectorXd::Zero(rows),
                 Eigen::MatrixXd::Zero(rows, x_.size()),
                 Eigen::MatrixXd::Zero(rows, rows),
                 {},
                 {}};
  Eigen::Index row = 0;
  for (const Seen& one : seen) {
    const Eigen::VectorXd& at = point_of(one, rest);
    const auto errors = CeilingCameraErrors::from_vector(at.segment<3>(3));
    const PatchOnCeiling patch = on_ceiling(camera_, one.image, errors).value_or(one.patch);
    const PatchRows rows_at = rows_of(one.cell, patch, one.directed, at);
    all.H.block<3, kCommon>(row, 0) = rows_at.common;
    all.H.block<3, 3>(row, patches_.at(one.cell)) = rows_at.own;
    all.R.block<3, 3>(row, row) = patch.covariance;
    // Linearised at another state than the mean.
    Eigen::VectorXd off = at - x_;
    off[2] = wrap_angle(off[2]);
    all.y.segment<3>(row) = rows_at.y + all.H.middleRows<3>(row) * off;
    row += 3;
  }
  all.HP = by_rows(seen, all.H, P_);
  all.S = by_rows(seen, all.H, all.HP.transpose()).transpose() + all.R;
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

/// Those that the prediction allows. Where it allows none, two or more are believed that agree with
/// one over which a multiple of the motion of the liveliest of the last ticks was unseen: odometry
/// whose variance follows the measured distance is too sure of a tick that it read too short, and a
/// wheel slips sooner than somebody lifts the robot and puts it down a centimetre further. What is
/// added is independent of the patches, with whose errors those of the pose go together.
std::vector<CeilingFilter::Seen> CeilingFilter::passed_gate(const std::vector<Seen>& seen,
                                                            const Pose2& start) {
  std::vector<Seen> passed = gated(seen, linearise(seen, state_at(start)));
  if (!passed.empty() || seen.size() < 2) return passed;
  const Eigen::Matrix3d before = P_.topLeftCorner<3, 3>();
  for (const double variances : kUnseenMotions) {
    P_.topLeftCorner<3, 3>() = before + variances * lively_Q_;
    passed = gated(seen, linearise(seen, state_at(start)));
    if (passed.size() < 2) continue;
    motion_P_ += variances * lively_Q_;
    return passed;
  }
  P_.topLeftCorner<3, 3>() = before;
  return {};
}

/// Bayes' rule over the shifts by whole cells: each was where the mean is, some cells aside, and
/// the fix is as many cells aside again.
void CeilingFilter::weigh_shifts(const Linearised& all, const std::vector<Seen>& seen,
                                 const Pose2& at) {
  const double cells = std::ceil(5.0 * belief_.position_sigma() / grid_.pitch_m);
  if (!(cells <= kFarthestShift)) {
    spread();
  } else {
    shift_by_chance(all, at, std::max(1, static_cast<int>(cells)));
  }
  judge_presence(seen, at);
  normalise_shifts();
}

/// It may be in any cell.
void CeilingFilter::spread() {
  elsewhere_ = true;
  if (!grid_.extent) return;
  CeilingCells hall = cells_in(grid_, *grid_.extent);
  // As far as a robot under the last patches may be from the middle of their cell.
  hall.first = {hall.first.i - 1, hall.first.j - 1};
  hall.last = {hall.last.i + 1, hall.last.j + 1};
  if (hall.count() > kMostCells) return;
  elsewhere_ = false;
  spread_ = true;
  shifts_.clear();
  judged_.clear();
  const CeilingCell here = nearest_cell(grid_, pose().position());
  const double each = 1.0 / static_cast<double>(hall.count());
  for (std::int64_t i = hall.first.i; i <= hall.last.i; ++i)
    for (std::int64_t j = hall.first.j; j <= hall.last.j; ++j)
      shifts_[{i - here.i, j - here.j}] = each;
}

/// @p reach: cells that the prediction may be off, each way.
void CeilingFilter::shift_by_chance(const Linearised& all, const Pose2& at, int reach) {
  // Of the shift (i, j) the residuals are less by aside · (i, j), the same two columns of every
  // patch.
  Eigen::MatrixXd aside = Eigen::MatrixXd::Zero(all.y.size(), 2);
  const Eigen::Matrix2d R = grid_.pitch_m * world_to_robot(at.theta);
  for (Eigen::Index row = 0; row < all.y.size(); row += 3) aside.middleRows<2>(row) = R;
  const Eigen::LDLT<Eigen::MatrixXd> S(all.S);
  const Eigen::MatrixXd weighed_aside = S.solve(aside);
  const Eigen::Matrix2d squares = aside.transpose() * weighed_aside;
  const Eigen::Vector2d slopes = weighed_aside.transpose() * all.y;
  std::vector<std::pair<CeilingCell, double>> moved;  // χ² beside that of no shift
  double least = std::numeric_limits<double>::infinity();
  for (std::int64_t i = -reach; i <= reach; ++i) {
    for (std::int64_t j = -reach; j <= reach; ++j) {
      const Eigen::Vector2d by(static_cast<double>(i), static_cast<double>(j));
      const double square = by.dot(squares * by - 2.0 * slopes);
      moved.push_back({{i, j}, square});
      least = std::min(least, square);
    }
  }
  Shifts weighed;
  for (const auto& [by, square] : moved) {
    const double chance = std::exp(-0.5 * (square - least));
    if (chance < kNegligible * kNegligible) continue;
    for (const auto& [from, weight] : shifts_)
      weighed[{from.i + by.i, from.j + by.j}] += weight * chance;
  }
  shifts_ = std::move(weighed);
}

/// Patches where a shift has none, and none where it has one. Each cell is judged once while it is
/// in view: a patch that fell off is missing in every frame for one and the same reason; so may
/// many be that a frame lacks, behind a glare or a person.
void CeilingFilter::judge_presence(const std::vector<Seen>& seen, const Pose2& at) {
  if (is_endless(grid_) || elsewhere_) return;
  std::set<CeilingCell> present;
  for (const Seen& one : seen) present.insert(one.cell);
  std::set<CeilingCell> judged;
  std::vector<CeilingCell> appeared;
  std::vector<CeilingCell> lacking;
  const CeilingCell middle = nearest_cell(grid_, at.position());
  const int reach = static_cast<int>(std::ceil(2.0 * camera_.rise_m() / grid_.pitch_m));
  for (std::int64_t i = middle.i - reach; i <= middle.i + reach; ++i) {
    for (std::int64_t j = middle.j - reach; j <= middle.j + reach; ++j) {
      const CeilingCell cell{i, j};
      const bool there = present.count(cell) > 0;
      if (!there && !in_sight(cell, at, kPlain_px)) continue;
      judged.insert(cell);
      if (judged_.count(cell) > 0) continue;
      (there ? appeared : lacking).push_back(cell);
    }
  }
  for (auto& [shift, weight] : shifts_) {
    const auto has = [&, by = shift](const CeilingCell& cell) {
      return has_patch(grid_, {cell.i + by.i, cell.j + by.j});
    };
    for (const CeilingCell& cell : appeared)
      if (!has(cell)) weight *= params_.spurious;
    const auto lacks = std::count_if(lacking.begin(), lacking.end(), has);
    for (std::ptrdiff_t i = 0; i < std::min(lacks, kMostLacking); ++i) weight *= params_.missing;
  }
  // While several shifts are left a patch that fell off is met again under another of them.
  if (shifts_.size() > 1) judged.insert(judged_.begin(), judged_.end());
  judged_ = std::move(judged);
}

void CeilingFilter::normalise_shifts() {
  double sum = 0.0;
  for (const auto& [shift, weight] : shifts_) sum += weight;
  Shifts kept;
  for (const auto& [shift, weight] : shifts_)
    if (weight > kNegligible * sum) kept[shift] = weight / sum;
  shifts_ = std::move(kept);
}

/// Patches contradict the prediction again and again: it may be anywhere, turned anyhow.
void CeilingFilter::doubt() {
  const double sigma = 0.5 * grid_.pitch_m;
  P_.topRows<3>().setZero();
  P_.leftCols<3>().setZero();
  P_.diagonal().head<3>() << sigma * sigma, sigma * sigma, kPi * kPi / 3.0;
  motion_P_ = P_.topLeftCorner<3, 3>();
  spread();
  gated_ = 0.0;
  contradicts_.reset();
}

/// One patch alone may be none of the grid's; another one that contradicts as well is no chance.
void CeilingFilter::note_contradiction(const std::vector<Seen>& seen) {
  double frames = 1.0;
  if (seen.size() == 1) {
    const Eigen::Vector2d at =
        pose().position() + world_to_robot(-pose().theta) * seen.front().patch.q;
    const bool another = contradicts_ && (*contradicts_ - at).norm() > kAnotherPatch_m;
    if (!another) frames = std::min(1.0, (stamp_ - updated_).seconds() / kSingle_s);
    contradicts_ = at;
  }
  gated_ += frames;
  if (gated_ >= params_.max_gated - 1e-9) doubt();
}

/// By value: the caller has the shift from shifts_, which this replaces.
void CeilingFilter::shift_by(CeilingCell shift) {
  if (shift == CeilingCell{}) return;
  x_.head<2>() += cell_centre(grid_, shift);
  turned_about_ += cell_centre(grid_, shift);
  std::map<CeilingCell, Eigen::Index> patches;
  for (const auto& [cell, place] : patches_) patches[{cell.i + shift.i, cell.j + shift.j}] = place;
  patches_ = std::move(patches);
  Shifts shifts;
  for (const auto& [by, weight] : shifts_) shifts[{by.i - shift.i, by.j - shift.j}] = weight;
  shifts_ = std::move(shifts);
  std::set<CeilingCell> judged;
  for (const CeilingCell& cell : judged_) judged.insert({cell.i + shift.i, cell.j + shift.j});
  judged_ = std::move(judged);
  std::set<CeilingCell> anchored;
  for (const CeilingCell& cell : anchored_) anchored.insert({cell.i + shift.i, cell.j + shift.j});
  anchored_ = std::move(anchored);
  if (lone_) lone_ = CeilingCell{lone_->i + shift.i, lone_->j + shift.j};
}

/// Kalman's; the camera's errors are considered and not updated (Schmidt 1966) where patches may be
/// those of the frames before, under other cells: to learn from them anew would count them twice.
Eigen::MatrixXd CeilingFilter::gain(const Linearised& all) const {
  Eigen::MatrixXd K = all.S.ldlt().solve(all.HP).transpose();
  if (cells_unsure_) K.middleRows<3>(3).setZero();
  return K;
}

CeilingFilter::Rest CeilingFilter::fused_state(const Linearised& all) const {
  const Eigen::VectorXd weighed = all.S.ldlt().solve(all.y);
  Eigen::VectorXd step = all.HP.transpose() * weighed;
  if (cells_unsure_) step.segment<3>(3).setZero();
  Rest rest{x_ + step, x_};
  rest.moved.head<3>() += motion_P_ * (all.H.leftCols<3>().transpose() * weighed);
  rest.at[2] = wrap_angle(rest.at[2]);
  rest.moved[2] = wrap_angle(rest.moved[2]);
  return rest;
}

/// Where the update ends: linearised there again until it comes to rest (Bell and Cathey 1993).
CeilingFilter::Rest CeilingFilter::converged(const std::vector<Seen>& seen,
                                             const Pose2& start) const {
  Rest rest = state_at(start);
  for (int i = 0; i < kIterations; ++i) {
    const Rest next = fused_state(linearise(seen, rest));
    const double moved = (next.at - rest.at).head<kCommon>().norm();
    rest = next;
    if (moved < kAtRest) break;
  }
  return rest;
}

/// Each patch by itself may agree with a wide prediction, and two of them not with each other: the
/// place of one, as it was learnt or as it is seen, is not true. It is left out, and what was
/// learnt of it forgotten.
CeilingFilter::Rest CeilingFilter::settle(std::vector<Seen>& passed, const Pose2& start) {
  for (;;) {
    Rest rest = converged(passed, start);
    if (passed.size() < 2) return rest;
    const Linearised all = linearise(passed, rest);
    const Eigen::LDLT<Eigen::MatrixXd> S(all.S);
    const Eigen::VectorXd weighed = S.solve(all.y);
    if (all.y.dot(weighed) <= chi_square_quantile(kTogether, static_cast<double>(all.y.size())))
      return rest;
    const Eigen::MatrixXd inverse = S.solve(Eigen::MatrixXd::Identity(all.S.rows(), all.S.cols()));
    std::size_t worst = 0;
    double most = 0.0;
    for (std::size_t i = 0; i < passed.size(); ++i) {
      const auto row = 3 * static_cast<Eigen::Index>(i);
      const Eigen::Vector3d part = weighed.segment<3>(row);
      const Eigen::Matrix3d own = inverse.block<3, 3>(row, row);
      const double less = part.dot(own.ldlt().solve(part));  // that χ² is without it
      if (less <= most) continue;
      most = less;
      worst = i;
    }
    forget(passed[worst].cell);
    passed.erase(passed.begin() + static_cast<std::ptrdiff_t>(worst));
  }
}

/// What was learnt of a patch's place is bound to what was then believed of the camera's errors,
/// of which the images tell little. Were it linearised in each frame where the mean has come to
/// meanwhile, the difference of two linearisations would count as knowledge: a robot that stands
/// still would learn its tilt. The update is therefore linear in what is seen, and here the places
/// are expressed anew at the mean to which it has led, so that the image of each stays as it was,
/// in mean and covariance (a robot-centred map; Castellanos, Martinez-Cantin, Tardós, Neira 2007).
void CeilingFilter::express_anew(const Eigen::VectorXd& moved) {
  if (anchored_.empty()) return;
  const auto errors_then = CeilingCameraErrors::from_vector(moved.segment<3>(3));
  const Eigen::VectorXd now = x_;
  Eigen::VectorXd off = now - moved;
  off[2] = wrap_angle(off[2]);
  struct Change {
    Eigen::Index place;
    Eigen::Matrix<double, 3, kCommon> common;
    Eigen::Matrix3d own;
  };
  std::vector<Change> changes;
  for (const CeilingCell& cell : anchored_) {
    const Eigen::Index place = patches_.at(cell);
    // As it would be seen from where it was linearised.
    PatchOnCeiling image;
    const PatchRows none = rows_of(cell, image, true, moved);
    image.q = -none.y.head<2>();
    image.psi = wrap_angle(moved[place + 2] - moved[2]);
    const auto then =
        rows_of(cell, with_errors(camera_, image, errors_then, errors_then), true, moved);
    const auto here =
        rows_of(cell, with_errors(camera_, image, errors_then, camera_errors()), true, now);
    const Eigen::Vector3d moved_on =
        then.common * off.head<kCommon>() + then.own * off.segment<3>(place);
    x_.segment<3>(place) += here.own.transpose() * (here.y + moved_on);
    changes.push_back({place, here.own.transpose() * (then.common - here.common),
                       here.own.transpose() * then.own});
  }
  // T P Tᵀ, where T has the common states and a patch's own alone.
  for (const Change& change : changes)
    P_.middleRows<3>(change.place) =
        change.common * P_.topRows<kCommon>() + change.own * P_.middleRows<3>(change.place).eval();
  for (const Change& change : changes)
    P_.middleCols<3>(change.place) = P_.leftCols<kCommon>() * change.common.transpose() +
                                     P_.middleCols<3>(change.place).eval() * change.own.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

/// From now on what was learnt of their places stays as it was seen. Where patches hang as the grid
/// has them nothing is to be learnt, and each frame is linearised by itself.
void CeilingFilter::anchor(const std::vector<Seen>& passed) {
  if (grid_.placement_m < kPlacementLearnt_m) return;
  for (const Seen& one : passed) anchored_.insert(one.cell);
}

/// A patch's place is as unknown as before it was seen.
void CeilingFilter::forget(const CeilingCell& cell) {
  anchored_.erase(cell);
  const Eigen::Index place = patches_.at(cell);
  x_.segment<3>(place).setZero();
  P_.middleRows<3>(place).setZero();
  P_.middleCols<3>(place).setZero();
  P_(place, place) = P_(place + 1, place + 1) = grid_.placement_m * grid_.placement_m;
  P_(place + 2, place + 2) = grid_.placement_turn * grid_.placement_turn;
}

void CeilingFilter::fuse(const Linearised& all, const std::vector<Seen>& seen) {
  const Eigen::MatrixXd K = gain(all);
  x_ += K * all.y;
  x_[2] = wrap_angle(x_[2]);
  // Joseph's form, since the placement errors of a perfect grid have no variance at all:
  // L P Lᵀ + K R Kᵀ with L = I − K H, as L P − (L P Hᵀ − K R) Kᵀ.
  const Eigen::MatrixXd left = P_ - K * all.HP;
  const Eigen::MatrixXd lacking = by_rows(seen, all.H, left.transpose()).transpose() - K * all.R;
  const Eigen::MatrixXd P = left - lacking * K.transpose();
  // What rounding leaves of asymmetry grows from frame to frame, along directions without variance.
  P_ = 0.5 * (P + P.transpose());
}

/// Any patch fits a wide prediction, also one that is none of the grid's: until another bears the
/// fix out it is not believed alone. Called with what a frame is about to teach.
void CeilingFilter::note_lone_patch(const std::vector<Seen>& passed) {
  const CeilingCell& cell = passed.front().cell;
  const bool alone = passed.size() == 1;
  if (alone && wide())
    lone_ = cell;
  else if (!alone || (lone_ && *lone_ != cell))
    lone_.reset();
}

CeilingFilter::Fit CeilingFilter::fit(const std::vector<Seen>& seen) {
  Fit fitted;
  fitted.start = point_of_linearisation(seen);
  fitted.seen = associated(seen, fitted.start.pose);
  hold(fitted.seen, fitted.start.pose, open());
  fitted.passed = passed_gate(fitted.seen, fitted.start.pose);
  return fitted;
}

/// The flow may have followed a shadow. Two or more patches that it contradicts, and that agree
/// with what the robot can have done meanwhile, are believed; not where that is half a pitch.
CeilingFilter::Fit CeilingFilter::fit_against_flow(const std::vector<Seen>& seen) {
  const Eigen::Matrix3d before = P_.topLeftCorner<3, 3>();
  const Eigen::Matrix3d motion_before = motion_P_;
  P_.topLeftCorner<3, 3>() += unknown_motion(0.0, flow_alone_s_);
  motion_P_ += unknown_motion(0.0, flow_alone_s_);
  refresh_belief();
  if (!open()) {
    Fit fitted = fit(seen);
    if (fitted.passed.size() >= 2) return fitted;
  }
  P_.topLeftCorner<3, 3>() = before;
  motion_P_ = motion_before;
  refresh_belief();
  return {};
}

CeilingUpdate CeilingFilter::update(const std::vector<PatchImage>& patches) {
  const std::vector<Seen> seen = see(patches);
  before_.clear();
  for (const Seen& one : seen) before_.push_back(one.patch);
  if (seen.empty()) return CeilingUpdate::none_seen;
  Fit fitted = fit(seen);
  if (fitted.passed.empty() && flow_alone_s_ > 0.0) fitted = fit_against_flow(seen);
  std::vector<Seen>& passed = fitted.passed;
  if (passed.empty()) {
    note_contradiction(seen);
    updated_ = stamp_;
    refresh_belief();
    return CeilingUpdate::gated;
  }
  gated_ = 0.0;
  contradicts_.reset();
  updated_ = stamp_;
  const Rest rest = settle(passed, fitted.start.pose);
  note_lone_patch(passed);
  note_turn(fitted.start);
  const Linearised all = linearise(passed, rest);
  weigh_shifts(all, fitted.seen, Pose2::from_vector(rest.at.head<3>()));
  fuse(all, passed);
  express_anew(rest.moved);
  anchor(passed);
  motion_P_.setZero();
  unknown_s_ = 0.0;
  flow_alone_s_ = 0.0;
  const auto best =
      std::max_element(shifts_.begin(), shifts_.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  shift_by(best->first);
  refresh_belief();
  return CeilingUpdate::fused;
}

void CeilingFilter::take_cell_as_given() {
  shifts_ = {{CeilingCell{}, 1.0}};
  elsewhere_ = false;
  refresh_belief();
}

void CeilingFilter::place(const CeilingTruthState& truth) {
  x_.setZero();
  x_.head<3>() = truth.pose.vector();
  x_.segment<3>(3) = truth.errors.vector();
  for (const auto& [cell, place] : patches_)
    if (const auto found = truth.placement.find(cell); found != truth.placement.end())
      x_.segment<3>(place) = found->second;
  refresh_belief();
}

void CeilingFilter::inform(const CeilingTruthState& truth, const std::vector<PatchImage>& patches) {
  place(truth);
  const std::vector<Seen> seen = associated(see(patches), truth.pose);
  if (seen.empty()) return;
  hold(seen, truth.pose, false);
  place(truth);
  fuse(linearise(seen, {x_, x_}), seen);
  place(truth);
}

/// All, or of too many a systematic sample: one at every n-th part of the weight.
std::vector<std::pair<CeilingCell, double>> CeilingFilter::told_shifts() const {
  std::vector<std::pair<CeilingCell, double>> told(shifts_.begin(), shifts_.end());
  if (told.size() <= kMostHypotheses) return told;
  constexpr double kPart = 1.0 / static_cast<double>(kMostHypotheses);
  double passed = 0.0;
  double next = 0.5 * kPart;
  for (auto& [shift, weight] : told) {
    passed += weight;
    const double parts = std::max(0.0, std::ceil((passed - next) / kPart));
    next += parts * kPart;
    weight = parts * kPart;
  }
  told.erase(
      std::remove_if(told.begin(), told.end(), [](const auto& one) { return one.second <= 0.0; }),
      told.end());
  return told;
}

void CeilingFilter::refresh_belief() {
  belief_.stamp = stamp_;
  belief_.pose = pose();
  belief_.covariance = P_.topLeftCorner<3, 3>();
  const double mount = params_.mount_sigma_m * params_.mount_sigma_m;
  const double yaw = params_.mount_yaw_sigma * params_.mount_yaw_sigma;
  belief_.covariance.diagonal() += Eigen::Vector3d(mount, mount, yaw);
  belief_.hypotheses.clear();
  const double best = shifts_[CeilingCell{}];
  const double doubt = (1.0 - params_.sure) * (spread_ ? kSpreadDoubt : 1.0);
  const bool unsure = best * (1.0 - turned_) < 1.0 - doubt || open() || lone_ || elsewhere_;
  belief_.status = unsure ? BeliefStatus::ambiguous : BeliefStatus::tracking;
  belief_.lost_probability = std::max(
      {1.0 - best * (1.0 - turned_), lone_ ? kLoneDoubt : 0.0, elsewhere_ ? kElsewhere : 0.0});
  if (belief_.status == BeliefStatus::tracking) {
    spread_ = false;
    return;
  }
  for (const auto& [shift, weight] : told_shifts()) {
    const Eigen::Vector2d p = belief_.pose.position() + cell_centre(grid_, shift);
    const double as_believed = weight * (1.0 - turned_);
    belief_.hypotheses.push_back(
        {{p.x(), p.y(), belief_.pose.theta}, belief_.covariance, as_believed});
    if (turned_ <= kNegligible) continue;
    const Eigen::Vector2d q = 2.0 * turned_about_ - p;
    belief_.hypotheses.push_back({{q.x(), q.y(), wrap_angle(belief_.pose.theta + kPi)},
                                  belief_.covariance,
                                  weight * turned_});
  }
}

}  // namespace vigia::localization

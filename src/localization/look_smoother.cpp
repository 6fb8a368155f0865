#include "look_smoother.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

/// An input about a point. With S = L Lᵀ the innovation's covariance, an image has G = L⁻¹ H,
/// W = G P and the whitened innovation y: the update is x + Wᵀ y, P − Wᵀ W.
struct Linearised {
  Eigen::Matrix3d dx_dx = Eigen::Matrix3d::Identity();  ///< of an increment, on the pose
  int rows = 0;  ///< components of the measurement: 3 of a disc, 6 of points, none otherwise
  Matrix6 G_t;   ///< Gᵀ, in the first columns
  Matrix6 W_t;
  Vector6 y;

  /// What the image adds to the adjoint, Gᵀ (W λ + y).
  template <int N>
  Vector6 pull(const Vector6& adjoint) const {
    const Eigen::Matrix<double, N, 1> whitened =
        W_t.leftCols<N>().transpose() * adjoint + y.head<N>();
    return G_t.leftCols<N>() * whitened;
  }
};

Vector6 wrapped(Vector6 difference) {
  difference(2) = wrap_angle(difference(2));
  return difference;
}

/// The increment that leads from @p from to @p to; its turns add up to those of @p read.
OdometryIncrement way_between(const Vector6& from, const Vector6& to,
                              const OdometryIncrement& read) {
  constexpr double kTurnKnown = 1e-3;  // m of way below which its direction is that read
  const Eigen::Vector2d ahead = unit_vector(from(2) + read.rot1);
  const Eigen::Vector2d moved = (to - from).head<2>();
  OdometryIncrement way = read;
  way.trans = ahead.dot(moved);
  if (std::abs(way.trans) < kTurnKnown) return way;
  const double turn = std::atan(cross(ahead, moved) / way.trans);
  way.trans /= std::cos(turn);
  way.rot1 += turn;
  way.rot2 -= turn;
  return way;
}

/// Moves @p state by an increment linearised at @p at and at the way from there to @p next. The
/// derivatives by the heading go with that way: with the way as read, whose error is correlated
/// with what the images say of it, headings and ranges would be biased by a fifth of their sigma.
void pass(const Motion& motion, const Vector6& at, const Vector6& next, const LookModel& model,
          EkfState& state, Linearised& about) {
  const OdometryIncrement& read = motion.increment;
  const Pose2 pose = Pose2::from_vector(at.head<3>());
  const OdometryIncrement way = way_between(at, next, read);
  const Eigen::Vector3d error(read.rot1 - way.rot1, read.trans - way.trans, read.rot2 - way.rot2);
  about.dx_dx = move_jacobian_pose(pose, way);
  state.mean.head<3>() = move(pose, way).vector() + move_jacobian_control(pose, way) * error +
                         about.dx_dx * wrapped(state.mean - at).head<3>();
  state.covariance = propagate_covariance(state.covariance, pose, way,
                                          control_covariance(motion.even, model.odometry));
  state.stamp = read.to;
}

/// Updates @p state by a measurement of N components, H and R at the point of linearisation,
/// @p innovation about the state's mean.
template <int N>
void update(const Eigen::Matrix<double, N, 6>& H, const Eigen::Matrix<double, N, N>& R,
            const Eigen::Matrix<double, N, 1>& innovation, EkfState& state, Linearised& about) {
  const Eigen::Matrix<double, N, 6> HP = H * state.covariance;
  const Eigen::LLT<Eigen::Matrix<double, N, N>> S(HP * H.transpose() + R);
  const Eigen::Matrix<double, N, 6> W = S.matrixL().solve(HP);
  const Eigen::Matrix<double, N, 1> y = S.matrixL().solve(innovation);
  state.mean += W.transpose() * y;
  state.covariance -= W.transpose() * W;
  about.rows = N;
  about.G_t.leftCols<N>() = S.matrixL().solve(H).transpose();
  about.W_t.leftCols<N>() = W.transpose();
  about.y.head<N>() = y;
}

/// Updates @p state by an image linearised at @p at. False when there is none from there.
bool pass(const DiscFix& fix, const Vector6& at, const LookModel& model, EkfState& state,
          Linearised& about) {
  const auto image = predict_disc(fix.landmark, fix.shot, model.on_ground,
                                  Pose2::from_vector(at.head<3>()), {at(3), at(4), at(5)});
  if (!image) return false;
  const Matrix36 H = state_jacobian(*image);
  const Eigen::Matrix3d R = fix.R + reading_covariance(*image, model.sensor);
  update<3>(H, R, fix.z - image->z - H * wrapped(state.mean - at), state, about);
  state.stamp = std::max(state.stamp, fix.shot.stamp);
  return true;
}

bool pass(const PointsFix& fix, const Vector6& at, const LookModel& model, EkfState& state,
          Linearised& about) {
  const auto seen = measure_points(fix.points, fix.landmark.wMl, fix.shot, model.on_ground,
                                   Pose2::from_vector(at.head<3>()), {at(3), at(4), at(5)});
  if (!seen) return false;
  update<6>(seen->H, reading_covariance(*seen, model.sensor),
            seen->y - seen->H * wrapped(state.mean - at), state, about);
  state.stamp = std::max(state.stamp, fix.shot.stamp);
  return true;
}

/// The filter linearised about @p trajectory. False when a landmark has no image from there.
bool forward(const EkfState& start, const std::vector<const EkfInput*>& inputs,
             const std::vector<Vector6>& trajectory, const LookModel& model,
             std::vector<EkfState>& filtered, std::vector<Linearised>& about) {
  filtered.clear();
  about.resize(inputs.size());
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    about[k].dx_dx.setIdentity();
    about[k].rows = 0;
    filtered.push_back(k == 0 ? start : filtered.back());
    if (inputs[k] == nullptr) continue;
    if (const auto* motion = std::get_if<Motion>(inputs[k])) {
      // An image is the last of the inputs.
      pass(*motion, trajectory[k], trajectory[k + 1], model, filtered[k], about[k]);
      continue;
    }
    const auto* disc = std::get_if<DiscFix>(inputs[k]);
    const bool seen = disc != nullptr ? pass(*disc, trajectory[k], model, filtered[k], about[k])
                                      : pass(std::get<PointsFix>(*inputs[k]), trajectory[k], model,
                                             filtered[k], about[k]);
    if (!seen) return false;
  }
  return true;
}

/// The smoothed mean before each input, x − P λ with the adjoint λ of all that comes after.
std::vector<Vector6> backward(const EkfState& start, const std::vector<EkfState>& filtered,
                              const std::vector<Linearised>& about) {
  std::vector<Vector6> smoothed(about.size());
  Vector6 adjoint = Vector6::Zero();
  for (std::size_t k = about.size(); k-- > 0;) {
    const Linearised& input = about[k];
    const EkfState& before = k == 0 ? start : filtered[k - 1];
    if (input.rows == 3) adjoint -= input.pull<3>(adjoint);
    if (input.rows == 6) adjoint -= input.pull<6>(adjoint);
    adjoint.head<3>() = (input.dx_dx.transpose() * adjoint.head<3>()).eval();
    smoothed[k] = before.mean - before.covariance * adjoint;
  }
  return smoothed;
}

double largest_move(const std::vector<Vector6>& from, const std::vector<Vector6>& to) {
  double largest = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k)
    largest = std::max(largest, wrapped(to[k] - from[k]).cwiseAbs().maxCoeff());
  return largest;
}

}  // namespace

std::optional<SmoothedLook> smooth_look(const EkfState& start,
                                        const std::vector<const EkfInput*>& inputs,
                                        std::vector<Vector6> guess, const LookModel& model,
                                        int iterations, double converged) {
  SmoothedLook look{{}, std::move(guess)};
  look.filtered.reserve(inputs.size());
  std::vector<Linearised> about;
  for (int i = 0; i < iterations; ++i) {
    if (!forward(start, inputs, look.trajectory, model, look.filtered, about)) return std::nullopt;
    std::vector<Vector6> smoothed = backward(start, look.filtered, about);
    const double moved = largest_move(look.trajectory, smoothed);
    look.trajectory = std::move(smoothed);
    if (moved < converged) break;
  }
  for (EkfState& state : look.filtered) state.mean.head<3>() = state.pose().vector();
  return look;
}

}  // namespace vigia::localization

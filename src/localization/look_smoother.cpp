#include "look_smoother.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vigia/core/overloaded.hpp"
#include "vigia/core/plane_geometry.hpp"

namespace vigia::localization {
namespace {

/// An input about a point. With S = L Lᵀ the innovation's covariance, an image has G = L⁻¹ H,
/// W = G P and the whitened innovation y: the update is x + Wᵀ y, P − Wᵀ W.
struct StepLinearised {
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
OdometryIncrement increment_between(const Vector6& from, const Vector6& to,
                                    const OdometryIncrement& read) {
  constexpr double kTurnKnown = 1e-3;  // m driven below which the direction is that read
  const Eigen::Vector2d ahead = unit_vector(from(2) + read.rot1);
  const Eigen::Vector2d moved = (to - from).head<2>();
  OdometryIncrement driven = read;
  driven.trans = ahead.dot(moved);
  if (std::abs(driven.trans) < kTurnKnown) return driven;
  const double turn = std::atan(cross(ahead, moved) / driven.trans);
  driven.trans /= std::cos(turn);
  driven.rot1 += turn;
  driven.rot2 -= turn;
  return driven;
}

/// Moves @p state by an increment linearised at @p at and at the motion from there to @p next. The
/// derivatives by the heading go with that motion: with the one read, whose error is correlated
/// with what the images say of it, headings and ranges would be biased by a fifth of their sigma.
void pass(const Motion& motion, const Vector6& at, const Vector6& next, const LookModel& model,
          LookState& state, StepLinearised& about) {
  const OdometryIncrement& read = motion.increment;
  const Pose2 pose = Pose2::from_vector(at.head<3>());
  const OdometryIncrement driven = increment_between(at, next, read);
  const Eigen::Vector3d error(read.rot1 - driven.rot1, read.trans - driven.trans,
                              read.rot2 - driven.rot2);
  about.dx_dx = move_jacobian_pose(pose, driven);
  state.mean.head<3>() = move(pose, driven).vector() + move_jacobian_control(pose, driven) * error +
                         about.dx_dx * wrapped(state.mean - at).head<3>();
  state.covariance = propagate_covariance(state.covariance, pose, driven,
                                          control_covariance(motion.mean_speed, model.odometry));
  state.stamp = read.to;
}

/// L⁻¹. Eigen's triangular solver prepares for large matrices, which costs more than this does.
template <int N>
Eigen::Matrix<double, N, N> inverse_of_lower(const Eigen::Matrix<double, N, N>& L) {
  Eigen::Matrix<double, N, N> inverse = Eigen::Matrix<double, N, N>::Zero();
  for (int j = 0; j < N; ++j) {
    inverse(j, j) = 1.0 / L(j, j);
    for (int i = j + 1; i < N; ++i) {
      double sum = 0.0;
      for (int k = j; k < i; ++k) sum += L(i, k) * inverse(k, j);
      inverse(i, j) = -sum / L(i, i);
    }
  }
  return inverse;
}

/// Updates @p state, which lies @p off from the point of linearisation.
template <int N>
void update(const Linearised<N>& image, const Vector6& off, LookState& state,
            StepLinearised& about) {
  const Eigen::Matrix<double, N, 1> innovation = image.y - image.H * off;
  const Eigen::Matrix<double, N, 6> HP = image.H * state.covariance;
  const Eigen::LLT<Eigen::Matrix<double, N, N>> S(HP * image.H.transpose() + image.R);
  const Eigen::Matrix<double, N, N> whiten = inverse_of_lower<N>(S.matrixL());
  const Eigen::Matrix<double, N, 6> W = whiten * HP;
  const Eigen::Matrix<double, N, 1> y = whiten * innovation;
  state.mean += W.transpose() * y;
  state.covariance -= W.transpose() * W;
  about.rows = N;
  about.G_t.template leftCols<N>() = (whiten * image.H).transpose();
  about.W_t.template leftCols<N>() = W.transpose();
  about.y.template head<N>() = y;
}

/// Updates @p state by an image linearised at @p at. False when there is none from there.
template <typename M>
bool pass(const M& match, const Vector6& at, const LookModel& model, LookState& state,
          StepLinearised& about) {
  const auto image = linearise(model.measurement, match, at);
  if (!image) return false;
  update(*image, wrapped(state.mean - at), state, about);
  state.stamp = std::max(state.stamp, match.shot.stamp);
  return true;
}

/// The filter linearised about @p trajectory. False when a landmark has no image from there.
bool forward(const LookState& start, const std::vector<const LookInput*>& inputs,
             const std::vector<Vector6>& trajectory, const LookModel& model,
             std::vector<LookState>& filtered, std::vector<StepLinearised>& about) {
  filtered.clear();
  about.resize(inputs.size());
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    about[k].dx_dx.setIdentity();
    about[k].rows = 0;
    filtered.push_back(k == 0 ? start : filtered.back());
    if (inputs[k] == nullptr) continue;
    const bool seen = std::visit(
        Overloaded{[&](const Motion& motion) {
                     // An image is the last of the inputs.
                     pass(motion, trajectory[k], trajectory[k + 1], model, filtered[k], about[k]);
                     return true;
                   },
                   [&](const auto& match) {
                     return pass(match, trajectory[k], model, filtered[k], about[k]);
                   }},
        *inputs[k]);
    if (!seen) return false;
  }
  return true;
}

/// The smoothed mean before each input, x − P λ with the adjoint λ of all that comes after.
std::vector<Vector6> backward(const LookState& start, const std::vector<LookState>& filtered,
                              const std::vector<StepLinearised>& about) {
  std::vector<Vector6> smoothed(about.size());
  Vector6 adjoint = Vector6::Zero();
  for (std::size_t k = about.size(); k-- > 0;) {
    const StepLinearised& input = about[k];
    const LookState& before = k == 0 ? start : filtered[k - 1];
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

std::optional<SmoothedLook> smooth_look(const LookState& start,
                                        const std::vector<const LookInput*>& inputs,
                                        std::vector<Vector6> guess, const LookModel& model,
                                        int iterations, double converged) {
  SmoothedLook look{{}, std::move(guess)};
  look.filtered.reserve(inputs.size());
  std::vector<StepLinearised> about;
  for (int i = 0; i < iterations; ++i) {
    if (!forward(start, inputs, look.trajectory, model, look.filtered, about)) return std::nullopt;
    std::vector<Vector6> smoothed = backward(start, look.filtered, about);
    const double moved = largest_move(look.trajectory, smoothed);
    look.trajectory = std::move(smoothed);
    if (moved < converged) break;
  }
  for (LookState& state : look.filtered) state.mean.head<3>() = state.pose().vector();
  return look;
}

}  // namespace vigia::localization

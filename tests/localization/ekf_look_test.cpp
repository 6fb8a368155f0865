#include "localization/drive.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "vigia/localization/ekf.hpp"

namespace vigia::localization {
namespace {

constexpr int kImages = 10;
constexpr double kTick = 0.04;  // s

EkfParams params_of_test() {
  EkfParams params;
  params.centre_floor_px = 0.01;
  params.size_floor = 1e-4;
  params.iterations = 20;
  params.converged = 1e-8;
  return params;
}

/// A look at a landmark near by during which the robot drives an arc, and the wheels' report of it.
struct Look {
  Landmark landmark = test::disc(1, 5.2, 3.3, 1.5, 180.0);
  Prior prior;
  std::vector<OdometryIncrement> measured;  ///< between the images
  std::vector<EllipseObservation> images;
};

Look near_look() {
  Look look;
  RandomStream random(1, "look");
  Pose2 pose{4.0, 3.0, 0.2};
  const Eigen::Vector3d sigma(0.03, 0.03, from_deg(1.2));
  look.prior = {{pose.x + 0.03, pose.y - 0.02, pose.theta - 0.02}, sigma.cwiseAbs2().asDiagonal()};
  const LookBias bias{0.004, -0.003, 0.002};
  for (int i = 0; i < kImages; ++i) {
    const Stamp now = Stamp::from_seconds(kTick * i);
    const Shot shot = test::aimed_shot(look.landmark, {}, pose, bias, 1, now);
    look.images.push_back(test::observe(look.landmark, shot, {}, pose, bias, 0.0, 0.01, random));
    const Stamp next = Stamp::from_seconds(kTick * (i + 1));
    look.measured.push_back(arc_increment(0.3, 0.5, now, next));
    pose = move(pose, arc_increment(0.32, 0.53, now, next));
  }
  look.measured.pop_back();
  return look;
}

/// The whole look as one least-squares problem in the first state and the noise of each increment,
/// solved by Gauss–Newton with numerical derivatives.
class BatchLook {
 public:
  BatchLook(const Look& look, const EkfParams& params) : look_(look), params_(params) {}

  LookState solve() const {
    Eigen::VectorXd unknown = Eigen::VectorXd::Zero(6 + 3 * (kImages - 1));
    Eigen::MatrixXd information;
    for (int i = 0; i < 20; ++i) {
      const auto f = [&](const Eigen::VectorXd& x) { return residuals(x); };
      const Eigen::MatrixXd J = derivative(f, unknown);
      information = J.transpose() * J;
      unknown -= information.ldlt().solve(J.transpose() * f(unknown));
    }
    const auto end = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return trajectory(x).back();
    };
    const Eigen::MatrixXd J = derivative(end, unknown);
    LookState state;
    state.mean = trajectory(unknown).back();
    state.covariance = J * information.ldlt().solve(J.transpose());
    return state;
  }

 private:
  template <typename F>
  static Eigen::MatrixXd derivative(const F& f, const Eigen::VectorXd& x) {
    Eigen::MatrixXd J(f(x).size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const Eigen::VectorXd h = 1e-6 * Eigen::VectorXd::Unit(x.size(), i);
      J.col(i) = (f(x + h) - f(x - h)) / 2e-6;
    }
    return J;
  }

  std::vector<Vector6> trajectory(const Eigen::VectorXd& unknown) const {
    Vector6 state = unknown.head<6>();
    state.head<3>() += look_.prior.pose.vector();
    std::vector<Vector6> states{state};
    for (std::size_t k = 0; k < look_.measured.size(); ++k) {
      OdometryIncrement u = look_.measured[k];
      const Eigen::Vector3d w = unknown.segment<3>(6 + 3 * static_cast<Eigen::Index>(k));
      u.rot1 += w(0);
      u.trans += w(1);
      u.rot2 += w(2);
      state.head<3>() = move(Pose2::from_vector(state.head<3>()), u).vector();
      states.push_back(state);
    }
    return states;
  }

  Eigen::VectorXd residuals(const Eigen::VectorXd& unknown) const {
    const std::vector<Vector6> states = trajectory(unknown);
    Eigen::VectorXd r(unknown.size() + 3 * kImages);
    Vector6 first = unknown.head<6>();
    r.head<3>() = look_.prior.covariance.llt().matrixL().solve(first.head<3>().eval());
    r.segment<3>(3) = look_covariance(params_.sensor).llt().matrixL().solve(first.tail<3>().eval());
    for (std::size_t k = 0; k < look_.measured.size(); ++k) {
      const auto i = 6 + 3 * static_cast<Eigen::Index>(k);
      const Eigen::Matrix3d Q = control_covariance(look_.measured[k], params_.odometry);
      r.segment<3>(i) = unknown.segment<3>(i).cwiseQuotient(Q.diagonal().cwiseSqrt());
    }
    for (std::size_t k = 0; k < look_.images.size(); ++k)
      r.segment<3>(unknown.size() + 3 * static_cast<Eigen::Index>(k)) =
          image_residual(states[k], look_.images[k]);
    return r;
  }

  Eigen::Vector3d image_residual(const Vector6& x, const EllipseObservation& image) const {
    const auto predicted = predict_disc(look_.landmark, image.shot, {},
                                        Pose2::from_vector(x.head<3>()), {x(3), x(4), x(5)});
    const Eigen::Vector3d floor(params_.centre_floor_px, params_.centre_floor_px,
                                params_.size_floor);
    Eigen::Matrix3d R = measured_disc_covariance(image);
    R.diagonal() += floor.cwiseAbs2();
    return R.llt().matrixL().solve(predicted->z - measured_disc(image));
  }

  const Look& look_;
  const EkfParams& params_;
};

TEST(EkfLook, ALookEndsWhereALeastSquaresSolutionOfAllItsImagesEnds) {
  const Look look = near_look();
  const EkfParams params = params_of_test();
  EkfLocalizer ekf(LandmarkMap({look.landmark}), {}, params);
  ekf.reset({}, look.prior);
  for (int i = 0; i < kImages; ++i) {
    const auto k = static_cast<std::size_t>(i);
    ASSERT_EQ(ekf.update(look.images[k]).status, UpdateStatus::fused) << i;
    if (k < look.measured.size()) ekf.predict(look.measured[k]);
  }
  const LookState batch = BatchLook(look, params).solve();
  EXPECT_LT((ekf.state().mean - batch.mean).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_LT((ekf.state().covariance - batch.covariance).norm(), 1e-3 * batch.covariance.norm());
}

TEST(EkfLook, ImagesInReverseOrderGiveWhatTheyGiveInOrder) {
  const Look look = near_look();
  EkfLocalizer in_order(LandmarkMap({look.landmark}), {}, params_of_test());
  EkfLocalizer reversed = in_order;
  in_order.reset({}, look.prior);
  reversed.reset({}, look.prior);
  for (std::size_t k = 0; k < look.images.size(); ++k) {
    in_order.update(look.images[k]);
    if (k < look.measured.size()) in_order.predict(look.measured[k]);
  }
  for (const OdometryIncrement& u : look.measured) reversed.predict(u);
  for (auto image = look.images.rbegin(); image != look.images.rend(); ++image)
    EXPECT_EQ(reversed.update(*image).status, UpdateStatus::fused);
  EXPECT_LT((in_order.state().mean - reversed.state().mean).norm(), 1e-12);
  EXPECT_LT((in_order.state().covariance - reversed.state().covariance).norm(), 1e-12);
}

}  // namespace
}  // namespace vigia::localization

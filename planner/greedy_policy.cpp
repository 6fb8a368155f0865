#include "greedy_policy.hpp"

#include "head_travel.hpp"

#include <cstdio>

#include <Eigen/LU>

namespace vigia::planner {
namespace {

/// The belief's covariance when the robot has moved on from the belief's pose to another.
Eigen::Matrix3d grown(const LookContext& context, const Pose2& to) {
  const Pose2& from = context.belief.pose;
  const auto u = chord_increment(from, to, wrap_angle(to.theta - from.theta), {}, {});
  const Eigen::Matrix3d dx_dx = move_jacobian_pose(from, u);
  const Eigen::Matrix3d dx_du = move_jacobian_control(from, u);
  return dx_dx * context.belief.covariance * dx_dx.transpose() +
         dx_du * control_covariance(u, context.odometry) * dx_du.transpose();
}

/// (P⁻¹ + I)⁻¹ without the inverse of P, which may be singular.
Eigen::Matrix3d fused(const Eigen::Matrix3d& covariance, const Eigen::Matrix3d& information) {
  return (Eigen::Matrix3d::Identity() + covariance * information).inverse() * covariance;
}

class GreedyPolicy final : public LookPolicy {
 public:
  std::string_view name() const override { return "greedy"; }

  std::optional<LookChoice> choose(const LookContext& context) override {
    std::optional<LookChoice> best;
    double least = 0.0;
    for (const Landmark& landmark : context.landmarks.all()) {
      const Arrival arrival = foresee(landmark, std::nullopt, context);
      if (!can_be_held(landmark, arrival, context)) continue;
      const auto information = context.information.look_information(landmark, arrival.pose);
      if (!information) continue;
      const double trace =
          fused(grown(context, arrival.pose), *information).topLeftCorner<2, 2>().trace();
      if (best && trace >= least) continue;
      least = trace;
      best = LookChoice{landmark.id};
    }
    if (best) {
      char text[64];
      std::snprintf(text, sizeof text, "least expected error after the look: %.1f cm",
                    100.0 * std::sqrt(least));
      best->reason = text;
    }
    return best;
  }
};

}  // namespace

std::unique_ptr<LookPolicy> make_greedy_policy() {
  return std::make_unique<GreedyPolicy>();
}

}  // namespace vigia::planner

// A look policy of one's own, asked along a mission's planned path.
// add_policy MISSION.yaml

#include <cmath>
#include <cstdio>
#include <exception>

#include <vigia/mission/mission.hpp>
#include <vigia/mission/planning_parts.hpp>
#include <vigia/planner/look_policy.hpp>
#include <vigia/planner/path_model.hpp>

using namespace vigia;

/// Looks at what is most nearly ahead: the head turns least.
class Ahead final : public planner::LookPolicy {
 public:
  std::string_view name() const override { return "ahead"; }
  std::optional<planner::LookChoice> choose(const planner::LookContext& context) override {
    std::optional<planner::LookChoice> best;
    double least = 0.0;
    const Pose2& pose = context.belief.pose;
    for (const Landmark& landmark : context.landmarks.all()) {
      if (!planner::can_be_observed(landmark, context, pose)) continue;
      const Eigen::Vector2d sight = landmark.centre_w().head<2>() - pose.position();
      const double turn = std::abs(wrap_angle(std::atan2(sight.y(), sight.x()) - pose.theta));
      if (best && turn >= least) continue;
      least = turn;
      best = planner::LookChoice{landmark.id, {}, {}, "most nearly ahead"};
    }
    return best;
  }
};

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  const mission::MissionSetup setup = mission::load_mission(argv[1]);
  const auto visibility = mission::visibility(setup);
  const auto head = mission::head_model(setup);
  const auto information = mission::landmark_information(setup);
  Ahead policy;
  for (double station_m = 0.0; station_m < setup.path.length(); station_m += 1.0) {
    Belief belief;
    belief.pose = planner::pose_on_path(setup.path, station_m);
    const auto choice = policy.choose({{},
                                       belief,
                                       {},
                                       station_m,
                                       setup.path,
                                       setup.world.landmarks,
                                       visibility,
                                       information,
                                       {},
                                       head,
                                       0.3,
                                       false,
                                       setup.noise.odometry});
    if (choice) std::printf("after %4.1f m: landmark %d\n", station_m, choice->landmark);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

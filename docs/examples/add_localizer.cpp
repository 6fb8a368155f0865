// A localizer of one's own rides along on a simulated drive.
// add_localizer MISSION.yaml

#include <cstdio>
#include <exception>

#include <vigia/core/landmark.hpp>
#include <vigia/localization/localizer.hpp>
#include <vigia/mission/mission.hpp>

using namespace vigia;

/// Dead reckoning, of which no covariance is told but one that grows by the metre.
class Plain final : public localization::Localizer {
 public:
  std::string_view name() const override { return "plain"; }
  void reset(Stamp stamp, const std::optional<Prior>& prior) override {
    belief_ = Belief{};
    belief_.stamp = stamp;
    belief_.pose = prior.value_or(anywhere()).pose;
    belief_.covariance = prior.value_or(anywhere()).covariance;
  }
  void predict(const OdometryIncrement& increment) override {
    belief_.pose = move(belief_.pose, increment);
    belief_.covariance += 1e-4 * std::abs(increment.trans) * Eigen::Matrix3d::Identity();
    belief_.stamp = increment.to;
  }
  localization::UpdateResult update(const Observation&) override { return {}; }  // unsupported
  const Belief& belief() const override { return belief_; }
  void lose() override { belief_.status = BeliefStatus::lost; }

 private:
  Belief belief_;
};

/// Gives a localizer what the mission's own are given, tick by tick.
class Ride final : public mission::Listener {
 public:
  explicit Ride(localization::Localizer& localizer) : localizer_(localizer) {}
  void on_start(const mission::MissionStart& start) override {
    localizer_.reset({}, start.setup.prior);
  }
  void on_tick(const mission::Tick& tick) override {
    localizer_.predict(tick.estimator.odometry);
    for (const Observation& each : tick.estimator.observations) localizer_.update(each);
    error_m_ = (localizer_.belief().pose.position() - tick.truth.pose.position()).norm();
  }
  double error_m() const { return error_m_; }

 private:
  localization::Localizer& localizer_;
  double error_m_ = 0.0;
};

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  const mission::MissionSetup setup = mission::load_mission(argv[1]);
  Plain plain;
  Ride ride(plain);
  mission::run_mission(setup, setup.seed, {&ride});
  std::printf("%s is %.1f cm off at the end\n", std::string(plain.name()).c_str(),
              100.0 * ride.error_m());
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

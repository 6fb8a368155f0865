#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/mission/mission.hpp"
#include "vigia/mission/run_folder.hpp"

namespace vigia::mission {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A robot of 0.54 m comes obliquely to a door of 0.65 m.
const std::string kNarrowDoor = std::string(VIGIA_SOURCE_DIR) + "/config/missions/narrow-door.yaml";

class NarrowDoor : public ::testing::Test {
 protected:
  Outcome drive(const MissionSetup& setup, std::uint64_t seed) {
    RunFolder recorder(dir_.path() / "run");
    const Outcome outcome = run_mission(setup, seed, {&recorder});
    recorder.folder().commit();
    return outcome;
  }
  std::string events() const { return vigia::testing::read_text(dir_.path() / "run/events.jsonl"); }
  vigia::testing::TempDir dir_;
};

TEST_F(NarrowDoor, IsPassedByARobotWithARangeRing) {
  const MissionSetup setup = load_mission(kNarrowDoor);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_EQ(drive(setup, seed), Outcome::arrived) << seed;
    EXPECT_THAT(events(), Not(HasSubstr("\"refused\""))) << seed;
  }
}

TEST_F(NarrowDoor, IsRefusedWithItsWidthByARobotThatDoesNotSeeItsFrame) {
  // It trusts its wheels so little that σ across the door is more than the 1.5 cm that fit.
  MissionSetup setup =
      load_mission(kNarrowDoor, {"localization.noise.odometry.trans_per_sqrt_m=0.1"});
  setup.robot.range_ring.reset();
  EXPECT_EQ(drive(setup, 1), Outcome::stuck);
  EXPECT_THAT(events(), HasSubstr("\"event\":\"refused\",\"x_m\":4,\"y_m\":3,\"width_m\":0.65"));
  EXPECT_THAT(events(), HasSubstr("a passage is too narrow and there is no way round"));
}

}  // namespace
}  // namespace vigia::mission

#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/mission/mission.hpp"
#include "vigia/mission/run_folder.hpp"

namespace vigia::mission {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Two rooms with a door of 0.65 m between them, which a robot of 0.54 m comes to obliquely.
constexpr const char* kTwoRooms = R"(
version: 1
name: two-rooms
world:
  name: two-rooms
  room: {width_m: 8, depth_m: 6, height_m: 2.8}
  walls:
    - {from_m: [4, 0], to_m: [4, 2.675]}
    - {from_m: [4, 3.325], to_m: [4, 6]}
  landmarks:
    - {id: 0, kind: disc, centre_m: [0, 1.5, 1.6], normal_deg: 0, radius_m: 0.1}
    - {id: 1, kind: disc, centre_m: [0, 4.5, 1.8], normal_deg: 0, radius_m: 0.1}
    - {id: 2, kind: disc, centre_m: [2, 0, 1.7], normal_deg: 90, radius_m: 0.1}
    - {id: 3, kind: disc, centre_m: [2.6, 6, 1.6], normal_deg: -90, radius_m: 0.1}
    - {id: 4, kind: disc, centre_m: [8, 1.4, 1.7], normal_deg: 180, radius_m: 0.1}
    - {id: 5, kind: disc, centre_m: [8, 4.4, 1.9], normal_deg: 180, radius_m: 0.1}
    - {id: 6, kind: disc, centre_m: [6, 0, 1.8], normal_deg: 90, radius_m: 0.1}
    - {id: 7, kind: disc, centre_m: [5.6, 6, 1.6], normal_deg: -90, radius_m: 0.1}
start: {position_m: [1, 1], heading_deg: 33.7, sigma_m: 0.05, sigma_deg: 1}
route: {goal_m: [7, 5]}
)";

class NarrowDoor : public ::testing::Test {
 protected:
  MissionSetup two_rooms(const std::vector<std::string>& overrides = {}) const {
    const auto file = dir_.path() / "two-rooms.yaml";
    std::ofstream(file) << kTwoRooms << "robot: " << VIGIA_SOURCE_DIR
                        << "/config/robots/b21-qvga.yaml\n";
    return load_mission(file, overrides);
  }
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
  const MissionSetup setup = two_rooms();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_EQ(drive(setup, seed), Outcome::arrived) << seed;
    EXPECT_THAT(events(), Not(HasSubstr("\"refused\""))) << seed;
  }
}

TEST_F(NarrowDoor, IsRefusedWithItsWidthByARobotThatDoesNotSeeItsFrame) {
  // It trusts its wheels so little that σ across the door is more than the 1.5 cm that fit.
  MissionSetup setup = two_rooms({"localization.noise.odometry.trans_per_sqrt_m=0.1"});
  setup.robot.range_ring.reset();
  EXPECT_EQ(drive(setup, 1), Outcome::stuck);
  EXPECT_THAT(events(), HasSubstr("\"event\":\"refused\",\"x_m\":4,\"y_m\":3,\"width_m\":0.65"));
  EXPECT_THAT(events(), HasSubstr("a passage is too narrow and there is no way round"));
}

}  // namespace
}  // namespace vigia::mission

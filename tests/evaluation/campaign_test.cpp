#include "vigia/evaluation/campaign.hpp"

#include "support/temp_dir.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"

namespace vigia::evaluation {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CampaignFile : public ::testing::Test {
 protected:
  /// A campaign of the room with these lines in its file.
  Campaign read(const std::string& lines, const std::vector<std::string>& overrides = {}) const {
    const auto file = dir_.path() / "campaign.yaml";
    std::ofstream(file) << "version: 1\nname: trial\nmission: " << VIGIA_SOURCE_DIR
                        << "/config/missions/armingol-room.yaml\n"
                        << lines;
    return read_campaign(file, overrides);
  }
  std::string mistake(const std::string& lines) const {
    try {
      read(lines);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  static std::vector<std::string> names(const Campaign& campaign) {
    std::vector<std::string> names;
    for (const auto& arm : campaign.arms) names.push_back(arm.name);
    return names;
  }
  /// The disturbances that an arm's mission switches on.
  static std::vector<std::string> on(const Arm& arm) {
    const sim::DisturbanceParams& d = arm.setup.disturbances;
    std::vector<std::string> names;
    const auto note = [&](const char* name, bool is_on) {
      if (is_on) names.emplace_back(name);
    };
    note("motion_blur", d.motion_blur.has_value());
    note("latency", d.latency.has_value());
    note("light", d.light.has_value());
    note("mounting", d.mounting.has_value());
    note("zoom_calibration", d.zoom_calibration.has_value());
    note("principal_point", d.principal_point.has_value());
    note("backlash", d.backlash.has_value());
    note("wheel_slip", d.wheel_slip.has_value());
    note("map_error", d.map_error.has_value());
    note("missing_landmarks", d.missing_landmarks.has_value());
    note("people", d.people.has_value());
    note("clutter", d.clutter.has_value());
    note("kidnapping", d.kidnapping.has_value());
    return names;
  }
  vigia::testing::TempDir dir_;
};

TEST_F(CampaignFile, OfOneMissionHasOneArmThatBearsItsPolicysName) {
  const Campaign campaign = read("seeds: {first: 7, count: 3}\n");
  EXPECT_THAT(names(campaign), ElementsAre("nearest"));
  EXPECT_EQ(campaign.first_seed, 7u);
  EXPECT_EQ(campaign.missions(), 3u);
}

TEST_F(CampaignFile, MultipliesItsListsAndNamesArmsByWhatDiffers) {
  const Campaign campaign = read(
      "policies: [nearest, random]\nlocalizers: [ekf]\n"
      "variants: [{name: short}, {name: long, set: [planner.dwell_s=2]}]\n"
      "set: [timeout_s=50]\nbaseline: random/short\n");
  EXPECT_THAT(names(campaign),
              ElementsAre("nearest/short", "nearest/long", "random/short", "random/long"));
  EXPECT_EQ(campaign.baseline, 2u);
  EXPECT_EQ(campaign.arms[3].setup.look.policy, "random");
  EXPECT_EQ(campaign.arms[3].setup.look.dwell_s, 2.0);
  EXPECT_EQ(campaign.arms[2].setup.look.dwell_s, 1.0);
  for (const auto& arm : campaign.arms) EXPECT_EQ(arm.setup.timeout_s, 50.0);
}

TEST_F(CampaignFile, IsOverriddenInEveryArm) {
  const Campaign campaign =
      read("policies: [nearest, random]\nset: [timeout_s=50]\n", {"timeout_s=60"});
  for (const auto& arm : campaign.arms) EXPECT_EQ(arm.setup.timeout_s, 60.0);
}

TEST_F(CampaignFile, SwitchesOnOneDisturbanceAnArmNoneOrAllButKidnapping) {
  // The mission's own disturbances are no part of an arm.
  const Campaign campaign = read(
      "set: [disturbances.light=realistic]\ndisturbances: [none, wheel_slip, kidnapping, all]\n");
  EXPECT_THAT(names(campaign), ElementsAre("none", "wheel_slip", "kidnapping", "all"));
  EXPECT_THAT(on(campaign.arms[0]), ElementsAre());
  EXPECT_THAT(on(campaign.arms[1]), ElementsAre("wheel_slip"));
  EXPECT_THAT(on(campaign.arms[2]), ElementsAre("kidnapping"));
  EXPECT_THAT(on(campaign.arms[3]),
              ElementsAre("motion_blur", "latency", "light", "mounting", "zoom_calibration",
                          "principal_point", "backlash", "wheel_slip", "map_error",
                          "missing_landmarks", "people", "clutter"));
  const auto& slip = *campaign.arms[1].setup.disturbances.wheel_slip;
  EXPECT_EQ(slip.per_m, sim::WheelSlipParams{}.per_m);
  EXPECT_EQ(slip.skew_per_m, sim::WheelSlipParams{}.skew_per_m);
  EXPECT_EQ(campaign.arms[1].disturbance, "wheel_slip");
  EXPECT_NE(campaign.arms[0].setup.resolved_yaml, campaign.arms[1].setup.resolved_yaml);
}

TEST_F(CampaignFile, CrossesDisturbancesWithPolicies) {
  const Campaign campaign = read("policies: [nearest, random]\ndisturbances: [none, people]\n");
  EXPECT_THAT(names(campaign),
              ElementsAre("nearest/none", "nearest/people", "random/none", "random/people"));
  EXPECT_EQ(campaign.arms[3].setup.look.policy, "random");
  EXPECT_THAT(on(campaign.arms[3]), ElementsAre("people"));
}

TEST_F(CampaignFile, RejectsADisturbanceThatTheMissionDoesNotKnow) {
  const std::string message = mistake("disturbances: [none, gremlins]\n");
  EXPECT_THAT(message, HasSubstr("campaign.yaml:4:15"));
  EXPECT_THAT(message, HasSubstr("disturbances"));
}

TEST_F(CampaignFile, ReportsAMistakeOfTheMissionWhereTheCampaignMakesIt) {
  const std::string message = mistake("policies: [nearest, oracel]\n");
  EXPECT_THAT(message, HasSubstr("campaign.yaml:4:11"));
  EXPECT_THAT(message, HasSubstr("oracel"));
}

TEST_F(CampaignFile, RejectsABaselineThatIsNoArm) {
  EXPECT_THAT(mistake("policies: [nearest, random]\nbaseline: fixed\n"),
              HasSubstr("must be the name of an arm: nearest, random"));
}

TEST_F(CampaignFile, RejectsTheSameArmTwice) {
  EXPECT_THAT(mistake("policies: [nearest, nearest]\n"), HasSubstr("twice"));
}

TEST_F(CampaignFile, RejectsWhatIsNoList) {
  EXPECT_THAT(mistake("policies: nearest\n"), HasSubstr("must be a list of texts"));
  EXPECT_THAT(mistake("policies: []\n"), HasSubstr("the list is empty"));
}

TEST_F(CampaignFile, RejectsANameThatWouldSpoilATable) {
  EXPECT_THAT(mistake("variants: [{name: \"a,b\"}]\n"), HasSubstr("a,b"));
}

TEST_F(CampaignFile, RejectsUnknownKeys) {
  EXPECT_THAT(mistake("policy: [nearest]\n"), HasSubstr("policies"));
}

}  // namespace
}  // namespace vigia::evaluation

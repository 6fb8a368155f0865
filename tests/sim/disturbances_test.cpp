#include "vigia/sim/disturbances.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vigia::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

DisturbanceParams params_of(const std::string& keys) {
  MapReader reader(parse_config("version: 1\n" + keys + "\n", "mission.yaml"), "mission");
  return read_disturbances(reader.map("disturbances"));
}

std::string error_of(const std::string& keys) {
  try {
    params_of(keys);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Disturbances, AreOffUnlessAsked) {
  const DisturbanceParams params = params_of("other: 1");
  EXPECT_FALSE(params.motion_blur || params.latency || params.light || params.mounting ||
               params.zoom_calibration || params.principal_point || params.backlash ||
               params.wheel_slip || params.map_error || params.missing_landmarks || params.people ||
               params.clutter || params.kidnapping);
}

TEST(Disturbances, AllSwitchesEveryOneButKidnapping) {
  const DisturbanceParams params = params_of("disturbances: {all: realistic}");
  EXPECT_TRUE(params.motion_blur && params.latency && params.light && params.mounting &&
              params.zoom_calibration && params.principal_point && params.backlash &&
              params.wheel_slip && params.map_error && params.missing_landmarks && params.people &&
              params.clutter);
  EXPECT_FALSE(params.kidnapping);
}

TEST(Disturbances, ASingleKeyOverridesAll) {
  const DisturbanceParams params = params_of(
      "disturbances: {all: realistic, people: off, kidnapping: realistic, latency: {latency_s: "
      "0.2}}");
  EXPECT_FALSE(params.people);
  EXPECT_TRUE(params.kidnapping);
  EXPECT_DOUBLE_EQ(params.latency->latency_s, 0.2);
}

TEST(Disturbances, WhatAMapLeavesOutIsRealistic) {
  const auto slip = params_of("disturbances: {wheel_slip: {per_m: 3}}").wheel_slip;
  EXPECT_DOUBLE_EQ(slip->per_m, 3.0);
  EXPECT_DOUBLE_EQ(slip->max_loss, WheelSlipParams{}.max_loss);
}

TEST(Disturbances, WhatIsReadIsWrittenOutAndReadsBackTheSame) {
  const auto root =
      parse_config("version: 1\ndisturbances: {all: realistic, people: {count: 2}, light: off}\n",
                   "mission.yaml");
  MapReader reader(root, "mission");
  read_disturbances(reader.map("disturbances"));
  const std::string resolved = dump_config(*root);
  EXPECT_THAT(resolved, AllOf(HasSubstr("backlash: realistic"), HasSubstr("distance_m: 0.4"),
                              HasSubstr("kidnapping:")));
  MapReader again(parse_config(resolved, "again.yaml"), "mission");
  const DisturbanceParams params = read_disturbances(again.map("disturbances"));
  EXPECT_EQ(params.people->count, 2);
  EXPECT_FALSE(params.light || params.kidnapping);
}

TEST(Disturbances, SayWhereAndWhatIsWrong) {
  EXPECT_THAT(error_of("disturbances: {light: strong}"),
              AllOf(HasSubstr("mission.yaml:2:"), HasSubstr("light"), HasSubstr("off, realistic")));
  EXPECT_THAT(error_of("disturbances: {wheel_slips: off}"),
              AllOf(HasSubstr("unknown key"), HasSubstr("wheel_slip")));
  EXPECT_THAT(error_of("disturbances: {people: {count: -1}}"),
              AllOf(HasSubstr("people.count"), HasSubstr("[0, 50]")));
  EXPECT_THAT(error_of("disturbances: {latency: {latency_ms: 80}}"),
              AllOf(HasSubstr("latency_ms"), HasSubstr("latency_s")));
  EXPECT_THAT(error_of("disturbances: {kidnapping: {earliest_s: 50, latest_s: 20}}"),
              HasSubstr("latest_s"));
  EXPECT_THAT(error_of("disturbances: [people]"), HasSubstr("must be a map"));
}

}  // namespace
}  // namespace vigia::sim

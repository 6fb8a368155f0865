#include "vigia/report/replay_page.hpp"

#include "base64.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vigia::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ReplayRun drive(std::size_t ticks) {
  ReplayRun run;
  run.name = "a-room";
  run.summary_json = R"({"outcome": "arrived", "sim_s": 4.0, "localizers": {}})";
  run.localizers.push_back({"ekf", true, {}, {}});
  for (std::size_t i = 0; i < ticks; ++i) {
    const double t = 0.04 * static_cast<double>(i + 1);
    run.t_s.push_back(t);
    run.truth.push_back({t, 0.0, 0.0});
    run.target.push_back(std::nullopt);
    Belief belief;
    belief.pose = {t, 0.03, 0.1};
    belief.covariance = Eigen::Vector3d(4e-4, 1e-4, 1e-5).asDiagonal();
    run.localizers[0].beliefs.push_back(belief);
    run.localizers[0].bound_m.push_back(0.01);
  }
  return run;
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const auto begin = text.find(from) + from.size();
  return text.substr(begin, text.find(to, begin) - begin);
}

nlohmann::json data_of(const std::string& page) {
  return nlohmann::json::parse(
      between(page, "<script type=\"application/json\" id=\"data\">", "</script>"));
}

TEST(ReplayPage, HoldsTheDrivesErrorsUncertaintyAndBound) {
  const auto run = data_of(replay_page({drive(100)}))["runs"][0];
  ASSERT_EQ(run["t"].size(), 100U);
  const auto& ekf = run["localizers"][0];
  EXPECT_DOUBLE_EQ(ekf["error"][7], 0.03);
  EXPECT_DOUBLE_EQ(ekf["turn"][7], 0.1);
  EXPECT_DOUBLE_EQ(ekf["sigma"][7], 0.02);
  EXPECT_DOUBLE_EQ(ekf["bound"][7], 0.01);
  EXPECT_EQ(run["summary"]["outcome"], "arrived");
}

TEST(ReplayPage, ThinsOutALongDriveAndKeepsItsEnds) {
  const auto run = data_of(replay_page({drive(1000)}, 300))["runs"][0];
  EXPECT_LE(run["t"].size(), 301U);
  EXPECT_EQ(run["t"].size(), run["localizers"][0]["x"].size());
  EXPECT_DOUBLE_EQ(run["t"].front(), 0.04);
  EXPECT_DOUBLE_EQ(run["t"].back(), 40.0);
}

TEST(ReplayPage, ShowsHostileNamesAsText) {
  ReplayRun run = drive(5);
  run.name = "</title></script><script>alert(1)</script>";
  run.events.push_back({0.1, "look", "<!--<script>alert(2)</script>"});
  run.command = "\xff\xfe not UTF-8";
  const std::string page = replay_page({run});
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("</title></script>")));
  const auto data = data_of(page)["runs"][0];
  EXPECT_EQ(data["name"], run.name);
  EXPECT_EQ(data["events"][0]["text"], run.events[0].text);
}

TEST(ReplayPage, RefersToNothingElse) {
  const std::string page = replay_page({drive(5)});
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("<script src")));
  EXPECT_THAT(page, Not(HasSubstr("stylesheet")));
}

TEST(ReplayPage, HoldsTheSuitabilityOfLandmarksAndLeavesOutWhereThereIsNone) {
  ReplayRun run = drive(5);
  run.suitability = {{0.04, 0.2}, {{7, {0.625, NAN}}}};
  const auto timeline = data_of(replay_page({run}))["runs"][0]["suitability"];
  EXPECT_EQ(timeline,
            nlohmann::json::parse(
                R"({"t": [0.04, 0.2], "landmarks": [{"id": 7, "values": [0.63, null]}]})"));
  run.suitability.t_s.pop_back();
  EXPECT_THROW(replay_page({run}), std::invalid_argument);
}

TEST(ReplayPage, LeavesValuesThatAreNotFiniteOut) {
  ReplayRun run = drive(5);
  run.localizers[0].beliefs[2].pose.x = NAN;
  run.localizers[0].beliefs[3].covariance.setConstant(INFINITY);
  const auto ekf = data_of(replay_page({run}))["runs"][0]["localizers"][0];
  EXPECT_TRUE(ekf["x"][2].is_null());
  EXPECT_TRUE(ekf["vx"][3].is_null());
}

TEST(ReplayPage, RejectsColumnsThatDoNotFit) {
  EXPECT_THROW(replay_page({}), std::invalid_argument);
  EXPECT_THROW(replay_page({ReplayRun{}}), std::invalid_argument);
  ReplayRun run = drive(5);
  run.truth.pop_back();
  EXPECT_THROW(replay_page({run}), std::invalid_argument);
}

TEST(Base64, IsThatOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\x00\xfe", 3)), "/wD+");
}

}  // namespace
}  // namespace vigia::report

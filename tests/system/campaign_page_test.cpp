#include "short_campaign.hpp"

#include <gmock/gmock.h>

namespace vigia {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using vigia::testing::read_text;

/// The data that a page holds.
nlohmann::json data_of(const fs::path& page) {
  const std::string text = read_text(page);
  const std::string before = "<script type=\"application/json\" id=\"data\">";
  const auto begin = text.find(before) + before.size();
  return nlohmann::json::parse(text.substr(begin, text.find("</script>", begin) - begin));
}

/// A folder with a campaign's summary and table, as `evaluate` would have left them.
class CampaignPage : public ShortCampaign {
 protected:
  static constexpr const char* kHeader =
      "seed,outcome,localizer,position_final_m,position_rmse_m,position_max_m,"
      "pcrlb_position_rms_m,arm,primary\n";

  void SetUp() override {
    fs::create_directories(out_ / "missions");
    put("summary.json", R"({"campaign": "by hand", "arms": [{"name": "near", "runs": 2}]})");
    put("results.csv", std::string(kHeader) + "1,arrived,ekf,0.01,0.02,0.05,0.015,near,ekf\n" +
                           "1,arrived,odometry,0.3,0.4,0.9,0.35,near,ekf\n" +
                           "2,collided,ekf,0.02,0.04,0.07,0.015,near,ekf\n");
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(out_ / name) << text;
  }
  vigia::testing::ProcessResult report() const { return vigia("report " + out_.string()); }
  void expect_refused(const std::string& message) const {
    const auto result = report();
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_FALSE(fs::exists(page_));
  }
  Path page_ = out_ / "report.html";
};

TEST_F(CampaignPage, IsWrittenAtTheEndOfACampaignAndSaysWhatItsFolderSays) {
  write_campaign(2);
  ASSERT_EQ(evaluate(whole_).status, 1);
  const auto data = data_of(whole_ / "report.html");
  EXPECT_EQ(data["summary"], nlohmann::json::parse(read_text(whole_ / "summary.json")));
  EXPECT_EQ(data["results"].size(), 2U);
  EXPECT_EQ(data["results"][0]["outcomes"][0]["of"], 2);
  EXPECT_EQ(data["bands"].size(), 1U);
  const std::string first = read_text(whole_ / "report.html");
  const auto again = vigia("report " + whole_.string());
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out, (whole_ / "report.html").string() + "\n");
  EXPECT_EQ(read_text(whole_ / "report.html"), first);
}

TEST_F(CampaignPage, TakesTheFiguresOfTheDrivingLocalizer) {
  ASSERT_EQ(report().status, 0);
  const auto arm = data_of(page_)["results"][0];
  EXPECT_EQ(arm["boxes"]["position_max_m"]["max"], 0.07);
  const auto& rmse = arm["boxes"]["position_rmse_m"];
  EXPECT_DOUBLE_EQ(rmse["low"], 0.021);
  EXPECT_DOUBLE_EQ(rmse["q1"], 0.025);
  EXPECT_DOUBLE_EQ(rmse["median"], 0.03);
  EXPECT_DOUBLE_EQ(rmse["high"], 0.039);
  EXPECT_EQ(arm["points"], nlohmann::json::parse("[[0.015, 0.02], [0.015, 0.04]]"));
  EXPECT_EQ(arm["outcomes"][1]["name"], "collided");
  EXPECT_EQ(arm["outcomes"][1]["count"], 1);
  EXPECT_NEAR(arm["outcomes"][1]["low"], 0.0126, 1e-4);  // 1 − 0.975^(1/2)
}

TEST_F(CampaignPage, ShowsHostileNamesAsText) {
  const std::string name = "</script><script>alert(1)</script>";
  put("summary.json", R"({"campaign": ")" + name + R"(", "arms": [{"name": ")" + name +
                          R"("}], "worst": [{"command": ")" + name + R"("}]})");
  put("results.csv", std::string(kHeader) + "1,arrived,ekf,1,1,1,1," + name + ",ekf\n");
  ASSERT_EQ(report().status, 0);
  EXPECT_THAT(read_text(page_), Not(HasSubstr("<script>alert")));
  const auto data = data_of(page_);
  EXPECT_EQ(data["results"][0]["name"], name);
  EXPECT_EQ(data["summary"]["worst"][0]["command"], name);
}

TEST_F(CampaignPage, SaysThatATableIsMissingOrTooLarge) {
  fs::remove(out_ / "results.csv");
  auto result = report();
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("There is no results.csv"));
  EXPECT_EQ(data_of(page_)["notes"].size(), 1U);
  put("results.csv", "");
  fs::resize_file(out_ / "results.csv", 2'000'000'000);  // sparse
  result = report();
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("results.csv has 2.0 GB"));
  EXPECT_THAT(std::string(data_of(page_)["notes"][0]), HasSubstr("distributions are left out"));
}

TEST_F(CampaignPage, RefusesATableThatWasCutOffOrIsNone) {
  put("results.csv", std::string(kHeader) + "1,arrived,ekf,0.01,0.02,0.05,0.015,near,ek");
  expect_refused("results.csv:2: is cut off: found 9 cells without a line feed, must be 9");
  put("results.csv", std::string(kHeader) + "1,arrived,ekf,0.01\n");
  expect_refused("results.csv:2: is cut off: found 4 cells, must be 9");
  put("results.csv", std::string(kHeader) + "1,arrived,ekf,a lot,0.02,0.05,0.015,near,ekf\n");
  expect_refused("results.csv:2: position_final_m: found 'a lot', must be a number");
  put("results.csv", "seed,outcome,localizer\n1,arrived,ekf\n");
  expect_refused("results.csv:1: has no column 'primary': written by another version");
  put("results.csv", "");
  expect_refused("results.csv:1: is empty");
}

TEST_F(CampaignPage, RefusesASummaryThatIsMissingOrNone) {
  put("summary.json", R"({"mission": "a run's"})");
  expect_refused("summary.json: has no list 'arms', must be a campaign's");
  put("summary.json", R"({"campaign": "cut o)");
  expect_refused("summary.json is no JSON object");
  fs::resize_file(out_ / "summary.json", 2'000'000'000);
  expect_refused("summary.json is too large to be one");
  fs::remove(out_ / "summary.json");
  expect_refused("is no campaign's folder: there is no summary.json; `vigia evaluate` makes one");
}

TEST_F(CampaignPage, ComesOfASummaryOfAnotherVersionWithWhatItHas) {
  put("summary.json",
      R"({"campaign": 7, "arms": [{"name": "near", "runs": "two", "means": 3}, 4, null], "seeds": 1})");
  EXPECT_EQ(report().status, 0);
  EXPECT_EQ(data_of(page_)["title"], "Campaign ");
  EXPECT_EQ(data_of(page_)["bands"].size(), 0U);
}

TEST_F(CampaignPage, IsOfOneCampaign) {
  const auto result = vigia("report " + out_.string() + " " + out_.string());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("must be run folders, or one campaign's"));
}

}  // namespace
}  // namespace vigia

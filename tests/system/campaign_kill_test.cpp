#include "short_campaign.hpp"

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

namespace vigia {
namespace {

namespace fs = std::filesystem;
using vigia::testing::read_text;

constexpr int kKills = VIGIA_KILLS;
constexpr int kShards = 3;

class KilledCampaign : public ShortCampaign {
 protected:
  using Seconds = std::chrono::duration<double>;

  void SetUp() override {
    write_campaign(30);
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_EQ(evaluate(whole_).status, 1);
    takes_ = std::chrono::steady_clock::now() - begin;
  }
  /// Kills the program at a moment between its start and the end of a whole evaluation. Gives
  /// whether it lived until then.
  bool kill_once(const std::string& arguments) {
    const pid_t child = start(arguments);
    std::this_thread::sleep_for(takes_ * std::uniform_real_distribution<>(0.0, 1.0)(random_));
    ::kill(child, SIGKILL);
    return WIFSIGNALED(wait_for(child));
  }
  static int lines(const fs::path& file) {
    const std::string text = read_text(file);
    return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  }
  std::size_t finished() const {
    std::size_t sum = 0;
    const auto json = status(out_);
    for (const auto& shard : json["shards"]) sum += shard["finished"].get<std::size_t>();
    return sum;
  }
  std::mt19937 random_{16};
  Seconds takes_{0.0};
};

TEST_F(KilledCampaign, LosesNoFinishedMissionOfAShard) {
  ASSERT_EQ(plan(out_, kShards).status, 0);
  int killed = 0;
  std::size_t before = 0;
  for (int i = 0; i < kKills; ++i) {
    killed +=
        kill_once(step("run-shard", out_) + std::to_string(1 + i % kShards) + " -j 1") ? 1 : 0;
    const std::size_t now = finished();
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_GT(killed, 0);
  for (int k = 1; k <= kShards; ++k) EXPECT_EQ(run_shard(out_, k).status, 0);
  EXPECT_EQ(finished(), 60u);
  EXPECT_EQ(vigia(step("merge", out_)).status, 1);
  expect_same_results(out_, whole_);
}

TEST_F(KilledCampaign, HasWholeResultsOrNoneWhileItIsMerged) {
  ASSERT_EQ(plan(out_, kShards).status, 0);
  for (int k = 1; k <= kShards; ++k) ASSERT_EQ(run_shard(out_, k).status, 0);
  for (int i = 0; i < kKills; ++i) {
    kill_once(step("merge", out_));
    for (const char* name : kResults) {
      if (!fs::exists(out_ / name)) continue;
      EXPECT_EQ(read_text(out_ / name), read_text(whole_ / name)) << name;
      fs::remove(out_ / name);
    }
  }
  EXPECT_EQ(finished(), 60u);
  EXPECT_EQ(vigia(step("merge", out_)).status, 1);
  expect_same_results(out_, whole_);
}

TEST_F(KilledCampaign, LosesNoFinishedMissionOfAnEvaluation) {
  int killed = 0;
  int before = 0;
  for (int i = 0; i < kKills; ++i) {
    killed += kill_once("evaluate " + file_.string() + " --quiet -j 2 --out " + out_.string());
    const int now = lines(out_ / "journal.jsonl");
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_GT(killed, 0);
  EXPECT_EQ(evaluate(out_).status, 1);
  EXPECT_EQ(lines(out_ / "journal.jsonl"), 60);
  expect_same_results(out_, whole_);
}

}  // namespace
}  // namespace vigia

#include <gtest/gtest.h>

#include "vigia/evaluation/seed_runs.hpp"

namespace vigia {
namespace {

mission::MissionSetup short_mission() {
  return mission::load_mission(
      std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml", {"timeout_s=6"});
}

std::vector<std::string> summaries(const mission::MissionSetup& setup, int threads) {
  std::vector<std::string> texts;
  for (const auto& score : evaluation::run_seeds(setup, 1, 4, threads))
    texts.push_back(evaluation::summary_json(score));
  return texts;
}

TEST(Determinism, TheSameSeedGivesTheSameBytesTwiceInAProcess) {
  const auto setup = short_mission();
  EXPECT_EQ(summaries(setup, 1), summaries(setup, 1));
}

TEST(Determinism, TheSameSeedGivesTheSameBytesOnOneThreadAndTwo) {
  const auto setup = short_mission();
  EXPECT_EQ(summaries(setup, 1), summaries(setup, 2));
}

TEST(Determinism, LoadingTheMissionAgainPlansTheSameRoute) {
  const auto first = short_mission();
  const auto second = short_mission();
  EXPECT_EQ(first.path.points(), second.path.points());
}

TEST(Determinism, AnotherSeedGivesAnotherDrive) {
  const auto setup = short_mission();
  const auto texts = summaries(setup, 2);
  EXPECT_NE(texts[0], texts[1]);
}

}  // namespace
}  // namespace vigia

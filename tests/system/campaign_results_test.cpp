#include "short_campaign.hpp"

#include <memory>

#include <gmock/gmock.h>
#include <sqlite3.h>

namespace vigia {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using vigia::testing::read_text;

using Rows = std::vector<std::vector<std::string>>;

/// The rows of a query; NULL reads "NULL".
Rows query(const fs::path& file, const std::string& sql) {
  sqlite3* opened = nullptr;
  EXPECT_EQ(sqlite3_open(file.c_str(), &opened), SQLITE_OK);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(opened, sqlite3_close);
  Rows rows;
  const auto add = [](void* to, int columns, char** values, char** /*names*/) {
    auto& row = static_cast<Rows*>(to)->emplace_back();
    for (int i = 0; i < columns; ++i) row.emplace_back(values[i] == nullptr ? "NULL" : values[i]);
    return 0;
  };
  char* message = nullptr;
  EXPECT_EQ(sqlite3_exec(opened, sql.c_str(), add, &rows, &message), SQLITE_OK)
      << (message == nullptr ? "" : message) << "\n"
      << sql;
  sqlite3_free(message);
  return rows;
}

class CampaignResults : public ShortCampaign {
 protected:
  void SetUp() override {
    write_campaign(3, ", timeout_s=12");
    const auto result =
        vigia("evaluate " + file_.string() + " --quiet -j 2 --out " + whole_.string() +
              " --sqlite " + sqlite_.string() + " --ompl-log " + log_.string());
    ASSERT_EQ(result.status, 1) << result.err;
  }
  Path sqlite_ = dir_.path() / "results.sqlite";
  Path log_ = dir_.path() / "results.log";
};

TEST_F(CampaignResults, AsSqliteHoldWhatTheSummaryHolds) {
  const auto summary = nlohmann::json::parse(read_text(whole_ / "summary.json"));
  EXPECT_THAT(query(sqlite_, "SELECT name, configuration, command, seeds FROM campaign"),
              ElementsAre(ElementsAre("short", summary["configuration"].get<std::string>(),
                                      summary["command"].get<std::string>(), "3")));
  EXPECT_THAT(query(sqlite_, "SELECT name FROM arms ORDER BY arm"),
              ElementsAre(ElementsAre("nearest"), ElementsAre("random")));
  EXPECT_THAT(query(sqlite_, "SELECT count(*) FROM missions"), ElementsAre(ElementsAre("6")));
  const auto worst =
      query(sqlite_,
            "SELECT command, position_max_m FROM missions JOIN localizers USING "
            "(mission) WHERE localizer = 'ekf' ORDER BY position_max_m DESC LIMIT 1");
  EXPECT_EQ(worst.at(0).at(0), summary["worst"][0]["command"]);
  // SQLite's text has fifteen digits.
  EXPECT_NEAR(std::stod(worst.at(0).at(1)), summary["worst"][0]["position_max_m"].get<double>(),
              1e-14);
  EXPECT_NE(query(sqlite_, "SELECT count(*) FROM looks")[0][0], "0");
}

TEST_F(CampaignResults, AsSqliteAnswerTheQueriesOfThePage) {
  const std::string page = read_text(fs::path(VIGIA_SOURCE_DIR) / "docs/results.md");
  int queries = 0;
  for (std::size_t at = page.find("```sql\n"); at != std::string::npos;
       at = page.find("```sql\n", at + 1)) {
    const std::size_t begin = at + 7;
    const std::string sql = page.substr(begin, page.find("```", begin) - begin);
    EXPECT_FALSE(query(sqlite_, sql).empty()) << sql;
    ++queries;
  }
  EXPECT_EQ(queries, 5);
}

TEST_F(CampaignResults, OfShardsAreTheSameSqliteRows) {
  const Path merged = dir_.path() / "merged.sqlite";
  ASSERT_EQ(plan(out_, 2).status, 0);
  for (const int k : {2, 1}) ASSERT_EQ(run_shard(out_, k).status, 0);
  ASSERT_EQ(vigia(step("merge", out_) + "--sqlite " + merged.string()).status, 1);
  for (const char* table : {"campaign", "arms", "missions", "localizers", "looks", "losses"}) {
    const std::string all = std::string("SELECT * FROM ") + table;
    EXPECT_EQ(query(merged, all), query(sqlite_, all)) << table;
  }
}

TEST_F(CampaignResults, AsSqliteAreRefusedByAFullDisk) {
  const auto full = vigia::testing::run_process(
      "sh -c \"trap '' 25; ulimit -f 40; exec " + std::string(VIGIA_PROGRAM) + " evaluate " +
          file_.string() + " --quiet --out " + whole_.string() + " --sqlite " + sqlite_.string() +
          "2\"",
      dir_.path());
  EXPECT_EQ(full.status, 2);
  EXPECT_THAT(full.err, HasSubstr("cannot write"));
  EXPECT_FALSE(fs::exists(sqlite_.string() + "2"));
}

TEST_F(CampaignResults, AsALogAreReadByOmplsOwnReader) {
  if (std::system("command -v ompl_benchmark_statistics >/dev/null") != 0)
    GTEST_SKIP() << "no ompl_benchmark_statistics here: apt-get install ompl-demos";
  const Path arena = dir_.path() / "arena.db";
  const auto read = vigia::testing::run_process(
      "ompl_benchmark_statistics " + log_.string() + " -d " + arena.string(), dir_.path());
  ASSERT_EQ(read.status, 0) << read.err;
  EXPECT_THAT(query(arena, "SELECT name, configuration FROM experiments"), SizeIs(1));
  const Rows theirs = query(arena,
                            "SELECT name, seed, solved, time, position_rmse_m FROM runs JOIN "
                            "plannerConfigs ON plannerid = plannerConfigs.id ORDER BY name, seed");
  const Rows ours =
      query(sqlite_,
            "SELECT arms.name, seed, outcome = 'arrived', sim_s, position_rmse_m FROM "
            "missions JOIN arms USING (arm) JOIN localizers USING (mission) WHERE "
            "localizer = 'ekf' ORDER BY arms.name, seed");
  EXPECT_THAT(ours, SizeIs(6));
  EXPECT_EQ(theirs, ours);
}

}  // namespace
}  // namespace vigia

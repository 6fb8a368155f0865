#include "vigia/evaluation/paper_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "vigia/evaluation/armingol_table.hpp"
#include "vigia/evaluation/text_table.hpp"

namespace vigia::evaluation {
namespace {

using ::testing::HasSubstr;

PaperTable table() {
  PaperRow row{"final position", "cm"};
  row.published = 2.0;
  row.best = 0.5551;
  row.best_95 = Interval{0.5, 0.61};
  row.n = 100;
  return {"armingol", {{"look_angle_deg", 0.3}}, {row}, {"a remark"}};
}

TEST(PaperTable, JsonHasTheContractsKeysAndNullWhereAColumnDoesNotApply) {
  const auto json = nlohmann::json::parse(paper_table_json(table()));
  EXPECT_EQ(json["paper"], "armingol");
  EXPECT_EQ(json["noise"]["look_angle_deg"], 0.3);
  const auto& row = json["rows"][0];
  EXPECT_EQ(row["quantity"], "final position");
  EXPECT_EQ(row["unit"], "cm");
  EXPECT_EQ(row["published"], 2.0);
  EXPECT_TRUE(row["as_published"].is_null());
  EXPECT_TRUE(row["limit"].is_null());
  EXPECT_EQ(row["n"], 100);
  EXPECT_EQ(row["best_95"][1], 0.61);
  EXPECT_FALSE(row.contains("as_published_95"));
}

TEST(PaperTable, TextShowsFiguresIntervalsNoiseAndRemarks) {
  const std::string text = paper_table_text(table());
  EXPECT_THAT(text, HasSubstr("0.555 [0.5, 0.61]"));
  EXPECT_THAT(text, HasSubstr("noise: look_angle_deg = 0.3\n"));
  EXPECT_THAT(text, HasSubstr("a remark\n"));
}

TEST(TextTable, AlignsByCharactersNotBytes) {
  EXPECT_EQ(aligned_table({{"x", "σ"}, {"°", "12"}}), "x   σ\n-  --\n°  12\n");
  EXPECT_EQ(markdown_table({{"x", "y"}, {"1", "2"}}), "| x | y |\n|---|---:|\n| 1 | 2 |\n");
}

TEST(ArmingolTable, SetsAPlanBesideThePrintedAreas) {
  const auto rows =
      table_1_rows({{0, {0, 4, 6}, 6, 74.0}, {1, {4, 6}, 4, 60.0}, {7, {2}, 2, 50.0}});
  ASSERT_EQ(rows.size(), 16u);
  EXPECT_EQ(rows[0].published, 6.0);
  EXPECT_EQ(rows[0].as_published, 6.0);
  EXPECT_EQ(rows[1].published, 76.0);
  EXPECT_EQ(rows[1].as_published, 74.0);
  EXPECT_THAT(rows[2].quantity, HasSubstr("visible 4 (here 4 6)"));
  EXPECT_FALSE(rows[4].as_published);  // area 2, which the plan lacks
  EXPECT_FALSE(rows[15].published);    // area 7, which the paper lacks
}

}  // namespace
}  // namespace vigia::evaluation

#include "label_placer.hpp"

#include <gtest/gtest.h>

namespace vigia::report {
namespace {

bool overlap(const Box& a, const Box& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

TEST(LabelPlacer, TakesThePreferredSideOnAnEmptySheet) {
  LabelPlacer labels({0.0, 0.0, 200.0, 200.0});
  const auto box = labels.place({100.0, 100.0}, {20.0, 10.0}, 5.0, {1.0, 0.0});
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->x, 105.0, 1e-9);
  EXPECT_NEAR(box->y, 95.0, 1e-9);
}

TEST(LabelPlacer, LabelsAtOnePointDoNotOverlap) {
  LabelPlacer labels({0.0, 0.0, 200.0, 200.0});
  std::vector<Box> boxes;
  for (int i = 0; i < 6; ++i)
    if (const auto box = labels.place({100.0, 100.0}, {24.0, 12.0}, 6.0, {0.0, -1.0}))
      boxes.push_back(*box);
  ASSERT_GE(boxes.size(), 4U);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size(); ++j) EXPECT_FALSE(overlap(boxes[i], boxes[j]));
}

TEST(LabelPlacer, StaysInsideItsBounds) {
  LabelPlacer labels({0.0, 0.0, 50.0, 50.0});
  const auto box = labels.place({48.0, 25.0}, {20.0, 10.0}, 4.0, {1.0, 0.0});
  ASSERT_TRUE(box);
  EXPECT_LE(box->right(), 50.0);
}

TEST(LabelPlacer, AvoidsTheDrawingWhereItCan) {
  LabelPlacer labels({0.0, 0.0, 200.0, 200.0});
  for (int i = 0; i < 20; ++i) labels.avoid({101.0 + i, 90.0});
  const auto box = labels.place({100.0, 100.0}, {20.0, 10.0}, 5.0, {0.0, -1.0});
  ASSERT_TRUE(box);
  EXPECT_FALSE(overlap(*box, {101.0, 89.5, 19.0, 1.0}));
}

TEST(LabelPlacer, GivesUpWhereEverythingIsTaken) {
  LabelPlacer labels({0.0, 0.0, 100.0, 100.0});
  labels.block({0.0, 0.0, 100.0, 100.0});
  EXPECT_FALSE(labels.place({50.0, 50.0}, {10.0, 10.0}, 5.0, {1.0, 0.0}));
}

}  // namespace
}  // namespace vigia::report

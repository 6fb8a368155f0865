// Adán's "no code errors", on ten thousand views each: clean, and as hard as a building makes them.

#include "tracking/pattern_views.hpp"

#include <cstdio>

#include <gtest/gtest.h>

namespace vigia::tracking::testing {
namespace {

void report(const char* what, const ReadingRates& rates) {
  std::printf("%s: %d views, %d read rightly (%.2f %%), %d wrongly, %d rejected\n", what,
              rates.views, rates.right, 100.0 * rates.right / rates.views, rates.wrong,
              rates.views - rates.right - rates.wrong);
}

TEST(PatternReadingOnTenThousandViews, CleanOnesAreReadAndNeverWrongly) {
  const ReadingRates rates = read_clean_views(10000, 11);
  report("clean", rates);
  EXPECT_EQ(rates.wrong, 0);
  EXPECT_GE(rates.right, 9900);
}

TEST(PatternReadingOnTenThousandViews, HardOnesAreRejectedRatherThanReadWrongly) {
  const ReadingRates rates = read_hard_views(10000, 12);
  report("coloured light, blur, noise, hidden dots", rates);
  EXPECT_EQ(rates.wrong, 0);
  EXPECT_GE(rates.right, 5000);
}

}  // namespace
}  // namespace vigia::tracking::testing

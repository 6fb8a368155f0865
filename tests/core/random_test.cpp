#include "vigia/core/random.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace vigia {
namespace {

TEST(RandomStream, RepeatsForTheSameSeedAndName) {
  RandomStream a(42, "camera");
  RandomStream b(42, "camera");
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(a.normal(), b.normal());
    EXPECT_EQ(a.uniform(-1.0, 1.0), b.uniform(-1.0, 1.0));
    EXPECT_EQ(a.index(17), b.index(17));
  }
}

TEST(RandomStream, SeedsOfDifferentNamesAndNumbersDiffer) {
  std::set<std::uint64_t> seeds;
  const char* names[] = {"", "a", "b", "ab", "ba", "camera", "camera2", "odometry"};
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (const char* name : names) seeds.insert(derive_seed(seed, name));
    for (std::uint64_t number = 0; number < 8; ++number) seeds.insert(derive_seed(seed, number));
  }
  // The empty name leaves the mixed seed alone; all 1600 must still differ.
  EXPECT_EQ(seeds.size(), 1600U);
}

TEST(RandomStream, StreamsOfDifferentNamesAreUncorrelated) {
  constexpr int kCount = 20000;
  RandomStream a(1, "head");
  RandomStream b(1, "odometry");
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) sum += a.normal() * b.normal();
  const double standard_error = 1.0 / std::sqrt(kCount);
  EXPECT_LT(std::abs(sum / kCount), 4.0 * standard_error);  // k = 4
}

TEST(RandomStream, NormalsHaveMeanZeroAndVarianceOne) {
  constexpr int kCount = 20000;
  RandomStream random(3, "normal");
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_LT(std::abs(sum / kCount), 4.0 / std::sqrt(kCount));                  // k = 4
  EXPECT_LT(std::abs(squares / kCount - 1.0), 4.0 * std::sqrt(2.0 / kCount));  // k = 4
}

TEST(RandomStream, UniformsStayInTheirRange) {
  RandomStream random(4, "uniform");
  std::set<std::size_t> seen;
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-2.0, 3.0);
    EXPECT_GE(x, -2.0);
    EXPECT_LT(x, 3.0);
    seen.insert(random.index(5));
  }
  EXPECT_EQ(seen, (std::set<std::size_t>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace vigia

#include "supervisor.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace vigia::pilot {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

TEST(Supervisor, ActivationsAreSharesOfOneInEverySituation) {
  for (const bool hold : {false, true})
    for (const bool evading : {false, true})
      for (const bool way : {false, true})
        for (const double ahead : {0.0, 0.5, 0.9, 1.3, 1.6, 3.0, kNothing})
          for (double lasted = 0.0; lasted <= 3.0; lasted += 0.1) {
            const Activations a = supervise({hold, ahead, lasted, evading, way}, {});
            EXPECT_GE(std::min({a.follow, a.avoid, a.hold}), 0.0);
            EXPECT_NEAR(a.follow + a.avoid + a.hold, 1.0, 1e-12);
          }
}

TEST(Supervisor, OnAFreePathThePathFollowerAloneIsHeard) {
  const Activations a = supervise({false, kNothing, 0.0, false, false}, {});
  EXPECT_EQ(a.follow, 1.0);
  EXPECT_EQ(a.avoid, 0.0);
  EXPECT_EQ(a.hold, 0.0);
}

TEST(Supervisor, WaitsAtFirstAndGoesRoundWhatStays) {
  const AvoidanceParams params;
  const Activations fresh = supervise({false, params.near_m, 0.0, false, true}, params);
  EXPECT_EQ(fresh.hold, 1.0);
  const Activations old = supervise({false, params.near_m, params.patience_s, false, true}, params);
  EXPECT_EQ(old.avoid, 1.0);
  const Activations closed =
      supervise({false, params.near_m, params.patience_s, false, false}, params);
  EXPECT_EQ(closed.hold, 1.0);
}

TEST(Supervisor, AnOrderToHoldOutweighsEverything) {
  const Activations a = supervise({true, 0.8, 9.0, true, true}, {});
  EXPECT_EQ(a.hold, 1.0);
}

TEST(Supervisor, ActivationsAreContinuousInDistanceAndTime) {
  // The steepest of the memberships, 1.5 over its width, bounds what a small step may change.
  const AvoidanceParams params;
  const double per_m = 1.5 / (params.notice_m - params.near_m);
  const double per_s = 1.5 / (0.5 * params.patience_s);
  for (double ahead = 0.0; ahead < 2.0; ahead += 0.01)
    for (double lasted = 0.0; lasted < 2.0; lasted += 0.05) {
      const auto at = [&](double m, double s) {
        return supervise({false, m, s, false, true}, params).hold;
      };
      EXPECT_LE(std::abs(at(ahead + 0.01, lasted) - at(ahead, lasted)), 0.01 * per_m + 1e-12);
      EXPECT_LE(std::abs(at(ahead, lasted + 0.01) - at(ahead, lasted)), 0.01 * per_s + 1e-12);
    }
}

}  // namespace
}  // namespace vigia::pilot

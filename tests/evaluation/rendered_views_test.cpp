#include "vigia/evaluation/rendered_views.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace vigia::evaluation {
namespace {

TEST(RenderedViews, AreReadAndRefinedToTheBound) {
  const QuixoteSetting setting;
  RandomStream random(3, "rendered views");
  const auto views = random_views(setting, 0.1, 60, random);
  const RenderedViews rendered = render_views(setting, views, {4.0, 0.7, true}, 3);
  EXPECT_EQ(rendered.wrong, 0);
  ASSERT_GE(rendered.read.size(), 55U);
  const MethodErrors refined = judge_views(rendered.read, ViewMethod::refined);
  const LimitErrors limit = limit_of_views(rendered.read);
  // An rms of n normal errors lies within 3/√(2n) of its σ with a probability of 99.7 %.
  const double spread = 3.0 / std::sqrt(2.0 * static_cast<double>(refined.views));
  for (std::size_t i = 2; i < kViewQuantities; ++i)
    EXPECT_LT(refined.quantities[i].rms / limit.rms[i], 1.1 * (1.0 + spread)) << i;
}

}  // namespace
}  // namespace vigia::evaluation

#include "vigia/planner/fuzzy_engine.hpp"

#include "mamdani.hpp"

#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/planner/fuzzy_supervisors.hpp"

namespace vigia::planner {
namespace {

using test::Mamdani;
using ::testing::ElementsAre;

/// A system with every shape, both joints, negation and weights.
std::string system_with(const std::string& conjunction, const std::string& disjunction,
                        const std::string& implication, const std::string& aggregation) {
  return "Engine: all\n"
         "InputVariable: a\n  range: 0 10\n"
         "  term: low Ramp 4 1\n  term: mid Triangle 1 4 8\n  term: high Gaussian 9 2.5\n"
         "InputVariable: b\n  range: -5 5\n"
         "  term: left Trapezoid -5 -5 -2 0.5\n  term: right Trapezoid -2 1 5 5\n"
         "OutputVariable: c\n  range: -1 2\n  aggregation: " +
         aggregation +
         "\n  defuzzifier: Centroid 75\n"
         "  term: small Triangle -0.5 0 0.5\n  term: big Gaussian 1 0.3\n  term: all Ramp -1 2\n"
         "RuleBlock: rules\n  conjunction: " +
         conjunction + "\n  disjunction: " + disjunction + "\n  implication: " + implication +
         "\n  rule: if a is low and b is left then c is small\n"
         "  rule: if a is mid or b is right then c is big with 0.7\n"
         "  rule: if a is not high and b is not left then c is all with 0.4\n"
         "  rule: if a is high then c is big\n";
}

/// Largest difference on a grid over the ranges, ends and corners of terms included.
double largest_difference(const std::string& text) {
  FuzzyEngine engine = FuzzyEngine::read(text, "test.fll");
  const FllSystem system = read_fll(text, "test.fll");
  const Mamdani reference(system);
  const int steps = system.inputs.size() > 2 ? 12 : 40;
  std::vector<int> index(system.inputs.size(), 0);
  double largest = 0.0;
  while (true) {
    std::vector<double> x;
    for (std::size_t i = 0; i < index.size(); ++i) {
      const FllVariable& v = system.inputs[i];
      x.push_back(v.low + (v.high - v.low) * index[i] / steps);
    }
    largest = std::max(largest, std::abs(engine.evaluate(x) - reference.evaluate(x)));
    std::size_t axis = 0;
    while (axis < index.size() && ++index[axis] > steps) index[axis++] = 0;
    if (axis == index.size()) return largest;
  }
}

TEST(FuzzyEngine, AgreesWithAnIndependentMamdaniForEveryShapeAndOperator) {
  for (const char* conjunction : {"Minimum", "AlgebraicProduct"})
    for (const char* disjunction : {"Maximum", "AlgebraicSum"})
      for (const char* implication : {"Minimum", "AlgebraicProduct"})
        for (const char* aggregation : {"Maximum", "AlgebraicSum"})
          EXPECT_LE(
              largest_difference(system_with(conjunction, disjunction, implication, aggregation)),
              1e-9)
              << conjunction << disjunction << implication << aggregation;
}

TEST(FuzzyEngine, AgreesWithAnIndependentMamdaniForTheRuleBasesThatAreShipped) {
  const FuzzyRules rules;
  EXPECT_LE(largest_difference(rules.suitability.text), 1e-9);
  EXPECT_LE(largest_difference(rules.points.text), 1e-9);
  EXPECT_LE(largest_difference(rules.zoom_groups.text), 1e-9);
  EXPECT_LE(largest_difference(rules.choice.text), 1e-9);
}

TEST(FuzzyEngine, NamesItsInputsAndTerms) {
  const FuzzyEngine engine =
      FuzzyEngine::read(system_with("Minimum", "Maximum", "Minimum", "Maximum"), "test.fll");
  EXPECT_EQ(engine.name(), "all");
  EXPECT_THAT(engine.input_names(), ElementsAre("a", "b"));
  EXPECT_THAT(engine.term_names(0), ElementsAre("low", "mid", "high"));
  EXPECT_THAT(engine.membership(1, -3.0), ElementsAre(1.0, 0.0));
}

TEST(FuzzyEngine, HoldsInputsWithinTheirRange) {
  FuzzyEngine engine =
      FuzzyEngine::read(system_with("Minimum", "Maximum", "Minimum", "Maximum"), "test.fll");
  EXPECT_EQ(engine.evaluate({-100.0, 99.0}), engine.evaluate({0.0, 5.0}));
  EXPECT_EQ(engine.evaluate({std::numeric_limits<double>::infinity(), 0.0}),
            engine.evaluate({10.0, 0.0}));
}

TEST(FuzzyEngine, RefusesWhatIsNoNumberAndTheWrongCount) {
  FuzzyEngine engine =
      FuzzyEngine::read(system_with("Minimum", "Maximum", "Minimum", "Maximum"), "test.fll");
  EXPECT_THROW(engine.evaluate({std::nan(""), 0.0}), std::invalid_argument);
  EXPECT_THROW(engine.evaluate({1.0}), std::invalid_argument);
}

TEST(FuzzyEngine, ACopyGivesTheSameAnswersOnAThreadOfItsOwn) {
  FuzzyEngine original = FuzzyEngine::read(FuzzyRules{}.suitability.text, "test.fll");
  std::vector<double> expected;
  for (int i = 0; i < 500; ++i) expected.push_back(original.evaluate({0.02 * i, 0.15 * i}));
  std::vector<std::vector<double>> answers(4);
  std::vector<std::thread> threads;
  for (auto& own : answers)
    threads.emplace_back([&own, copy = original]() mutable {
      for (int i = 0; i < 500; ++i) own.push_back(copy.evaluate({0.02 * i, 0.15 * i}));
    });
  for (auto& thread : threads) thread.join();
  for (const auto& own : answers) EXPECT_EQ(own, expected);
}

TEST(FuzzyEngine, AFileThatIsMissingIsSaidSo) {
  try {
    FuzzyEngine::load("nowhere.fll");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "nowhere.fll: can't be read");
  }
}

}  // namespace
}  // namespace vigia::planner

#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/planner/fuzzy_engine.hpp"

namespace vigia::planner {
namespace {

const std::string kSystem =
    "Engine: e\n"                                   // 1
    "InputVariable: x\n"                            // 2
    "  range: 0 1\n"                                // 3
    "  lock-range: false\n"                         // 4
    "  term: low Ramp 1 0\n"                        // 5
    "  term: high Ramp 0 1\n"                       // 6
    "OutputVariable: y\n"                           // 7
    "  enabled: true\n"                             // 8
    "  range: 0 1\n"                                // 9
    "  aggregation: Maximum\n"                      // 10
    "  defuzzifier: Centroid 100\n"                 // 11
    "  term: a Triangle 0 0.2 0.4\n"                // 12
    "  term: b Triangle 0.6 0.8 1\n"                // 13
    "RuleBlock: r\n"                                // 14
    "  conjunction: Minimum\n"                      // 15
    "  implication: Minimum\n"                      // 16
    "  rule: if x is low then y is a\n"             // 17
    "  rule: if x is high then y is b with 0.5\n";  // 18

/// kSystem with one line put for another.
struct Mistake {
  std::string line;
  std::string instead;
  std::string message;
};

void PrintTo(const Mistake& mistake, std::ostream* out) {
  *out << mistake.instead;
}

class FllMistake : public testing::TestWithParam<Mistake> {};

TEST_P(FllMistake, IsReportedWithItsPlace) {
  std::string text = kSystem;
  const auto at = text.find(GetParam().line);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, GetParam().line.size(), GetParam().instead);
  try {
    FuzzyEngine::read(text, "s.fll");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), "s.fll:" + GetParam().message);
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfARule, FllMistake,
    testing::Values(
        Mistake{"if x is low", "if z is low", "17:12: unknown input 'z' (known: x)"},
        Mistake{"if x is low", "if x is lo", "17:17: unknown term 'lo' of x (known: low, high)"},
        Mistake{"then y is a", "then z is a", "17:26: unknown output 'z' (known: y)"},
        Mistake{"then y is a", "then y is c", "17:31: unknown term 'c' of y (known: a, b)"},
        Mistake{"if x is low", "when x is low", "17:9: rule: found 'when', must be if"},
        Mistake{"if x is low then", "if x is low",
                "17:21: rule: found 'y', must be one of and, or, then"},
        Mistake{"if x is low", "if x is low and x is high or x is low",
                "17:35: a rule joins by 'and' or by 'or', not by both: write two rules"},
        Mistake{"then y is a", "then y is", "17:9: the rule ends where a term must follow"},
        Mistake{"with 0.5", "with 0", "18:39: weight: found '0', must lie in (0, 1]"},
        Mistake{"with 0.5", "with nan", "18:39: found 'nan', must be a finite number"},
        Mistake{"with 0.5", "with 0.5 or so", "18:43: rule: found 'or' after the rule's end"},
        Mistake{"if x is high", "if x is low",
                "18:9: a rule with the same condition was given before at s.fll:17:9"},
        Mistake{"if x is low", "if x is low or x is high",
                "14:1: RuleBlock: the key 'disjunction' is missing"},
        Mistake{"  conjunction: Minimum\n", "  conjunction: Minimum\n  enabled: false\n",
                "16:12: enabled: found 'false', must be true (rules that are switched off would be "
                "left out in silence)"},
        Mistake{"  conjunction: Minimum\n", "  activation: First\n",
                "15:15: activation: found 'First', must be General (every rule counts)"},
        Mistake{"  rule: if x is low then y is a\n  rule: if x is high then y is b with 0.5\n", "",
                "14:1: RuleBlock: it has no rule"},
        Mistake{"  rule: if x is high then y is b with 0.5\n", "",
                "17:9: no rule covers x = 1; add a rule or widen a term"}));

INSTANTIATE_TEST_SUITE_P(
    OfAVariable, FllMistake,
    testing::Values(
        Mistake{"range: 0 1\n  lock", "range: 1 0\n  lock",
                "3:10: range: found 1 0, the first number must be below the second"},
        Mistake{"range: 0 1\n  lock", "range: 0 inf\n  lock",
                "3:12: found 'inf', must be a finite number"},
        Mistake{"range: 0 1\n  lock", "range: 0 nan\n  lock",
                "3:12: found 'nan', must be a finite number"},
        Mistake{"range: 0 1\n  lock", "range: 0\n  lock",
                "3:10: range: must be two numbers, low and high"},
        Mistake{"range: 0 1\n  lock", "lock", "2:1: InputVariable: the key 'range' is missing"},
        Mistake{"lock-range: false", "lock-range: true",
                "4:15: lock-range: found 'true', must be false (values outside the range would be "
                "clamped in silence)"},
        Mistake{"lock-range: false", "range: 0 2", "4:3: the key 'range' is given twice"},
        Mistake{"lock-range: false", "lock_range: false",
                "4:3: unknown key 'lock_range' in InputVariable (known: description, enabled, "
                "range, lock-range, term)"},
        Mistake{"enabled: true", "enabled: false",
                "8:12: enabled: found 'false', must be true (a variable that is switched off would "
                "be left out in silence)"},
        Mistake{"term: high", "term: low", "6:9: the term 'low' of x is given twice"},
        Mistake{"OutputVariable: y", "OutputVariable: x", "7:17: the variable 'x' is given twice"},
        Mistake{"InputVariable: x", "InputVariable: is",
                "2:16: found 'is', must be a name: letters, digits and underscores, none of the "
                "rules' own words"},
        Mistake{"InputVariable: x\n  range: 0 1\n", "InputVariable: x-y\n  range: 0 1\n",
                "2:16: found 'x-y', must be a name: letters, digits and underscores, none of the "
                "rules' own words"},
        Mistake{"low Ramp 1 0", "low Ramp 1 1",
                "5:9: term low: Ramp needs two different numbers: where it is 0, where it is 1"},
        Mistake{"low Ramp 1 0", "low Ramp 1 nan", "5:20: found 'nan', must be a finite number"},
        Mistake{"low Ramp 1 0", "low Bell 1 0 2",
                "5:9: term low: found the shape 'Bell', must be one of Gaussian, Ramp, Trapezoid, "
                "Triangle"},
        Mistake{"0 0.2 0.4", "0 0.5 0.4",
                "12:9: term a: Triangle needs three numbers in ascending order: left, top, right"},
        Mistake{"0 0.2 0.4", "0 0.2 0.4 0.9",
                "12:9: term a: Triangle needs three numbers in ascending order: left, top, right"},
        Mistake{"0 0.2 0.4", "1.2 1.3 1.4",
                "17:9: the term 'a' of y has no area within the range, or too little for the "
                "defuzzifier's resolution"},
        Mistake{"Maximum", "Minimum",
                "10:16: aggregation: found 'Minimum', must be one of Maximum, AlgebraicSum"},
        Mistake{"Centroid 100", "Bisector 100",
                "11:16: defuzzifier: found 'Bisector 100', must be 'Centroid' and a resolution"},
        Mistake{"Centroid 100", "Centroid 5",
                "11:25: defuzzifier: found '5', must be a whole number in [10, 10000]"},
        Mistake{"enabled: true", "default: 0.5",
                "8:12: default: found '0.5', must be nan (every input must be covered by a rule "
                "instead)"},
        Mistake{"enabled: true", "lock-previous: true",
                "8:18: lock-previous: found 'true', must be false (an answer must not depend on "
                "the one before)"}));

INSTANTIATE_TEST_SUITE_P(
    OfTheFile, FllMistake,
    testing::Values(Mistake{"Engine: e\n", "", "1:1: the section 'Engine' is missing"},
                    Mistake{"Engine: e\n", "name: e\n",
                            "1:1: found the key 'name' before the first section 'Engine: name'"},
                    Mistake{"  range: 0 1\n  lock", "  range 0 1\n  lock",
                            "3:1: found 'range 0 1', must be 'key: value'"},
                    Mistake{"RuleBlock: r\n", "RuleBlock: r\nRuleBlock: s\n",
                            "15:1: a second RuleBlock; there must be exactly one"},
                    Mistake{"Engine: e\n", "Engine: e\a\n",
                            "1:1: found a control character, must be plain text"}));

TEST(Fll, CommentsBlankLinesAndIndentationSayNothing) {
  std::string text = "# a comment\n\n" + kSystem;
  text.replace(text.find("range: 0 1"), 10, "\t range:\t0   1  # of x");
  FuzzyEngine plain = FuzzyEngine::read(kSystem, "s.fll");
  FuzzyEngine commented = FuzzyEngine::read(text, "s.fll");
  EXPECT_EQ(plain.evaluate({0.3}), commented.evaluate({0.3}));
}

}  // namespace
}  // namespace vigia::planner

#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vigia/core/error.hpp"

namespace vigia::planner {

/// A linguistic term: fuzzylite's name of the shape and its parameters.
struct FllTerm {
  std::string name;
  std::string shape;  ///< Triangle, Trapezoid, Ramp or Gaussian
  std::vector<double> parameters;
};

struct FllVariable {
  std::string name;
  double low = 0.0;
  double high = 1.0;
  std::vector<FllTerm> terms;
};

/// "variable is [not] term" of a rule's antecedent.
struct FllProposition {
  std::size_t input = 0;
  std::size_t term = 0;
  bool negated = false;
};

struct FllRule {
  std::string text;  ///< as fuzzylite reads it
  std::vector<FllProposition> propositions;
  bool any = false;      ///< joined by "or" instead of "and"
  std::size_t then = 0;  ///< term of the output
  double weight = 1.0;
  SourceLocation where;
};

/// A Mamdani system with one output and one block of rules.
struct FllSystem {
  std::string name;
  std::vector<FllVariable> inputs;
  FllVariable output;
  std::string aggregation;  ///< Maximum or AlgebraicSum
  int resolution = 100;     ///< midpoints of the centroid's sum
  std::string conjunction;  ///< Minimum or AlgebraicProduct; empty when no rule joins by "and"
  std::string disjunction;  ///< Maximum or AlgebraicSum; empty when no rule joins by "or"
  std::string implication;  ///< Minimum or AlgebraicProduct
  std::vector<FllRule> rules;
};

/// Reads a file in fuzzylite's language as strictly as the YAML files are read: what fuzzylite
/// would drop, clamp or guess in silence – a rule with an unknown word, an inverted range, a name
/// given twice, a number that is not finite, lock-range, a switched-off part – is an InputError
/// with file:line:column and what would be right. @p name stands for the file in messages.
FllSystem read_fll(const std::string& text, const std::string& name);

}  // namespace vigia::planner

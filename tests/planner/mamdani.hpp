#pragma once

#include "fll_reader.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vigia::planner::test {

/// A Mamdani system evaluated without fuzzylite, by the same rule of integration: the centroid over
/// the midpoints of `resolution` equal parts of the output's range.
class Mamdani {
 public:
  explicit Mamdani(FllSystem system) : system_(std::move(system)) {}

  double evaluate(const std::vector<double>& x) const {
    std::vector<double> fired;
    for (const FllRule& rule : system_.rules) fired.push_back(rule.weight * antecedent(rule, x));
    const FllVariable& output = system_.output;
    const double step = (output.high - output.low) / system_.resolution;
    double area = 0.0;
    double moment = 0.0;
    for (int i = 0; i < system_.resolution; ++i) {
      const double y = output.low + (i + 0.5) * step;
      const double mu = aggregated(fired, y);
      area += mu;
      moment += mu * y;
    }
    return moment / area;
  }

 private:
  static double membership(const FllTerm& term, double x) {
    const auto& p = term.parameters;
    if (term.shape == "Gaussian") return std::exp(-std::pow((x - p[0]) / p[1], 2) / 2.0);
    if (term.shape == "Ramp") return std::clamp((x - p[0]) / (p[1] - p[0]), 0.0, 1.0);
    const double left = p[0];
    const double top = p[1];
    const double back = term.shape == "Triangle" ? p[1] : p[2];
    const double right = p.back();
    if (x < left || x > right) return 0.0;
    if (x < top) return (x - left) / (top - left);
    if (x > back) return (right - x) / (right - back);
    return 1.0;
  }

  double antecedent(const FllRule& rule, const std::vector<double>& x) const {
    double result = rule.any ? 0.0 : 1.0;
    for (const auto& p : rule.propositions) {
      double mu = membership(system_.inputs[p.input].terms[p.term], x[p.input]);
      if (p.negated) mu = 1.0 - mu;
      if (rule.any)
        result =
            system_.disjunction == "Maximum" ? std::max(result, mu) : result + mu - result * mu;
      else
        result = system_.conjunction == "AlgebraicProduct" ? result * mu : std::min(result, mu);
    }
    return result;
  }

  double aggregated(const std::vector<double>& fired, double y) const {
    double result = 0.0;
    for (std::size_t r = 0; r < fired.size(); ++r) {
      const double mu = membership(system_.output.terms[system_.rules[r].then], y);
      const double implied =
          system_.implication == "Minimum" ? std::min(fired[r], mu) : fired[r] * mu;
      result = system_.aggregation == "Maximum" ? std::max(result, implied)
                                                : result + implied - result * implied;
    }
    return result;
  }

  FllSystem system_;
};

}  // namespace vigia::planner::test

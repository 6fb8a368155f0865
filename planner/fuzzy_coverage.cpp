#include "fuzzy_coverage.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vigia::planner {
namespace {

/// The least degree that counts as covered; fuzzylite drops what is below 1e-6.
constexpr double kMinFired = 1e-3;
constexpr std::size_t kMaxWork = 5000000;

double degree(const FllTerm& term, double x) {
  const auto& p = term.parameters;
  const auto rise = [x](double from, double to) {
    return from == to ? (x >= to ? 1.0 : 0.0) : std::clamp((x - from) / (to - from), 0.0, 1.0);
  };
  const auto fall = [x](double from, double to) {
    return from == to ? (x <= to ? 1.0 : 0.0) : std::clamp((to - x) / (to - from), 0.0, 1.0);
  };
  if (term.shape == "Triangle") return std::min(rise(p[0], p[1]), fall(p[1], p[2]));
  if (term.shape == "Trapezoid") return std::min(rise(p[0], p[1]), fall(p[2], p[3]));
  if (term.shape == "Ramp") return std::clamp((x - p[0]) / (p[1] - p[0]), 0.0, 1.0);
  return std::exp(-0.5 * (x - p[0]) * (x - p[0]) / (p[1] * p[1]));
}

/// Ends of the range, corners of the terms within it, and the middles between.
std::vector<double> samples(const FllVariable& variable) {
  std::vector<double> corners{variable.low, variable.high};
  for (const FllTerm& term : variable.terms) {
    if (term.shape == "Gaussian") continue;
    for (const double p : term.parameters)
      if (p > variable.low && p < variable.high) corners.push_back(p);
  }
  std::sort(corners.begin(), corners.end());
  std::vector<double> all = corners;
  for (std::size_t i = 1; i < corners.size(); ++i)
    all.push_back(0.5 * (corners[i - 1] + corners[i]));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

double fired(const FllSystem& system, const FllRule& rule, const std::vector<double>& x) {
  double result = rule.any ? 0.0 : 1.0;
  for (const FllProposition& proposition : rule.propositions) {
    const FllTerm& term = system.inputs[proposition.input].terms[proposition.term];
    const double plain = degree(term, x[proposition.input]);
    const double each = proposition.negated ? 1.0 - plain : plain;
    // The smaller of the conjunctions that a file may choose, and of the disjunctions.
    result = rule.any ? std::max(result, each) : result * each;
  }
  return result * rule.weight;
}

bool covered(const FllSystem& system, const std::vector<double>& x) {
  return std::any_of(system.rules.begin(), system.rules.end(),
                     [&](const FllRule& rule) { return fired(system, rule, x) >= kMinFired; });
}

[[noreturn]] void report(const FllSystem& system, const std::vector<double>& x) {
  std::ostringstream at;
  for (std::size_t i = 0; i < x.size(); ++i)
    at << (i > 0 ? ", " : "") << system.inputs[i].name << " = " << x[i];
  throw InputError(system.rules.front().where,
                   "no rule covers " + at.str() + "; add a rule or widen a term");
}

/// Whether the centroid's sum meets the term at all.
void check_output(const FllSystem& system) {
  const FllVariable& output = system.output;
  const double step = (output.high - output.low) / system.resolution;
  for (const FllRule& rule : system.rules) {
    const FllTerm& term = output.terms[rule.then];
    double highest = 0.0;
    for (int i = 0; i < system.resolution; ++i)
      highest = std::max(highest, degree(term, output.low + (i + 0.5) * step));
    if (highest < kMinFired)
      throw InputError(rule.where, "the term '" + term.name + "' of " + output.name +
                                       " has no area within the range, or too little for the "
                                       "defuzzifier's resolution");
  }
}

}  // namespace

void check_coverage(const FllSystem& system) {
  check_output(system);
  std::vector<std::vector<double>> axes;
  std::size_t combinations = 1;
  for (const FllVariable& input : system.inputs) {
    axes.push_back(samples(input));
    combinations *= axes.back().size();
    if (combinations * system.rules.size() > kMaxWork)
      throw InputError(
          system.rules.front().where,
          "the system has too many inputs and terms to check that its rules cover all");
  }
  std::vector<double> x(axes.size());
  for (std::size_t n = 0; n < combinations; ++n) {
    std::size_t rest = n;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      x[i] = axes[i][rest % axes[i].size()];
      rest /= axes[i].size();
    }
    if (!covered(system, x)) report(system, x);
  }
}

}  // namespace vigia::planner

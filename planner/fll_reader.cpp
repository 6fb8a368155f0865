#include "fll_reader.hpp"

#include "fll_lines.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace vigia::planner {
namespace {

using Names = std::vector<std::string>;

std::string list(const Names& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The lines of a section: each key once, but those that repeat; none that nobody asked for.
class SectionReader {
 public:
  SectionReader(const FllSection& section, const Names& repeated, const Names& known)
      : section_(section) {
    std::set<std::string> seen;
    for (const FllLine& line : section.lines) {
      const bool repeats = std::find(repeated.begin(), repeated.end(), line.key) != repeated.end();
      if (!repeats && std::find(known.begin(), known.end(), line.key) == known.end())
        throw InputError(line.key_where, "unknown key '" + line.key + "' in " + section.head.key +
                                             " (known: " + list(known) + ", " + list(repeated) +
                                             ")");
      if (!repeats && !seen.insert(line.key).second)
        throw InputError(line.key_where, "the key '" + line.key + "' is given twice");
    }
  }

  const FllLine* find(const std::string& key) const {
    const auto& lines = section_.lines;
    const auto at = std::find_if(lines.begin(), lines.end(),
                                 [&key](const FllLine& line) { return line.key == key; });
    return at == lines.end() ? nullptr : &*at;
  }

  const FllLine& require(const std::string& key) const {
    const FllLine* line = find(key);
    if (line == nullptr)
      throw InputError(section_.head.key_where,
                       section_.head.key + ": the key '" + key + "' is missing");
    return *line;
  }

  /// A key that may be left out but has only one right value.
  void only(const std::string& key, const std::string& value, const std::string& why) const {
    const FllLine* line = find(key);
    if (line != nullptr && line->value != value)
      throw InputError(line->value_where,
                       key + ": found '" + line->value + "', must be " + value + " (" + why + ")");
  }

  std::string one_of(const std::string& key, const Names& values) const {
    const FllLine& line = require(key);
    if (std::find(values.begin(), values.end(), line.value) == values.end())
      throw InputError(line.value_where,
                       key + ": found '" + line.value + "', must be one of " + list(values));
    return line.value;
  }

 private:
  const FllSection& section_;
};

void check_name(const std::string& name, const SourceLocation& where) {
  static const std::set<std::string> keywords{"if",   "is",       "then",      "and",
                                              "or",   "with",     "not",       "any",
                                              "very", "somewhat", "extremely", "seldom"};
  if (!is_fll_name(name) || keywords.count(name) != 0)
    throw InputError(where, "found '" + name +
                                "', must be a name: letters, digits and underscores, none of "
                                "the rules' own words");
}

/// Parameters of the shapes that are known, and what they must satisfy.
void check_shape(const FllTerm& term, const FllLine& line) {
  const auto& p = term.parameters;
  const auto wrong = [&](const std::string& right) {
    throw InputError(line.value_where, "term " + term.name + ": " + term.shape + " needs " + right);
  };
  if (term.shape == "Triangle") {
    if (p.size() != 3 || !std::is_sorted(p.begin(), p.end()) || p.front() == p.back())
      wrong("three numbers in ascending order: left, top, right");
  } else if (term.shape == "Trapezoid") {
    if (p.size() != 4 || !std::is_sorted(p.begin(), p.end()) || p.front() == p.back())
      wrong("four numbers in ascending order: left, left top, right top, right");
  } else if (term.shape == "Ramp") {
    if (p.size() != 2 || p[0] == p[1]) wrong("two different numbers: where it is 0, where it is 1");
  } else if (term.shape == "Gaussian") {
    if (p.size() != 2 || p[1] < 1e-6) wrong("two numbers: mean and a deviation of at least 1e-6");
  } else {
    throw InputError(line.value_where, "term " + term.name + ": found the shape '" + term.shape +
                                           "', must be one of Gaussian, Ramp, Trapezoid, Triangle");
  }
}

FllTerm read_term(const FllLine& line) {
  const auto words = words_of(line);
  if (words.size() < 2)
    throw InputError(line.value_where, "term: must be a name, a shape and its numbers");
  FllTerm term;
  term.name = words[0].text;
  check_name(term.name, words[0].where);
  term.shape = words[1].text;
  for (std::size_t i = 2; i < words.size(); ++i)
    term.parameters.push_back(read_fll_number(words[i]));
  check_shape(term, line);
  return term;
}

/// The part that inputs and outputs share.
FllVariable read_variable(const FllSection& section, const SectionReader& reader) {
  FllVariable variable;
  variable.name = section.head.value;
  check_name(variable.name, section.head.value_where);
  reader.only("enabled", "true", "a variable that is switched off would be left out in silence");
  reader.only("lock-range", "false", "values outside the range would be clamped in silence");
  const FllLine& range = reader.require("range");
  const auto words = words_of(range);
  if (words.size() != 2)
    throw InputError(range.value_where, "range: must be two numbers, low and high");
  variable.low = read_fll_number(words[0]);
  variable.high = read_fll_number(words[1]);
  if (!(variable.low < variable.high))
    throw InputError(range.value_where,
                     "range: found " + range.value + ", the first number must be below the second");
  for (const FllLine& line : section.lines) {
    if (line.key != "term") continue;
    FllTerm term = read_term(line);
    for (const FllTerm& other : variable.terms)
      if (other.name == term.name)
        throw InputError(line.value_where,
                         "the term '" + term.name + "' of " + variable.name + " is given twice");
    variable.terms.push_back(std::move(term));
  }
  if (variable.terms.empty())
    throw InputError(section.head.key_where, variable.name + ": it has no term");
  return variable;
}

void read_output(const FllSection& section, FllSystem& system) {
  const SectionReader reader(section, {"term"},
                             {"description", "enabled", "range", "lock-range", "aggregation",
                              "defuzzifier", "default", "lock-previous"});
  system.output = read_variable(section, reader);
  system.aggregation = reader.one_of("aggregation", {"Maximum", "AlgebraicSum"});
  reader.only("default", "nan", "every input must be covered by a rule instead");
  reader.only("lock-previous", "false", "an answer must not depend on the one before");
  const FllLine& line = reader.require("defuzzifier");
  const auto words = words_of(line);
  if (words.size() != 2 || words[0].text != "Centroid")
    throw InputError(line.value_where, "defuzzifier: found '" + line.value +
                                           "', must be 'Centroid' and a resolution");
  const double resolution = read_fll_number(words[1]);
  if (resolution < 10.0 || resolution > 10000.0 || resolution != std::floor(resolution))
    throw InputError(words[1].where, "defuzzifier: found '" + words[1].text +
                                         "', must be a whole number in [10, 10000]");
  system.resolution = static_cast<int>(resolution);
}

template <typename Items>
Names names_of(const Items& items) {
  Names names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

/// Reads the words of one rule.
class RuleReader {
 public:
  RuleReader(const FllSystem& system, const FllLine& line)
      : system_(system), line_(line), words_(words_of(line)) {}

  FllRule read() {
    FllRule rule;
    rule.where = line_.value_where;
    expect({"if"});
    std::string joint;
    do {
      rule.propositions.push_back(read_proposition());
      const std::string next = expect({"and", "or", "then"});
      if (next == "then") break;
      if (!joint.empty() && joint != next)
        throw InputError(before(),
                         "a rule joins by 'and' or by 'or', not by both: write two rules");
      joint = next;
    } while (true);
    rule.any = joint == "or";
    const FllWord& output = word("the output's name");
    if (output.text != system_.output.name)
      throw InputError(output.where,
                       "unknown output '" + output.text + "' (known: " + system_.output.name + ")");
    expect({"is"});
    rule.then = index(names_of(system_.output.terms), "term", system_.output.name);
    read_weight(rule);
    for (const FllWord& each : words_) rule.text += (rule.text.empty() ? "" : " ") + each.text;
    return rule;
  }

 private:
  SourceLocation before() const { return words_[next_ - 1].where; }

  const FllWord& word(const std::string& wanted) {
    if (next_ == words_.size())
      throw InputError(line_.value_where, "the rule ends where " + wanted + " must follow");
    return words_[next_++];
  }

  std::string expect(const Names& choices) {
    const FllWord& found = word(list(choices));
    if (std::find(choices.begin(), choices.end(), found.text) == choices.end())
      throw InputError(found.where, "rule: found '" + found.text + "', must be " +
                                        (choices.size() > 1 ? "one of " : "") + list(choices));
    return found.text;
  }

  std::size_t index(const Names& names, const std::string& what, const std::string& of) {
    const FllWord& found = word("a " + what);
    const auto at = std::find(names.begin(), names.end(), found.text);
    if (at == names.end())
      throw InputError(found.where, "unknown " + what + " '" + found.text + "'" +
                                        (of.empty() ? "" : " of " + of) +
                                        " (known: " + list(names) + ")");
    return static_cast<std::size_t>(at - names.begin());
  }

  FllProposition read_proposition() {
    FllProposition proposition;
    proposition.input = index(names_of(system_.inputs), "input", "");
    const FllVariable& input = system_.inputs[proposition.input];
    expect({"is"});
    proposition.negated = next_ < words_.size() && words_[next_].text == "not";
    if (proposition.negated) ++next_;
    proposition.term = index(names_of(input.terms), "term", input.name);
    return proposition;
  }

  void read_weight(FllRule& rule) {
    if (next_ == words_.size()) return;
    expect({"with"});
    const FllWord& found = word("a weight");
    rule.weight = read_fll_number(found);
    if (rule.weight <= 0.0 || rule.weight > 1.0)
      throw InputError(found.where, "weight: found '" + found.text + "', must lie in (0, 1]");
    if (next_ != words_.size())
      throw InputError(words_[next_].where,
                       "rule: found '" + words_[next_].text + "' after the rule's end");
  }

  const FllSystem& system_;
  const FllLine& line_;
  std::vector<FllWord> words_;
  std::size_t next_ = 0;
};

void check_twin(const std::vector<FllRule>& rules, const FllRule& rule) {
  const auto same = [&](const FllRule& other) {
    return other.any == rule.any && other.propositions.size() == rule.propositions.size() &&
           std::equal(rule.propositions.begin(), rule.propositions.end(),
                      other.propositions.begin(), [](const auto& a, const auto& b) {
                        return a.input == b.input && a.term == b.term && a.negated == b.negated;
                      });
  };
  const auto twin = std::find_if(rules.begin(), rules.end(), same);
  if (twin != rules.end())
    throw InputError(
        rule.where, "a rule with the same condition was given before at " + to_string(twin->where));
}

void read_rules(const FllSection& section, FllSystem& system) {
  const SectionReader reader(
      section, {"rule"},
      {"description", "enabled", "conjunction", "disjunction", "implication", "activation"});
  reader.only("enabled", "true", "rules that are switched off would be left out in silence");
  reader.only("activation", "General", "every rule counts");
  system.implication = reader.one_of("implication", {"Minimum", "AlgebraicProduct"});
  bool joins_and = false;
  bool joins_or = false;
  for (const FllLine& line : section.lines) {
    if (line.key != "rule") continue;
    FllRule rule = RuleReader(system, line).read();
    check_twin(system.rules, rule);
    joins_or = joins_or || rule.any;
    joins_and = joins_and || (!rule.any && rule.propositions.size() > 1);
    system.rules.push_back(std::move(rule));
  }
  if (system.rules.empty()) throw InputError(section.head.key_where, "RuleBlock: it has no rule");
  if (joins_and) system.conjunction = reader.one_of("conjunction", {"Minimum", "AlgebraicProduct"});
  if (joins_or) system.disjunction = reader.one_of("disjunction", {"Maximum", "AlgebraicSum"});
}

void read_input(const FllSection& section, FllSystem& system) {
  const SectionReader reader(section, {"term"}, {"description", "enabled", "range", "lock-range"});
  system.inputs.push_back(read_variable(section, reader));
}

const FllSection& only_section(const std::vector<FllSection>& sections, const std::string& head,
                               const std::string& file) {
  const FllSection* found = nullptr;
  for (const FllSection& section : sections) {
    if (section.head.key != head) continue;
    if (found != nullptr)
      throw InputError(section.head.key_where, "a second " + head + "; there must be exactly one");
    found = &section;
  }
  if (found == nullptr) throw InputError({file, 1, 1}, "the section '" + head + "' is missing");
  return *found;
}

}  // namespace

FllSystem read_fll(const std::string& text, const std::string& name) {
  const auto sections = split_fll(text, name);
  FllSystem system;
  const FllSection& engine = only_section(sections, "Engine", name);
  const SectionReader only_a_description(engine, {}, {"description"});
  system.name = engine.head.value;
  std::set<std::string> names;
  for (const FllSection& section : sections) {
    const bool variable =
        section.head.key == "InputVariable" || section.head.key == "OutputVariable";
    if (variable && !names.insert(section.head.value).second)
      throw InputError(section.head.value_where,
                       "the variable '" + section.head.value + "' is given twice");
    if (section.head.key == "InputVariable") read_input(section, system);
  }
  if (system.inputs.empty()) throw InputError({name, 1, 1}, "there is no InputVariable");
  read_output(only_section(sections, "OutputVariable", name), system);
  read_rules(only_section(sections, "RuleBlock", name), system);
  return system;
}

}  // namespace vigia::planner

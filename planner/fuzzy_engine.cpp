#include "vigia/planner/fuzzy_engine.hpp"

#include "fll_reader.hpp"
#include "fuzzy_coverage.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <fl/Headers.h>

#include "vigia/core/error.hpp"

namespace vigia::planner {
namespace {

fl::Term* make_term(const FllTerm& term) {
  const auto& p = term.parameters;
  if (term.shape == "Triangle") return new fl::Triangle(term.name, p[0], p[1], p[2]);
  if (term.shape == "Trapezoid") return new fl::Trapezoid(term.name, p[0], p[1], p[2], p[3]);
  if (term.shape == "Ramp") return new fl::Ramp(term.name, p[0], p[1]);
  return new fl::Gaussian(term.name, p[0], p[1]);
}

fl::TNorm* make_tnorm(const std::string& name) {
  if (name == "Minimum") return new fl::Minimum;
  if (name == "AlgebraicProduct") return new fl::AlgebraicProduct;
  return nullptr;
}

fl::SNorm* make_snorm(const std::string& name) {
  if (name == "Maximum") return new fl::Maximum;
  if (name == "AlgebraicSum") return new fl::AlgebraicSum;
  return nullptr;
}

void add_rules(const FllSystem& system, fl::Engine& engine) {
  auto* block = new fl::RuleBlock;
  engine.addRuleBlock(block);
  block->setConjunction(make_tnorm(system.conjunction));
  block->setDisjunction(make_snorm(system.disjunction));
  block->setImplication(make_tnorm(system.implication));
  block->setActivation(new fl::General);
  for (const FllRule& rule : system.rules) {
    auto* made = new fl::Rule(rule.text);
    block->addRule(made);
    try {
      made->load(&engine);
    } catch (const fl::Exception& error) {
      throw InputError(rule.where,
                       std::string("fuzzylite does not take the rule: ") + error.what());
    }
    if (!made->isLoaded()) throw InputError(rule.where, "fuzzylite dropped the rule");
  }
}

/// What fuzzylite makes of a system that was read.
std::unique_ptr<fl::Engine> build(const FllSystem& system) {
  auto engine = std::make_unique<fl::Engine>(system.name);
  for (const FllVariable& input : system.inputs) {
    auto* variable = new fl::InputVariable(input.name, input.low, input.high);
    engine->addInputVariable(variable);
    for (const FllTerm& term : input.terms) variable->addTerm(make_term(term));
  }
  auto* output = new fl::OutputVariable(system.output.name, system.output.low, system.output.high);
  engine->addOutputVariable(output);
  for (const FllTerm& term : system.output.terms) output->addTerm(make_term(term));
  output->setAggregation(make_snorm(system.aggregation));
  output->setDefuzzifier(new fl::Centroid(system.resolution));
  add_rules(system, *engine);
  return engine;
}

void check_loaded(const fl::Engine& engine) {
  for (const fl::RuleBlock* block : engine.ruleBlocks())
    for (const fl::Rule* rule : block->rules())
      if (!rule->isLoaded()) throw std::logic_error("a copy of a fuzzy engine lost a rule");
}

}  // namespace

struct FuzzyEngine::Impl {
  explicit Impl(FllSystem read) : system(std::move(read)), engine(build(system)) {}
  Impl(const Impl& other) : system(other.system), engine(other.engine->clone()) {
    check_loaded(*engine);
  }

  FllSystem system;
  std::unique_ptr<fl::Engine> engine;
};

FuzzyEngine::FuzzyEngine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FuzzyEngine::FuzzyEngine(const FuzzyEngine& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
FuzzyEngine& FuzzyEngine::operator=(const FuzzyEngine& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
FuzzyEngine::FuzzyEngine(FuzzyEngine&&) noexcept = default;
FuzzyEngine& FuzzyEngine::operator=(FuzzyEngine&&) noexcept = default;
FuzzyEngine::~FuzzyEngine() = default;

FuzzyEngine FuzzyEngine::read(const std::string& text, const std::string& name) {
  FllSystem system = read_fll(text, name);
  check_coverage(system);
  return FuzzyEngine(std::make_unique<Impl>(std::move(system)));
}

FuzzyEngine FuzzyEngine::load(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError({file.string(), 0, 0}, "can't be read");
  return read({std::istreambuf_iterator<char>(in), {}}, file.string());
}

const std::string& FuzzyEngine::name() const {
  return impl_->system.name;
}

std::vector<std::string> FuzzyEngine::input_names() const {
  std::vector<std::string> names;
  for (const FllVariable& input : impl_->system.inputs) names.push_back(input.name);
  return names;
}

std::vector<std::string> FuzzyEngine::term_names(std::size_t input) const {
  std::vector<std::string> names;
  for (const FllTerm& term : impl_->system.inputs.at(input).terms) names.push_back(term.name);
  return names;
}

double FuzzyEngine::evaluate(const std::vector<double>& inputs) {
  const auto& variables = impl_->engine->inputVariables();
  if (inputs.size() != variables.size())
    throw std::invalid_argument("the fuzzy system " + name() + " takes " +
                                std::to_string(variables.size()) + " inputs");
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (std::isnan(inputs[i]))
      throw std::invalid_argument("the input " + variables[i]->getName() + " is not a number");
    const FllVariable& variable = impl_->system.inputs[i];
    variables[i]->setValue(std::clamp(inputs[i], variable.low, variable.high));
  }
  impl_->engine->process();
  const double value = impl_->engine->outputVariables().front()->getValue();
  // check_coverage() leaves no inputs for which no rule fires.
  if (std::isnan(value)) throw std::logic_error("no rule of " + name() + " fired");
  return value;
}

std::vector<double> FuzzyEngine::membership(std::size_t input, double value) const {
  const FllVariable& variable = impl_->system.inputs.at(input);
  const double held = std::clamp(value, variable.low, variable.high);
  std::vector<double> degrees;
  for (const fl::Term* term : impl_->engine->inputVariables()[input]->terms())
    degrees.push_back(term->membership(held));
  return degrees;
}

}  // namespace vigia::planner

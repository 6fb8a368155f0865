#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace vigia::planner {

/// A Mamdani fuzzy system with one output, evaluated by fuzzylite and read from its .fll files,
/// strictly (see read below). The output is the centroid of the aggregated rules on the output's
/// universe, by the sum over midpoints that the file's resolution asks for.
///
/// An engine is no shared thing: evaluating writes into it. A copy is a clone of its own; give one
/// to each thread.
class FuzzyEngine {
 public:
  /// Reads a system. @p name stands for the file in messages. Throws InputError with
  /// file:line:column for whatever fuzzylite would drop, clamp or guess in silence, and for inputs
  /// within the ranges that no rule covers.
  static FuzzyEngine read(const std::string& text, const std::string& name);
  static FuzzyEngine load(const std::filesystem::path& file);

  FuzzyEngine(const FuzzyEngine& other);
  FuzzyEngine& operator=(const FuzzyEngine& other);
  FuzzyEngine(FuzzyEngine&&) noexcept;
  FuzzyEngine& operator=(FuzzyEngine&&) noexcept;
  ~FuzzyEngine();

  const std::string& name() const;
  /// In the order in which evaluate() takes them.
  std::vector<std::string> input_names() const;
  std::vector<std::string> term_names(std::size_t input) const;

  /// The output for @p inputs, each held within its variable's range. Throws std::invalid_argument
  /// for a wrong number of inputs and for one that is not a number.
  double evaluate(const std::vector<double>& inputs);
  /// Degree, in [0, 1], to which @p value is each term of an input.
  std::vector<double> membership(std::size_t input, double value) const;

 private:
  struct Impl;
  explicit FuzzyEngine(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace vigia::planner

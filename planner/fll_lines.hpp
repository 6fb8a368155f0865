#pragma once

#include <string>
#include <vector>

#include "vigia/core/error.hpp"

namespace vigia::planner {

/// "key: value" with the place of each.
struct FllLine {
  std::string key;
  std::string value;
  SourceLocation key_where;
  SourceLocation value_where;
};

/// A headed part of the file: Engine, InputVariable, OutputVariable or RuleBlock.
struct FllSection {
  FllLine head;
  std::vector<FllLine> lines;
};

/// Splits the text into sections; comments (#) and empty lines are dropped. Throws InputError for a
/// line without a colon, for one before the first section and for a control character.
std::vector<FllSection> split_fll(const std::string& text, const std::string& name);

/// A word of a value, with its place.
struct FllWord {
  std::string text;
  SourceLocation where;
};

std::vector<FllWord> words_of(const FllLine& line);

/// Reads a finite number of at most 1e9. Throws InputError.
double read_fll_number(const FllWord& word);

/// Whether the text is a letter or underscore followed by letters, digits and underscores.
bool is_fll_name(const std::string& text);

}  // namespace vigia::planner

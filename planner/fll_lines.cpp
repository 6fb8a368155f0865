#include "fll_lines.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

namespace vigia::planner {
namespace {

constexpr double kLargest = 1e9;
constexpr const char* kBlank = " \t\r";

bool is_section(const std::string& key) {
  static const std::array<std::string, 4> heads{"Engine", "InputVariable", "OutputVariable",
                                                "RuleBlock"};
  return std::find(heads.begin(), heads.end(), key) != heads.end();
}

void check_characters(const std::string& line, const SourceLocation& where) {
  for (const char c : line)
    if (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\r')
      throw InputError(where, "found a control character, must be plain text");
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

int column_of(const std::string& line, std::size_t from) {
  const auto at = line.find_first_not_of(kBlank, from);
  return static_cast<int>(at == std::string::npos ? from : at) + 1;
}

FllLine read_line(const std::string& line, const SourceLocation& where) {
  const auto colon = line.find(':');
  if (colon == std::string::npos)
    throw InputError(where, "found '" + trimmed(line) + "', must be 'key: value'");
  FllLine result;
  result.key = trimmed(line.substr(0, colon));
  result.value = trimmed(line.substr(colon + 1));
  result.key_where = {where.file, where.line, column_of(line, 0)};
  result.value_where = {where.file, where.line, column_of(line, colon + 1)};
  return result;
}

}  // namespace

std::vector<FllSection> split_fll(const std::string& text, const std::string& name) {
  std::vector<FllSection> sections;
  std::istringstream in(text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const SourceLocation where{name, number, 1};
    check_characters(line, where);
    line.resize(std::min(line.find('#'), line.size()));
    if (trimmed(line).empty()) continue;
    FllLine read = read_line(line, where);
    if (is_section(read.key)) {
      sections.push_back({std::move(read), {}});
    } else if (sections.empty()) {
      throw InputError(read.key_where,
                       "found the key '" + read.key + "' before the first section 'Engine: name'");
    } else {
      sections.back().lines.push_back(std::move(read));
    }
  }
  return sections;
}

std::vector<FllWord> words_of(const FllLine& line) {
  std::vector<FllWord> words;
  std::size_t at = 0;
  while ((at = line.value.find_first_not_of(kBlank, at)) != std::string::npos) {
    const auto end = std::min(line.value.find_first_of(kBlank, at), line.value.size());
    SourceLocation where = line.value_where;
    where.column += static_cast<int>(at);
    words.push_back({line.value.substr(at, end - at), where});
    at = end;
  }
  return words;
}

double read_fll_number(const FllWord& word) {
  double value = 0.0;
  const char* first = word.text.data();
  const char* last = first + word.text.size();
  const auto [end, code] = std::from_chars(first, last, value);
  if (code != std::errc() || end != last || !(std::abs(value) <= kLargest))
    throw InputError(word.where, "found '" + word.text + "', must be a finite number");
  return value;
}

bool is_fll_name(const std::string& text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !text.empty() && letter(text.front()) &&
         std::all_of(text.begin(), text.end(),
                     [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

}  // namespace vigia::planner

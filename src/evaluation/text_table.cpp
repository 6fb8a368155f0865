#include "vigia/evaluation/text_table.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace vigia::evaluation {
namespace {

/// Code points: the bytes that do not continue one.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::vector<std::size_t> column_widths(const TextRows& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows) {
    assert(row.size() == widths.size());
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  return widths;
}

/// A bar would end the cell.
std::string without_bars(const std::string& cell) {
  std::string text;
  for (const char c : cell) text += c == '|' ? std::string("\\|") : std::string(1, c);
  return text;
}

}  // namespace

std::string aligned_table(const TextRows& rows, Cells cells) {
  if (rows.empty()) return "";
  const auto widths = column_widths(rows);
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::string& cell = rows[r][i];
      const std::string blanks(widths[i] - width_of(cell), ' ');
      const bool to_the_left = i == 0 || cells == Cells::words;
      if (i > 0) text += "  ";
      if (!to_the_left) text += blanks;
      text += cell;
      if (to_the_left && i + 1 < widths.size()) text += blanks;
    }
    text += '\n';
    if (r > 0) continue;
    for (std::size_t i = 0; i < widths.size(); ++i)
      text += (i == 0 ? "" : "  ") + std::string(widths[i], '-');
    text += '\n';
  }
  return text;
}

std::string markdown_table(const TextRows& rows, Cells cells) {
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    text += '|';
    for (const auto& cell : rows[r]) text += ' ' + without_bars(cell) + " |";
    text += '\n';
    if (r > 0) continue;
    text += '|';
    for (std::size_t i = 0; i < rows[r].size(); ++i)
      text += i == 0 || cells == Cells::words ? "---|" : "---:|";
    text += '\n';
  }
  return text;
}

}  // namespace vigia::evaluation

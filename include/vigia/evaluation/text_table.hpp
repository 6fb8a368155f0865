#pragma once

#include <string>
#include <vector>

namespace vigia::evaluation {

/// Cells in rows, the first row a heading. Every row has as many cells as the first.
using TextRows = std::vector<std::vector<std::string>>;

/// What stands in the columns after the first: numbers to the right, words to the left.
enum class Cells { numbers, words };

/// Columns aligned with blanks; a line of dashes below the heading. Widths count characters of
/// UTF-8.
std::string aligned_table(const TextRows& rows, Cells cells = Cells::numbers);

/// The same rows in Markdown.
std::string markdown_table(const TextRows& rows, Cells cells = Cells::numbers);

}  // namespace vigia::evaluation

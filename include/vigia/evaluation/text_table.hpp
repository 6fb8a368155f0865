#pragma once

#include <string>
#include <vector>

namespace vigia::evaluation {

/// Cells in rows, the first row a heading. Every row has as many cells as the first.
using TextRows = std::vector<std::vector<std::string>>;

/// Columns aligned with blanks, the first to the left and the others to the right; a line of dashes
/// below the heading. Widths count characters of UTF-8.
std::string aligned_table(const TextRows& rows);

/// The same rows in Markdown.
std::string markdown_table(const TextRows& rows);

}  // namespace vigia::evaluation

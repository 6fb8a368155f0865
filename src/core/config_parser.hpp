#pragma once

#include <memory>
#include <string>

#include "vigia/core/config.hpp"

namespace vigia {

/// A YAML document as a tree, strictly: one document, valid UTF-8, text keys, no duplicate key, no
/// tag but `!!str`, no anchor inside itself, bounded depth and size. An empty text gives a null
/// node. Every node is located at its line and column of @p where.file, or, when @p where_is_fixed,
/// at @p where. Throws InputError.
std::shared_ptr<ConfigNode> parse_yaml(const std::string& bytes, const SourceLocation& where,
                                       bool where_is_fixed);

/// The content of a file of configuration. Throws InputError at @p wanted_at (where the file was
/// asked for; unknown: the file itself) unless it is a regular file that can be read.
std::string read_config_text(const std::filesystem::path& file, const SourceLocation& wanted_at);

/// Loads the file that a value names: relative to the file in which the value was written, or, for
/// a value of the command line (it has no line), to the working directory.
std::shared_ptr<ConfigNode> load_named_config(const ConfigNode& name);

/// Whether a text read back as a plain (unquoted) scalar is that text and no null.
bool is_plain_text(const std::string& text);

/// The shortest text that reads back as the same number.
std::string write_number(double value);

/// A value as messages quote it: in single quotes, shortened when long.
std::string quoted_for_message(const std::string& value);

}  // namespace vigia

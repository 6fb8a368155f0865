#include "config_parser.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>

#include "vigia/core/config.hpp"
#include "vigia/core/renamed_keys.hpp"
#include "vigia/core/suggestion.hpp"

namespace vigia {
namespace {

using NodePtr = std::shared_ptr<ConfigNode>;

std::string found_text(const ConfigNode& node) {
  switch (node.kind) {
    case ConfigNode::Kind::null:
      return "nothing";
    case ConfigNode::Kind::scalar:
      return (node.quoted ? "the text " : "") + quoted_for_message(node.scalar);
    case ConfigNode::Kind::list:
      return "a list of " + std::to_string(node.items.size());
    case ConfigNode::Kind::map:
      return "a map";
  }
  return "";
}

/// Where a value was written; a map or an empty value is found by its key.
const SourceLocation& location(const ConfigNode& node) {
  const bool by_key = node.kind == ConfigNode::Kind::map || node.kind == ConfigNode::Kind::null;
  return by_key && !node.key_where.file.empty() ? node.key_where : node.where;
}

NodePtr make_scalar(std::string text, const SourceLocation& where, bool quoted = false) {
  auto node = std::make_shared<ConfigNode>();
  node->kind = ConfigNode::Kind::scalar;
  node->scalar = std::move(text);
  node->quoted = quoted;
  node->where = where;
  return node;
}

NodePtr make_list(const double* values, Eigen::Index count, const SourceLocation& where) {
  auto node = std::make_shared<ConfigNode>();
  node->kind = ConfigNode::Kind::list;
  node->where = where;
  for (Eigen::Index i = 0; i < count; ++i)
    node->items.push_back(make_scalar(write_number(values[i]), where));
  return node;
}

NodePtr make_text_list(const std::vector<std::string>& texts, const SourceLocation& where) {
  auto node = std::make_shared<ConfigNode>();
  node->kind = ConfigNode::Kind::list;
  node->where = where;
  for (const std::string& text : texts)
    node->items.push_back(make_scalar(text, where, !is_plain_text(text)));
  return node;
}

/// The text of a plain number without the leading plus that std::from_chars does not know.
std::string_view digits_of(const ConfigNode& node) {
  std::string_view text = node.scalar;
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

class ValueError {
 public:
  explicit ValueError(const std::string& path) : path_(path) {}
  [[noreturn]] void fail(const ConfigNode& node, const std::string& right) const {
    throw InputError(location(node), path_ + ": found " + found_text(node) + ", " + right);
  }
  void check_range(const ConfigNode& node, double value, Range range) const {
    if (value >= range.low && value <= range.high) return;
    if (std::isinf(range.high)) fail(node, "must be at least " + write_number(range.low));
    if (std::isinf(range.low)) fail(node, "must be at most " + write_number(range.high));
    fail(node, "must lie in [" + write_number(range.low) + ", " + write_number(range.high) + "]");
  }

 private:
  const std::string& path_;
};

double read_number(const ConfigNode& node, const std::string& path, Range range) {
  const ValueError error(path);
  if (node.kind != ConfigNode::Kind::scalar || node.quoted) error.fail(node, "must be a number");
  const std::string_view text = digits_of(node);
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool infinite_or_nan = node.scalar == ".inf" || node.scalar == "-.inf" ||
                               node.scalar == "+.inf" || node.scalar == ".nan" ||
                               node.scalar == ".Inf" || node.scalar == ".NaN";
  if (infinite_or_nan || (code == std::errc() && !std::isfinite(value)))
    error.fail(node, "must be a finite number");
  if (code == std::errc::result_out_of_range)
    error.fail(node, "must be a number that a double can hold");
  if (code != std::errc() || end != text.data() + text.size()) error.fail(node, "must be a number");
  error.check_range(node, value, range);
  return value;
}

std::int64_t read_integer(const ConfigNode& node, const std::string& path, Range range) {
  const ValueError error(path);
  if (node.kind != ConfigNode::Kind::scalar || node.quoted)
    error.fail(node, "must be a whole number");
  const std::string_view text = digits_of(node);
  std::int64_t value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc::result_out_of_range) error.fail(node, "must fit into 64 bits");
  if (code != std::errc() || end != text.data() + text.size())
    error.fail(node, "must be a whole number");
  error.check_range(node, static_cast<double>(value), range);
  return value;
}

template <int N>
Eigen::Matrix<double, N, 1> read_vector(const ConfigNode& node, const std::string& path,
                                        Range range) {
  if (node.kind != ConfigNode::Kind::list || node.items.size() != N)
    ValueError(path).fail(node, "must be a list of " + std::to_string(N) + " numbers");
  Eigen::Matrix<double, N, 1> value;
  for (int i = 0; i < N; ++i) {
    const auto at = static_cast<std::size_t>(i);
    value[i] = read_number(*node.items[at], path + "[" + std::to_string(i) + "]", range);
  }
  return value;
}

bool read_boolean(const ConfigNode& node, const std::string& path) {
  const bool plain = node.kind == ConfigNode::Kind::scalar && !node.quoted;
  if (plain && node.scalar == "true") return true;
  if (plain && node.scalar == "false") return false;
  ValueError(path).fail(node, "must be true or false");
}

const std::string& read_text(const ConfigNode& node, const std::string& path) {
  if (node.kind != ConfigNode::Kind::scalar) ValueError(path).fail(node, "must be a text");
  return node.scalar;
}

std::size_t read_choice(const ConfigNode& node, const std::string& path,
                        const std::vector<std::string>& choices) {
  const std::string& text = read_text(node, path);
  const auto found = std::find(choices.begin(), choices.end(), text);
  if (found == choices.end())
    ValueError(path).fail(node, "must be one of " + joined(choices) + suggestion(text, choices));
  return static_cast<std::size_t>(found - choices.begin());
}

InputError renamed_error(const SourceLocation& where, const RenamedKey& key) {
  return {where, "the key '" + key.before + "' is now '" + key.now + "'"};
}

}  // namespace

std::string write_number(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

MapReader::MapReader(std::shared_ptr<ConfigNode> node, std::string what)
    : node_(std::move(node)), what_(std::move(what)) {
  if (node_->kind != ConfigNode::Kind::map && node_->kind != ConfigNode::Kind::null)
    ValueError(what_).fail(*node_, "must be a map of keys and values");
}

std::string MapReader::path(const std::string& key) const {
  return what_.empty() ? key : what_ + "." + key;
}

const ConfigNode* MapReader::find(const std::string& key) const {
  const ConfigNode* value = node_->find(key);
  return value != nullptr && !value->absent() ? value : nullptr;
}

const ConfigNode* MapReader::ask(const std::string& key) const {
  asked_.insert(key);
  return find(key);
}

const ConfigNode& MapReader::require(const std::string& key) const {
  const ConfigNode* value = ask(key);
  if (value == nullptr) throw missing(key);
  return *value;
}

InputError MapReader::missing(const std::string& key) const {
  for (const auto& [name, value] : node_->entries)
    if (const RenamedKey* renamed = find_renamed_key(path(name)))
      return renamed_error(value->key_where, *renamed);
  constexpr std::size_t kSlips = 2;
  for (const auto& [name, value] : node_->entries)
    if (asked_.count(name) == 0 && edit_distance(name, key) <= kSlips)
      return {value->key_where, path(key) + ": the key is missing; found '" + name + "'"};
  return {where(), path(key) + ": the key is missing"};
}

void MapReader::resolve(const std::string& key, std::shared_ptr<ConfigNode> value) {
  node_->kind = ConfigNode::Kind::map;
  node_->entries.emplace_back(key, std::move(value));
}

bool MapReader::has(const std::string& key) const {
  return ask(key) != nullptr;
}

bool MapReader::holds_map(const std::string& key) const {
  const ConfigNode* value = ask(key);
  return value != nullptr && value->kind == ConfigNode::Kind::map;
}

const SourceLocation& MapReader::where() const {
  return location(*node_);
}

SourceLocation MapReader::where(const std::string& key) const {
  const ConfigNode* value = find(key);
  return value != nullptr ? location(*value) : where();
}

double MapReader::number(const std::string& key, Range range) {
  return read_number(require(key), path(key), range);
}

double MapReader::number(const std::string& key, Range range, double fallback) {
  if (const ConfigNode* value = ask(key)) return read_number(*value, path(key), range);
  resolve(key, make_scalar(write_number(fallback), where()));
  return fallback;
}

std::int64_t MapReader::integer(const std::string& key, Range range) {
  return read_integer(require(key), path(key), range);
}

std::int64_t MapReader::integer(const std::string& key, Range range, std::int64_t fallback) {
  if (const ConfigNode* value = ask(key)) return read_integer(*value, path(key), range);
  resolve(key, make_scalar(std::to_string(fallback), where()));
  return fallback;
}

bool MapReader::boolean(const std::string& key, bool fallback) {
  if (const ConfigNode* value = ask(key)) return read_boolean(*value, path(key));
  resolve(key, make_scalar(fallback ? "true" : "false", where()));
  return fallback;
}

std::string MapReader::text(const std::string& key) {
  return read_text(require(key), path(key));
}

std::string MapReader::folder_name(const std::string& key) {
  const ConfigNode& value = require(key);
  const std::string& name = read_text(value, path(key));
  if (name.empty() || name == "." || name == ".." || name.find('/') != std::string::npos)
    ValueError(path(key)).fail(value, "must be a name that a folder can have: not empty, no '/'");
  return name;
}

std::string MapReader::text(const std::string& key, const std::string& fallback) {
  if (const ConfigNode* value = ask(key)) return read_text(*value, path(key));
  resolve(key, make_scalar(fallback, where(), !is_plain_text(fallback)));
  return fallback;
}

std::optional<MapReader::NamedText> MapReader::text_or_file(const std::string& key) {
  const std::string value = text(key, "default");
  if (value == "default") return std::nullopt;
  ConfigNode& node = *node_->find(key);
  if (value.find('\n') != std::string::npos)
    return NamedText{value, to_string(node.where) + " (" + path(key) + ")"};
  const std::filesystem::path file = std::filesystem::path(node.where.file).parent_path() / value;
  std::ifstream in(file, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(in), {}};
  if (!in || content.find('\n') == std::string::npos)
    throw InputError(node.where, path(key) + ": found '" + value +
                                     "', must be a file that can be read, or a text of several "
                                     "lines");
  node.scalar = content;
  node.quoted = true;
  return NamedText{content, file.string()};
}

std::size_t MapReader::choice(const std::string& key, const std::vector<std::string>& choices) {
  return read_choice(require(key), path(key), choices);
}

std::size_t MapReader::choice(const std::string& key, const std::vector<std::string>& choices,
                              std::size_t fallback) {
  if (const ConfigNode* value = ask(key)) return read_choice(*value, path(key), choices);
  resolve(key, make_scalar(choices.at(fallback), where(), !is_plain_text(choices.at(fallback))));
  return fallback;
}

Eigen::Vector2d MapReader::vector2(const std::string& key, Range range) {
  return read_vector<2>(require(key), path(key), range);
}

Eigen::Vector2d MapReader::vector2(const std::string& key, Range range,
                                   const Eigen::Vector2d& fallback) {
  if (const ConfigNode* value = ask(key)) return read_vector<2>(*value, path(key), range);
  resolve(key, make_list(fallback.data(), 2, where()));
  return fallback;
}

Eigen::Vector3d MapReader::vector3(const std::string& key, Range range) {
  return read_vector<3>(require(key), path(key), range);
}

Eigen::Vector3d MapReader::vector3(const std::string& key, Range range,
                                   const Eigen::Vector3d& fallback) {
  if (const ConfigNode* value = ask(key)) return read_vector<3>(*value, path(key), range);
  resolve(key, make_list(fallback.data(), 3, where()));
  return fallback;
}

std::vector<Eigen::Vector2d> MapReader::points2(const std::string& key, Range range,
                                                std::size_t least) {
  const ConfigNode& value = require(key);
  if (value.kind != ConfigNode::Kind::list || value.items.size() < least)
    ValueError(path(key)).fail(
        value, "must be a list of at least " + std::to_string(least) + " points [x, y]");
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < value.items.size(); ++i)
    points.push_back(
        read_vector<2>(*value.items[i], path(key) + "[" + std::to_string(i) + "]", range));
  return points;
}

std::vector<std::string> MapReader::texts(const std::string& key) {
  const ConfigNode& value = require(key);
  if (value.kind != ConfigNode::Kind::list)
    ValueError(path(key)).fail(value, "must be a list of texts");
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < value.items.size(); ++i)
    texts.push_back(read_text(*value.items[i], path(key) + "[" + std::to_string(i) + "]"));
  return texts;
}

std::vector<std::string> MapReader::names(const std::string& key,
                                          const std::vector<std::string>& known,
                                          const std::vector<std::string>& fallback) {
  const ConfigNode* value = ask(key);
  if (value == nullptr) {
    resolve(key, make_text_list(fallback, where()));
    return fallback;
  }
  if (value->kind != ConfigNode::Kind::list || value->items.empty())
    ValueError(path(key)).fail(*value, "must be a list of one or more of " + joined(known));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < value->items.size(); ++i) {
    const std::string at = path(key) + "[" + std::to_string(i) + "]";
    names.push_back(known[read_choice(*value->items[i], at, known)]);
    if (std::find(names.begin(), names.end() - 1, names.back()) != names.end() - 1)
      ValueError(at).fail(*value->items[i], "which stands in the list before");
  }
  return names;
}

MapReader MapReader::map(const std::string& key) {
  ask(key);
  for (const auto& [name, value] : node_->entries) {
    if (name == key) return {value, path(key)};
  }
  auto made = std::make_shared<ConfigNode>();
  made->kind = ConfigNode::Kind::map;
  made->implicit = true;
  made->where = made->key_where = where();
  resolve(key, made);
  return {made, path(key)};
}

std::vector<MapReader> MapReader::maps(const std::string& key) {
  std::vector<MapReader> readers;
  const ConfigNode* value = ask(key);
  if (value == nullptr || value->kind == ConfigNode::Kind::null) return readers;
  if (value->kind != ConfigNode::Kind::list)
    ValueError(path(key)).fail(*value, "must be a list of maps");
  for (std::size_t i = 0; i < value->items.size(); ++i)
    readers.emplace_back(value->items[i], path(key) + "[" + std::to_string(i) + "]");
  return readers;
}

MapReader MapReader::map_or_file(const std::string& key) {
  const ConfigNode& asked = require(key);
  if (asked.kind == ConfigNode::Kind::scalar) {
    if (asked.scalar.empty())
      ValueError(path(key)).fail(asked, "must be a map or the name of a file");
    const NodePtr loaded = load_named_config(asked);
    for (auto& entry : node_->entries) {
      if (entry.first == key) entry.second = loaded;
    }
  }
  return map(key);
}

void MapReader::only_where(const std::string& key, const std::string& words) {
  conditions_.emplace(key, words);
}

void MapReader::finish() const {
  for (const auto& [key, value] : node_->entries) {
    if (asked_.count(key) != 0) continue;
    const SourceLocation& place = value->key_where.file.empty() ? value->where : value->key_where;
    if (const RenamedKey* renamed = find_renamed_key(path(key)))
      throw renamed_error(place, *renamed);
    const std::string of = what_.empty() ? "" : " in " + what_;
    const auto condition = conditions_.find(key);
    if (condition != conditions_.end())
      throw InputError(place, "the key " + quoted_for_message(key) + of + " counts only where " +
                                  condition->second);
    const std::vector<std::string> known(asked_.begin(), asked_.end());
    throw InputError(place, "unknown key " + quoted_for_message(key) + of + suggestion(key, known) +
                                " (known: " + joined(known) + ")");
  }
}

InputError MapReader::error(const std::string& key, const std::string& what) const {
  return {where(key), path(key) + ": " + what};
}

}  // namespace vigia

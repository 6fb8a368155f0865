#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/error.hpp"

namespace vigia {

/// A node of a configuration tree that remembers where each value was written.
struct ConfigNode {
  enum class Kind { null, scalar, list, map };
  using Entry = std::pair<std::string, std::shared_ptr<ConfigNode>>;

  Kind kind = Kind::null;
  std::string scalar;
  bool quoted = false;
  std::vector<std::shared_ptr<ConfigNode>> items;
  std::vector<Entry> entries;  ///< in the order of the file
  SourceLocation where;
  SourceLocation key_where;  ///< of the key whose value this is; unknown in a list
  /// Made by a reader for an absent map: it counts as absent until something is written into it.
  bool implicit = false;

  ConfigNode* find(const std::string& key) const;
  /// Whether it is an implicit map without content.
  bool absent() const;
};

/// Reads a YAML file, strictly: `version: 1` is required at the top, duplicate keys are errors,
/// `extends: other.yaml` (relative to the file) is merged below it (maps merge, lists replace,
/// cycles are errors). The result has neither `version` nor `extends`. Throws InputError.
std::shared_ptr<ConfigNode> load_config(const std::filesystem::path& file);

/// The same from a string; @p name stands for the file in messages.
std::shared_ptr<ConfigNode> parse_config(const std::string& text, const std::string& name);

/// Sets a value at a dotted path as `--set a.b=value` does; the value is YAML. Maps on the way are
/// made; the name of a YAML file on the way is replaced by its content; a list or another scalar on
/// the way is an error. `a.b=null` removes the key, which must be there.
void set_config(ConfigNode& root, const std::string& assignment);

/// Writes the tree as YAML with `version: 1`; read back, it gives the same tree.
std::string dump_config(const ConfigNode& root);

/// Bounds of a number, both inclusive.
struct Range {
  double low;
  double high;
};

/// Reads the keys of one map, each once, and in finish() rejects those that nobody asked for.
/// A default that is used is written back into the tree: dumped afterwards, the tree is fully
/// resolved. Every getter throws InputError with file:line:column, key, value and what would be
/// right. The unit is part of the key (`_m`, `_deg`, `_s`, `_px`); values are returned as written.
class MapReader {
 public:
  /// @p what names the map in messages, e.g. "planner". A null node counts as an empty map.
  MapReader(std::shared_ptr<ConfigNode> node, std::string what);

  /// Whether the key was given; counts as asking for it.
  bool has(const std::string& key) const;
  /// Whether the key's value is a map; counts as asking for it.
  bool holds_map(const std::string& key) const;
  const SourceLocation& where() const;
  SourceLocation where(const std::string& key) const;

  double number(const std::string& key, Range range);
  double number(const std::string& key, Range range, double fallback);
  std::int64_t integer(const std::string& key, Range range);
  std::int64_t integer(const std::string& key, Range range, std::int64_t fallback);
  bool boolean(const std::string& key, bool fallback);
  std::string text(const std::string& key);
  /// A text of which a folder's name is made.
  std::string folder_name(const std::string& key);
  std::string text(const std::string& key, const std::string& fallback);
  /// A text with line breaks given in place, or the name of a file (relative to the file in which
  /// the value was written) whose content takes the place of its name in the tree; nothing for
  /// "default" and for an absent key, which is resolved to it. `name` stands for the file in
  /// messages.
  struct NamedText {
    std::string text;
    std::string name;
  };
  std::optional<NamedText> text_or_file(const std::string& key);
  /// One of @p choices; returns its index.
  std::size_t choice(const std::string& key, const std::vector<std::string>& choices);
  std::size_t choice(const std::string& key, const std::vector<std::string>& choices,
                     std::size_t fallback);
  /// A list of exactly N numbers, each in @p range.
  Eigen::Vector2d vector2(const std::string& key, Range range);
  Eigen::Vector2d vector2(const std::string& key, Range range, const Eigen::Vector2d& fallback);
  Eigen::Vector3d vector3(const std::string& key, Range range);
  Eigen::Vector3d vector3(const std::string& key, Range range, const Eigen::Vector3d& fallback);
  /// A list of points, each a list of two numbers, at least @p least of them.
  std::vector<Eigen::Vector2d> points2(const std::string& key, Range range, std::size_t least);

  /// A list of texts.
  std::vector<std::string> texts(const std::string& key);
  /// A list of some of @p known, at least one and each once.
  std::vector<std::string> names(const std::string& key, const std::vector<std::string>& known,
                                 const std::vector<std::string>& fallback);

  /// A map below this one; absent it reads as empty, and is created when something is resolved.
  MapReader map(const std::string& key);
  /// A list of maps; absent it reads as empty.
  std::vector<MapReader> maps(const std::string& key);
  /// A map given in place, or the name of a file (relative to the file in which the value was
  /// written) that holds it; a file's content takes the place of its name in the tree.
  MapReader map_or_file(const std::string& key);

  /// The key stands here only where @p words hold, which they do not: finish() says so of it.
  void only_where(const std::string& key, const std::string& words);
  /// Throws InputError for the first key that no getter asked for, and names a near one.
  void finish() const;

  /// An InputError at a key (or at the map, when the key is absent).
  InputError error(const std::string& key, const std::string& what) const;

 private:
  /// The key with the names of the maps around it, as `--set` takes it.
  std::string path(const std::string& key) const;
  const ConfigNode* find(const std::string& key) const;
  const ConfigNode* ask(const std::string& key) const;
  const ConfigNode& require(const std::string& key) const;
  InputError missing(const std::string& key) const;
  void resolve(const std::string& key, std::shared_ptr<ConfigNode> value);

  std::shared_ptr<ConfigNode> node_;
  std::string what_;
  mutable std::set<std::string> asked_;
  std::map<std::string, std::string> conditions_;  ///< of keys that do not hold
};

}  // namespace vigia

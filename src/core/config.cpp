#include "vigia/core/config.hpp"

#include "config_parser.hpp"

#include <algorithm>

namespace vigia {
namespace {

using NodePtr = std::shared_ptr<ConfigNode>;

/// Lays @p over on @p base: maps merge, an empty (null) map changes nothing, all else replaces.
NodePtr merge(const NodePtr& base, const NodePtr& over) {
  if (base->kind != ConfigNode::Kind::map) return over;
  if (over->kind == ConfigNode::Kind::null) return base;
  if (over->kind != ConfigNode::Kind::map) return over;
  for (const auto& [key, value] : over->entries) {
    const auto& wanted = key;
    const auto twin = std::find_if(base->entries.begin(), base->entries.end(),
                                   [&wanted](const auto& entry) { return entry.first == wanted; });
    if (twin == base->entries.end())
      base->entries.emplace_back(key, value);
    else
      twin->second = merge(twin->second, value);
  }
  base->where = over->where;
  base->key_where = over->key_where;
  return base;
}

/// Takes an entry out of a map; nullptr when it has none of that key.
NodePtr take(ConfigNode& map, const std::string& key) {
  const auto found = std::find_if(map.entries.begin(), map.entries.end(),
                                  [&key](const auto& entry) { return entry.first == key; });
  if (found == map.entries.end()) return nullptr;
  NodePtr value = found->second;
  map.entries.erase(found);
  return value;
}

void take_version(ConfigNode& root) {
  const NodePtr version = take(root, "version");
  if (!version)
    throw InputError(root.where, "the key 'version' is missing; write 'version: 1' at the top");
  if (version->kind != ConfigNode::Kind::scalar || version->quoted || version->scalar != "1")
    throw InputError(version->where, "version: found " + quoted_for_message(version->scalar) +
                                         ", must be 1, the version that this program reads");
}

/// A map in place of a file's name is no file: what it extends would be passed over.
void refuse_below_the_top(const ConfigNode& node) {
  for (const auto& item : node.items) refuse_below_the_top(*item);
  for (const auto& [key, value] : node.entries) {
    if (key == "version" || key == "extends")
      throw InputError(value->key_where,
                       "'" + key +
                           "' belongs to the top of a file, not into a map "
                           "within one; write the name of a file instead of the map");
    refuse_below_the_top(*value);
  }
}

std::string name_cycle(const std::vector<std::filesystem::path>& chain,
                       const std::filesystem::path& again) {
  auto first = std::find(chain.begin(), chain.end(), again);
  std::string names;
  for (; first != chain.end(); ++first) names += first->string() + " → ";
  return names + again.string();
}

NodePtr resolve(const std::string& text, const std::string& name,
                std::vector<std::filesystem::path>& chain);

/// Reads what `extends` names and lays @p root on it.
NodePtr extend(const NodePtr& root, const ConfigNode& extends, const std::string& name,
               std::vector<std::filesystem::path>& chain) {
  if (extends.kind != ConfigNode::Kind::scalar || extends.scalar.empty())
    throw InputError(extends.kind == ConfigNode::Kind::null ? extends.key_where : extends.where,
                     "extends: must be the name of one file");
  const auto file = std::filesystem::path(name).parent_path() / extends.scalar;
  const std::string text = read_config_text(file, extends.where);
  const auto identity = std::filesystem::weakly_canonical(file);
  if (std::find(chain.begin(), chain.end(), identity) != chain.end())
    throw InputError(extends.where,
                     "extends: the files extend each other: " + name_cycle(chain, identity));
  chain.push_back(identity);
  const NodePtr base = resolve(text, file.lexically_normal().string(), chain);
  chain.pop_back();
  return merge(base, root);
}

NodePtr resolve(const std::string& text, const std::string& name,
                std::vector<std::filesystem::path>& chain) {
  const NodePtr root = parse_yaml(text, {name, 0, 0}, false);
  if (root->kind == ConfigNode::Kind::null)
    throw InputError({name, 1, 1}, "there is nothing in it; write 'version: 1' and keys");
  if (root->kind != ConfigNode::Kind::map)
    throw InputError(root->where, "the top must be a map of keys and values");
  take_version(*root);
  const NodePtr extends = take(*root, "extends");
  refuse_below_the_top(*root);
  return extends ? extend(root, *extends, name, chain) : root;
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> keys(1);
  for (const char c : path) {
    if (c == '.')
      keys.emplace_back();
    else
      keys.back() += c;
  }
  return keys;
}

bool names_a_file(const ConfigNode& node) {
  const auto ending = std::filesystem::path(node.scalar).extension();
  return node.kind == ConfigNode::Kind::scalar && (ending == ".yaml" || ending == ".yml");
}

/// The map at a key, for a path that goes on below it: made when it is absent, and loaded when the
/// value is the name of a file.
ConfigNode& step_into(ConfigNode& parent, const std::string& key, const SourceLocation& where) {
  for (auto& [name, value] : parent.entries)
    if (name == key && names_a_file(*value)) value = load_named_config(*value);
  ConfigNode* child = parent.find(key);
  if (child == nullptr) {
    auto made = std::make_shared<ConfigNode>();
    made->where = made->key_where = where;
    parent.entries.emplace_back(key, made);
    child = made.get();
  }
  if (child->kind == ConfigNode::Kind::null) child->kind = ConfigNode::Kind::map;
  if (child->kind != ConfigNode::Kind::map)
    throw InputError(where, quoted_for_message(key) + " is " +
                                (child->kind == ConfigNode::Kind::list ? "a list" : "a value") +
                                " (" + to_string(child->where) + "), not a map with keys");
  return *child;
}

}  // namespace

ConfigNode* ConfigNode::find(const std::string& key) const {
  for (const auto& [name, value] : entries) {
    if (name == key) return value.get();
  }
  return nullptr;
}

bool ConfigNode::absent() const {
  return implicit && std::all_of(entries.begin(), entries.end(),
                                 [](const Entry& entry) { return entry.second->absent(); });
}

NodePtr load_config(const std::filesystem::path& file) {
  const std::string text = read_config_text(file, {});
  std::vector<std::filesystem::path> chain{std::filesystem::weakly_canonical(file)};
  return resolve(text, file.string(), chain);
}

NodePtr parse_config(const std::string& text, const std::string& name) {
  std::vector<std::filesystem::path> chain{std::filesystem::weakly_canonical(name)};
  return resolve(text, name, chain);
}

NodePtr load_named_config(const ConfigNode& name) {
  const auto folder = name.where.line > 0 ? std::filesystem::path(name.where.file).parent_path()
                                          : std::filesystem::path();
  const auto file = (folder / name.scalar).lexically_normal();
  read_config_text(file, name.where);  // so that a missing file is reported where it is named
  return load_config(file);
}

void set_config(ConfigNode& root, const std::string& assignment) {
  const SourceLocation where{"--set " + assignment, 0, 0};
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos) throw InputError(where, "must read key=value");
  const auto keys = split_path(assignment.substr(0, equals));
  if (std::find(keys.begin(), keys.end(), "") != keys.end())
    throw InputError(where, "the key must be names joined by single dots");
  if (keys.size() == 1 && (keys.front() == "version" || keys.front() == "extends"))
    throw InputError(where, "'" + keys.front() + "' belongs to a file and cannot be set");
  const NodePtr value = parse_yaml(assignment.substr(equals + 1), where, true);
  value->key_where = where;

  ConfigNode* map = &root;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) map = &step_into(*map, keys[i], where);
  const auto entry = std::find_if(map->entries.begin(), map->entries.end(),
                                  [&](const auto& e) { return e.first == keys.back(); });
  if (value->kind == ConfigNode::Kind::null) {
    if (entry == map->entries.end())
      throw InputError(where, quoted_for_message(keys.back()) + " is not there to be removed");
    map->entries.erase(entry);
  } else if (entry != map->entries.end()) {
    entry->second = value;
  } else {
    map->entries.emplace_back(keys.back(), value);
  }
}

}  // namespace vigia

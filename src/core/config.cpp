#include "vigia/core/config.hpp"

#include "config_parser.hpp"

#include <algorithm>
#include <optional>
#include <sstream>

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

/// A key of a path and the places, from 0, in the lists that follow it: cameras[0].
struct PathStep {
  std::string key;
  std::vector<std::size_t> places;
};

/// The places behind a key, "[0][1]"; nothing where it is written otherwise.
std::optional<std::vector<std::size_t>> places_of(const std::string& text) {
  constexpr std::size_t kDigits = 6;
  std::vector<std::size_t> places;
  for (std::size_t open = 0; open < text.size();) {
    const std::size_t close = text.find(']', open);
    if (text[open] != '[' || close == std::string::npos) return std::nullopt;
    const std::string digits = text.substr(open + 1, close - open - 1);
    if (digits.empty() || digits.size() > kDigits ||
        digits.find_first_not_of("0123456789") != std::string::npos)
      return std::nullopt;
    places.push_back(std::stoul(digits));
    open = close + 1;
  }
  return places;
}

std::vector<PathStep> split_path(const std::string& path, const SourceLocation& where) {
  std::vector<PathStep> steps;
  std::istringstream parts(path + ".");
  for (std::string part; std::getline(parts, part, '.');) {
    const std::size_t open = std::min(part.find('['), part.size());
    const auto places = places_of(part.substr(open));
    if (!places)
      throw InputError(where, "a place in a list is written key[0], counted from 0, found " +
                                  quoted_for_message(part));
    if (open == 0) throw InputError(where, "the key must be names joined by single dots");
    steps.push_back({part.substr(0, open), *places});
  }
  return steps;
}

bool names_a_file(const ConfigNode& node) {
  const auto ending = std::filesystem::path(node.scalar).extension();
  return node.kind == ConfigNode::Kind::scalar && (ending == ".yaml" || ending == ".yml");
}

[[noreturn]] void throw_other_kind(const ConfigNode& node, const std::string& name,
                                   const std::string& wanted, const SourceLocation& where) {
  const char* const found = node.kind == ConfigNode::Kind::list  ? "a list"
                            : node.kind == ConfigNode::Kind::map ? "a map"
                                                                 : "a value";
  throw InputError(where, quoted_for_message(name) + " is " + found + " (" + to_string(node.where) +
                              "), not " + wanted);
}

/// Checks that there is such a place; @p name: of the list in messages.
void require_place(const ConfigNode& list, std::size_t place, const std::string& name,
                   const SourceLocation& where) {
  if (list.kind != ConfigNode::Kind::list) throw_other_kind(list, name, "a list", where);
  const std::size_t count = list.items.size();
  if (place < count) return;
  throw InputError(where, quoted_for_message(name) + " has " + std::to_string(count) +
                              (count == 1 ? " item" : " items") + " (" + to_string(list.where) +
                              "), counted from 0: there is no [" + std::to_string(place) + "]");
}

/// The value at a key, loaded when it is the name of a file; nullptr when there is none.
NodePtr* value_at(ConfigNode& map, const std::string& key) {
  for (auto& [name, value] : map.entries) {
    if (name != key) continue;
    if (names_a_file(*value)) value = load_named_config(*value);
    return &value;
  }
  return nullptr;
}

/// The list that the last of a step's places is in.
ConfigNode& list_of(ConfigNode& map, const PathStep& step, const SourceLocation& where) {
  NodePtr* at = value_at(map, step.key);
  if (at == nullptr) throw InputError(where, "there is no list " + quoted_for_message(step.key));
  for (std::size_t k = 0; k < step.places.size(); ++k) {
    require_place(**at, step.places[k], step.key, where);
    if (k + 1 == step.places.size()) break;
    at = &(*at)->items[step.places[k]];
  }
  return **at;
}

/// The map at a step, for a path that goes on below it: made when the key is absent, and loaded
/// when the value is the name of a file.
ConfigNode& step_into(ConfigNode& parent, const PathStep& step, const SourceLocation& where) {
  ConfigNode* child = nullptr;
  if (!step.places.empty()) {
    NodePtr& item = list_of(parent, step, where).items[step.places.back()];
    if (names_a_file(*item)) item = load_named_config(*item);
    child = item.get();
  } else if (NodePtr* value = value_at(parent, step.key)) {
    child = value->get();
  } else {
    auto made = std::make_shared<ConfigNode>();
    made->where = made->key_where = where;
    parent.entries.emplace_back(step.key, made);
    child = made.get();
  }
  if (child->kind == ConfigNode::Kind::null) child->kind = ConfigNode::Kind::map;
  if (child->kind != ConfigNode::Kind::map)
    throw_other_kind(*child, step.key, "a map with keys", where);
  return *child;
}

/// Puts the value into the list, or takes the item out.
void set_item(ConfigNode& map, const PathStep& step, const NodePtr& value,
              const SourceLocation& where) {
  auto& items = list_of(map, step, where).items;
  const auto item = items.begin() + static_cast<std::ptrdiff_t>(step.places.back());
  if (value->kind == ConfigNode::Kind::null)
    items.erase(item);
  else
    *item = value;
}

void set_entry(ConfigNode& map, const std::string& key, const NodePtr& value,
               const SourceLocation& where) {
  const auto entry = std::find_if(map.entries.begin(), map.entries.end(),
                                  [&](const auto& e) { return e.first == key; });
  if (value->kind == ConfigNode::Kind::null) {
    if (entry == map.entries.end())
      throw InputError(where, quoted_for_message(key) + " is not there to be removed");
    map.entries.erase(entry);
  } else if (entry != map.entries.end()) {
    entry->second = value;
  } else {
    map.entries.emplace_back(key, value);
  }
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
  const auto steps = split_path(assignment.substr(0, equals), where);
  const PathStep& last = steps.back();
  if (steps.size() == 1 && (last.key == "version" || last.key == "extends"))
    throw InputError(where, "'" + last.key + "' belongs to a file and cannot be set");
  const NodePtr value = parse_yaml(assignment.substr(equals + 1), where, true);
  value->key_where = where;

  ConfigNode* map = &root;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) map = &step_into(*map, steps[i], where);
  if (last.places.empty())
    set_entry(*map, last.key, value, where);
  else
    set_item(*map, last, value, where);
}

}  // namespace vigia

#pragma once

#include <string>
#include <utility>
#include <vector>

#include "vigia/core/params.hpp"

namespace vigia {

/// What the reference says of one key.
struct KeyRow {
  std::string key;  ///< as `--set` takes it; a key of a list's items is `list[].key`
  std::string kind;
  std::string unit;
  std::string range;  ///< empty: any value of its kind
  std::string usual;  ///< the default; empty: none
  bool required = false;
  std::string where;  ///< what must hold for the map to have the key; empty: nothing
  std::string meaning;
};

/// The unit that a key's ending says, "°/s" of `rate_deg_s`; empty: it says none.
std::string unit_of_key(const std::string& key);

/// Collects what the reference says of the keys that are visited.
class KeyReference : public ParamVisitor {
 public:
  /// @p prefix stands before every key, e.g. "robot."
  explicit KeyReference(std::string prefix = "") : prefix_(std::move(prefix)) {}
  const std::vector<KeyRow>& rows() const { return rows_; }

  bool given(const char* key, const Describe& describe_keys) override;
  void where(bool holds, const std::string& words, const Describe& describe_keys) override;
  void map(const char* key, const About& about, const Describe& describe_map) override;
  void map_or_file(const char* key, const About& about, const Describe& describe_map) override;
  void each(const char* key, const About& about, const Describe& describe_item) override;
  void require(bool, const char*, const std::string&) override {}
  MapReader* reader() const override { return nullptr; }

 protected:
  void field(const char* key, const Field& field, const About& about) override;
  bool toggle_map(const char* key, bool on, const About& about,
                  const Describe& describe_map) override;

 private:
  void add(const char* key, std::string kind, std::string range, std::string usual,
           const About& about);
  void below(const std::string& key, const Describe& describe_map);

  std::string prefix_;
  std::string where_;
  std::string from_elsewhere_;  ///< where the defaults of a map come from, in words
  bool optional_ = false;       ///< the keys are visited though they may be left out
  std::vector<KeyRow> rows_;
};

/// The reference of everything that @p params takes.
template <typename Params>
std::vector<KeyRow> key_reference(const std::string& prefix, Params params = {}) {
  KeyReference visitor(prefix);
  describe(visitor, params);
  return visitor.rows();
}

}  // namespace vigia

#include "vigia/core/key_reference.hpp"

#include "config_parser.hpp"

#include <array>
#include <cmath>

#include "vigia/core/suggestion.hpp"

namespace vigia {
namespace {

std::string write_bound(const Bound& bound) {
  constexpr double kLongest = 1e7;  // whole numbers that are read more easily without exponent
  if (!bound.text.empty()) return bound.text;
  const bool whole = bound.value == std::floor(bound.value) && std::abs(bound.value) <= kLongest;
  return whole ? std::to_string(static_cast<long long>(bound.value)) : write_number(bound.value);
}

std::string write_bounds(const Bounds& bounds) {
  const bool below = std::isinf(bounds.low.value);
  const bool above = std::isinf(bounds.high.value);
  if (below && above) return "";
  if (above) return "≥ " + write_bound(bounds.low);
  if (below) return "≤ " + write_bound(bounds.high);
  return write_bound(bounds.low) + " … " + write_bound(bounds.high);
}

/// Kind, range and default of a key.
struct Said {
  std::string kind;
  std::string range;
  std::string usual;
};

class FieldSays {
 public:
  Said operator()(const NumberField& f) const {
    return {"number", write_bounds(f.bounds), write_number(f.value)};
  }
  Said operator()(const AngleField& f) const {
    return {"number", write_bounds(f.degrees), write_number(written_degrees(f.radians))};
  }
  Said operator()(const IntegerField& f) const {
    return {"whole number", write_bounds(f.bounds), std::to_string(f.value)};
  }
  Said operator()(const BooleanField& f) const {
    return {"true or false", "", f.value ? "true" : "false"};
  }
  Said operator()(const TextField& f) const { return {"text", "", f.value}; }
  Said operator()(const FolderField&) const { return {"name of a folder", "", ""}; }
  Said operator()(const TextOrFileField&) const { return {"text or file", "", "default"}; }
  Said operator()(const ChoiceField& f) const {
    return {"one of", joined(f.names), f.index < f.names.size() ? f.names[f.index] : ""};
  }
  Said operator()(const VectorField& f) const {
    std::string usual;
    for (Eigen::Index i = 0; i < f.values.size(); ++i)
      usual += (i == 0 ? "[" : ", ") + write_number(f.values[i]);
    return {std::to_string(f.values.size()) + " numbers", write_bounds(f.bounds), usual + "]"};
  }
  Said operator()(const PointsField& f) const {
    const std::string least =
        f.min_count > 0 ? ", at least " + std::to_string(f.min_count) : std::string();
    return {"points [x, y]" + least, write_bounds(f.bounds), ""};
  }
  Said operator()(const TextsField&) const { return {"list of texts", "", ""}; }
  Said operator()(const NamesField& f) const {
    return {"list of", joined(f.known), "[" + joined(f.names) + "]"};
  }
};

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

}  // namespace

std::string unit_of_key(const std::string& key) {
  // The longer endings come before those that end them.
  static const std::array<std::pair<const char*, const char*>, 20> endings{{
      {"_per_sqrt_rad_deg", "°/√rad"},
      {"_per_sqrt_m_deg", "°/√m"},
      {"_per_sqrt_m", "m/√m"},
      {"_deg_per_m", "°/m"},
      {"_per_m2", "1/m²"},
      {"per_m", "1/m"},
      {"_per_s", "1/s"},
      {"_deg_s2", "°/s²"},
      {"_deg_s", "°/s"},
      {"_mm_s", "mm/s"},
      {"_mps2", "m/s²"},
      {"_mps", "m/s"},
      {"_deg", "°"},
      {"_mm", "mm"},
      {"_px", "px"},
      {"_hz", "Hz"},
      {"_kelvin", "K"},
      {"_grey", "grey levels"},
      {"_m", "m"},
      {"_s", "s"},
  }};
  for (const auto& [ending, unit] : endings)
    if (ends_with(key, ending)) return unit;
  return "";
}

void KeyReference::add(const char* key, std::string kind, std::string range, std::string usual,
                       const About& about) {
  KeyRow row;
  row.key = prefix_ + key;
  row.kind = std::move(kind);
  row.unit = about.unit.empty() ? unit_of_key(key) : about.unit;
  row.range = std::move(range);
  row.required = about.must_be_given && !optional_;
  if (!about.default_words.empty())
    row.usual = about.default_words;
  else if (!about.must_be_given && !optional_)
    row.usual = from_elsewhere_.empty() ? std::move(usual) : from_elsewhere_;
  row.where = where_;
  row.meaning = about.meaning;
  rows_.push_back(std::move(row));
}

void KeyReference::field(const char* key, const Field& field, const About& about) {
  Said said = std::visit(FieldSays(), field);
  add(key, std::move(said.kind), std::move(said.range), std::move(said.usual), about);
}

void KeyReference::below(const std::string& key, const Describe& describe_map) {
  const std::string prefix = std::exchange(prefix_, prefix_ + key + ".");
  const std::string where = std::exchange(where_, "");
  const bool optional = std::exchange(optional_, false);
  describe_map();
  prefix_ = prefix;
  where_ = where;
  optional_ = optional;
}

bool KeyReference::given(const char*, const Describe& describe_keys) {
  const bool before = std::exchange(optional_, true);
  describe_keys();
  optional_ = before;
  return false;
}

void KeyReference::where(bool, const std::string& words, const Describe& describe_keys) {
  const std::string before = std::exchange(where_, words);
  describe_keys();
  where_ = before;
}

void KeyReference::map(const char* key, const About& about, const Describe& describe_map) {
  add(key, "map", "", "", about);
  const std::string before = from_elsewhere_;
  if (!about.default_words.empty()) from_elsewhere_ = about.default_words;
  below(key, describe_map);
  from_elsewhere_ = before;
}

void KeyReference::map_or_file(const char* key, const About& about, const Describe& describe_map) {
  add(key, "map or file", "", "", about.required());
  below(key, describe_map);
}

void KeyReference::each(const char* key, const About& about, const Describe& describe_item) {
  add(key, "list of maps", "", "", about);
  below(std::string(key) + "[]", describe_item);
}

bool KeyReference::toggle_map(const char* key, bool on, const About& about,
                              const Describe& describe_map) {
  add(key, "off, realistic or a map", "", on ? "realistic" : "off", about);
  below(key, describe_map);
  return on;
}

}  // namespace vigia

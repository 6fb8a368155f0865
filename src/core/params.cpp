#include "vigia/core/params.hpp"

#include "config_parser.hpp"

#include <algorithm>
#include <cmath>

#include "vigia/core/angle.hpp"

namespace vigia {
namespace {

/// Reads one key into its field, or writes the field's value into the tree as the default.
class FieldReader {
 public:
  FieldReader(MapReader& map, std::string key, bool required)
      : map_(map), key_(std::move(key)), required_(required) {}

  void operator()(const NumberField& f) const {
    const Range range = f.bounds.range();
    f.value = required_ ? map_.number(key_, range) : map_.number(key_, range, f.value);
  }
  void operator()(const AngleField& f) const {
    const Range range = f.degrees.range();
    f.radians = from_deg(required_ ? map_.number(key_, range)
                                   : map_.number(key_, range, to_deg(f.radians)));
  }
  void operator()(const IntegerField& f) const {
    const Range range = f.bounds.range();
    f.value = required_ ? map_.integer(key_, range) : map_.integer(key_, range, f.value);
  }
  void operator()(const BooleanField& f) const { f.value = map_.boolean(key_, f.value); }
  void operator()(const TextField& f) const {
    f.value = required_ ? map_.text(key_) : map_.text(key_, f.value);
  }
  void operator()(const FolderField& f) const { f.value = map_.folder_name(key_); }
  void operator()(const TextOrFileField& f) const {
    if (auto given = map_.text_or_file(key_)) {
      f.text = given->text;
      f.name = given->name;
    }
  }
  void operator()(const ChoiceField& f) const {
    f.index = required_ ? map_.choice(key_, f.names) : map_.choice(key_, f.names, f.index);
  }
  void operator()(VectorField& f) const {
    const Range range = f.bounds.range();
    if (f.values.size() == 2) {
      f.values = required_ ? map_.vector2(key_, range)
                           : map_.vector2(key_, range, Eigen::Vector2d(f.values));
    } else {
      f.values = required_ ? map_.vector3(key_, range)
                           : map_.vector3(key_, range, Eigen::Vector3d(f.values));
    }
  }
  void operator()(const PointsField& f) const {
    f.points = map_.points2(key_, f.bounds.range(), f.min_count);
  }
  void operator()(const TextsField& f) const { f.texts = map_.texts(key_); }
  void operator()(const NamesField& f) const { f.names = map_.names(key_, f.known, f.names); }

 private:
  MapReader& map_;
  std::string key_;
  bool required_;
};

}  // namespace

Bound bound_of(const std::string& key, double value, double margin) {
  if (margin == 0.0) return {key, value};
  const char* sign = margin < 0.0 ? " − " : " + ";
  return {key + sign + write_number(std::abs(margin)), value + margin};
}

About About::required() const {
  About about = *this;
  about.must_be_given = true;
  return about;
}

About About::otherwise(std::string words) const {
  About about = *this;
  about.default_words = std::move(words);
  return about;
}

About About::in(std::string words) const {
  About about = *this;
  about.unit = std::move(words);
  return about;
}

void ParamVisitor::name(const char* key, std::string& value, const std::vector<std::string>& names,
                        const About& about) {
  auto index =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), value) - names.begin());
  field(key, ChoiceField{index, names}, about);
  value = names.at(index);
}

bool ParamReader::given(const char* key, const Describe& describe_keys) {
  if (absent_ != nullptr) note_absent(key);
  if (absent_ != nullptr || !here().has(key)) return false;
  describe_keys();
  return true;
}

// Where it does not hold, the keys are visited to be noted, and the fields stay as they are: what
// else a description does to its struct must hang on the condition as well.
void ParamReader::where(bool holds, const std::string& words, const Describe& describe_keys) {
  const std::string* const before = absent_;
  if (!holds && before == nullptr) absent_ = &words;
  describe_keys();
  absent_ = before;
}

void ParamReader::field(const char* key, const Field& field, const About& about) {
  if (absent_ != nullptr) {
    note_absent(key);
    return;
  }
  Field copy = field;
  std::visit(FieldReader(here(), key, about.must_be_given), copy);
}

void ParamReader::below(MapReader map, const Describe& describe_map) {
  maps_.push_back(&map);
  describe_map();
  map.finish();
  maps_.pop_back();
}

void ParamReader::map(const char* key, const About&, const Describe& describe_map) {
  if (absent_ != nullptr) return note_absent(key);
  below(here().map(key), describe_map);
}

void ParamReader::map_or_file(const char* key, const About&, const Describe& describe_map) {
  if (absent_ != nullptr) return note_absent(key);
  below(here().map_or_file(key), describe_map);
}

void ParamReader::each(const char* key, const About&, const Describe& describe_item) {
  if (absent_ != nullptr) return note_absent(key);
  for (MapReader& item : here().maps(key)) below(std::move(item), describe_item);
}

bool ParamReader::toggle_map(const char* key, bool on, const About&, const Describe& describe_map) {
  if (absent_ != nullptr) note_absent(key);
  if (absent_ != nullptr) return on;
  if (!here().holds_map(key)) return here().choice(key, {"off", "realistic"}, on ? 1 : 0) == 1;
  below(here().map(key), describe_map);
  return true;
}

void ParamReader::require(bool holds, const char* key, const std::string& message) {
  if (!holds && absent_ == nullptr) throw here().error(key, message);
}

double written_degrees(double radians) {
  constexpr double kDigits = 1e9;  // of what a person writes
  const double degrees = to_deg(radians);
  const double rounded = std::round(degrees * kDigits) / kDigits;
  return from_deg(rounded) == radians ? rounded : degrees;
}

}  // namespace vigia

#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "vigia/core/config.hpp"

namespace vigia {

/// A bound of a number: a figure, or one that hangs on another key of the same map.
struct Bound {
  Bound(double figure) : value(figure) {}  // NOLINT(google-explicit-constructor): {0.0, 1.0}
  Bound(std::string words, double figure) : value(figure), text(std::move(words)) {}
  double value;
  std::string text;  ///< as the reference writes it; empty: the figure
};

/// The bound that the value of @p key sets, @p margin above it.
Bound bound_of(const std::string& key, double value, double margin = 0.0);

/// Both inclusive.
struct Bounds {
  Bound low;
  Bound high;
  Range range() const { return {low.value, high.value}; }
};

/// What the reference says of a key beside its range and default.
struct About {
  About(const char* what) : meaning(what) {}  // NOLINT(google-explicit-constructor): "…"
  /// The key must be given.
  About required() const;
  /// Where the default comes from, when it is none that the struct has.
  About otherwise(std::string words) const;
  /// The unit, where the key's ending does not say it.
  About in(std::string words) const;

  std::string meaning;
  bool must_be_given = false;
  std::string default_words;
  std::string unit;
};

// What a key may hold, and the field that holds it in the program.
struct NumberField {
  double& value;
  const Bounds& bounds;
};
/// Degrees in the file, radians in the field.
struct AngleField {
  double& radians;
  const Bounds& degrees;
};
struct IntegerField {
  std::int64_t& value;
  const Bounds& bounds;
};
struct BooleanField {
  bool& value;
};
struct TextField {
  std::string& value;
};
/// A text of which a folder's name is made.
struct FolderField {
  std::string& value;
};
/// A text of several lines, or the name of the file that holds it; `default` leaves both fields as
/// they are. The name stands for the text in messages.
struct TextOrFileField {
  std::string& text;
  std::string& name;
};
/// One of some names, by its index.
struct ChoiceField {
  std::size_t& index;
  const std::vector<std::string>& names;
};
/// A list of numbers of fixed length.
struct VectorField {
  Eigen::Ref<Eigen::VectorXd> values;
  const Bounds& bounds;
};
/// A list of at least so many points.
struct PointsField {
  std::vector<Eigen::Vector2d>& points;
  const Bounds& bounds;
  std::size_t min_count;
};
struct TextsField {
  std::vector<std::string>& texts;
};
/// A list of some of the known names, at least one and each once.
struct NamesField {
  std::vector<std::string>& names;
  const std::vector<std::string>& known;
};
using Field =
    std::variant<NumberField, AngleField, IntegerField, BooleanField, TextField, FolderField,
                 TextOrFileField, ChoiceField, VectorField, PointsField, TextsField, NamesField>;

/// Visits the keys of a map in a file and the fields of the struct that takes them. A struct of
/// parameters is described once, by a function beside it,
///
///     void describe(ParamVisitor& v, Params& p);
///
/// which gives each field's key, range and meaning; the value that a field has is the default.
/// From the description come the strict reading and the resolved dump (read_params) and the
/// reference (KeyReference).
class ParamVisitor {
 public:
  using Describe = std::function<void()>;

  ParamVisitor() = default;
  ParamVisitor(const ParamVisitor&) = delete;
  ParamVisitor& operator=(const ParamVisitor&) = delete;
  virtual ~ParamVisitor() = default;

  void number(const char* key, double& value, const Bounds& bounds, const About& about) {
    field(key, NumberField{value, bounds}, about);
  }
  void angle(const char* key, double& radians, const Bounds& degrees, const About& about) {
    field(key, AngleField{radians, degrees}, about);
  }
  template <typename Integer>
  void integer(const char* key, Integer& value, const Bounds& bounds, const About& about) {
    auto whole = static_cast<std::int64_t>(value);
    field(key, IntegerField{whole, bounds}, about);
    value = static_cast<Integer>(whole);
  }
  void boolean(const char* key, bool& value, const About& about) {
    field(key, BooleanField{value}, about);
  }
  void text(const char* key, std::string& value, const About& about) {
    field(key, TextField{value}, about);
  }
  void folder_name(const char* key, std::string& value, const About& about) {
    field(key, FolderField{value}, about);
  }
  void text_or_file(const char* key, std::string& value, std::string& name, const About& about) {
    field(key, TextOrFileField{value, name}, about);
  }
  /// An enumeration whose values count from 0, as @p names do.
  template <typename Enum>
  void choice(const char* key, Enum& value, const std::vector<std::string>& names,
              const About& about) {
    auto index = static_cast<std::size_t>(value);
    field(key, ChoiceField{index, names}, about);
    value = static_cast<Enum>(index);
  }
  /// One of @p names; the field holds one of them before, unless the key is required.
  void name(const char* key, std::string& value, const std::vector<std::string>& names,
            const About& about);
  template <int N>
  void vector(const char* key, Eigen::Matrix<double, N, 1>& value, const Bounds& bounds,
              const About& about) {
    field(key, VectorField{value, bounds}, about);
  }
  void points(const char* key, std::vector<Eigen::Vector2d>& value, const Bounds& bounds,
              std::size_t min_count, const About& about) {
    field(key, PointsField{value, bounds, min_count}, about);
  }
  void texts(const char* key, std::vector<std::string>& value, const About& about) {
    field(key, TextsField{value}, about);
  }
  void names(const char* key, std::vector<std::string>& value,
             const std::vector<std::string>& known, const About& about) {
    field(key, NamesField{value, known}, about);
  }

  /// Keys that stand in the map only when they are given: @p describe_keys is called then, and
  /// visits @p key among others. Says whether it was.
  virtual bool given(const char* key, const Describe& describe_keys) = 0;
  /// Keys that a map has only where @p holds, which @p words put into a sentence.
  virtual void where(bool holds, const std::string& words, const Describe& describe_keys) = 0;

  /// A map below this one.
  template <typename Params>
  void map(const char* key, Params& params, const About& about) {
    map(key, about, [&] { describe(*this, params); });
  }
  /// A map below this one that is no struct of its own.
  virtual void map(const char* key, const About& about, const Describe& describe_map) = 0;
  /// A required map, or the name of a file that holds it.
  virtual void map_or_file(const char* key, const About& about, const Describe& describe_map) = 0;
  /// A list of maps; @p describe_item is called for each. Left out, it is empty.
  virtual void each(const char* key, const About& about, const Describe& describe_item) = 0;
  /// `off`, `realistic` (the values that Params has) or a map; @p on: `realistic` when left out.
  template <typename Params>
  void toggle(const char* key, std::optional<Params>& params, bool on, const About& about) {
    Params inner{};
    const bool is_on = toggle_map(key, on, about, [&] { describe(*this, inner); });
    if (is_on)
      params = inner;
    else
      params.reset();
  }

  /// Rejects the value of @p key with @p message unless @p holds.
  virtual void require(bool holds, const char* key, const std::string& message) = 0;
  /// The map that is read, for checks that want places in the file; null when none is.
  virtual MapReader* reader() const = 0;

 protected:
  virtual void field(const char* key, const Field& field, const About& about) = 0;
  /// Whether it is on.
  virtual bool toggle_map(const char* key, bool on, const About& about,
                          const Describe& describe_map) = 0;
};

/// Reads the keys of a map strictly (see MapReader) into the fields that are visited. The reader
/// that it is given stays the caller's to finish.
class ParamReader : public ParamVisitor {
 public:
  explicit ParamReader(MapReader& reader) : maps_{&reader} {}

  bool given(const char* key, const Describe& describe_keys) override;
  void where(bool holds, const std::string& words, const Describe& describe_keys) override;
  void map(const char* key, const About& about, const Describe& describe_map) override;
  void map_or_file(const char* key, const About& about, const Describe& describe_map) override;
  void each(const char* key, const About& about, const Describe& describe_item) override;
  void require(bool holds, const char* key, const std::string& message) override;
  MapReader* reader() const override { return absent_ == nullptr ? maps_.back() : nullptr; }

 protected:
  void field(const char* key, const Field& field, const About& about) override;
  bool toggle_map(const char* key, bool on, const About& about,
                  const Describe& describe_map) override;

 private:
  MapReader& here() { return *maps_.back(); }
  void below(MapReader map, const Describe& describe_map);
  /// Notes a key of where() that does not hold.
  void note_absent(const char* key) { here().only_where(key, *absent_); }

  const std::string* absent_ = nullptr;  ///< what does not hold where keys are only noted
  std::vector<MapReader*> maps_;         ///< from the top down to the one that is read
};

/// Reads all keys of a map into @p params. Throws InputError.
template <typename Params>
void read_params(MapReader reader, Params& params) {
  ParamReader visitor(reader);
  describe(visitor, params);
  reader.finish();
}

/// Degrees as somebody would have written the angle: the shortest figure that gives it.
double written_degrees(double radians);

}  // namespace vigia

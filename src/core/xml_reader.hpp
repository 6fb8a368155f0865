#pragma once

#include <string>
#include <vector>

#include "vigia/core/error.hpp"

namespace vigia {

/// An element of an XML text: its children and, where it has none, its text.
struct XmlElement {
  std::string name;
  std::string text;
  std::vector<XmlElement> children;
  SourceLocation where;

  /// The only child of that name; nullptr without one. Throws InputError for two.
  const XmlElement* find(const std::string& child) const;
};

/// Reads the elements and texts of an XML document; attributes are passed over. Strict: no document
/// type, no entities but the five of XML, a bounded depth and size. Throws InputError.
XmlElement parse_xml(const std::string& text, const std::string& name);

}  // namespace vigia

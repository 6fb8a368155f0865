#include "xml_reader.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

namespace vigia {
namespace {

constexpr std::size_t kMostXmlBytes = std::size_t{1} << 20U;
constexpr int kDeepestXml = 32;

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.' ||
         c == ':';
}

std::string trimmed(const std::string& text) {
  const auto blank = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto first = std::find_if_not(text.begin(), text.end(), blank);
  const auto last = std::find_if_not(text.rbegin(), std::make_reverse_iterator(first), blank);
  return {first, last.base()};
}

class XmlParser {
 public:
  XmlParser(const std::string& text, const std::string& name) : text_(text), name_(name) {}

  XmlElement document() {
    skip_between();
    if (!next_is("<")) throw error("found no element, where an XML text begins with one");
    XmlElement root = element(0);
    skip_between();
    if (at_ < text_.size()) throw error("found more after the end of the one outer element");
    return root;
  }

 private:
  SourceLocation here() const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(at_);
    const auto line_start = std::find(std::make_reverse_iterator(end), text_.rend(), '\n').base();
    return {name_, 1 + static_cast<int>(std::count(text_.begin(), end, '\n')),
            1 + static_cast<int>(end - line_start)};
  }
  InputError error(const std::string& what) const { return {here(), what}; }
  bool next_is(std::string_view start) const {
    return text_.compare(at_, start.size(), start) == 0;
  }

  void skip_blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }

  void skip_past(std::string_view end, const char* what) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string::npos) throw error(std::string("this ") + what + " has no end");
    at_ = found + end.size();
  }

  // Comments, declarations and blanks.
  void skip_between() {
    for (;;) {
      skip_blanks();
      if (next_is("<!--"))
        skip_past("-->", "comment");
      else if (next_is("<?"))
        skip_past("?>", "declaration");
      else if (next_is("<!"))
        throw error("found a document type or a CDATA section, which are not read here");
      else
        return;
    }
  }

  std::string read_name() {
    const std::size_t start = at_;
    while (at_ < text_.size() && is_name_character(text_[at_])) ++at_;
    if (at_ == start) throw error("found no name of an element after '<'");
    return text_.substr(start, at_ - start);
  }

  // True when the tag closes itself.
  enum class TagEnd { open, closed };
  TagEnd skip_attributes() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '>') {
        ++at_;
        return TagEnd::open;
      }
      if (next_is("/>")) {
        at_ += 2;
        return TagEnd::closed;
      }
      if (c == '<') break;
      ++at_;
      if (c == '"' || c == '\'') skip_past(std::string_view(&c, 1), "attribute");
    }
    throw error("this tag has no end '>'");
  }

  char entity() {
    constexpr std::pair<std::string_view, char> kEntities[] = {
        {"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}};
    for (const auto& [written, meant] : kEntities)
      if (next_is(written)) {
        at_ += written.size();
        return meant;
      }
    throw error("found '&', where &lt; &gt; &amp; &quot; or &apos; would be right");
  }

  XmlElement element(int depth) {
    if (depth > kDeepestXml) throw error("elements within elements, more than 32 deep");
    XmlElement out;
    out.where = here();
    ++at_;
    out.name = read_name();
    if (skip_attributes() == TagEnd::closed) return out;
    for (;;) {
      if (at_ >= text_.size())
        throw InputError(out.where, "the element <" + out.name + "> has no end");
      if (next_is("</")) break;
      if (next_is("<!") || next_is("<?"))
        skip_between();
      else if (next_is("<"))
        out.children.push_back(element(depth + 1));
      else
        out.text += text_[at_] == '&' ? entity() : text_[at_++];
    }
    const SourceLocation end_tag = here();
    at_ += 2;
    const std::string end = read_name();
    if (end != out.name)
      throw InputError(end_tag, "found </" + end + ">, where </" + out.name + "> would be right");
    skip_blanks();
    if (!next_is(">")) throw error("this tag has no end '>'");
    ++at_;
    out.text = trimmed(out.text);
    return out;
  }

  const std::string& text_;
  std::string name_;
  std::size_t at_ = 0;
};

}  // namespace

const XmlElement* XmlElement::find(const std::string& child) const {
  const XmlElement* found = nullptr;
  for (const XmlElement& element : children) {
    if (element.name != child) continue;
    if (found != nullptr)
      throw InputError(element.where, "a second <" + child + "> within <" + name + ">");
    found = &element;
  }
  return found;
}

XmlElement parse_xml(const std::string& text, const std::string& name) {
  if (text.size() > kMostXmlBytes) throw InputError({name}, "an XML text of more than 1 MB");
  return XmlParser(text, name).document();
}

}  // namespace vigia

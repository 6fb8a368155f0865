#include "config_parser.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

namespace vigia {
namespace {

constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxNodes = 200'000;
constexpr std::size_t kMaxKeyBytes = 128;
constexpr std::uintmax_t kMaxFileBytes = 16 * 1024 * 1024;

using NodePtr = std::shared_ptr<ConfigNode>;

/// Bytes of the UTF-8 sequence that begins at @p i, or 0 where none does.
std::size_t utf8_length(const std::string& text, std::size_t i) {
  const auto byte = [&text](std::size_t at) {
    return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
  };
  const auto lead = byte(i);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead <= 0xDF   ? 2
                             : lead >= 0xE0 && lead <= 0xEF ? 3
                             : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                            : 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xC0U) != 0x80) return 0;
  }
  const auto second = byte(i + 1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second >= 0xA0;
  const bool beyond = lead == 0xF4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

/// yaml-cpp takes some control bytes for the end of the text and passes broken UTF-8 on.
void require_clean_text(const std::string& text, SourceLocation where, bool where_is_fixed) {
  if (!where_is_fixed) where.line = where.column = 1;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) throw InputError(where, "the text is not valid UTF-8");
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F)
      throw InputError(
          where, "a control character (code " + std::to_string(c) + ") does not belong into YAML");
    if (!where_is_fixed) {
      where.line += c == '\n' ? 1 : 0;
      where.column = c == '\n' ? 1 : where.column + static_cast<int>(length);
    }
    i += length;
  }
}

/// Whether the scalar that begins at @p begin, perhaps after its anchor and tag, opens a quote that
/// the text never closes: yaml-cpp takes the end of the text for the quote's end.
bool leaves_quote_open(const std::string& text, std::size_t begin) {
  std::size_t i = begin;
  while (i < text.size() && (text[i] == '&' || text[i] == '!')) {
    i = text.find_first_of(" \t\r\n", i);
    i = text.find_first_not_of(" \t\r\n", i);
  }
  if (i >= text.size() || (text[i] != '"' && text[i] != '\'')) return false;
  const char quote = text[i];
  for (++i; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      if (quote == '"' || i + 1 == text.size() || text[i + 1] != quote) return false;
      ++i;
    }
  }
  return true;
}

/// Builds the tree from yaml-cpp's events: they carry the mark of every key and alias, which
/// yaml-cpp's own node tree forgets.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& text, SourceLocation where, bool where_is_fixed)
      : text_(text), where_(std::move(where)), where_is_fixed_(where_is_fixed) {}

  NodePtr root() const { return root_; }
  SourceLocation locate(const YAML::Mark& mark) const {
    if (where_is_fixed_ || mark.is_null()) return where_;
    return {where_.file, mark.line + 1, mark.column + 1};
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (root_) throw InputError(locate(mark), "a second document begins here; one is read");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(make(ConfigNode::Kind::null, mark), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto target = anchors_.find(anchor);
    if (target == anchors_.end())
      throw InputError(locate(mark), "the alias refers to the anchor that it lies in: a loop");
    NodePtr copy = copy_tree(*target->second, mark);
    copy->where = locate(mark);
    add(copy, YAML::NullAnchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    if (tag != "?" && tag != "!" && tag != "tag:yaml.org,2002:str") reject_tag(mark, tag);
    if (tag != "?" && leaves_quote_open(text_, static_cast<std::size_t>(mark.pos)))
      throw InputError(locate(mark), "the quote that opens here is never closed");
    NodePtr node = make(ConfigNode::Kind::scalar, mark);
    node->scalar = value;
    node->quoted = tag != "?" || value.find('\n') != std::string::npos;
    add(node, anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open(ConfigNode::Kind::list, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(ConfigNode::Kind::map, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    NodePtr node;
    YAML::anchor_t anchor;
    std::optional<std::string> key;  // read, its value still to come
    SourceLocation key_where;
  };

  [[noreturn]] void reject_tag(const YAML::Mark& mark, const std::string& tag) const {
    throw InputError(locate(mark), "the tag " + quoted_for_message(tag) + " is not understood");
  }

  NodePtr make(ConfigNode::Kind kind, const YAML::Mark& mark) {
    if (++nodes_ > kMaxNodes)
      throw InputError(locate(mark), "more than " + std::to_string(kMaxNodes) +
                                         " values (aliases count each time)");
    auto node = std::make_shared<ConfigNode>();
    node->kind = kind;
    node->where = locate(mark);
    return node;
  }

  NodePtr copy_tree(const ConfigNode& source, const YAML::Mark& mark) {
    NodePtr copy = make(source.kind, mark);
    *copy = source;
    for (NodePtr& item : copy->items) item = copy_tree(*item, mark);
    for (auto& [key, value] : copy->entries) value = copy_tree(*value, mark);
    return copy;
  }

  void open(ConfigNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
            YAML::anchor_t anchor) {
    if (tag != "?" && !tag.empty()) reject_tag(mark, tag);
    if (open_.size() >= kMaxDepth)
      throw InputError(locate(mark), "nested deeper than " + std::to_string(kMaxDepth) + " levels");
    if (expects_key()) reject_key(locate(mark));
    open_.push_back({make(kind, mark), anchor, std::nullopt, {}});
  }

  void close() {
    const Open done = std::move(open_.back());
    open_.pop_back();
    add(done.node, done.anchor);
  }

  bool expects_key() const {
    return !open_.empty() && open_.back().node->kind == ConfigNode::Kind::map && !open_.back().key;
  }

  [[noreturn]] static void reject_key(const SourceLocation& where) {
    throw InputError(where, "a key must be a short text (or a bracket is left open)");
  }

  void add(const NodePtr& node, YAML::anchor_t anchor) {
    if (anchor != YAML::NullAnchor) anchors_[anchor] = node;
    if (open_.empty()) {
      root_ = node;
      return;
    }
    Open& top = open_.back();
    if (top.node->kind == ConfigNode::Kind::list) {
      top.node->items.push_back(node);
    } else if (!top.key) {
      add_key(top, *node);
    } else {
      node->key_where = top.key_where;
      top.node->entries.emplace_back(*top.key, node);
      top.key.reset();
    }
  }

  static void add_key(Open& top, const ConfigNode& node) {
    if (node.kind != ConfigNode::Kind::scalar || node.scalar.size() > kMaxKeyBytes)
      reject_key(node.where);
    if (const ConfigNode* earlier = top.node->find(node.scalar))
      throw InputError(node.where, "the key " + quoted_for_message(node.scalar) +
                                       " occurs twice; it was given before at " +
                                       to_string(earlier->key_where));
    top.key = node.scalar;
    top.key_where = node.where;
  }

  const std::string& text_;
  SourceLocation where_;
  bool where_is_fixed_;
  NodePtr root_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, NodePtr> anchors_;
  std::size_t nodes_ = 0;
};

}  // namespace

NodePtr parse_yaml(const std::string& bytes, const SourceLocation& where, bool where_is_fixed) {
  require_clean_text(bytes, where, where_is_fixed);
  const std::string mark = "\xEF\xBB\xBF";  // some editors begin a file with a byte-order mark
  const std::string text = bytes.substr(bytes.compare(0, mark.size(), mark) == 0 ? mark.size() : 0);
  TreeBuilder builder(text, where, where_is_fixed);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) continue;
  } catch (const YAML::Exception& failure) {
    throw InputError(builder.locate(failure.mark), "this is not YAML: " + failure.msg);
  }
  return builder.root() ? builder.root() : std::make_shared<ConfigNode>();
}

std::string read_config_text(const std::filesystem::path& file, const SourceLocation& wanted_at) {
  const auto fail = [&](const std::string& why) {
    const bool elsewhere = !wanted_at.file.empty();
    const std::string name = "the file '" + file.string() + "' ";
    throw InputError(elsewhere ? wanted_at : SourceLocation{file.string(), 0, 0},
                     (elsewhere ? name : "the file ") + why);
  };
  std::error_code code;
  const auto status = std::filesystem::status(file, code);
  if (!std::filesystem::exists(status)) fail("does not exist");
  if (std::filesystem::is_directory(status)) fail("is a directory");
  if (!std::filesystem::is_regular_file(status)) fail("is not a regular file");
  if (std::filesystem::file_size(file, code) > kMaxFileBytes || code) fail("is larger than 16 MB");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  if (!stream || !(content << stream.rdbuf() || stream.peek() == std::ifstream::traits_type::eof()))
    fail("cannot be read");
  return content.str();
}

bool is_plain_text(const std::string& text) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '/';
  };
  if (text.empty() || !plain(text.front())) return false;
  if (text == "null" || text == "Null" || text == "NULL") return false;
  return std::all_of(text.begin(), text.end(),
                     [&plain](char c) { return plain(c) || c == '-' || c == '+'; });
}

std::string quoted_for_message(const std::string& value) {
  constexpr std::size_t kShown = 60;
  std::string shown;
  std::size_t i = 0;
  while (i < value.size() && shown.size() < kShown) {
    const std::size_t length = std::max<std::size_t>(1, utf8_length(value, i));
    const bool control = static_cast<unsigned char>(value[i]) < 0x20;
    shown += control ? std::string(1, ' ') : value.substr(i, length);
    i += length;
  }
  return "'" + shown + (i < value.size() ? "…'" : "'");
}

}  // namespace vigia

#include "config_parser.hpp"

#include <algorithm>
#include <cstdio>

#include "vigia/core/config.hpp"

namespace vigia {
namespace {

std::string quote(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (code < 0x20 || code == 0x7F) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02X", static_cast<unsigned>(code));
      quoted += escape;
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

bool is_plain_scalar(const ConfigNode& node, const std::string& text) {
  return node.kind == ConfigNode::Kind::scalar && !node.quoted && node.scalar == text;
}

// A plain scalar of one place may be something else in another: '-' in a flow list is an empty
// list below a dash.
bool reads_back_plain(const std::string& text) {
  if (is_plain_text(text)) return true;
  try {
    const auto root = parse_config("version: 1\nlist:\n  - " + text + "\nkey: " + text + "\n", "");
    const ConfigNode& list = *root->find("list");
    return root->entries.size() == 2 && list.items.size() == 1 &&
           is_plain_scalar(*list.items.front(), text) && is_plain_scalar(*root->find("key"), text);
  } catch (const InputError&) {
    return false;
  }
}

std::string write_scalar(const ConfigNode& node) {
  return node.quoted || !reads_back_plain(node.scalar) ? quote(node.scalar) : node.scalar;
}

std::string write_key(const std::string& key) {
  return is_plain_text(key) ? key : quote(key);
}

bool fits_flow(const ConfigNode& node) {
  switch (node.kind) {
    case ConfigNode::Kind::null:
      return true;
    case ConfigNode::Kind::scalar: {
      const std::string written = write_scalar(node);
      return written.front() == '"' || std::all_of(written.begin(), written.end(), [](char c) {
               return is_plain_text(std::string("x") + c);
             });
    }
    case ConfigNode::Kind::list:
      return std::all_of(node.items.begin(), node.items.end(), [](const auto& item) {
        return item->kind != ConfigNode::Kind::map && fits_flow(*item);
      });
    case ConfigNode::Kind::map:
      return std::all_of(node.entries.begin(), node.entries.end(),
                         [](const auto& entry) { return entry.second->absent(); });
  }
  return false;
}

std::string write_flow(const ConfigNode& node) {
  switch (node.kind) {
    case ConfigNode::Kind::null:
      return "null";
    case ConfigNode::Kind::scalar:
      return write_scalar(node);
    case ConfigNode::Kind::map:
      return "{}";
    case ConfigNode::Kind::list:
      break;
  }
  std::string text = "[";
  for (const auto& item : node.items) {
    if (text.size() > 1) text += ", ";
    text += write_flow(*item);
  }
  return text + "]";
}

/// Appends a value in block style below its key or dash: " value\n" or "\n" and indented lines.
void write_below(std::string& out, const ConfigNode& node, std::size_t indent);
/// Appends an item of a list in block style.
void write_item(std::string& out, const ConfigNode& item, std::size_t indent);

void write_entries(std::string& out, const ConfigNode& map, std::size_t indent) {
  for (const auto& [key, value] : map.entries) {
    if (value->absent()) continue;
    out += std::string(indent, ' ') + write_key(key) + ":";
    write_below(out, *value, indent + 2);
  }
}

void write_below(std::string& out, const ConfigNode& node, std::size_t indent) {
  if (node.kind == ConfigNode::Kind::scalar) {
    out += " " + write_scalar(node) + "\n";
  } else if (fits_flow(node)) {
    out += " " + write_flow(node) + "\n";
  } else if (node.kind == ConfigNode::Kind::map) {
    out += "\n";
    write_entries(out, node, indent);
  } else {
    out += "\n";
    for (const auto& item : node.items) write_item(out, *item, indent);
  }
}

void write_item(std::string& out, const ConfigNode& item, std::size_t indent) {
  const std::size_t begin = out.size();
  if (item.kind == ConfigNode::Kind::map && !fits_flow(item)) {
    write_entries(out, item, indent + 2);
    out[begin + indent] = '-';  // the first entry stands on the line of the dash
  } else {
    out += std::string(indent, ' ') + "-";
    write_below(out, item, indent + 2);
  }
}

}  // namespace

std::string dump_config(const ConfigNode& root) {
  std::string out = "version: 1\n";
  write_entries(out, root, 0);
  return out;
}

}  // namespace vigia

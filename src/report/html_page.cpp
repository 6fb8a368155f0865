#include "html_page.hpp"

#include "page_assets.hpp"

namespace vigia::report {
namespace {

// No network, no other file: a page that is mailed reads nothing but itself.
constexpr std::string_view kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
)";

/// As text of an HTML element.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

/// JSON without '<', which only its strings hold: nothing in it ends the script that it stands in.
std::string without_brackets(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

void append(std::string& page, std::string_view before, std::string_view text,
            std::string_view after) {
  page += before;
  page += text;
  page += after;
}

}  // namespace

std::string html_page(const HtmlPage& page) {
  std::string text(kHead);
  append(text, "<title>", escaped(page.title), "</title>\n");
  append(text, "<style>", assets::kCommonCss, "</style>\n");
  for (const auto style : page.styles) append(text, "<style>", style, "</style>\n");
  append(text, "</head>\n<body>\n", page.body, "");
  append(text, "<script type=\"application/json\" id=\"data\">", without_brackets(page.data_json),
         "</script>\n");
  append(text, "<script>", assets::kCommonJs, "</script>\n");
  for (const auto script : page.scripts) append(text, "<script>", script, "</script>\n");
  text += "</body>\n</html>\n";
  return text;
}

}  // namespace vigia::report

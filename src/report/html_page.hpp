#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vigia::report {

/// What a page is made of.
struct HtmlPage {
  std::string title;
  std::vector<std::string_view> styles;  ///< beside those that every page has
  std::string_view body;
  std::string data_json;                  ///< that the scripts find as `vigia.data`
  std::vector<std::string_view> scripts;  ///< after the one that every page has
};

/// One self-contained HTML file without any reference to another, which a content security policy
/// forbids the network. Title and data are shown as text, whatever they hold.
std::string html_page(const HtmlPage& page);

}  // namespace vigia::report

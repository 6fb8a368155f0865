#pragma once

#include <string_view>

namespace vigia::report::assets {

// The files of page/, put into the program by page/embed.cmake.
extern const std::string_view kPageHtml;
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;
extern const std::string_view kPlotCss;  ///< of uPlot, MIT licence: page/third_party
extern const std::string_view kPlotJs;

}  // namespace vigia::report::assets

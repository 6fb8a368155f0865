#pragma once

#include <string_view>

namespace vigia::report::assets {

// The files of page/, put into the program by page/embed.cmake.
extern const std::string_view kCommonCss;
extern const std::string_view kCommonJs;
extern const std::string_view kReplayHtml;
extern const std::string_view kReplayCss;
extern const std::string_view kReplayJs;
extern const std::string_view kCampaignHtml;
extern const std::string_view kCampaignCss;
extern const std::string_view kCampaignJs;
extern const std::string_view kPlotCss;  ///< of uPlot, MIT licence: page/third_party
extern const std::string_view kPlotJs;

}  // namespace vigia::report::assets

#include "vigia/report/campaign_page.hpp"

#include "html_page.hpp"
#include "page_assets.hpp"

namespace vigia::report {

std::string campaign_page(const std::string& title, const std::string& data_json) {
  return html_page(
      {title, {assets::kCampaignCss}, assets::kCampaignHtml, data_json, {assets::kCampaignJs}});
}

}  // namespace vigia::report

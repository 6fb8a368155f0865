#include "vigia/evaluation/provenance.hpp"

#include "checked_line.hpp"
#include "provenance_json.hpp"

#include <fmt/format.h>

#include "vigia/evaluation/descriptor.hpp"

namespace vigia::evaluation {

Provenance provenance_of(const Campaign& campaign) {
  return {campaign.name, VIGIA_VERSION, build_fingerprint(), configuration_of(campaign),
          campaign.command};
}

std::string configuration_of(const Campaign& campaign) {
  std::string text = fmt::format("{} seeds {}+{} baseline {}\n", campaign.name, campaign.first_seed,
                                 campaign.seeds, campaign.baseline);
  for (const Arm& arm : campaign.arms)
    text += fmt::format("{} {}\n", arm.name, fingerprint(arm.setup.resolved_yaml));
  return fingerprint(text);
}

std::string build_fingerprint() {
  static const std::string build = fingerprint(read_bytes("/proc/self/exe"));
  return build;
}

Json provenance_json(const Provenance& provenance) {
  return {{"campaign", provenance.campaign},
          {"version", provenance.version},
          {"build", provenance.build},
          {"configuration", provenance.configuration},
          {"command", provenance.command}};
}

Provenance provenance_from(const Json& json) {
  return {json.value("campaign", ""), json.value("version", ""), json.value("build", ""),
          json.value("configuration", ""), json.value("command", "")};
}

std::string difference(const Provenance& plan, const Provenance& other, bool any_version) {
  const auto differs = [](const char* what, const std::string& planned, const std::string& found) {
    return planned == found ? ""
                            : fmt::format("its {} is {}, the plan's is {}", what,
                                          found.empty() ? "unknown" : found, planned);
  };
  std::string text = differs("campaign", plan.campaign, other.campaign);
  if (text.empty()) text = differs("configuration", plan.configuration, other.configuration);
  if (text.empty() && !any_version) text = differs("version", plan.version, other.version);
  if (text.empty() && !any_version) text = differs("build", plan.build, other.build);
  return text;
}

std::string mission_file(std::size_t arm) {
  return fmt::format("missions/{:03}.yaml", arm);
}

}  // namespace vigia::evaluation

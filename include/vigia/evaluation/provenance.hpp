#pragma once

#include <cstddef>
#include <string>

#include "vigia/evaluation/campaign.hpp"

namespace vigia::evaluation {

/// Where results come from.
struct Provenance {
  std::string campaign;
  std::string version;        ///< of the program
  std::string build;          ///< fingerprint of the program's file
  std::string configuration;  ///< fingerprint of the campaign, see configuration_of()
  std::string command;        ///< that drives the whole campaign in one process
};

Provenance provenance_of(const Campaign& campaign);

/// Fingerprint of what decides a campaign's results beside the program: its arms with their
/// resolved missions, its seeds and its baseline.
std::string configuration_of(const Campaign& campaign);

/// What results of @p other differ in from those of @p plan, "" for nothing. @p any_version:
/// version and build may.
std::string difference(const Provenance& plan, const Provenance& other, bool any_version);

/// Tells the program from any other that was built from other sources.
std::string build_fingerprint();

/// Where a campaign's folder keeps the resolved mission of an arm.
std::string mission_file(std::size_t arm);

}  // namespace vigia::evaluation

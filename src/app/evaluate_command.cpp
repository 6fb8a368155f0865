#include "campaign_output.hpp"
#include "campaign_progress.hpp"
#include "commands.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vigia::app {
namespace {

struct EvaluateOptions {
  std::string campaign;
  std::vector<std::string> overrides;
  std::string out;
  CampaignOutput output;
  int threads = 0;
  bool restart = false;
  bool quiet = false;
};

int evaluate(const EvaluateOptions& options) {
  const auto campaign = evaluation::read_campaign(options.campaign, options.overrides);
  const std::string out = options.out.empty() ? "campaigns/" + campaign.name : options.out;
  evaluation::CampaignJournal journal(out, campaign, options.restart);
  const int threads = threads_of(options.threads);
  CampaignLine line(options.quiet);
  evaluation::run_campaign(campaign, journal, threads, std::ref(line));
  line.finish(threads);
  return write_campaign(journal.folder(), campaign, journal.finished(), options.output);
}

}  // namespace

void add_evaluate(CLI::App& app, int& status) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App* command = app.add_subcommand(
      "evaluate", "Drive a campaign's missions and print the statistics; resumes when repeated");
  command->add_option("campaign", options->campaign, "Campaign file (YAML)")->required();
  add_threads(*command, options->threads);
  command->add_option("--out", options->out, "Output folder (default campaigns/<campaign>)");
  command->add_option("--set", options->overrides, "Override a key of the mission in every arm")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  options->output.add_options(*command);
  command->add_flag("--restart", options->restart, "Forget the missions that the folder holds");
  command->add_flag("--quiet", options->quiet, "No progress line");
  command->callback([options, &status] { status = evaluate(*options); });
}

}  // namespace vigia::app

#include "commands.hpp"
#include "config_folder.hpp"
#include "papers.hpp"

#include <algorithm>
#include <memory>
#include <thread>

#include <fmt/format.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_folder.hpp"

namespace vigia::app {
namespace {

struct ReproduceOptions {
  std::string paper;
  std::string config;
  std::string out;
  int seeds = 0;
  int threads = 0;
  bool json = false;
  bool quiet = false;
};

const Paper& find_paper(const std::string& name) {
  const auto found = std::find_if(papers().begin(), papers().end(),
                                  [&](const Paper& paper) { return paper.name == name; });
  if (found != papers().end()) return *found;
  std::string names;
  for (const auto& paper : papers()) names += (names.empty() ? "" : ", ") + paper.name;
  throw InputError("found the paper \"" + name + "\", must be one of " + names);
}

int reproduce(const ReproduceOptions& options) {
  const Paper& paper = find_paper(options.paper);
  const std::string out = options.out.empty() ? "papers/" + paper.name : options.out;
  OutputFolder folder(out, "table.json");
  PaperOptions how;
  how.config = config_folder(options.config);
  how.out = folder.staging();
  how.seeds = options.seeds;
  how.threads = options.threads > 0
                    ? options.threads
                    : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  how.quiet = options.quiet || options.json;
  const evaluation::PaperTable table = paper.repeat(how);
  const std::string json = evaluation::paper_table_json(table);
  const std::string text = evaluation::paper_table_text(table);
  folder.add("table.json", json);
  folder.add("table.txt", text);
  folder.commit();
  fmt::print("{}", options.json ? json : text);
  if (!options.json) fmt::print("\nfolder: {}\n", out);
  return 0;
}

}  // namespace

void add_reproduce(CLI::App& app, int& status) {
  auto options = std::make_shared<ReproduceOptions>();
  CLI::App* command =
      app.add_subcommand("reproduce",
                         "Repeat a paper's experiment: published, as published, best, "
                         "limit");
  std::string names;
  for (const auto& paper : papers())
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", paper.name, paper.title);
  command->add_option("paper", options->paper, names)->required();
  command->add_option("--out", options->out, "Output folder (default papers/<paper>)");
  command->add_option("--seeds", options->seeds, "Drives or trials (default: the experiment's own)")
      ->check(CLI::Range(2, 1000000));
  command->add_option("-j,--threads", options->threads, "Threads (default: all cores)")
      ->check(CLI::Range(1, 1024));
  command->add_option("--config", options->config, "Folder with missions/, worlds/, robots/");
  command->add_flag("--json", options->json, "Print table.json on stdout");
  command->add_flag("--quiet", options->quiet, "No progress line");
  command->callback([options, &status] { status = reproduce(*options); });
}

}  // namespace vigia::app

#include "commands.hpp"
#include "usage_mistake.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <system_error>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "vigia/core/error.hpp"

namespace {

/// Exit statuses of the program (DESIGN: 0 done, 1 the mission or a check failed, 2 wrong input).
constexpr int kWrongInput = 2;
constexpr int kNotWritten = 2;
constexpr int kBroken = 3;

void log_to_stderr() {
  auto logger = spdlog::stderr_color_mt("vigia");
  logger->set_pattern("%^%l%$: %v");
  spdlog::set_default_logger(logger);
}

/// A file that grows beyond the limit of the process is an error of the write, as a full disk is,
/// and what was begun is removed.
void take_size_limits_for_errors() {
  std::signal(SIGXFSZ, SIG_IGN);
}

int run_program(int argc, char** argv) {
  log_to_stderr();
  cv::setNumThreads(1);
  CLI::App app{
      "vigia keeps a mobile robot localized by looking at the right landmark, at the right "
      "moment, at the right zoom."};
  app.set_version_flag("--version", VIGIA_VERSION);
  app.require_subcommand(1);
  int status = 0;
  vigia::app::add_run(app, status);
  vigia::app::add_plan(app, status);
  vigia::app::add_check(app, status);
  vigia::app::add_track(app, status);
  vigia::app::add_landmark(app, status);
  vigia::app::add_calibrate(app, status);
  vigia::app::add_evaluate(app, status);
  vigia::app::add_campaign(app, status);
  vigia::app::add_reproduce(app, status);
  vigia::app::add_report(app, status);
  vigia::app::add_export(app, status);
  vigia::app::add_help(app, status);
  try {
    app.parse(argc, argv);
    return status;
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    spdlog::error("{}; see vigia help", vigia::app::usage_mistake(app, error));
    return kWrongInput;
  } catch (const vigia::InputError& error) {
    spdlog::error("{}", error.what());
    return kWrongInput;
  } catch (const std::system_error& error) {
    spdlog::error("{}", error.what());  // as of an output that takes no more
    return kNotWritten;
  } catch (const std::exception& error) {
    spdlog::critical("unexpected: {}", error.what());
    return kBroken;
  }
}

/// What was printed has arrived. A full disk shows when the last of it is written.
bool output_is_written() {
  std::cout.flush();
  const bool streamed = std::cout.good();
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && streamed;
}

}  // namespace

int main(int argc, char** argv) {
  take_size_limits_for_errors();
  try {
    const int status = run_program(argc, argv);
    if (output_is_written()) return status;
    spdlog::error("standard output has not taken all that was printed; is its disk full?");
    return std::max(status, kNotWritten);
  } catch (...) {
    std::fputs("vigia: unexpected failure\n", stderr);
    return kBroken;
  }
}

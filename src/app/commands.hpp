#pragma once

#include <CLI/CLI.hpp>

namespace vigia::app {

// Each adds a command to the program; running it sets @p status, the exit status. Wrong input
// throws InputError.
void add_run(CLI::App& app, int& status);
void add_plan(CLI::App& app, int& status);
void add_check(CLI::App& app, int& status);
void add_track(CLI::App& app, int& status);
void add_landmark(CLI::App& app, int& status);
void add_calibrate(CLI::App& app, int& status);
/// The one for a camera that looks up, below `calibrate`.
void add_calibrate_ceiling(CLI::App& calibrate, int& status);
void add_campaign(CLI::App& app, int& status);
void add_evaluate(CLI::App& app, int& status);
void add_reproduce(CLI::App& app, int& status);
void add_report(CLI::App& app, int& status);
void add_export(CLI::App& app, int& status);
void add_help(CLI::App& app, int& status);

}  // namespace vigia::app

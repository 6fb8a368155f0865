#include "commands.hpp"
namespace vigia::app {
void add_track(CLI::App& /*app*/, int& /*status*/) {}
}  // namespace vigia::app

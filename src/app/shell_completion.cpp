#include "shell_completion.hpp"

#include "command_tree.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vigia::app {
namespace {

/// What may follow a command: the commands below it and its long options.
void add_case(const CLI::App& command, const std::string& path, std::string& script) {
  script += fmt::format("    '{}') commands='{}' options='{}' ;;\n", path,
                        fmt::join(names_of(commands_below(command)), " "),
                        fmt::join(long_options_of(command), " "));
  for (const CLI::App* below : commands_below(command))
    add_case(*below, path.empty() ? below->get_name() : path + " " + below->get_name(), script);
}

constexpr const char* kHead = R"(# bash completion for vigia; written by `vigia help completion`
_vigia_words() {
  case "$1" in
)";

constexpr const char* kTail = R"(    *) return 1 ;;
  esac
}

_vigia() {
  local word=${COMP_WORDS[COMP_CWORD]} path='' commands='' options='' i
  _vigia_words ''
  for ((i = 1; i < COMP_CWORD; i++)); do
    case " $commands " in
      *" ${COMP_WORDS[i]} "*)
        path="${path:+$path }${COMP_WORDS[i]}"
        _vigia_words "$path"
        ;;
    esac
  done
  COMPREPLY=()
  case $word in
    -*) mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word") ;;
    *) [ -n "$commands" ] && mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$word") ;;
  esac
}

complete -o default -F _vigia vigia
)";

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::string script = kHead;
  add_case(app, "", script);
  return script + kTail;
}

}  // namespace vigia::app

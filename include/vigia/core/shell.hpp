#pragma once

#include <string>
#include <string_view>

namespace vigia {

/// One word of a POSIX shell's command line: in single quotes where it needs them.
std::string shell_word(std::string_view text);

}  // namespace vigia

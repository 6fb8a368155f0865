#include "config_folder.hpp"

#include <string>
#include <vector>

#include "vigia/core/error.hpp"

namespace vigia::app {
namespace fs = std::filesystem;

fs::path config_folder(const fs::path& given) {
  std::vector<fs::path> candidates{given};
  if (given.empty()) {
    std::error_code unknown;
    const fs::path program = fs::read_symlink("/proc/self/exe", unknown).parent_path();
    // Installed: bin/ beside share/. Built: build/<preset>/bin/ in the source tree.
    candidates = {program / "../share/vigia/config", program / "../../../config", "config"};
  }
  std::string looked;
  for (const auto& candidate : candidates) {
    std::error_code error;
    if (fs::is_directory(candidate / "missions", error)) return candidate.lexically_normal();
    looked += (looked.empty() ? "" : ", ") + candidate.lexically_normal().string();
  }
  throw InputError("no folder with missions/ found; looked at " + looked +
                   "; name one with --config");
}

}  // namespace vigia::app

#include "media.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include <dlfcn.h>

#include "vigia/imaging/window_display.hpp"

namespace vigia::imaging {
namespace {

constexpr int kLoading = RTLD_LAZY | RTLD_LOCAL;

// Beside the program as it is built and installed; for other programs along their run path, which
// the sanitizers' dlopen does not know. The module stays for good.
const Media& load_media() {
  std::error_code unknown;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  const auto beside = program.parent_path().parent_path() / VIGIA_MODULE_DIR / VIGIA_MEDIA_MODULE;
  const bool is_beside = std::filesystem::exists(beside, unknown);
  void* const module = dlopen(is_beside ? beside.c_str() : VIGIA_MEDIA_MODULE, kLoading);
  void* const entry = module != nullptr ? dlsym(module, "vigia_media") : nullptr;
  if (entry == nullptr)
    throw std::runtime_error(std::string("the module for pictures, " VIGIA_MEDIA_MODULE
                                         ", cannot be loaded; it belongs into ../" VIGIA_MODULE_DIR
                                         "/ of the program's folder, or on its run path: ") +
                             dlerror());
  return *reinterpret_cast<decltype(&vigia_media)>(entry)();
}

}  // namespace

const Media& media() {
  static const Media& loaded = load_media();
  return loaded;
}

std::unique_ptr<VideoWriter> write_video(const std::filesystem::path& mp4, int width, int height,
                                         double pictures_hz) {
  return media().write_video(mp4, width, height, pictures_hz);
}

std::unique_ptr<vpDisplay> open_window(vpImage<vpRGBa>& picture, const std::string& title) {
  return media().open_window(picture, title);
}

}  // namespace vigia::imaging

#include "media.hpp"

#include <stdexcept>
#include <string>

#include <dlfcn.h>

#include "vigia/imaging/window_display.hpp"

namespace vigia::imaging {
namespace {

// The dynamic loader looks along the program's run path. The module stays for good.
const Media& load_media() {
  void* const module = dlopen(VIGIA_MEDIA_MODULE, RTLD_LAZY | RTLD_LOCAL);
  void* const entry = module != nullptr ? dlsym(module, "vigia_media") : nullptr;
  if (entry == nullptr)
    throw std::runtime_error(std::string("vigia's module for pictures cannot be loaded: ") +
                             dlerror());
  return *reinterpret_cast<decltype(&vigia_media)>(entry)();
}

}  // namespace

const Media& media() {
  static const Media& loaded = load_media();
  return loaded;
}

std::unique_ptr<vpDisplay> open_window(vpImage<vpRGBa>& picture, const std::string& title) {
  return media().open_window(picture, title);
}

}  // namespace vigia::imaging

// Any text is either a camera with finite numbers, or an InputError.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "vigia/core/camera_file.hpp"
#include "vigia/core/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const vigia::Intrinsics camera = vigia::parse_camera(text, "input");
    const double sum = camera.px + camera.py + camera.u0 + camera.v0 + camera.kdu;
    if (!std::isfinite(sum) || camera.width < 1 || camera.height < 1) std::abort();
  } catch (const vigia::InputError&) {
    return 0;
  }
  return 0;
}

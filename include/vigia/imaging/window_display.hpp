#pragma once

#include <memory>
#include <string>

#include <visp3/core/vpDisplay.h>

namespace vigia::imaging {

/// An X window that shows @p picture, which must outlive it.
/// @throws vpDisplayException without a display
std::unique_ptr<vpDisplay> open_window(vpImage<vpRGBa>& picture, const std::string& title);

}  // namespace vigia::imaging

#include "overlay_window.hpp"

#include <utility>

#include <visp3/core/vpDisplayException.h>
#include <visp3/core/vpMouseButton.h>

#include "vigia/core/error.hpp"
#include "vigia/imaging/window_display.hpp"

namespace vigia::app {

OverlayWindow::OverlayWindow(std::string title, std::string without)
    : title_(std::move(title)), without_(std::move(without)) {}
OverlayWindow::~OverlayWindow() = default;

void OverlayWindow::show(const vpImage<vpRGBa>& picture) {
  const bool same_size =
      picture.getWidth() == picture_.getWidth() && picture.getHeight() == picture_.getHeight();
  picture_ = picture;
  try {
    if (!display_ || !same_size) {
      display_.reset();
      display_ = imaging::open_window(picture_, title_);
    }
    vpDisplay::display(picture_);
    vpDisplay::flush(picture_);
    vpImagePoint at;
    vpMouseButton::vpMouseButtonType button = vpMouseButton::none;
    closed_ = vpDisplay::getClick(picture_, at, button, false) && button == vpMouseButton::button3;
  } catch (const vpException&) {
    throw InputError("--view: no X display can be opened; " + without_);
  }
}

}  // namespace vigia::app

#pragma once

#include <memory>

#include <visp3/core/vpDisplay.h>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

namespace vigia::app {

/// A window that shows pictures as they come.
class OverlayWindow {
 public:
  OverlayWindow();
  ~OverlayWindow();

  /// Throws InputError when there is no display.
  void show(const vpImage<vpRGBa>& picture);
  /// Whether the user has clicked into the window with the right button: the end.
  bool closed() const { return closed_; }

 private:
  vpImage<vpRGBa> picture_;
  std::unique_ptr<vpDisplay> display_;
  bool closed_ = false;
};

}  // namespace vigia::app

#pragma once

#include <memory>
#include <string>

#include <visp3/core/vpDisplay.h>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

namespace vigia::app {

/// A window that shows pictures as they come.
class OverlayWindow {
 public:
  /// @p without: what becomes of it, or helps, where there is no display.
  OverlayWindow(std::string title, std::string without);
  ~OverlayWindow();

  /// Throws InputError when there is no display.
  void show(const vpImage<vpRGBa>& picture);
  /// Whether the user has clicked into the window with the right button: the end.
  bool closed() const { return closed_; }

 private:
  std::string title_;
  std::string without_;
  vpImage<vpRGBa> picture_;
  std::unique_ptr<vpDisplay> display_;
  bool closed_ = false;
};

}  // namespace vigia::app

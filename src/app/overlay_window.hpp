#pragma once

#include <string>

#include <sys/types.h>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>

namespace vigia::app {

/// A window that shows pictures as they come. It is a process of its own: Xlib ends the process
/// whose display is lost, or whose window the window manager kills, and what is driven must go on.
class OverlayWindow {
 public:
  /// @p without: what becomes of it, or helps, where there is no window.
  OverlayWindow(std::string title, std::string without);
  OverlayWindow(const OverlayWindow&) = delete;
  OverlayWindow& operator=(const OverlayWindow&) = delete;
  ~OverlayWindow();

  /// Throws InputError when there is no display, or none any more.
  void show(const vpImage<vpRGBa>& picture);
  /// Whether the user has clicked into the window with the right button: the end.
  bool closed() const { return closed_; }

 private:
  void open();
  void end();

  std::string title_;
  std::string without_;
  pid_t process_ = -1;
  int connection_ = -1;  ///< pictures go there, an answer to each comes back
  bool closed_ = false;
};

}  // namespace vigia::app

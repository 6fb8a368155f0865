#include "overlay_window.hpp"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <utility>

#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <visp3/core/vpDisplay.h>
#include <visp3/core/vpMouseButton.h>

#include "vigia/core/error.hpp"
#include "vigia/imaging/window_display.hpp"

namespace vigia::app {
namespace {

struct Size {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

enum class Answer : char { shown, closed, no_display };

/// All of the bytes; false when the other side is gone.
bool send_all(int connection, const void* bytes, std::size_t count) {
  const char* next = static_cast<const char*>(bytes);
  while (count > 0) {
    const ssize_t sent = ::send(connection, next, count, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    next += sent;
    count -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int connection, void* bytes, std::size_t count) {
  char* next = static_cast<char*>(bytes);
  while (count > 0) {
    const ssize_t got = ::recv(connection, next, count, 0);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    next += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

std::size_t bytes_of(const Size& size) {
  return std::size_t{4} * size.width * size.height;
}

/// The window, in the process that has it.
class Shown {
 public:
  explicit Shown(const std::string& title) : title_(title) {}

  /// Takes a picture from the connection; false at its end.
  bool take(int connection) {
    Size size;
    if (!receive_all(connection, &size, sizeof size)) return false;
    if (size.width != picture_.getWidth() || size.height != picture_.getHeight()) {
      display_.reset();
      picture_.resize(size.height, size.width);
    }
    return receive_all(connection, picture_.bitmap, bytes_of(size));
  }

  Answer show() {
    try {
      if (!display_) display_ = imaging::open_window(picture_, title_);
      vpDisplay::display(picture_);
      vpDisplay::flush(picture_);
      vpImagePoint at;
      vpMouseButton::vpMouseButtonType button = vpMouseButton::none;
      const bool clicked = vpDisplay::getClick(picture_, at, button, false);
      return clicked && button == vpMouseButton::button3 ? Answer::closed : Answer::shown;
    } catch (const std::exception&) {
      return Answer::no_display;
    }
  }

 private:
  const std::string& title_;
  vpImage<vpRGBa> picture_;
  std::unique_ptr<vpDisplay> display_;
};

/// Closes the files that the process was copied with: Xlib's exit, when the display is lost, would
/// write what is buffered for them a second time.
int keep_alone(int connection) {
  constexpr int kKept = 3;
  if (connection != kKept) ::dup2(connection, kKept);
  ::close_range(kKept + 1, ~0U, 0);
  return kKept;
}

[[noreturn]] void serve_window(int inherited, const std::string& title) {
  const int connection = keep_alone(inherited);
  {
    Shown window(title);
    while (window.take(connection)) {
      const Answer answer = window.show();
      if (!send_all(connection, &answer, 1) || answer != Answer::shown) break;
    }
  }
  ::_exit(0);  // what is open in this copy of the process belongs to the other
}

}  // namespace

OverlayWindow::OverlayWindow(std::string title, std::string without)
    : title_(std::move(title)), without_(std::move(without)) {}

OverlayWindow::~OverlayWindow() {
  end();
}

void OverlayWindow::open() {
  int ends[2] = {-1, -1};
  std::cout.flush();  // or the copy's exit writes it again
  std::fflush(stdout);
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw InputError("--view: no window can be opened; " + without_);
  process_ = ::fork();
  if (process_ == 0) {
    serve_window(ends[1], title_);
  }
  ::close(ends[1]);
  connection_ = ends[0];
}

void OverlayWindow::end() {
  if (connection_ >= 0) ::close(connection_);
  if (process_ > 0) ::waitpid(process_, nullptr, 0);
  connection_ = -1;
  process_ = -1;
}

void OverlayWindow::show(const vpImage<vpRGBa>& picture) {
  if (connection_ < 0) open();
  const Size size{picture.getWidth(), picture.getHeight()};
  Answer answer = Answer::no_display;
  const bool answered = send_all(connection_, &size, sizeof size) &&
                        send_all(connection_, picture.bitmap, bytes_of(size)) &&
                        receive_all(connection_, &answer, 1);
  if (answered && answer == Answer::shown) return;
  end();
  if (!answered) throw InputError("--view: the window is gone, or its display; " + without_);
  if (answer == Answer::no_display)
    throw InputError("--view: no X display can be opened; " + without_);
  closed_ = true;
}

}  // namespace vigia::app

#include "vigia/evaluation/descriptor.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "vigia/core/error.hpp"

namespace vigia::evaluation {

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

void fail(const std::string& what, const std::filesystem::path& path) {
  throw InputError(fmt::format("cannot {} {}: {}", what, path.string(), std::strerror(errno)));
}

Descriptor open_to_append(const std::filesystem::path& file) {
  Descriptor descriptor(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (descriptor.get() < 0) fail("open", file);
  return descriptor;
}

void append_line(const Descriptor& descriptor, std::string_view line,
                 const std::filesystem::path& file) {
  // One call: lines of a process that is killed are whole or the last.
  while (!line.empty()) {
    const ssize_t written = ::write(descriptor.get(), line.data(), line.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", file);
    line.remove_prefix(static_cast<std::size_t>(written));
  }
}

Descriptor lock_folder(const std::filesystem::path& folder) {
  Descriptor lock(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock.get() < 0) fail("open", folder);
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0)
    throw InputError("another process is at work in " + folder.string());
  return lock;
}

std::string read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace vigia::evaluation

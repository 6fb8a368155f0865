#include "vigia/core/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <random>

#include <fcntl.h>
#include <unistd.h>

#include "vigia/core/error.hpp"

namespace vigia {
namespace {

/// What a file that is written aside survives: the end of this process, or of the machine.
enum class Durability { process, machine };

/// Makes the disk remember the name. A file system that cannot is no fault of the file.
void sync_folder(const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

void write_aside(const std::filesystem::path& path, const std::filesystem::path& aside,
                 std::string_view bytes, Durability durability) {
  reject_special_file(path);
  try {
    OutputFile file(aside);
    file.write(bytes);
    if (durability == Durability::machine) file.sync();
    file.close();
    std::filesystem::rename(aside, path);
    if (durability == Durability::machine) sync_folder(path);
  } catch (const std::filesystem::filesystem_error& error) {
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw InputError("cannot write " + path.string() + ": " + error.code().message());
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(aside, ignored);
    throw;
  }
}

}  // namespace

void reject_special_file(const std::filesystem::path& path) {
  std::error_code unknown;
  const auto status = std::filesystem::status(path, unknown);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw InputError("cannot write " + path.string() + ": it is not an ordinary file");
}

OutputFile::OutputFile(std::filesystem::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
  if (!file_) fail();
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail();
}

void OutputFile::flush() {
  if (std::fflush(file_.get()) != 0) fail();
}

void OutputFile::close() {
  if (!file_) return;
  if (std::fflush(file_.get()) != 0) fail();
  if (std::fclose(file_.release()) != 0) fail();
}

void OutputFile::fail() const {
  throw InputError("cannot write " + path_.string() + ": " + std::strerror(errno));
}

void OutputFile::sync() {
  if (std::fflush(file_.get()) != 0 || ::fsync(::fileno(file_.get())) != 0) fail();
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  write_aside(path, path.string() + ".part", bytes, Durability::process);
}

void write_shared_file(const std::filesystem::path& path, std::string_view bytes) {
  write_aside(path, path.string() + own_part_suffix(), bytes, Durability::machine);
}

std::string own_part_suffix() {
  char host[256] = "";
  if (::gethostname(host, sizeof host - 1) != 0) host[0] = '\0';
  std::random_device random;
  char name[320];
  std::snprintf(name, sizeof name, ".part-%s-%ld-%08x%08x", host, static_cast<long>(::getpid()),
                random(), random());
  return name;
}

}  // namespace vigia

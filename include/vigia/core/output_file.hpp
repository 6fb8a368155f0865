#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace vigia {

/// A file being written whose every failure (no permission, no space) is an InputError that names
/// the file and the system's reason.
class OutputFile {
 public:
  /// Creates or truncates @p path.
  explicit OutputFile(std::filesystem::path path);

  void write(std::string_view bytes);
  /// Hands what was written to the system: it stays when this program ends suddenly.
  void flush();
  /// Flushes and closes; what was written is on its way to the disk without error.
  void close();
  /// Flushes and waits until the disk has it: it stays when the machine ends suddenly.
  void sync();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// A name for new bytes must not take the place of a device, a pipe or a folder.
/// @throws InputError where @p path is one
void reject_special_file(const std::filesystem::path& path);

/// Writes a whole file aside and then gives it its name: either the old or the new content is
/// there, never half of one.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// The same for a file that processes on several machines may write at once: each writes aside
/// under a name of its own, and the disk has the bytes before the file has its name.
void write_shared_file(const std::filesystem::path& path, std::string_view bytes);

/// ".part-<host>-<process>-<random number>": the end of a name that no other process uses.
std::string own_part_suffix();

}  // namespace vigia

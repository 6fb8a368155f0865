#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
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

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// Writes a whole file aside and then gives it its name: either the old or the new content is
/// there, never half of one.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace vigia

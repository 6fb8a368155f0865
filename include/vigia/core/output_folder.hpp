#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vigia {

/// A folder that is built aside (a hidden sibling) and takes its name in commit(). An earlier
/// folder of that name is replaced then and not before, and only when it is empty or holds the file
/// @p mark, which tells what this program made from what it must not touch. Destroyed without
/// commit() nothing stays; what a killed process left is removed by the next that makes the same
/// folder. Every failure is an InputError that names the folder.
class OutputFolder {
 public:
  OutputFolder(const std::filesystem::path& folder, std::string mark);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where files are written until commit().
  const std::filesystem::path& staging() const { return staging_; }
  /// Makes a folder below.
  void make(const std::string& name) const;
  /// Writes a text file.
  void add(const std::string& name, std::string_view text) const;
  void commit();

 private:
  void check_replaceable() const;

  std::filesystem::path folder_;
  std::filesystem::path staging_;
  std::string mark_;
  bool committed_ = false;
};

}  // namespace vigia

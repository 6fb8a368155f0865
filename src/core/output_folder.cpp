#include "vigia/core/output_folder.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>

#include <unistd.h>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"

namespace vigia {
namespace fs = std::filesystem;
namespace {

/// Whether the process has ended; also false where nobody may tell.
bool has_ended(pid_t process) {
  return ::kill(process, 0) != 0 && errno == ESRCH;
}

/// Removes what processes that were killed had begun under this prefix and their number.
void remove_abandoned(const fs::path& beside, const std::string& prefix) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(beside, error)) {
    const std::string name = entry.path().filename().string();
    if (name.compare(0, prefix.size(), prefix) != 0) continue;
    const std::string number = name.substr(prefix.size());
    if (number.empty() || number.size() > 9) continue;
    if (number.find_first_not_of("0123456789") != std::string::npos) continue;
    std::error_code ignored;
    if (has_ended(static_cast<pid_t>(std::atoi(number.c_str()))))
      fs::remove_all(entry.path(), ignored);
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& folder, std::string mark) : mark_(std::move(mark)) {
  if (folder.empty()) throw InputError("the output folder's name is empty");
  folder_ = fs::absolute(folder).lexically_normal();
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  check_replaceable();
  const std::string prefix = "." + folder_.filename().string() + ".part-";
  remove_abandoned(folder_.parent_path(), prefix);
  staging_ = folder_.parent_path() / (prefix + std::to_string(::getpid()));
  std::error_code error;
  fs::remove_all(staging_, error);
  fs::create_directories(staging_, error);
  if (error)
    throw InputError("cannot make the folder " + folder_.string() + ": " + error.message());
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(staging_, ignored);
}

void OutputFolder::check_replaceable() const {
  std::error_code error;
  const auto status = fs::status(folder_, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status))
    throw InputError("cannot make the folder " + folder_.string() + ": a file of that name exists");
  if (!fs::is_empty(folder_, error) && !fs::exists(folder_ / mark_, error))
    throw InputError("cannot replace the folder " + folder_.string() + ": it holds no " + mark_ +
                     ", so it is not one of ours; choose another --out");
}

void OutputFolder::make(const std::string& name) const {
  std::error_code error;
  fs::create_directories(staging_ / name, error);
  if (error)
    throw InputError("cannot make the folder " + (staging_ / name).string() + ": " +
                     error.message());
}

void OutputFolder::add(const std::string& name, std::string_view text) const {
  OutputFile file(staging_ / name);
  file.write(text);
  file.close();
}

void OutputFolder::commit() {
  check_replaceable();
  std::error_code error;
  const fs::path old = staging_.string() + "-old";
  const bool replaces = fs::exists(folder_, error);
  if (replaces) fs::rename(folder_, old, error);
  if (!error) fs::rename(staging_, folder_, error);
  if (error) {
    std::error_code ignored;
    if (replaces && !fs::exists(folder_, ignored)) fs::rename(old, folder_, ignored);
    throw InputError("cannot make the folder " + folder_.string() + ": " + error.message());
  }
  committed_ = true;
  if (replaces) fs::remove_all(old, error);
}

}  // namespace vigia

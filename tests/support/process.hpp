#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <sys/wait.h>

namespace vigia::testing {

struct ProcessResult {
  int status = -1;
  std::string out;
  std::string err;
};

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs a shell command; stderr goes through a file in @p scratch.
inline ProcessResult run_process(const std::string& command, const std::filesystem::path& scratch) {
  const std::filesystem::path err = scratch / "stderr.txt";
  ProcessResult result;
  std::FILE* pipe = ::popen((command + " 2>" + err.string()).c_str(), "r");
  if (pipe == nullptr) return result;
  char buffer[4096];
  std::size_t got = 0;
  while ((got = std::fread(buffer, 1, sizeof buffer, pipe)) > 0) result.out.append(buffer, got);
  const int status = ::pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.err = read_text(err);
  return result;
}

}  // namespace vigia::testing

#include "vigia/core/output_file.hpp"

#include <cerrno>
#include <cstring>

#include "vigia/core/error.hpp"

namespace vigia {

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

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path aside = path.string() + ".part";
  try {
    OutputFile file(aside);
    file.write(bytes);
    file.close();
    std::filesystem::rename(aside, path);
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

}  // namespace vigia

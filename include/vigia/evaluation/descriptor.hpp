#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace vigia::evaluation {

/// An open file, closed with this.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  int get() const { return number_; }

 private:
  int number_;
};

/// Throws InputError "cannot <what> <path>: <the system's reason>".
[[noreturn]] void fail(const std::string& what, const std::filesystem::path& path);

/// Opens or makes @p file, to which every write appends. Throws InputError.
Descriptor open_to_append(const std::filesystem::path& file);

/// Hands @p line to the system at once: it stays when the process is killed. @p file is named in
/// the InputError of a failure.
void append_line(const Descriptor& descriptor, std::string_view line,
                 const std::filesystem::path& file);

/// A lock on a folder that the kernel drops with the process, however that ends. Throws InputError
/// when another process of this machine has it.
Descriptor lock_folder(const std::filesystem::path& folder);

/// The whole of a file, empty where there is none.
std::string read_bytes(const std::filesystem::path& file);

}  // namespace vigia::evaluation

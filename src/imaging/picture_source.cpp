#include "vigia/imaging/picture_source.hpp"

#include "media.hpp"
#include "stdin_source.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include <unistd.h>

#include "vigia/core/error.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::imaging {
namespace {

namespace fs = std::filesystem;

bool has_ending(const fs::path& file, const std::vector<std::string>& endings) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

bool is_picture_name(const fs::path& file) {
  return has_ending(file, {".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".bmp", ".tif", ".tiff"});
}

bool is_video_name(const fs::path& file) {
  return has_ending(file, {".mp4", ".avi", ".mpg", ".mpeg", ".mkv", ".mov", ".webm"});
}

bool is_device(const std::string& input) {
  const std::string stem = "/dev/video";
  return input.size() > stem.size() && input.size() <= stem.size() + 3 &&
         input.compare(0, stem.size(), stem) == 0 &&
         std::all_of(input.begin() + static_cast<std::ptrdiff_t>(stem.size()), input.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_picture_name(entry.path())) files.push_back(entry.path());
  if (files.empty()) throw InputError(folder.string() + ": no pictures in this folder");
  std::sort(files.begin(), files.end());
  return files;
}

class FileList : public PictureSource {
 public:
  explicit FileList(std::vector<fs::path> files) : files_(std::move(files)) {}

  std::optional<Picture> next() override {
    if (at_ == files_.size()) return std::nullopt;
    const fs::path& file = files_[at_++];
    return Picture{file.string(), std::nullopt, std::make_unique<ImageFrame>(read_image(file))};
  }

 private:
  std::vector<fs::path> files_;
  std::size_t at_ = 0;
};

/// A file name with one place for a number.
struct NumberedName {
  std::string before;
  std::string after;
  std::size_t width = 0;  ///< digits at least, the first of them zeros; 0: as many as it takes
};

// %d or %0Nd, once, with N from 1 to 9.
NumberedName parse_numbered(const std::string& pattern, const std::string& name) {
  const InputError wrong({pattern},
                         "found '%' in the file's name, where one %d or %0Nd (N from 1 "
                         "to 9) would be right, or a file of this very name");
  const std::size_t at = name.find('%');
  if (at == std::string::npos || name.find('%', at + 1) != std::string::npos) throw wrong;
  NumberedName out;
  out.before = name.substr(0, at);
  std::size_t end = at + 1;
  if (name.size() > at + 2 && name[at + 1] == '0' && name[at + 2] >= '1' && name[at + 2] <= '9') {
    out.width = static_cast<std::size_t>(name[at + 2] - '0');
    end = at + 3;
  }
  if (end >= name.size() || name[end] != 'd') throw wrong;
  out.after = name.substr(end + 1);
  return out;
}

// The number in a file's name, where the name is one of the pattern's.
std::optional<unsigned long> number_in(const std::string& name, const NumberedName& pattern) {
  constexpr std::size_t kMostDigits = 9;
  if (name.size() <= pattern.before.size() + pattern.after.size()) return std::nullopt;
  const std::size_t digits = name.size() - pattern.before.size() - pattern.after.size();
  if (digits > kMostDigits || name.compare(0, pattern.before.size(), pattern.before) != 0 ||
      name.compare(name.size() - pattern.after.size(), std::string::npos, pattern.after) != 0)
    return std::nullopt;
  const std::string number = name.substr(pattern.before.size(), digits);
  if (!std::all_of(number.begin(), number.end(),
                   [](unsigned char c) { return std::isdigit(c) != 0; }))
    return std::nullopt;
  // As printf would write it: padded to the width, and no zeros before that.
  const bool padded = digits == pattern.width;
  const bool free_of_zeros = digits > pattern.width && (number[0] != '0' || digits == 1);
  if (!padded && !free_of_zeros) return std::nullopt;
  return std::stoul(number);
}

}  // namespace

std::vector<fs::path> numbered_files(const std::string& pattern) {
  const fs::path path(pattern);
  const NumberedName wanted = parse_numbered(pattern, path.filename().string());
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::vector<std::pair<unsigned long, fs::path>> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (const auto number = number_in(entry->path().filename().string(), wanted))
      found.emplace_back(*number, path.parent_path() / entry->path().filename());
  if (found.empty()) throw InputError({pattern}, "no file has such a name, with a number at %");
  std::sort(found.begin(), found.end());
  std::vector<fs::path> files;
  files.reserve(found.size());
  for (auto& entry : found) files.push_back(std::move(entry.second));
  return files;
}

std::unique_ptr<PictureSource> open_pictures(const std::string& input, const SourceParams& params) {
  if (input == "-") return open_descriptor(STDIN_FILENO, params);
  if (is_address(input)) return media().open_stream(parse_address(input), params);
  if (is_device(input)) return media().open_device(input, params);
  const fs::path path(input);
  if (fs::is_directory(path)) return std::make_unique<FileList>(pictures_in(path));
  if (!fs::exists(path) && input.find('%') != std::string::npos)
    return std::make_unique<FileList>(numbered_files(input));
  if (is_video_name(path) && fs::is_regular_file(path)) return media().open_video(path);
  return std::make_unique<FileList>(std::vector<fs::path>{path});
}

}  // namespace vigia::imaging

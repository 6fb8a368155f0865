#include "stdin_source.hpp"

#include "encoded_picture.hpp"

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include <unistd.h>

#include "vigia/core/error.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::imaging {
namespace {

constexpr std::size_t kLongestMagic = 8;
constexpr std::size_t kLargestPicture = std::size_t{1} << 28U;

class DescriptorSource : public PictureSource {
 public:
  DescriptorSource(int descriptor, SourceParams params)
      : descriptor_(descriptor), params_(std::move(params)) {}

  std::optional<Picture> next() override {
    std::optional<std::size_t> length = picture_length(bytes_);
    while (!length) {
      if (bytes_.size() >= kLongestMagic && !is_picture(bytes_))
        throw InputError(name() + ": no JPEG, PNG or binary PNM begins here");
      if (bytes_.size() > kLargestPicture) throw InputError(name() + ": more than 256 MB");
      if (!read_more()) {
        if (bytes_.empty() || stopped()) return end();
        throw InputError(name() + (is_picture(bytes_)
                                       ? ": this picture ends early: truncated stream"
                                       : ": no JPEG, PNG or binary PNM begins here"));
      }
      length = picture_length(bytes_);
    }
    auto frame = std::make_unique<ImageFrame>(
        decode_picture(std::string_view(bytes_).substr(0, *length), name()));
    bytes_.erase(0, *length);
    return Picture{"stdin#" + std::to_string(++number_), std::nullopt, std::move(frame)};
  }

 private:
  std::string name() const { return "stdin, picture " + std::to_string(number_ + 1); }
  bool stopped() const { return params_.stop && params_.stop(); }

  std::optional<Picture> end() const {
    if (number_ == 0 && !stopped()) throw InputError("stdin: no picture came");
    return std::nullopt;
  }

  // False at the end, and when stopped.
  bool read_more() {
    char block[1U << 16U];
    for (;;) {
      if (stopped()) return false;
      const ssize_t got = ::read(descriptor_, block, sizeof block);
      if (got > 0) bytes_.append(block, static_cast<std::size_t>(got));
      if (got >= 0) return got > 0;
      if (errno != EINTR)
        throw InputError(std::string("stdin: reading failed: ") + std::strerror(errno));
    }
  }

  int descriptor_;
  SourceParams params_;
  std::string bytes_;
  int number_ = 0;
};

}  // namespace

std::unique_ptr<PictureSource> open_descriptor(int descriptor, const SourceParams& params) {
  return std::make_unique<DescriptorSource>(descriptor, params);
}

}  // namespace vigia::imaging

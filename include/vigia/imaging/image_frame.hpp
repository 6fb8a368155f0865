#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vigia/imaging/frame.hpp"

namespace vigia::imaging {

/// A recorded picture as a Frame. Grey from colour as ViSP converts it.
class ImageFrame : public Frame {
 public:
  explicit ImageFrame(vpImage<unsigned char> grey);
  explicit ImageFrame(vpImage<vpRGBa> colour);

  int width() const override;
  int height() const override;
  void read_grey(const Window& window, unsigned char* out, std::ptrdiff_t stride) const override;
  void read_colour(const Window& window, vpRGBa* out, std::ptrdiff_t stride) const override;

 private:
  vpImage<unsigned char> grey_;
  vpImage<vpRGBa> colour_;
};

/// Reads a picture file (PNG, JPEG, PGM, PPM, …). Throws InputError when the file is missing, is no
/// picture, or ends early.
ImageFrame read_image(const std::filesystem::path& file);

/// Decodes the bytes of such a file. @p name stands for it in messages. Throws InputError.
ImageFrame decode_picture(std::string_view bytes, const std::string& name);

/// Writes a PNG, aside first and then renamed, so that no half-written file stays. Throws
/// InputError when it can't be written.
void write_png(const std::filesystem::path& file, const vpImage<vpRGBa>& image);

}  // namespace vigia::imaging

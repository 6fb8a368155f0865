#include "fast_start.hpp"

#include <cstdint>
#include <optional>
#include <string_view>

namespace vigia::imaging {
namespace {

// ISO/IEC 14496-12: a file is a row of boxes of size, type and content, and so are some boxes.
constexpr std::size_t kBoxHead = 8;

std::uint64_t big_endian_at(const std::string& bytes, std::size_t at, std::size_t width) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < width; ++i)
    value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

void put_big_endian(std::string& bytes, std::size_t at, std::size_t width, std::uint64_t value) {
  for (std::size_t i = width; i-- > 0; value >>= 8U)
    bytes[at + i] = static_cast<char>(value & 0xffU);
}

struct Mp4Box {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string_view type;
};

/// The box that begins at @p at and ends before @p end; nothing where none does.
std::optional<Mp4Box> box_at(const std::string& bytes, std::size_t at, std::size_t end) {
  if (end - at < kBoxHead) return std::nullopt;
  std::uint64_t size = big_endian_at(bytes, at, 4);
  if (size == 1 && end - at >= kBoxHead + 8) size = big_endian_at(bytes, at + kBoxHead, 8);
  if (size < kBoxHead || size > end - at) return std::nullopt;
  return Mp4Box{at, at + static_cast<std::size_t>(size), std::string_view(bytes).substr(at + 4, 4)};
}

/// Adds @p by to the places in the file that the tables of a box's boxes hold.
void move_places(std::string& bytes, std::size_t begin, std::size_t end, std::uint64_t by) {
  for (auto box = box_at(bytes, begin, end); box; box = box_at(bytes, box->end, end)) {
    const std::size_t content = box->begin + kBoxHead;
    if (box->type == "trak" || box->type == "mdia" || box->type == "minf" || box->type == "stbl")
      move_places(bytes, content, box->end, by);
    if (box->type != "stco" && box->type != "co64") continue;
    const std::size_t width = box->type == "stco" ? 4 : 8;
    for (std::size_t at = content + 8; at + width <= box->end; at += width)  // version, count
      put_big_endian(bytes, at, width, big_endian_at(bytes, at, width) + by);
  }
}

}  // namespace

std::string with_index_first(const std::string& mp4) {
  std::optional<Mp4Box> pictures;
  std::optional<Mp4Box> index;
  for (auto box = box_at(mp4, 0, mp4.size()); box; box = box_at(mp4, box->end, mp4.size())) {
    if (box->type == "mdat" && !pictures) pictures = box;
    if (box->type == "moov") index = box;
  }
  if (!pictures || !index || index->begin < pictures->begin) return mp4;
  std::string moved = mp4.substr(index->begin, index->end - index->begin);
  move_places(moved, kBoxHead, moved.size(), moved.size());
  return mp4.substr(0, pictures->begin) + moved +
         mp4.substr(pictures->begin, index->begin - pictures->begin) + mp4.substr(index->end);
}

}  // namespace vigia::imaging

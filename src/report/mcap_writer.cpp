#include "vigia/report/mcap_writer.hpp"

#include "crc32.hpp"

#include <algorithm>

#include "vigia/core/error.hpp"
#include "vigia/core/output_file.hpp"

namespace vigia::report {
namespace {

// Names, order and width of the fields are those of the MCAP specification.

constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};
constexpr std::string_view kMcapLibrary = "vigia";

enum class McapOp : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0b,
  summary_offset = 0x0e,
  data_end = 0x0f,
};

/// Little-endian.
template <typename Unsigned>
void append(std::string& out, Unsigned value) {
  for (std::size_t i = 0; i < sizeof value; ++i)
    out += static_cast<char>(static_cast<std::uint64_t>(value) >> (8U * i) & 0xffU);
}

void append_text(std::string& out, std::string_view text) {
  append(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

void append_start(std::string& out, McapOp op, std::uint64_t content_bytes) {
  append(out, static_cast<std::uint8_t>(op));
  append(out, content_bytes);
}

std::string mcap_record(McapOp op, std::string_view content) {
  std::string out;
  append_start(out, op, content.size());
  out += content;
  return out;
}

std::string header_record() {
  std::string content;
  append_text(content, "");  // no profile
  append_text(content, kMcapLibrary);
  return mcap_record(McapOp::header, content);
}

/// @p file, which a finished one may replace.
std::filesystem::path replaceable(std::filesystem::path file) {
  reject_special_file(file);
  return file;
}

}  // namespace

void McapWriter::Span::add(std::uint64_t time) {
  first = messages == 0 ? time : std::min(first, time);
  last = std::max(last, time);
  ++messages;
}

McapWriter::McapWriter(std::filesystem::path file, std::size_t chunk_bytes)
    : path_(replaceable(std::move(file))),
      aside_(path_.string() + ".part"),
      file_(aside_),
      chunk_bytes_(chunk_bytes) {
  put(kMcapMagic);
  put(header_record());
}

McapWriter::~McapWriter() {
  std::error_code ignored;
  if (!finished_) std::filesystem::remove(aside_, ignored);
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes);
  crc_ = crc32(bytes, crc_);
  place_ += bytes.size();
}

McapWriter::ChannelId McapWriter::schema_id(const McapSchema& schema) {
  const auto known = schemas_.find(schema.name);
  if (known != schemas_.end()) return known->second;
  const auto id = static_cast<ChannelId>(schemas_.size() + 1);
  schemas_.emplace(schema.name, id);
  std::string content;
  append(content, id);
  append_text(content, schema.name);
  append_text(content, "jsonschema");
  append_text(content, schema.text);
  const std::string record = mcap_record(McapOp::schema, content);
  schema_records_ += record;
  put(record);
  return id;
}

McapWriter::ChannelId McapWriter::add_channel(const std::string& topic, const McapSchema& schema) {
  const auto id = static_cast<ChannelId>(channels_.size() + 1);
  std::string content;
  append(content, id);
  append(content, schema_id(schema));
  append_text(content, topic);
  append_text(content, "json");
  append_text(content, "");  // no metadata
  channels_.push_back({mcap_record(McapOp::channel, content), 0, {}});
  put(channels_.back().record);
  return id;
}

void McapWriter::write(ChannelId channel, Stamp at, std::string_view json) {
  Channel& to = channels_.at(channel - std::size_t{1});
  const auto time = static_cast<std::uint64_t>(at.ns);
  to.index.emplace_back(time, chunk_.size());
  std::string start;
  append(start, channel);
  append(start, static_cast<std::uint32_t>(to.messages++));
  append(start, time);  // logged
  append(start, time);  // published
  append_start(chunk_, McapOp::message, start.size() + json.size());
  chunk_ += start;
  chunk_ += json;
  chunk_span_.add(time);
  span_.add(time);
  if (chunk_.size() >= chunk_bytes_) end_chunk();
}

/// Puts the index of each channel's messages in the chunk. @returns where each begins: a map.
std::string McapWriter::put_message_indexes() {
  std::string places;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    auto& index = channels_[i].index;
    if (index.empty()) continue;
    const auto id = static_cast<ChannelId>(i + 1);
    append(places, id);
    append(places, place_);
    std::string entries;
    for (const auto& [time, offset] : index) {
      append(entries, time);
      append(entries, offset);
    }
    std::string content;
    append(content, id);
    append_text(content, entries);
    put(mcap_record(McapOp::message_index, content));
    index.clear();
  }
  return places;
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::uint64_t begin = place_;
  std::string start;
  append(start, chunk_span_.first);
  append(start, chunk_span_.last);
  append(start, static_cast<std::uint64_t>(chunk_.size()));
  append(start, crc32(chunk_));
  append_text(start, "");  // no compression
  append(start, static_cast<std::uint64_t>(chunk_.size()));
  std::string head;
  append_start(head, McapOp::chunk, start.size() + chunk_.size());
  put(head + start);
  put(chunk_);
  const std::uint64_t end = place_;
  const std::string places = put_message_indexes();
  std::string content;
  append(content, chunk_span_.first);
  append(content, chunk_span_.last);
  append(content, begin);
  append(content, end - begin);
  append_text(content, places);
  append(content, place_ - end);
  append_text(content, "");  // no compression
  append(content, static_cast<std::uint64_t>(chunk_.size()));
  append(content, static_cast<std::uint64_t>(chunk_.size()));
  chunk_indexes_ += mcap_record(McapOp::chunk_index, content);
  ++chunks_;
  chunk_.clear();
  chunk_span_ = {};
}

std::string McapWriter::statistics() const {
  std::string counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    append(counts, static_cast<ChannelId>(i + 1));
    append(counts, channels_[i].messages);
  }
  std::string content;
  append(content, span_.messages);
  append(content, static_cast<std::uint16_t>(schemas_.size()));
  append(content, static_cast<std::uint32_t>(channels_.size()));
  append(content, std::uint32_t{0});  // attachments
  append(content, std::uint32_t{0});  // metadata
  append(content, chunks_);
  append(content, span_.first);
  append(content, span_.last);
  append_text(content, counts);
  return mcap_record(McapOp::statistics, content);
}

void McapWriter::put_summary() {
  std::string channel_records;
  for (const Channel& channel : channels_) channel_records += channel.record;
  const std::uint64_t begin = place_;
  crc_ = 0;  // the footer's is the summary's
  std::string offsets;
  const auto put_group = [&](McapOp op, const std::string& records) {
    if (records.empty()) return;
    std::string content;
    append(content, static_cast<std::uint8_t>(op));
    append(content, place_);
    append(content, static_cast<std::uint64_t>(records.size()));
    offsets += mcap_record(McapOp::summary_offset, content);
    put(records);
  };
  put_group(McapOp::schema, schema_records_);
  put_group(McapOp::channel, channel_records);
  put_group(McapOp::statistics, statistics());
  put_group(McapOp::chunk_index, chunk_indexes_);
  const std::uint64_t offsets_begin = place_;
  put(offsets);
  std::string footer;
  append_start(footer, McapOp::footer, 8 + 8 + 4);
  append(footer, begin);
  append(footer, offsets_begin);
  put(footer);
  std::string crc;
  append(crc, crc_);
  put(crc);
}

void McapWriter::finish() {
  end_chunk();
  std::string crc;
  append(crc, crc_);
  put(mcap_record(McapOp::data_end, crc));
  put_summary();
  put(kMcapMagic);
  file_.close();
  std::error_code failed;
  std::filesystem::rename(aside_, path_, failed);
  if (failed) throw InputError("cannot write " + path_.string() + ": " + failed.message());
  finished_ = true;
}

}  // namespace vigia::report

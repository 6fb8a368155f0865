#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vigia/core/output_file.hpp"
#include "vigia/core/stamp.hpp"

namespace vigia::report {

/// What the messages of a channel look like: a JSON schema.
struct McapSchema {
  std::string_view name;
  std::string_view text;
};

/// Writes JSON messages into an MCAP file (version 0 of the format): in chunks without compression,
/// each with an index, and a summary by which a reader finds the messages of a topic and a time
/// without reading the rest. The file is written aside, so that it takes no more memory than a
/// chunk, and takes its name in finish(); without that nothing stays. Every failure of the file is
/// an InputError.
class McapWriter {
 public:
  using ChannelId = std::uint16_t;

  /// @p chunk_bytes: a chunk ends with the message by which it has so many.
  explicit McapWriter(std::filesystem::path file, std::size_t chunk_bytes = std::size_t{1} << 20U);
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Channels of one schema's name share the schema.
  ChannelId add_channel(const std::string& topic, const McapSchema& schema);
  /// @p at: the mission's time, which the file counts from 1970.
  void write(ChannelId channel, Stamp at, std::string_view json);
  void finish();

 private:
  using IndexEntry = std::pair<std::uint64_t, std::uint64_t>;  ///< time, place in the chunk
  struct Channel {
    std::string record;
    std::uint64_t messages = 0;
    std::vector<IndexEntry> index;  ///< of the present chunk
  };
  /// First and last time of messages.
  struct Span {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    std::uint64_t messages = 0;

    void add(std::uint64_t time);
  };

  void put(std::string_view bytes);
  void end_chunk();
  std::string put_message_indexes();
  void put_summary();
  std::string statistics() const;
  ChannelId schema_id(const McapSchema& schema);

  std::filesystem::path path_;
  std::filesystem::path aside_;
  OutputFile file_;
  std::size_t chunk_bytes_;
  std::uint64_t place_ = 0;  ///< in the file
  std::uint32_t crc_ = 0;    ///< of the file so far
  std::map<std::string, ChannelId, std::less<>> schemas_;
  std::string schema_records_;
  std::vector<Channel> channels_;  ///< by id − 1
  std::string chunk_;              ///< the messages of the present one
  Span chunk_span_;
  Span span_;
  std::string chunk_indexes_;
  std::uint32_t chunks_ = 0;
  bool finished_ = false;
};

}  // namespace vigia::report

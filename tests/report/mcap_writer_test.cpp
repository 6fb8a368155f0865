#include "vigia/report/mcap_writer.hpp"

#include "crc32.hpp"
#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "vigia/core/error.hpp"

namespace vigia::report {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::string_view kMagicOfTheFormat{"\x89MCAP0\r\n", 8};
constexpr McapSchema kThing{"test.Thing", R"({"type": "object"})"};
constexpr McapSchema kOther{"test.Other", R"({"type": "object", "title": "other"})"};

/// Reads little-endian fields one after the other.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t number(std::size_t width) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < width; ++i)
      value |= std::uint64_t{static_cast<unsigned char>(bytes_.at(at_ + i))} << (8U * i);
    at_ += width;
    return value;
  }
  std::string text() {
    const auto size = number(4);
    return std::string(take(size));
  }
  std::string_view take(std::size_t size) {
    const auto out = bytes_.substr(at_, size);
    if (out.size() != size) throw std::out_of_range("the record ends early");
    at_ += size;
    return out;
  }
  std::size_t at() const { return at_; }
  bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

struct Record {
  int op = 0;
  std::size_t begin = 0;
  std::size_t size = 0;  ///< with its op and length
  std::string_view content;
};

Record record_at(std::string_view bytes, std::size_t begin) {
  Cursor cursor(bytes.substr(begin));
  const int op = static_cast<int>(cursor.number(1));
  const std::size_t size = cursor.number(8);
  return {op, begin, 9 + size, cursor.take(size)};
}

std::vector<Record> records(std::string_view bytes) {
  std::vector<Record> list;
  for (std::size_t at = 0; at < bytes.size(); at += list.back().size)
    list.push_back(record_at(bytes, at));
  return list;
}

/// A file of two channels of one schema and one of another, in chunks of about 200 bytes.
class McapFile : public ::testing::Test {
 protected:
  void SetUp() override {
    McapWriter writer(file_, 200);
    const auto a = writer.add_channel("/a", kThing);
    const auto b = writer.add_channel("/b", kThing);
    const auto c = writer.add_channel("/c", kOther);
    for (int i = 0; i < 20; ++i) {
      writer.write(a, Stamp{1'000'000'000LL * i}, "{\"i\":" + std::to_string(i) + "}");
      if (i % 2 == 0) writer.write(b, Stamp{1'000'000'000LL * i + 5}, "{}");
    }
    writer.write(c, Stamp{7}, "{}");  // late
    writer.finish();
    bytes_ = vigia::testing::read_text(file_);
    const std::string_view all = bytes_;
    ASSERT_EQ(all.substr(0, 8), kMagicOfTheFormat);
    ASSERT_EQ(all.substr(all.size() - 8), kMagicOfTheFormat);
    records_ = records(all.substr(0, all.size() - 8).substr(8));
    for (Record& record : records_) record.begin += 8;
  }
  std::vector<Record> of(int op) const {
    std::vector<Record> found;
    std::copy_if(records_.begin(), records_.end(), std::back_inserter(found),
                 [op](const Record& record) { return record.op == op; });
    return found;
  }

  vigia::testing::TempDir dir_;
  fs::path file_ = dir_.path() / "drive.mcap";
  std::string bytes_;
  std::vector<Record> records_;
};

TEST(Crc32, IsThatOfTheStandardsExampleInOnePieceOrTwo) {
  EXPECT_EQ(crc32("123456789"), 0xcbf43926U);
  EXPECT_EQ(crc32("6789", crc32("12345")), 0xcbf43926U);
  EXPECT_EQ(crc32(""), 0U);
}

TEST_F(McapFile, BeginsWithTheHeaderAndEndsWithTheFooter) {
  EXPECT_EQ(records_.front().op, 0x01);
  EXPECT_EQ(records_.back().op, 0x02);
  EXPECT_EQ(of(0x0f).size(), 1U);
  Cursor header(records_.front().content);
  EXPECT_EQ(header.text(), "");
  EXPECT_EQ(header.text(), "vigia");
}

TEST_F(McapFile, StatesTheChecksumOfItsDataAndOfItsSummary) {
  const std::string_view all = bytes_;
  const Record data_end = of(0x0f).front();
  EXPECT_EQ(Cursor(data_end.content).number(4), crc32(all.substr(0, data_end.begin)));
  Cursor footer(records_.back().content);
  const std::size_t summary = footer.number(8);
  EXPECT_EQ(summary, data_end.begin + data_end.size);
  footer.number(8);
  const std::size_t crc_at = records_.back().begin + 9 + 16;
  EXPECT_EQ(footer.number(4), crc32(all.substr(summary, crc_at - summary)));
}

TEST_F(McapFile, RepeatsSchemasAndChannelsInItsSummary) {
  const std::size_t data_end = of(0x0f).front().begin;
  for (const auto& [op, count] : {std::pair{0x03, 2U}, std::pair{0x04, 3U}}) {
    const auto all = of(op);
    ASSERT_EQ(all.size(), 2 * count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_LT(all[i].begin, data_end);
      EXPECT_GT(all[i + count].begin, data_end);
      EXPECT_EQ(all[i].content, all[i + count].content);
    }
  }
  Cursor channel(of(0x04)[2].content);
  EXPECT_EQ(channel.number(2), 3U);
  EXPECT_EQ(channel.number(2), 2U);
  EXPECT_EQ(channel.text(), "/c");
  EXPECT_EQ(channel.text(), "json");
  Cursor schema(of(0x03)[1].content);
  EXPECT_EQ(schema.number(2), 2U);
  EXPECT_EQ(schema.text(), "test.Other");
  EXPECT_EQ(schema.text(), "jsonschema");
  EXPECT_EQ(schema.text(), kOther.text);
}

TEST_F(McapFile, ReachesEveryMessageByItsIndexes) {
  const auto chunk_indexes = of(0x08);
  ASSERT_GT(chunk_indexes.size(), 3U);
  EXPECT_EQ(chunk_indexes.size(), of(0x06).size());
  std::map<std::uint64_t, std::vector<std::uint64_t>> times;
  for (const Record& record : chunk_indexes) {
    Cursor index(record.content);
    const auto first = index.number(8);
    const auto last = index.number(8);
    const Record chunk = record_at(bytes_, index.number(8));
    EXPECT_EQ(chunk.op, 0x06);
    EXPECT_EQ(chunk.size, index.number(8));
    const std::string where = index.text();
    Cursor places(where);
    Cursor body(chunk.content);
    EXPECT_EQ(body.number(8), first);
    EXPECT_EQ(body.number(8), last);
    constexpr std::size_t kFields = 3 * 8 + 4 + 4 + 8;  // before the messages
    EXPECT_EQ(body.number(8), chunk.content.size() - kFields);
    const auto crc = body.number(4);
    EXPECT_EQ(body.text(), "");
    const std::string_view messages = body.take(body.number(8));
    EXPECT_EQ(crc, crc32(messages));
    EXPECT_TRUE(body.at_end());
    std::size_t index_bytes = 0;
    while (!places.at_end()) {
      const auto channel = places.number(2);
      const Record entries = record_at(bytes_, places.number(8));
      EXPECT_EQ(entries.op, 0x07);
      index_bytes += entries.size;
      Cursor entry(entries.content);
      EXPECT_EQ(entry.number(2), channel);
      EXPECT_EQ(entry.number(4), entries.content.size() - 6);
      while (!entry.at_end()) {
        const auto time = entry.number(8);
        const Record message = record_at(messages, entry.number(8));
        Cursor fields(message.content);
        EXPECT_EQ(message.op, 0x05);
        EXPECT_EQ(fields.number(2), channel);
        EXPECT_EQ(fields.number(4), times[channel].size());  // the channel's sequence
        EXPECT_EQ(fields.number(8), time);
        EXPECT_EQ(fields.number(8), time);
        EXPECT_LE(first, time);
        EXPECT_LE(time, last);
        times[channel].push_back(time);
      }
    }
    EXPECT_EQ(index.number(8), index_bytes);
    EXPECT_EQ(index.text(), "");
    EXPECT_EQ(index.number(8), messages.size());
    EXPECT_EQ(index.number(8), messages.size());
  }
  EXPECT_EQ(times[1].size(), 20U);
  EXPECT_EQ(times[2].size(), 10U);
  EXPECT_EQ(times[3], std::vector<std::uint64_t>{7});
}

TEST_F(McapFile, CountsItsMessages) {
  Cursor statistics(of(0x0b).front().content);
  EXPECT_EQ(statistics.number(8), 31U);
  EXPECT_EQ(statistics.number(2), 2U);
  EXPECT_EQ(statistics.number(4), 3U);
  EXPECT_EQ(statistics.number(4), 0U);
  EXPECT_EQ(statistics.number(4), 0U);
  EXPECT_EQ(statistics.number(4), of(0x06).size());
  EXPECT_EQ(statistics.number(8), 0U);
  EXPECT_EQ(statistics.number(8), 19'000'000'000U);
  EXPECT_EQ(statistics.number(4), 30U);
  for (const unsigned count : {20U, 10U, 1U}) {
    statistics.number(2);
    EXPECT_EQ(statistics.number(8), count);
  }
}

TEST_F(McapFile, LeadsToTheGroupsOfItsSummary) {
  Cursor footer(records_.back().content);
  footer.number(8);
  const auto offsets = of(0x0e);
  EXPECT_EQ(footer.number(8), offsets.front().begin);
  ASSERT_EQ(offsets.size(), 4U);
  for (const Record& record : offsets) {
    Cursor offset(record.content);
    const auto op = static_cast<int>(offset.number(1));
    const auto begin = offset.number(8);
    const auto group =
        records(std::string_view(bytes_).substr(begin, static_cast<std::size_t>(offset.number(8))));
    ASSERT_FALSE(group.empty());
    for (const Record& member : group) EXPECT_EQ(member.op, op);
  }
}

TEST(McapWriter, LeavesTheOldFileUnlessItIsFinished) {
  const vigia::testing::TempDir dir;
  const fs::path file = dir.path() / "drive.mcap";
  std::ofstream(file) << "old";
  {
    McapWriter writer(file);
    writer.write(writer.add_channel("/a", kThing), {}, "{}");
  }
  EXPECT_EQ(vigia::testing::read_text(file), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), {}), 1);
}

TEST(McapWriter, ReplacesNothingThatIsNoOrdinaryFile) {
  const vigia::testing::TempDir dir;
  const fs::path pipe = dir.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const fs::path& file : {pipe, dir.path()}) {
    try {
      const McapWriter writer(file);
      FAIL() << file;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file.string() + ": it is not an ordinary file"));
    }
  }
}

TEST(McapWriter, OfNoMessageIsAFileWithoutAChunk) {
  const vigia::testing::TempDir dir;
  const fs::path file = dir.path() / "empty.mcap";
  McapWriter(file).finish();
  const std::string bytes = vigia::testing::read_text(file);
  const auto all = records(std::string_view(bytes).substr(0, bytes.size() - 8).substr(8));
  for (const Record& record : all) EXPECT_NE(record.op, 0x06);
  EXPECT_EQ(all.back().op, 0x02);
}

}  // namespace
}  // namespace vigia::report

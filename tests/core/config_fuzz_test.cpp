#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "vigia/core/random.hpp"

// The functions of tests/fuzz, which abort when more than an InputError comes of a text.
extern "C" int fuzz_config(const std::uint8_t* data, std::size_t size);
extern "C" int fuzz_field(const std::uint8_t* data, std::size_t size);
extern "C" int fuzz_world(const std::uint8_t* data, std::size_t size);

namespace vigia {
namespace {

std::vector<std::string> read_corpus() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(VIGIA_TEST_DATA "/fuzz/config"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> corpus;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return corpus;
}

void run(const std::string& text) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(text.data());
  fuzz_config(data, text.size());
  fuzz_world(data, text.size());
  fuzz_field(data, text.size());
}

/// One edit of the kinds that break a reader: a byte of YAML's grammar, a cut, a copy, a splice.
void mutate(std::string& text, const std::vector<std::string>& corpus, RandomStream& random) {
  static const std::string grammar =
      "[]{}:,-?&*!|>'\"%@#~ \t\n\r.0123456789e+-<=\\\x01\x04\xC3\xFF";
  const std::size_t at = random.index(text.size() + 1);
  const std::size_t length = random.index(1 + std::min<std::size_t>(20, text.size() - at));
  switch (random.index(5)) {
    case 0:
      text.insert(at, 1, grammar[random.index(grammar.size())]);
      break;
    case 1:
      text.erase(at, length);
      break;
    case 2:
      text.insert(random.index(text.size() + 1), text.substr(at, length));
      break;
    case 3:
      if (at < text.size()) text[at] = grammar[random.index(grammar.size())];
      break;
    default: {
      const std::string& other = corpus[random.index(corpus.size())];
      text = text.substr(0, at) + other.substr(random.index(other.size() + 1));
      break;
    }
  }
}

TEST(ConfigFuzz, NothingButInputErrorLeavesTheReaderOnTheCorpus) {
  const auto corpus = read_corpus();
  ASSERT_FALSE(corpus.empty());
  for (const std::string& text : corpus) EXPECT_NO_THROW(run(text)) << text;
}

TEST(ConfigFuzz, NothingButInputErrorLeavesTheReaderOnMutationsOfTheCorpus) {
  const auto corpus = read_corpus();
  RandomStream random(20260101, "config fuzz");
  for (int i = 0; i < 4000; ++i) {
    std::string text = corpus[random.index(corpus.size())];
    const std::size_t edits = 1 + random.index(6);
    for (std::size_t k = 0; k < edits; ++k) mutate(text, corpus, random);
    ASSERT_NO_THROW(run(text)) << text;
  }
}

}  // namespace
}  // namespace vigia

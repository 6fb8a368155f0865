#include "vigia/mission/event.hpp"

#include <set>

#include <gtest/gtest.h>

namespace vigia::mission {
namespace {

TEST(Events, HaveAWordOfTheirOwnForEachKind) {
  std::set<std::string_view> words;
  for (int kind = 0; kind <= static_cast<int>(EventKind::stuck); ++kind) {
    const std::string_view word = to_string(static_cast<EventKind>(kind));
    EXPECT_FALSE(word.empty()) << kind;
    EXPECT_TRUE(words.insert(word).second) << word;
  }
}

}  // namespace
}  // namespace vigia::mission

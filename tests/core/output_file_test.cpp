#include "vigia/core/output_file.hpp"

#include "config_files.hpp"

#include <cstdio>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "vigia/core/error.hpp"
#include "vigia/core/shell.hpp"

namespace vigia {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SharedFile : public ConfigFiles {};

TEST_F(SharedFile, IsWrittenAsideUnderANameThatNoOtherHas) {
  const std::string suffix = own_part_suffix();
  EXPECT_THAT(suffix, HasSubstr(".part-"));
  EXPECT_NE(own_part_suffix(), suffix);
  EXPECT_EQ(suffix.find('/'), std::string::npos);
}

TEST_F(SharedFile, TakesThePlaceOfAnEarlierOneAndLeavesNothingAside) {
  const fs::path file = path("a.json");
  write_shared_file(file, "earlier");
  write_shared_file(file, "later");
  std::ifstream stream(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "later");
  EXPECT_EQ(std::distance(fs::directory_iterator(path("")), fs::directory_iterator()), 1);
}

TEST_F(SharedFile, DoesNotTakeThePlaceOfWhatIsNoOrdinaryFile) {
  const fs::path pipe = path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const auto& write : {write_file, write_shared_file}) {
    try {
      write(pipe, "bytes");
      FAIL() << "it was written";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("not an ordinary file"));
    }
  }
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(SharedFile, NamesTheFileThatCannotBeWritten) {
  try {
    write_shared_file(path("absent/a.json"), "text");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent/a.json.part-"));
    EXPECT_THAT(error.what(), HasSubstr("No such file or directory"));
  }
}

/// What a shell makes of a word.
std::string echoed(const std::string& word) {
  std::FILE* pipe = ::popen(("printf %s " + word).c_str(), "r");
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  ::pclose(pipe);
  return text;
}

TEST(ShellWord, ComesBackFromAShellAsItWas) {
  for (const char* text : {"plain-1.2/x=y", "", "it's a \"b\" $(c) `d` \\ *", "two\nlines"})
    EXPECT_EQ(echoed(shell_word(text)), text);
  EXPECT_EQ(shell_word("plain-1.2/x=y"), "plain-1.2/x=y");
}

}  // namespace
}  // namespace vigia

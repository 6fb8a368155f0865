#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vigia {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A run folder of a mission that ends after two seconds.
class ARunFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto made = vigia("run " VIGIA_SOURCE_DIR
                            "/config/missions/armingol-room.yaml --no-pictures --quiet --set "
                            "timeout_s=2 --out " +
                            folder_.string());
    ASSERT_EQ(made.status, 1) << made.err;
  }
  vigia::testing::ProcessResult vigia(const std::string& arguments) const {
    return vigia::testing::run_process(std::string(VIGIA_PROGRAM) + " " + arguments, dir_.path());
  }
  vigia::testing::ProcessResult export_to(const fs::path& file,
                                          const std::string& more = "") const {
    return vigia("export " + folder_.string() + " --mcap " + file.string() + " " + more);
  }
  /// How many files stand beside the run folder and what the test's processes said.
  bool left_anything(const fs::path& in) const {
    for (const auto& entry : fs::directory_iterator(in))
      if (entry.path().extension() == ".mcap" || entry.path().extension() == ".part") return true;
    return false;
  }

  vigia::testing::TempDir dir_;
  fs::path folder_ = dir_.path() / "run";
};

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t n = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

TEST_F(ARunFolder, IsExportedWithEveryTicksPoseAndFivePicturesASecond) {
  const fs::path file = dir_.path() / "drive.mcap";
  const auto result = export_to(file);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, file.string() + "\n");
  const std::string bytes = vigia::testing::read_text(file);
  EXPECT_THAT(bytes, StartsWith("\x89MCAP0\r\n"));
  EXPECT_EQ(count(bytes, "\"format\":\"jpeg\""), 10U);
  EXPECT_EQ(count(bytes, "\"body_frame_id\":\"ekf\""), 50U);  // one in every tick of 40 ms
  EXPECT_EQ(export_to(dir_.path() / "again.mcap").status, 0);
  EXPECT_EQ(vigia::testing::read_text(dir_.path() / "again.mcap"), bytes);
}

TEST_F(ARunFolder, IsExportedWithoutPicturesWhereNoneAreWanted) {
  const fs::path file = dir_.path() / "drive.mcap";
  EXPECT_EQ(export_to(file, "--images-hz 0").status, 0);
  EXPECT_EQ(count(vigia::testing::read_text(file), "jpeg\""), 0U);
  for (const char* wrong : {"-1", "nan"}) {
    const auto result = export_to(file, std::string("--images-hz ") + wrong);
    EXPECT_EQ(result.status, 2);
    EXPECT_THAT(result.err, HasSubstr("--images-hz"));
  }
}

TEST_F(ARunFolder, ThatIsHostileOrCutOffIsNamedAndLeavesNoFile) {
  const fs::path mission = folder_ / "mission.yaml";
  const std::string whole = vigia::testing::read_text(mission);
  struct Fault {
    std::string text;
    std::string message;
  };
  for (const Fault& fault :
       {Fault{whole.substr(0, whole.find("\nlocalization") + 6), "mission.yaml"},
        Fault{std::string(17U << 20U, '#'), "larger than 16 MB"}, Fault{"", "mission.yaml"},
        Fault{"name: '<script>alert(1)</script>'\nversion: 1\n", "mission.yaml"}}) {
    std::ofstream(mission, std::ios::trunc) << fault.text;
    const auto result = export_to(dir_.path() / "drive.mcap");
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(fault.message));
    EXPECT_FALSE(left_anything(dir_.path()));
  }
  fs::remove(mission);
  EXPECT_THAT(export_to(dir_.path() / "drive.mcap").err, HasSubstr("is no run folder"));
  EXPECT_FALSE(left_anything(dir_.path()));
}

TEST_F(ARunFolder, IsNotExportedWhereNoFileCanBeWritten) {
  const auto nowhere = export_to(dir_.path() / "no/such/drive.mcap");
  EXPECT_EQ(nowhere.status, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("No such file or directory"));
  // A limit of the file's size is an error of the write, as a full disk is.
  const auto full =
      vigia::testing::run_process("ulimit -f 100; " VIGIA_PROGRAM " export " + folder_.string() +
                                      " --mcap " + (dir_.path() / "drive.mcap").string(),
                                  dir_.path());
  EXPECT_EQ(full.status, 2) << full.err;
  EXPECT_THAT(full.err, HasSubstr("cannot write"));
  EXPECT_FALSE(left_anything(dir_.path()));
}

}  // namespace
}  // namespace vigia

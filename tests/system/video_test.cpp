#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/videoio.hpp>

namespace vigia {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A mission that ends after a second, with what its video holds.
class RunWithVideo : public ::testing::Test {
 protected:
  vigia::testing::ProcessResult run(const std::string& mission, const std::string& more) const {
    return vigia::testing::run_process(
        std::string(VIGIA_PROGRAM) + " run " VIGIA_SOURCE_DIR "/config/missions/" + mission +
            ".yaml --no-pictures --quiet --set timeout_s=1 --out " + folder_.string() + " " + more,
        dir_.path());
  }
  std::string text(const std::string& name) const {
    return vigia::testing::read_text(folder_ / name);
  }

  vigia::testing::TempDir dir_;
  fs::path folder_ = dir_.path() / "run";
};

TEST_F(RunWithVideo, HasAPictureForEveryTickAndLastsAsLongAsTheMission) {
  // The stereo pair's pictures, 320 wide, stand side by side.
  for (const auto& [mission, width] :
       {std::pair{"armingol-room", 640}, std::pair{"mirosot", 640}}) {
    const auto result = run(mission, "--video");
    ASSERT_EQ(result.status, 1) << result.err;
    cv::VideoCapture video((folder_ / "camera.mp4").string());
    ASSERT_TRUE(video.isOpened());
    const std::string ticks = text("ticks.csv");
    int pictures = 0;
    cv::Mat picture;
    while (video.read(picture)) ++pictures;
    EXPECT_EQ(pictures, std::count(ticks.begin(), ticks.end(), '\n') - 1) << mission;
    const double sim_s = nlohmann::json::parse(text("summary.json"))["sim_s"];
    EXPECT_NEAR(pictures / video.get(cv::CAP_PROP_FPS), sim_s, 1e-3) << mission;
    EXPECT_EQ(video.get(cv::CAP_PROP_FRAME_WIDTH), width);
  }
}

TEST_F(RunWithVideo, IsTheSameMissionAsWithout) {
  ASSERT_EQ(run("armingol-room", "--video").status, 1);
  const std::string with = text("ticks.csv");
  ASSERT_EQ(run("armingol-room", "").status, 1);
  EXPECT_EQ(text("ticks.csv"), with);
  EXPECT_FALSE(fs::exists(folder_ / "camera.mp4"));
}

TEST_F(RunWithVideo, ThatTheDiskDoesNotHoldIsAnErrorAndLeavesNothing) {
  const auto result =
      vigia::testing::run_process("ulimit -f 40; " VIGIA_PROGRAM " run " VIGIA_SOURCE_DIR
                                  "/config/missions/armingol-room.yaml --video --no-pictures "
                                  "--quiet --set timeout_s=1.2 --out " +
                                      folder_.string(),
                                  dir_.path());
  EXPECT_EQ(result.status, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr("cannot write"));
  EXPECT_FALSE(fs::exists(folder_));
}

// Debian's Cairo and OpenCV need libX11 themselves; what opens windows and videos does not come.
TEST_F(RunWithVideo, LoadsNoLibraryOfWindowsAndVideosUnlessItIsAskedTo) {
  const auto loaded = [this](const std::string& more) {
    return vigia::testing::run_process(
               "env -u DISPLAY LD_DEBUG=files " VIGIA_PROGRAM " run " VIGIA_SOURCE_DIR
               "/config/missions/armingol-room.yaml --no-pictures --quiet --set timeout_s=1 "
               "--out " +
                   folder_.string() + more,
               dir_.path())
        .err;
  };
  const auto names = [](const std::string& text, const char* library) {
    return text.find(library) != std::string::npos;
  };
  const std::string plain = loaded("");
  const std::string viewed = loaded(" --view=fast");
  for (const char* library : {"libvisp_gui", "libavcodec", "vigia_media"}) {
    EXPECT_FALSE(names(plain, library)) << library;
    EXPECT_TRUE(names(viewed, library)) << library;
  }
}

TEST_F(RunWithVideo, GoesOnWithoutADisplay) {
  const auto result = vigia::testing::run_process(
      "env -u DISPLAY " VIGIA_PROGRAM " run " VIGIA_SOURCE_DIR
      "/config/missions/armingol-room.yaml --no-pictures --quiet --view=fast --set timeout_s=1 "
      "--out " +
          folder_.string(),
      dir_.path());
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.err, HasSubstr("no X display can be opened; the mission goes on"));
  EXPECT_TRUE(fs::exists(folder_ / "summary.json"));
}

TEST_F(RunWithVideo, KnowsTwoPacesOfAView) {
  const auto result = run("armingol-room", "--view=slow");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("--view"));
}

}  // namespace
}  // namespace vigia

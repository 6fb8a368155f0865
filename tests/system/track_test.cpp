#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vigia {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A grey picture of a dark disc, antialiased, as a binary PGM.
std::string disc_picture(double u, double v, double radius, int width = 160, int height = 120) {
  std::string pgm = "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  constexpr int kFine = 4;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      int inside = 0;
      for (int i = 0; i < kFine * kFine; ++i) {
        const double du = x + (i % kFine + 0.5) / kFine - 0.5 - u;
        const double dv = y + (i / kFine + 0.5) / kFine - 0.5 - v;
        inside += du * du + dv * dv < radius * radius ? 1 : 0;
      }
      pgm += static_cast<char>(200 - 150 * inside / (kFine * kFine));
    }
  return pgm;
}

std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

const std::string kCameraXml =
    "<root><camera><name>c</name><image_width>160</image_width><image_height>120</image_height>"
    "<model><type>perspectiveProjWithoutDistortion</type><px>400</px><py>400</py><u0>79.5</u0>"
    "<v0>59.5</v0></model></camera></root>";

class Track : public ::testing::Test {
 protected:
  vigia::testing::ProcessResult vigia(const std::string& arguments) const {
    return vigia::testing::run_process(std::string(VIGIA_PROGRAM) + " " + arguments, dir_.path());
  }
  fs::path file(const std::string& name, const std::string& text) const {
    std::ofstream(dir_.path() / name, std::ios::binary) << text;
    return dir_.path() / name;
  }
  vigia::testing::TempDir dir_;
};

const std::string kPictures = "/usr/share/visp-images-data/ViSP-images";

TEST_F(Track, TracksTheThirtySixCirclesOfAPicture) {
  if (!fs::exists(kPictures)) GTEST_SKIP() << "visp-images-data is not installed";
  const auto result = vigia("track " + kPictures + "/calibration/grid36-01.pgm --quiet --out " +
                            (dir_.path() / "tracks").string());
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 37);
  EXPECT_EQ(vigia::testing::read_text(dir_.path() / "tracks/track.csv"), result.out);
  EXPECT_TRUE(fs::exists(dir_.path() / "tracks/overlay/00001_grid36-01.png"));
}

TEST_F(Track, TracksTheTagsOfAPicture) {
  const std::string file = kPictures + "/AprilTag/benchmark/640x480/tag36_11_640x480.png";
  if (!fs::exists(file)) GTEST_SKIP() << "visp-images-data is not installed";
  const auto result =
      vigia("track --tracker tag " + file + " --quiet --out " + (dir_.path() / "tags").string());
  EXPECT_EQ(result.status, 0) << result.err;
  // Five tags of four corners, and the header.
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 21);
  EXPECT_EQ(vigia::testing::read_text(dir_.path() / "tags/track.csv"), result.out);
}

TEST_F(Track, RejectsATruncatedPictureAndLeavesNoFolder) {
  if (!fs::exists(kPictures)) GTEST_SKIP() << "visp-images-data is not installed";
  const std::string whole = vigia::testing::read_text(kPictures + "/calibration/grid36-01.pgm");
  const auto cut = file("cut.pgm", whole.substr(0, whole.size() / 2));
  const auto result =
      vigia("track " + cut.string() + " --out " + (dir_.path() / "tracks").string());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("cut.pgm"));
  EXPECT_EQ(result.out, "");
  EXPECT_FALSE(fs::exists(dir_.path() / "tracks"));
}

TEST_F(Track, RejectsAFolderWithoutPictures) {
  fs::create_directory(dir_.path() / "empty");
  const auto result = vigia("track " + (dir_.path() / "empty").string());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("no pictures"));
}

TEST_F(Track, FollowsADiscThroughNumberedFilesInTheirOrder) {
  for (int k = 0; k < 4; ++k)
    file("f000" + std::to_string(k) + ".pgm", disc_picture(40.0 + 6.0 * k, 60.0, 14.0));
  const auto result = vigia("track --quiet " + (dir_.path() / "f%04d.pgm").string());
  EXPECT_EQ(result.status, 0) << result.err;
  const auto rows = cells_of(result.out);
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_THAT(result.out, StartsWith("image,frame,time_s,target,status,u,v,a,b,psi_deg,sigma_u"));
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(rows[k + 1][1], std::to_string(k + 1));
    EXPECT_EQ(rows[k + 1][3], "1");
    EXPECT_NEAR(std::stod(rows[k + 1][5]), 40.0 + 6.0 * static_cast<double>(k), 0.05);
  }
}

TEST_F(Track, ReadsPicturesFromItsInput) {
  const auto pictures =
      file("two.pgms", disc_picture(40.0, 60.0, 14.0) + disc_picture(44.0, 60.0, 14.0));
  const auto result = vigia("track --quiet - < " + pictures.string());
  EXPECT_EQ(result.status, 0) << result.err;
  const auto rows = cells_of(result.out);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[2][0], "stdin#2");
  EXPECT_EQ(rows[2][3], "1");
}

TEST_F(Track, WhatWasReadBeforeABadPictureStays) {
  file("a1.pgm", disc_picture(40.0, 60.0, 14.0));
  file("a2.pgm", disc_picture(40.0, 60.0, 14.0).substr(0, 300));
  const auto out = dir_.path() / "tracks";
  const auto result =
      vigia("track " + (dir_.path() / "a%d.pgm").string() + " --out " + out.string());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("a2.pgm: this picture ends early"));
  EXPECT_EQ(cells_of(result.out).size(), 2U);
  EXPECT_EQ(vigia::testing::read_text(out / "track.csv"), result.out);
}

TEST_F(Track, RowsComeWithTheirPicturesAndAnInterruptionKeepsThem) {
  const auto pipe = (dir_.path() / "pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto table = (dir_.path() / "table.csv").string();
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const std::string command = "exec " + std::string(VIGIA_PROGRAM) + " track --quiet - < " +
                                pipe + " > " + table + " 2>/dev/null";
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }
  std::ofstream stream(pipe, std::ios::binary);
  stream << disc_picture(40.0, 60.0, 14.0) << std::flush;
  // The input stays open: the row is there all the same.
  for (int wait = 0; wait < 600 && cells_of(vigia::testing::read_text(table)).size() < 2; ++wait)
    ::usleep(50000);
  EXPECT_EQ(cells_of(vigia::testing::read_text(table)).size(), 2U);
  ::kill(child, SIGINT);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(cells_of(vigia::testing::read_text(table)).size(), 2U);
}

TEST_F(Track, ACalibratedCameraGivesThePoseOfADisc) {
  const auto picture = file("disc.pgm", disc_picture(79.5, 59.5, 20.0));
  const auto camera = file("camera.xml", kCameraXml);
  const auto result = vigia("track --quiet " + picture.string() + " --camera " + camera.string() +
                            " --size 0.2 --out " + (dir_.path() / "out").string());
  EXPECT_EQ(result.status, 0) << result.err;
  const auto rows = cells_of(result.out);
  ASSERT_GE(rows.size(), 2U);
  EXPECT_THAT(result.out, StartsWith("image,frame,time_s,target,code,solution,pose_status,x_m"));
  // 0.1 m seen as 20 px at 400 px.
  EXPECT_NEAR(std::stod(rows[1][7]), 0.0, 0.002);
  EXPECT_NEAR(std::stod(rows[1][9]), 2.0, 0.02);
  EXPECT_EQ(rows[1].size(), 13U + 21U);
  EXPECT_EQ(vigia::testing::read_text(dir_.path() / "out/poses.csv"), result.out);
  EXPECT_EQ(cells_of(vigia::testing::read_text(dir_.path() / "out/track.csv")).size(), 2U);
}

TEST_F(Track, SaysWhenAPictureShowsFewerThanAreExpected) {
  const auto picture = file("disc.pgm", disc_picture(40.0, 60.0, 14.0));
  EXPECT_EQ(vigia("track --quiet --expect 1 " + picture.string()).status, 0);
  EXPECT_EQ(vigia("track --quiet --expect 2 " + picture.string()).status, 1);
}

TEST_F(Track, PicturesOfAnotherSizeThanTheCamerasAreRefused) {
  const auto picture = file("disc.pgm", disc_picture(40.0, 60.0, 14.0, 100, 120));
  const auto camera = file("camera.xml", kCameraXml);
  const auto result =
      vigia("track " + picture.string() + " --size 0.2 --camera " + camera.string());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("100×120 pixels, but --camera is calibrated for 160×120"));
}

TEST_F(Track, MistakesOfTheCommandAreNamed) {
  const std::string picture = file("disc.pgm", disc_picture(40.0, 60.0, 14.0)).string();
  const std::string camera = file("camera.xml", kCameraXml).string();
  const std::string wrong = file("wrong.xml", "<root><camera></root>").string();
  const struct {
    std::string arguments;
    const char* message;
  } cases[] = {
      {picture + " --radius-px 9:3", "--radius-px: found '9:3', must be MIN:MAX"},
      {picture + " --radius-px 9", "--radius-px: found '9'"},
      {picture + " --radius-px 1:9", "3 ≤ MIN"},
      {picture + " --radius-px a:b", "--radius-px"},
      {picture + " --ids 3", "--ids: discs have no codes"},
      {picture + " --tracker tag --ids x", "--ids: found 'x', must be the number of a tag"},
      {picture + " --tracker pattern --ids 1-2", "must be FLOOR-ROOM-PATTERN"},
      {picture + " --mirror 80,60,10,50", "--mirror and --panorama: are for --tracker field_scan"},
      {picture + " --tracker field_scan --mirror 80,60,10",
       "--mirror: found '80,60,10', must be U,V,INNER,OUTER"},
      {picture + " --tracker field_scan --ids 3", "a field has no --ids"},
      {picture + " --tracker field_scan --panorama", "--panorama: needs --out DIR"},
      {picture + " --tracker ceiling", "how large are the patches in the pictures?"},
      {picture + " --tracker ceiling --patch-px 20",
       "--patch-px: found '20', must be LENGTH:WIDTH"},
      {picture + " --tracker ceiling --patch-px 20:18", "1.5 WIDTH ≤ LENGTH"},
      {picture + " --tracker ceiling --patch-px 20:7 --rise-m 2", "only with --camera"},
      {picture + " --tracker ceiling --camera " + camera, "Give --rise-m H"},
      {picture + " --tracker ceiling --ids 3", "patches have no --ids"},
      {picture + " --tracker ceiling --rise-m 2 --placement 1:2 --camera " + camera,
       "--placement: found '1:2', must be METRES:DEGREES"},
      {picture + " --tracker ceiling --rise-m 2 --pitch-m 0.05 --camera " + camera,
       "--pitch-m 0.05: patches of 0.09 m would not lie apart"},
      {picture + " --patch-px 20:7", "are for --tracker ceiling"},
      {picture + " --camera " + camera, "--camera: how large are the landmarks?"},
      {picture + " --size 0.2", "only with --camera"},
      {picture + " --size 0.2 --camera /nowhere.xml", "/nowhere.xml: the file does not exist"},
      {picture + " --size 0.2 --camera " + wrong, "wrong.xml:1:15: found </root>"},
      {"ftp://user:secret@host/x", "ftp://host/x: a camera's address begins with"},
      {"'rtsp://user:secret@host/!x'", "path and query"},
      {(dir_.path() / "g%04d.png").string(), "no file has such a name"},
      {(dir_.path() / "g%s.png").string(), "one %d or %0Nd"},
      {"/dev/video987", "/dev/video987: no camera that can be opened"},
      {(dir_.path() / "none.mp4").string(), "none.mp4"},
  };
  for (const auto& wrong_use : cases) {
    const auto given = vigia("track " + wrong_use.arguments);
    EXPECT_EQ(given.status, 2) << wrong_use.arguments;
    EXPECT_THAT(given.err, HasSubstr(wrong_use.message)) << wrong_use.arguments;
    EXPECT_THAT(given.err, Not(HasSubstr("secret")));
    EXPECT_EQ(given.out, "") << wrong_use.arguments;
  }
}

/// A plain strip of 24 × 8 px about (u, v), its axis at @p angle, antialiased.
std::string strip_picture(double u, double v, double angle) {
  constexpr int kFine = 4;
  std::string pgm = "P5\n160 120\n255\n";
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      int inside = 0;
      for (int i = 0; i < kFine * kFine; ++i) {
        const double du = x + (i % kFine + 0.5) / kFine - 0.5 - u;
        const double dv = y + (i / kFine + 0.5) / kFine - 0.5 - v;
        const double along = du * std::cos(angle) + dv * std::sin(angle);
        const double across = dv * std::cos(angle) - du * std::sin(angle);
        inside += std::abs(along) < 12.0 && std::abs(across) < 4.0 ? 1 : 0;
      }
      pgm += static_cast<char>(200 - 140 * inside / (kFine * kFine));
    }
  return pgm;
}

TEST_F(Track, APatchOfACeilingIsAPlaceADirectionAndUnderAKnownCameraAPose) {
  const auto camera = file("camera.xml", kCameraXml);
  const auto one = file("one.pgm", strip_picture(70.25, 50.5, 0.2));
  const auto two = file("two.pgm", strip_picture(74.25, 50.5, 0.2));
  const auto found = vigia("track --tracker ceiling --plain --patch-px 24:8 " + one.string());
  ASSERT_EQ(found.status, 0) << found.err;
  const auto rows = cells_of(found.out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0][5], "u");
  EXPECT_NEAR(std::stod(rows[1][5]), 70.25, 0.05);
  EXPECT_NEAR(std::stod(rows[1][6]), 50.5, 0.05);
  EXPECT_NEAR(std::stod(rows[1][7]), 0.2 * 180.0 / 3.14159265, 0.5);
  // 0.09 m are 24 px of a lens of 400 px at 1.5 m: 4 px are 15 mm.
  const auto posed = vigia("track --tracker ceiling --plain --rise-m 1.5 --camera " +
                           camera.string() + " " + one.string() + " " + two.string());
  ASSERT_EQ(posed.status, 0) << posed.err;
  const auto poses = cells_of(posed.out);
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0][5], "x_m");
  const double dx = std::stod(poses[2][5]) - std::stod(poses[1][5]);
  const double dy = std::stod(poses[2][6]) - std::stod(poses[1][6]);
  EXPECT_NEAR(std::hypot(dx, dy), 0.015, 0.001);
  EXPECT_NEAR(std::stod(poses[1][7]), -0.2 * 180.0 / 3.14159265, 0.5);
}

TEST_F(Track, TooFewPatchesCalibrateNothing) {
  const auto camera = file("camera.xml", kCameraXml);
  const auto one = file("one.pgm", strip_picture(70.25, 50.5, 0.2));
  const std::string command = "calibrate ceiling --plain --camera " + camera.string() + " ";
  const auto result = vigia(command + "--rise-m 1.5 " + one.string());
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("not calibrated: 1 pictures with patches that agree"));
  EXPECT_EQ(vigia(command + one.string()).status, 2);
  const auto other = file("other.pgm", disc_picture(40.0, 60.0, 14.0, 100, 120));
  const auto wrong = vigia(command + "--rise-m 1.5 " + other.string());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("100×120 pixels, but --camera is calibrated for 160×120"));
}

TEST_F(Track, WithoutADisplayAWindowIsAnError) {
  const auto picture = file("disc.pgm", disc_picture(40.0, 60.0, 14.0));
  const auto result = vigia::testing::run_process(
      "env -u DISPLAY " + std::string(VIGIA_PROGRAM) + " track --view " + picture.string(),
      dir_.path());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("--view: no X display"));
}

TEST_F(Track, ALandmarkIsPrintedAsLargeAsThePaperTakesIt) {
  const auto print = dir_.path() / "tag.pdf";
  const auto result = vigia("landmark tag --id 5 --paper a4 -o " + print.string());
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("210 × 297 mm"));
  EXPECT_TRUE(fs::exists(print));
  EXPECT_EQ(vigia("landmark tag --id 5 --paper a7 -o " + print.string()).status, 2);
}

}  // namespace
}  // namespace vigia

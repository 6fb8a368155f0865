#include "vigia/report/map_picture.hpp"

#include "drive_layer.hpp"
#include "synthetic_drive.hpp"
#include "travel.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::report {
namespace {

using test::synthetic_drive;
using test::synthetic_world;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class MapPicture : public ::testing::Test {
 public:
  MapPicture() {
    std::string name = (std::filesystem::temp_directory_path() / "vigia-report-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
    folder_ = name;
  }
  ~MapPicture() override { std::filesystem::remove_all(folder_); }

 protected:
  std::string message_of_drawing(const MapDrive& drive, const std::filesystem::path& file) {
    try {
      draw_map(drive, file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
  WorldMap world_ = synthetic_world();
  MapDrive drive_ = synthetic_drive(world_);
};

// The colours of the pixels, each once.
std::set<unsigned> colours_of(const std::filesystem::path& file) {
  const vpImage<vpRGBa> image = imaging::colour_image(imaging::read_image(file));
  std::set<unsigned> colours;
  for (unsigned i = 0; i < image.getSize(); ++i) {
    const vpRGBa& p = image.bitmap[i];
    colours.insert((unsigned{p.R} << 16U) | (unsigned{p.G} << 8U) | p.B);
  }
  return colours;
}

TEST_F(MapPicture, ShowsEstimateOdometryLandmarksAndWallsInTheirColours) {
  draw_map(drive_, folder_ / "map.png");
  const std::set<unsigned> colours = colours_of(folder_ / "map.png");
  for (const unsigned colour :
       {0x0072b2U, 0xd55e00U, 0x009e73U, 0xcc79a7U, 0xe69f00U, 0x56b4e9U, 0x222222U, 0xffffffU})
    EXPECT_EQ(colours.count(colour), 1U) << std::hex << colour;
}

TEST_F(MapPicture, IsSixteenHundredPixelsWide) {
  draw_map(drive_, folder_ / "map.png");
  EXPECT_EQ(imaging::read_image(folder_ / "map.png").width(), 1600);
}

TEST_F(MapPicture, SameDriveGivesTheSameBytesInEveryFormat) {
  for (const std::string ending : {".png", ".svg", ".pdf"}) {
    draw_map(drive_, folder_ / ("first" + ending));
    draw_map(drive_, folder_ / ("second" + ending));
    EXPECT_TRUE(bytes_of(folder_ / ("first" + ending)) == bytes_of(folder_ / ("second" + ending)))
        << ending;
  }
}

TEST_F(MapPicture, EndingChoosesTheFormat) {
  draw_map(drive_, folder_ / "map.svg");
  draw_map(drive_, folder_ / "map.pdf");
  draw_map(drive_, folder_ / "map.png");
  EXPECT_THAT(bytes_of(folder_ / "map.svg"), StartsWith("<?xml"));
  EXPECT_THAT(bytes_of(folder_ / "map.pdf"), StartsWith("%PDF"));
  EXPECT_THAT(bytes_of(folder_ / "map.png"), StartsWith("\x89PNG"));
}

TEST_F(MapPicture, UnknownEndingIsAnErrorThatNamesTheKnownOnes) {
  const std::string message = message_of_drawing(drive_, folder_ / "map.bmp");
  EXPECT_THAT(message, HasSubstr("map.bmp: a picture's name ends in .png, .svg or .pdf"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(MapPicture, MissingFolderIsAnErrorThatNamesThePath) {
  const std::string message = message_of_drawing(drive_, folder_ / "absent" / "map.png");
  EXPECT_THAT(message, HasSubstr("absent/map.png.part: No such file or directory"));
}

TEST_F(MapPicture, PathBelowARegularFileIsAnError) {
  std::ofstream(folder_ / "file") << "text";
  const std::string message = message_of_drawing(drive_, folder_ / "file" / "map.png");
  EXPECT_THAT(message, HasSubstr("file/map.png.part: Not a directory"));
}

TEST_F(MapPicture, FailedWriteLeavesNothingBehind) {
  std::filesystem::create_directory(folder_ / "map.png");
  std::ofstream(folder_ / "map.png" / "inside") << "text";
  EXPECT_THAT(message_of_drawing(drive_, folder_ / "map.png"), HasSubstr("cannot write"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "map.png.part"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "map.png" / "inside"));
}

TEST_F(MapPicture, FullDiskIsAnError) {
  std::filesystem::create_symlink("/dev/full", folder_ / "map.png.part");
  EXPECT_THAT(message_of_drawing(drive_, folder_ / "map.png"),
              HasSubstr("map.png.part: No space left on device"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "map.png"));
}

TEST_F(MapPicture, WorldAloneIsAPicture) {
  draw_map(MapDrive{world_}, folder_ / "map.png");
  EXPECT_GT(imaging::read_image(folder_ / "map.png").height(), 900);
}

TEST_F(MapPicture, DifferentLengthsAreRefused) {
  drive_.odometry.pop_back();
  EXPECT_THROW(draw_map(drive_, folder_ / "map.png"), std::invalid_argument);
}

TEST_F(MapPicture, JumpsAndMarksBeyondTheDriveAreRefused) {
  const std::size_t beyond = drive_.truth.size();
  drive_.jumps = {beyond};
  EXPECT_THROW(draw_map(drive_, folder_ / "map.png"), std::invalid_argument);
  drive_.jumps = {};
  drive_.marks = {{beyond, "lost", true}};
  EXPECT_THROW(draw_map(drive_, folder_ / "map.png"), std::invalid_argument);
}

TEST_F(MapPicture, MarksAndJumpsChangeThePicture) {
  draw_map(drive_, folder_ / "plain.png");
  drive_.marks = {{300, "lost 12 s", true}};
  draw_map(drive_, folder_ / "marked.png");
  drive_.jumps = {300};
  draw_map(drive_, folder_ / "kidnapped.png");
  EXPECT_NE(bytes_of(folder_ / "plain.png"), bytes_of(folder_ / "marked.png"));
  EXPECT_NE(bytes_of(folder_ / "marked.png"), bytes_of(folder_ / "kidnapped.png"));
}

TEST(Travel, ARobotThatIsPutElsewhereHasNotDrivenThere) {
  const WorldMap world = synthetic_world();
  MapDrive drive{world};
  drive.truth = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {5.0, 3.0, 0.0}, {5.0, 4.0, 0.0}};
  EXPECT_THAT(travelled_m(drive), ::testing::ElementsAre(0.0, 1.0, 6.0, 7.0));
  drive.jumps = {2};
  EXPECT_THAT(travelled_m(drive), ::testing::ElementsAre(0.0, 1.0, 1.0, 2.0));
}

TEST(Travel, ALineIsCutAtItsJumps) {
  const std::vector<Eigen::Vector2d> points{{0.0, 0.0}, {0.1, 0.0}, {4.0, 0.0}, {4.1, 0.0}};
  for (const CutLine& line : {cut_at(points, {2}), cut_where_far(points)}) {
    ASSERT_EQ(line.pieces.size(), 2U);
    EXPECT_THAT(line.pieces[1], ::testing::ElementsAre(points[2], points[3]));
    ASSERT_EQ(line.jumps.size(), 1U);
    EXPECT_EQ(line.jumps[0], std::make_pair(points[1], points[2]));
  }
}

TEST_F(MapPicture, StatedEllipseScaleIsKeptAndAMissingOneIsChosen) {
  drive_.ellipse_scale = 7.0;
  EXPECT_EQ(ellipse_scale(drive_), 7.0);
  drive_.ellipse_scale = 0.0;
  for (MapPose& at : drive_.estimate) at.covariance = 1e-6 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(ellipse_scale(drive_), 50.0);
  for (MapPose& at : drive_.estimate) at.covariance = Eigen::Matrix3d::Identity();
  EXPECT_EQ(ellipse_scale(drive_), 1.0);
}

TEST(EllipseOutline, LiesAtTheAskedMahalanobisDistance) {
  Eigen::Matrix2d covariance;
  covariance << 4.0, 1.2, 1.2, 1.0;
  const Eigen::Vector2d centre(2.0, -1.0);
  for (const Eigen::Vector2d& p : ellipse_outline(centre, covariance, 3.0))
    EXPECT_NEAR((p - centre).dot(covariance.inverse() * (p - centre)), 9.0, 1e-9);
}

TEST(LookInstants, FollowTheOrderOfTheLooksWhereTheDriveCrossesItself) {
  const std::vector<Pose2> truth{
      {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {1.0, 0.1, 0.0}, {0.0, 0.0, 0.0}};
  const std::vector<MapLook> looks{{0, {2.0, 0.0}, true}, {1, {1.0, 0.0}, true}};
  EXPECT_THAT(look_instants(truth, looks), ::testing::ElementsAre(2U, 3U));
}

}  // namespace
}  // namespace vigia::report

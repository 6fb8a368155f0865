#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/mission/setup.hpp"
#include "vigia/perception/eye.hpp"

namespace vigia::perception {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A robot that stands 2.4 m before the disc 0 of Armingol's room and sees it in the middle.
class LandmarkEyeTest : public ::testing::Test {
 protected:
  LandmarkEyeTest()
      : simulator_(setup_.robot, setup_.world, setup_.appearance, pose_, 1),
        frame_((simulator_.advance(Duration{40'000'000}), simulator_.expose())) {
    const HeadReading head = simulator_.robot().read_head();
    shot_.stamp = simulator_.robot().truth().stamp;
    shot_.model = setup_.robot.zoom().at(head.zoom_mm);
    shot_.head = head.angles;
    shot_.zoom_mm = head.zoom_mm;
    belief_.stamp = shot_.stamp;
    belief_.pose = pose_;
    belief_.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  }

  std::unique_ptr<Eye> eye(bool directed) const {
    EyeParts parts{setup_.world.landmarks, setup_.on_ground(), setup_.noise.sensor};
    parts.directed = directed;
    return find_name(eyes(), "landmark")->make(parts);
  }
  std::vector<Observation> observe(Eye& eye, const std::optional<GazeRequest>& request) const {
    return eye.observe({*frame_, shot_}, belief_, request);
  }

  mission::MissionSetup setup_ =
      mission::load_mission(std::string(VIGIA_SOURCE_DIR) + "/config/missions/armingol-room.yaml");
  Pose2 pose_{1.0, 3.2, 0.0};
  sim::Simulator simulator_;
  std::unique_ptr<imaging::Frame> frame_;
  Shot shot_;
  Belief belief_;
};

std::string cells(const Eye& eye) {
  std::string line;
  eye.append_cells(line);
  return line;
}

TEST_F(LandmarkEyeTest, DirectedItObservesNothingUnlessItIsAsked) {
  const auto directed = eye(true);
  EXPECT_THAT(observe(*directed, std::nullopt), IsEmpty());
  EXPECT_EQ(cells(*directed), ",,,,,,");
  EXPECT_FALSE(directed->overlay().measured.has_value());
}

TEST_F(LandmarkEyeTest, DirectedItObservesTheLandmarkThatItIsAskedFor) {
  const auto directed = eye(true);
  const auto seen = observe(*directed, GazeRequest{0, TrackRequest::acquire});
  ASSERT_EQ(seen.size(), 1U);
  const auto& disc = std::get<EllipseObservation>(seen.front());
  EXPECT_EQ(disc.expected, std::optional<LandmarkId>(0));
  EXPECT_EQ(disc.shot.stamp, shot_.stamp);
  const imaging::Overlay overlay = directed->overlay();
  ASSERT_TRUE(overlay.measured && overlay.predicted);
  EXPECT_EQ(overlay.measured->u, disc.ellipse.u);
  // The head's look error of 0.3° is 3 px.
  EXPECT_NEAR(disc.ellipse.u, overlay.predicted->u, 12.0);
  EXPECT_NEAR(disc.ellipse.v, overlay.predicted->v, 12.0);
}

TEST_F(LandmarkEyeTest, DirectedItSaysThatALandmarkIsNotWhereItShouldBe) {
  const auto directed = eye(true);
  EXPECT_THAT(observe(*directed, GazeRequest{4, TrackRequest::acquire}), IsEmpty());
  EXPECT_EQ(cells(*directed), ",not_found,,,,,");
}

TEST_F(LandmarkEyeTest, NotDirectedItObservesWhateverACaptureShowsLargeEnoughToMeasure) {
  const auto fixed = eye(false);
  const auto seen = observe(*fixed, std::nullopt);
  const auto surveyed = fixed->survey({*frame_, shot_});
  EXPECT_LE(seen.size(), surveyed.size());
  for (const Observation& one : seen) EXPECT_GE(std::get<EllipseObservation>(one).ellipse.b, 4.5);
  const auto asked = observe(*eye(true), GazeRequest{0, TrackRequest::acquire});
  const Eigen::Vector2d disc = image_extent(asked.front()).centre;
  const bool found = std::any_of(seen.begin(), seen.end(), [&](const Observation& one) {
    return (image_extent(one).centre - disc).norm() < 0.5;
  });
  EXPECT_TRUE(found);
}

TEST_F(LandmarkEyeTest, WritesACellForEachOfItsColumns) {
  const auto directed = eye(true);
  const auto columns = static_cast<std::ptrdiff_t>(directed->columns().size());
  for (const LandmarkId landmark : {0, 4}) {
    observe(*directed, GazeRequest{landmark, TrackRequest::acquire});
    const std::string line = cells(*directed);
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns) << line;
  }
}

TEST(Eyes, AreFoundByTheirNames) {
  EXPECT_THAT(names_of(eyes()), ElementsAre("landmark", "field", "ceiling", "stereo"));
  const LandmarkMap none;
  for (const EyeEntry& entry : eyes()) EXPECT_EQ(entry.make({none})->name(), entry.name);
}

}  // namespace
}  // namespace vigia::perception

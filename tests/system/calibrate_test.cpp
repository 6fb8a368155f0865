#include "sim/soccer.hpp"
#include "support/process.hpp"
#include "support/temp_dir.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vigia/core/random.hpp"
#include "vigia/imaging/image_frame.hpp"
#include "vigia/localization/mirror_calibration.hpp"
#include "vigia/sim/camera_errors.hpp"
#include "vigia/sim/scene.hpp"
#include "vigia/sim/simulator.hpp"
#include "vigia/tracking/radial_scan.hpp"

namespace vigia {
namespace {

using ::testing::HasSubstr;

const sim::MirrorParams kBadlyMounted{0.01, from_deg(0.5), 1.0};

/// A field of 12×8 m under a mirror that is not quite as calibrated.
class MirrorInTheHall {
 public:
  explicit MirrorInTheHall(std::uint64_t seed)
      : world_(sim::field_world("field-12x8")), scene_(world_, look(), seed) {
    known_.rMc.linear() = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix();
    known_.rMc.translation() = Eigen::Vector3d(0.0, 0.0, 0.75);
    known_.mirror = sim::soccer_mirror();
    sim::DisturbanceParams disturbances;
    disturbances.mirror = kBadlyMounted;
    const sim::CameraErrors errors(disturbances, seed);
    Camera camera;
    camera.mount = FixedMount{known_.rMc};
    camera.optics = CameraModel(known_.mirror);
    true_.mirror = std::get<UnifiedOmni>(errors.true_model(known_.mirror));
    true_.rMc = std::get<FixedMount>(errors.true_mount(camera)).rMc;
  }

  const FieldMap& field() const { return *world_.field; }
  const localization::MirrorMount& known() const { return known_; }
  const localization::MirrorMount& truth() const { return true_; }

  std::unique_ptr<imaging::Frame> expose(const Pose2& pose, int number) const {
    sim::ImagingParams params;
    params.colour = true;
    return scene_.expose(to_isometry(pose) * true_.rMc, true_.mirror,
                         Stamp::from_seconds(0.04 * number), params);
  }

  /// The true change from what is known: focal length, middle, tilt.
  Eigen::Matrix<double, 5, 1> change() const {
    const Eigen::Matrix3d turn = known_.rMc.linear().transpose() * true_.rMc.linear();
    Eigen::Matrix<double, 5, 1> out;
    // turn = Rx(tilt_x) Ry(tilt_y)
    out << true_.mirror.px / known_.mirror.px - 1.0, true_.mirror.u0 - known_.mirror.u0,
        true_.mirror.v0 - known_.mirror.v0, std::atan2(turn(2, 1), turn(1, 1)),
        std::atan2(turn(0, 2), turn(0, 0));
    return out;
  }

 private:
  std::shared_ptr<const sim::Appearance> look() const {
    MapReader reader(load_config(VIGIA_SOURCE_DIR "/config/worlds/field-12x8.yaml"), "world");
    read_world_map(reader);
    return sim::read_appearance(reader, world_);
  }

  WorldMap world_;
  sim::Scene scene_;
  localization::MirrorMount known_;
  localization::MirrorMount true_;
};

std::vector<localization::MirrorPicture> scanned_pictures(const MirrorInTheHall& hall, int count,
                                                          RandomStream& random) {
  tracking::RadialScanner scanner(tracking::FloorView{hall.known().mirror, hall.known().rMc, 40.0},
                                  tracking::FieldPalette{});
  std::vector<localization::MirrorPicture> pictures;
  for (int i = 0; i < count; ++i) {
    const Pose2 pose{random.uniform(-4.0, 4.0), random.uniform(-3.0, 3.0),
                     random.uniform(-kPi, kPi)};
    const tracking::RadialScan scan = scanner.scan(*hall.expose(pose, i));
    localization::MirrorPicture& picture = pictures.emplace_back();
    for (const tracking::LinePoint& point : scan.points)
      picture.points.push_back({scan.pixel(point.ray, point.inner_px),
                                scan.pixel(point.ray, point.outer_px), point.sigma_px});
  }
  return pictures;
}

TEST(CalibrateOmni, ErrsByAsMuchAsItsCovarianceSaysOnRenderedPictures) {
  constexpr int kDraws = 24;
  double sum = 0.0;
  double worst = 0.0;
  double of_true_errors = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const MirrorInTheHall hall(100 + static_cast<std::uint64_t>(draw));
    RandomStream random(100 + static_cast<std::uint64_t>(draw), "places");
    const auto found =
        calibrate_mirror(hall.field(), hall.known(), scanned_pictures(hall, 6, random));
    ASSERT_EQ(found.status, localization::MirrorCalibrationStatus::converged) << draw;
    const Eigen::Matrix<double, 5, 1> error = found.change.head<5>() - hall.change();
    const double nees = error.dot(found.covariance.topLeftCorner<5, 5>().ldlt().solve(error)) / 5.0;
    if (std::getenv("VIGIA_SHOW") != nullptr)
      std::cerr << draw << " nees " << nees << " misfit " << found.misfit << " rms " << found.rms_px
                << " error " << error.transpose() << " sigma "
                << found.covariance.diagonal().head<5>().cwiseSqrt().transpose() << '\n';
    sum += nees;
    of_true_errors += nees / std::min(1.0, found.misfit);
    worst = std::max(worst, nees);
  }
  // The scan states more than it errs by in pictures without a real floor's faults (misfit 0.35),
  // and so does the covariance. By the errors that the points have it is right.
  EXPECT_LT(sum / kDraws, 1.0);
  EXPECT_LT(of_true_errors / kDraws, 1.4);
  EXPECT_GT(of_true_errors / kDraws, 0.6);
  EXPECT_LT(worst, 4.1);  // the 99.9th percentile of χ²/5
}

class CalibrateCommand : public ::testing::Test {
 protected:
  testing::ProcessResult vigia(const std::string& arguments) const {
    return testing::run_process(std::string(VIGIA_PROGRAM) + " calibrate " + arguments,
                                folder_.path());
  }
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  static std::string field_file() { return VIGIA_SOURCE_DIR "/config/fields/12x8.yaml"; }

  testing::TempDir folder_;
};

TEST_F(CalibrateCommand, WritesWhatTheMirrorTrulyIs) {
  const MirrorInTheHall hall(7);
  std::string pictures;
  const std::vector<Pose2> poses{{0.5, 0.3, 0.4}, {-2.0, 1.2, 2.0}, {2.4, -1.5, -1.2}};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string name = file("m" + std::to_string(i) + ".png");
    imaging::write_png(name, imaging::colour_image(*hall.expose(poses[i], static_cast<int>(i))));
    pictures += ' ' + name;
  }
  const auto result = vigia("omni" + pictures + " --field " + field_file() +
                            " --height 0.75 --focal-px 204 --max-angle-deg 99 --mirrored"
                            " --mirror 319.5,239.5,40,238 --out " +
                            file("out"));
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("3 of 3 pictures"));
  std::map<std::string, std::vector<double>> rows;
  std::istringstream lines(result.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "parameter,start,estimate,sigma");
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string name;
    std::getline(fields, name, ',');
    for (std::string value; std::getline(fields, value, ',');)
      rows[name].push_back(std::stod(value));
  }
  const auto truth = hall.change();
  const std::vector<std::pair<std::string, double>> expected{{"focal_px", 204.0 * (1.0 + truth[0])},
                                                             {"u0_px", 319.5 + truth[1]},
                                                             {"v0_px", 239.5 + truth[2]},
                                                             {"tilt_x_deg", to_deg(truth[3])},
                                                             {"tilt_y_deg", to_deg(truth[4])}};
  for (const auto& [name, value] : expected) {
    ASSERT_EQ(rows[name].size(), 3U) << name;
    EXPECT_NEAR(rows[name][1], value, 4.0 * rows[name][2]) << name;
  }
  EXPECT_EQ(rows["xi"].size(), 2U);  // known: no σ
  for (const char* name : {"calibration.csv", "covariance.csv", "distance.csv", "pictures.csv",
                           "camera.yaml", "overlay/00001_m0.png"})
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out" / name)) << name;
  // The camera as a robot file has it.
  MapReader reader(load_config(folder_.path() / "out" / "camera.yaml"), "robot");
  const Rig rig = sim::read_robot_setup(reader).rig();
  reader.finish();
  const Camera& camera = rig.cameras.front();
  const auto& mirror = std::get<UnifiedOmni>(std::get<CameraModel>(camera.optics));
  EXPECT_NEAR(mirror.px, rows["focal_px"][1], 1e-3);
  EXPECT_NEAR(mirror.py, -rows["focal_px"][1], 1e-3);
  const Eigen::Isometry3d rMc = std::get<FixedMount>(camera.mount).rMc;
  EXPECT_LT(Eigen::AngleAxisd(rMc.linear().transpose() * hall.truth().rMc.linear()).angle(),
            4.0 * from_deg(std::hypot(rows["tilt_x_deg"][2], rows["tilt_y_deg"][2])));
}

TEST_F(CalibrateCommand, SaysWhatIsWrongWithItsInput) {
  const std::string blank = file("blank.png");
  imaging::write_png(blank, vpImage<vpRGBa>(120, 160, vpRGBa(90, 90, 90)));
  const std::string with = "omni " + blank + " --height 0.75 --field ";
  auto result = vigia(with + field_file());
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("no mirror with a field is found; --mirror U,V,INNER,OUTER"));
  result = vigia(with + field_file() + " --mirror 80,60,10");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("--mirror: found '80,60,10', must be U,V,INNER,OUTER"));
  const std::string placed = with + field_file() + " --mirror 80,60,10,55";
  result = vigia(placed + " --near 1,2");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("--near: found '1,2', must be X,Y,HEADING"));
  result = vigia(placed + " --near 0,0,0 --near 1,2,3");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("--near: given 2 times, but there are 1 pictures"));
  result = vigia(placed + " --xi 0");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("a mirror of xi 0 shows no direction so far off its axis"));
  result = vigia(with + file("none.yaml"));
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, HasSubstr("none.yaml"));
  // A picture in which there is nothing to be found is no mistake of the command line.
  result = vigia(placed);
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.err, HasSubstr("no picture's points match the field's lines"));
}

}  // namespace
}  // namespace vigia

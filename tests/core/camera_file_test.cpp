#include "vigia/core/camera_file.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vigia {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::string& text) {
  try {
    parse_camera(text, "camera.txt");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

const std::string kViSP = R"(<?xml version="1.0"?>
<!-- calibrated -->
<root>
  <camera>
    <name>Camera</name>
    <image_width>640</image_width>
    <image_height>480</image_height>
    <model>
      <type>perspectiveProjWithoutDistortion</type>
      <px>900</px><py>901</py><u0>320</u0><v0>240</v0>
    </model>
    <model>
      <type>perspectiveProjWithDistortion</type>
      <px>878.5</px><py>876.25</py><u0>326.0</u0><v0>238.5</v0>
      <kud>-0.19</kud><kdu>0.2036</kdu>
    </model>
  </camera>
</root>
)";

std::string opencv(const std::string& coefficients) {
  return "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n"
         "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
         "   data: [ 700., 0., 319.5, 0., 701., 239.5, 0., 0., 1. ]\n"
         "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n"
         "   data: [ " +
         coefficients + " ]\n";
}

TEST(CameraFile, ViSPsXmlGivesTheModelWithDistortion) {
  const Intrinsics camera = parse_camera(kViSP, "camera.xml");
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
  EXPECT_DOUBLE_EQ(camera.px, 878.5);
  EXPECT_DOUBLE_EQ(camera.py, 876.25);
  EXPECT_DOUBLE_EQ(camera.u0, 326.0);
  EXPECT_DOUBLE_EQ(camera.v0, 238.5);
  EXPECT_DOUBLE_EQ(camera.kdu, 0.2036);
}

TEST(CameraFile, OpenCVsYamlGivesTheOneCoefficientThatFitsItsLens) {
  EXPECT_DOUBLE_EQ(parse_camera(opencv("0, 0, 0, 0, 0"), "c.yml").kdu, 0.0);
  const Intrinsics camera = parse_camera(opencv("-0.05, 0.004, 0.0, 0.0, 0.0"), "c.yml");
  EXPECT_DOUBLE_EQ(camera.px, 700.0);
  EXPECT_DOUBLE_EQ(camera.v0, 239.5);
  // A point in the corner, by OpenCV's polynomial and back through ours.
  const double x = 0.4;
  const double y = 0.3;
  const double r2 = x * x + y * y;
  const double factor = 1.0 - 0.05 * r2 + 0.004 * r2 * r2;
  const Eigen::Vector2d xy =
      unproject(camera, {camera.u0 + camera.px * factor * x, camera.v0 + camera.py * factor * y});
  EXPECT_NEAR(xy.x(), x, 0.5 / 700.0);
  EXPECT_NEAR(xy.y(), y, 0.5 / 700.0);
}

TEST(CameraFile, ALensThatOneCoefficientDoesNotFitIsRefused) {
  EXPECT_THAT(error_of(opencv("-0.9, 2.5, 0.02, 0.02, 0.0")), HasSubstr("undistort the pictures"));
}

TEST(CameraFile, MistakesAreNamedWithLineAndColumn) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kViSP;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_THAT(error_of(with("640", "wide")),
              HasSubstr("camera.txt:6:5: image_width: found 'wide', must be a number in"));
  EXPECT_THAT(error_of(with("640", "-1")), HasSubstr("image_width"));
  EXPECT_THAT(error_of(with("640", "nan")), HasSubstr("image_width"));
  EXPECT_THAT(error_of(with("<kdu>0.2036</kdu>", "")), HasSubstr("<model> has no <kdu>"));
  EXPECT_THAT(error_of(with("</root>", "")), HasSubstr("3:1: the element <root> has no end"));
  EXPECT_THAT(error_of(with("</camera>", "</model>")), HasSubstr("</camera> would be right"));
  EXPECT_THAT(error_of(with("<px>878.5</px>", "<px>1</px><px>2</px>")), HasSubstr("a second <px>"));
  EXPECT_THAT(error_of("<a><b>&evil;</b></a>"), HasSubstr("&amp;"));
  EXPECT_THAT(error_of("<!DOCTYPE a [<!ENTITY x \"y\">]><a/>"), HasSubstr("document type"));
  EXPECT_THAT(error_of("<opencv_storage/>"), HasSubstr("OpenCV's XML"));
  EXPECT_THAT(error_of("<root/>"), HasSubstr("has no <camera>"));
  EXPECT_THAT(error_of(""), HasSubstr("empty"));
  EXPECT_THAT(error_of("hello"), HasSubstr("no camera"));
  EXPECT_THAT(error_of("image_width: 640\n"), HasSubstr("the key 'image_height' is missing"));
  EXPECT_THAT(error_of("a: [1"), HasSubstr("camera.txt:"));
}

TEST(CameraFile, ElementsWithoutEndInEachOtherEndTheReading) {
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_THAT(error_of(deep), HasSubstr("32 deep"));
}

TEST(CameraFile, AMissingFileIsAnInputError) {
  try {
    read_camera("/nowhere/camera.xml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/camera.xml: the file does not exist"));
  }
}

}  // namespace
}  // namespace vigia

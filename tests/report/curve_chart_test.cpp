#include "vigia/report/curve_chart.hpp"

#include "support/temp_dir.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "vigia/core/error.hpp"
#include "vigia/imaging/image_frame.hpp"

namespace vigia::report {
namespace {

/// Pixels of the first curve's blue below the keys.
int blue_pixels(const std::filesystem::path& file) {
  const vpImage<vpRGBa> image = imaging::colour_image(imaging::read_image(file));
  const vpRGBa blue(0x00, 0x72, 0xb2);
  int count = 0;
  for (unsigned v = 82; v < image.getHeight(); ++v)
    for (unsigned u = 0; u < image.getWidth(); ++u)
      if (image[v][u].R == blue.R && image[v][u].G == blue.G && image[v][u].B == blue.B) ++count;
  return count;
}

CurveChart one_curve(Curve::Look look) {
  return {"A chart", "x", "y", {{"curve", {{0.0, 1.0}, {1.0, 10.0}, {2.0, 5.0}}, look}}};
}

TEST(CurveChart, ALongerCurveTakesMoreInk) {
  const testing::TempDir folder;
  const auto file = folder.path() / "chart.png";
  write_curve_chart(file, one_curve(Curve::Look::line));
  const int whole = blue_pixels(file);
  write_curve_chart(file, one_curve(Curve::Look::dashed));
  const int dashed = blue_pixels(file);
  write_curve_chart(file, one_curve(Curve::Look::marks));
  const int marks = blue_pixels(file);
  EXPECT_GT(whole, dashed);
  EXPECT_GT(dashed, marks);
  EXPECT_GT(marks, 3 * 30);  // three discs of 4 px radius
}

TEST(CurveChart, WritesEveryFormatAndNoOther) {
  const testing::TempDir folder;
  for (const char* name : {"chart.png", "chart.svg", "chart.pdf"}) {
    write_curve_chart(folder.path() / name, one_curve(Curve::Look::line));
    EXPECT_GT(std::filesystem::file_size(folder.path() / name), 500U) << name;
  }
  EXPECT_THROW(write_curve_chart(folder.path() / "chart.gif", one_curve(Curve::Look::line)),
               InputError);
}

TEST(CurveChart, RejectsAChartWithoutPointsAndALogarithmOfZero) {
  const testing::TempDir folder;
  EXPECT_THROW(write_curve_chart(folder.path() / "chart.png", {}), std::invalid_argument);
  CurveChart chart = one_curve(Curve::Look::line);
  chart.decades = true;
  write_curve_chart(folder.path() / "chart.png", chart);
  chart.curves[0].points[1].y() = 0.0;
  EXPECT_THROW(write_curve_chart(folder.path() / "chart.png", chart), std::invalid_argument);
}

}  // namespace
}  // namespace vigia::report

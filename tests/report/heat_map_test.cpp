#include "vigia/report/heat_map.hpp"

#include "support/temp_dir.hpp"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "vigia/imaging/image_frame.hpp"

namespace vigia::report {
namespace {

HeatMap two_cells(double left, double right) {
  HeatMap map;
  map.title = "Two cells";
  map.unit = "cm";
  map.max_m = {2.0, 1.0};
  map.columns = 2;
  map.rows = 1;
  map.values = {left, right};
  map.top = 10.0;
  return map;
}

TEST(HeatMap, AHigherValueIsDarkerAndWhatIsMissingIsBlank) {
  const testing::TempDir folder;
  const auto file = folder.path() / "heat.png";
  write_heat_map(file, two_cells(9.0, std::numeric_limits<double>::quiet_NaN()));
  const vpImage<unsigned char> high = imaging::grey_image(imaging::read_image(file));
  write_heat_map(file, two_cells(1.0, 1.0));
  const vpImage<unsigned char> low = imaging::grey_image(imaging::read_image(file));
  EXPECT_LT(high[200][200], low[200][200]);
  EXPECT_EQ(high[200][600], 255);
}

TEST(HeatMap, RejectsCellsWithoutValues) {
  const testing::TempDir folder;
  HeatMap map = two_cells(1.0, 2.0);
  map.rows = 2;
  EXPECT_THROW(write_heat_map(folder.path() / "heat.png", map), std::invalid_argument);
}

}  // namespace
}  // namespace vigia::report

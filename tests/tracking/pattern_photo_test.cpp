// Colour patterns in photographs: blur before the camera's response, and what else rooms add.

#include "tracking/photograph.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "vigia/core/angle.hpp"
#include "vigia/tracking/pattern_tracker.hpp"

namespace vigia::tracking::testing {
namespace {

constexpr double kSheet = 0.3;  // m
const PatternCode kPrinted{7, 42, 5};

PatternShape shape_of(const PatternCode& code) {
  PatternShape shape;
  shape.code = code;
  return shape;
}

PhotoParams ordinary_photo() {
  PhotoParams photo;
  photo.response = PhotoParams::Response::srgb;
  photo.bayer = true;
  photo.jpeg = 80;
  photo.raw_noise = 0.005;
  photo.fine = 2;
  return photo;
}

SheetView view(double sheet_px, double slant, RandomStream& random, int size,
               const Eigen::Vector2d& centre) {
  return view_of_sheet(kSheet, sheet_px, slant, random.uniform(-kPi, kPi),
                       random.uniform(-kPi, kPi), 1500.0, centre, size, size);
}

std::vector<PointsFeature> read_sheet(const Print& print, double sheet_px, double slant,
                                      const PhotoParams& photo, RandomStream& random,
                                      const std::vector<Sticker>& stickers = {}) {
  const int size = (static_cast<int>(1.45 * sheet_px) + 48) / 2 * 2;
  cv::Mat3f light = plain_wall(size, size, photo.fine, {0.3F, 0.3F, 0.3F});
  lay_sheet(light, photo.fine, view(sheet_px, slant, random, size, {0.5 * size, 0.5 * size}), print,
            stickers, random);
  return PatternTracker().find_all(imaging::ImageFrame(photograph(light, photo, random)));
}

struct Rates {
  int right = 0;
  int wrong = 0;
};

Rates read_many(int count, double sheet_px, double slant, PhotoParams photo, double blur_low,
                double blur_high, RandomStream& random) {
  Rates rates;
  for (int k = 0; k < count; ++k) {
    const PatternCode code{static_cast<int>(random.index(kFloors)),
                           static_cast<int>(random.index(kRooms)),
                           static_cast<int>(random.index(kPatterns))};
    photo.blur_px = random.uniform(blur_low, blur_high);
    for (const auto& feature : read_sheet(print_of_pattern(shape_of(code), strong_inks()), sheet_px,
                                          slant, photo, random)) {
      if (!feature.code) continue;
      const bool right = std::get<PatternCode>(*feature.code) == code;
      rates.right += right ? 1 : 0;
      rates.wrong += right ? 0 : 1;
    }
  }
  return rates;
}

TEST(PatternPhotos, BlurBeforeTheResponseMakesNoWrongCode) {
  RandomStream random(81, "blur before gamma");
  int wrong = 0;
  for (const double sheet_px : {120.0, 170.0})
    wrong += read_many(25, sheet_px, 0.3, ordinary_photo(), 2.0, 4.0, random).wrong;
  EXPECT_EQ(wrong, 0);
}

TEST(PatternPhotos, AreReadAtEverySizeFromNinetyPixelsOn) {
  for (const double sheet_px : {90.0, 100.0, 125.0, 180.0, 260.0}) {
    RandomStream random(82, "sizes");
    const Rates rates = read_many(12, sheet_px, 0.4, ordinary_photo(), 0.6, 1.2, random);
    EXPECT_EQ(rates.wrong, 0) << sheet_px;
    EXPECT_GE(rates.right, 11) << sheet_px;
  }
}

TEST(PatternPhotos, ANearPatternDoesNotHideAFarOne) {
  RandomStream random(83, "near and far");
  const PhotoParams photo = ordinary_photo();
  cv::Mat3f light = plain_wall(480, 480, photo.fine, {0.3F, 0.3F, 0.3F});
  lay_sheet(light, photo.fine, view(260.0, 0.2, random, 480, {190.0, 190.0}),
            print_of_pattern(shape_of(kPrinted), strong_inks()), {}, random);
  lay_sheet(light, photo.fine, view(95.0, 0.2, random, 480, {405.0, 405.0}),
            print_of_pattern(shape_of({3, 11, 2}), strong_inks()), {}, random);
  std::vector<PatternCode> read;
  for (const auto& feature :
       PatternTracker().find_all(imaging::ImageFrame(photograph(light, photo, random))))
    if (feature.code) read.push_back(std::get<PatternCode>(*feature.code));
  EXPECT_EQ(read.size(), 2U);
  for (const PatternCode& code : {kPrinted, PatternCode{3, 11, 2}})
    EXPECT_NE(std::find(read.begin(), read.end(), code), read.end());
}

/// The dots of a pattern but for those that @p keep leaves out.
Print some_dots(const std::function<bool(int label)>& keep) {
  std::vector<PrintedDisc> discs;
  const Inks inks = strong_inks();
  for (const PatternDot& dot : pattern_dots(shape_of(kPrinted)))
    if (keep(dot.label))
      discs.push_back({dot.centre_l.x(), dot.centre_l.y(), dot.radius_m, 0.0,
                       inks[static_cast<std::size_t>(dot.colour)]});
  return print_of_discs(kSheet, discs);
}

TEST(PatternPhotos, ASingleRingRoundACentreIsNoPattern) {
  RandomStream random(84, "single ring");
  for (const auto& print : {some_dots([](int label) { return label <= 8; }),
                            some_dots([](int label) { return label == 0 || label > 8; })})
    for (const PointsFeature& feature : read_sheet(print, 220.0, 0.2, ordinary_photo(), random))
      EXPECT_FALSE(feature.code);
}

TEST(PatternPhotos, ADotWhereTheSheetIsWhiteMakesItNoPattern) {
  RandomStream random(85, "extra dot");
  std::vector<PrintedDisc> discs;
  const Inks inks = strong_inks();
  for (const PatternDot& dot : pattern_dots(shape_of(kPrinted)))
    discs.push_back({dot.centre_l.x(), dot.centre_l.y(), dot.radius_m, 0.0,
                     inks[static_cast<std::size_t>(dot.colour)]});
  const double radius = 0.5 * (PatternShape{}.outer_radius_m + PatternShape{}.inner_radius_m);
  discs.push_back({radius * std::sin(kPi / 8), radius * std::cos(kPi / 8), 0.010, 0.0, inks[1]});
  for (const PointsFeature& feature :
       read_sheet(print_of_discs(kSheet, discs), 220.0, 0.2, ordinary_photo(), random))
    EXPECT_FALSE(feature.code);
}

TEST(PatternPhotos, ACentreThatIsLargerThanThePlaneHasItIsNotRead) {
  RandomStream random(87, "sticker");
  std::vector<PrintedDisc> discs;
  const Inks inks = strong_inks();
  for (const PatternDot& dot : pattern_dots(shape_of(kPrinted))) {
    const bool centre = dot.label == 0;
    discs.push_back({dot.centre_l.x(), dot.centre_l.y(), dot.radius_m * (centre ? 1.12 : 1.0), 0.0,
                     inks[centre ? 1U : static_cast<std::size_t>(dot.colour)]});
  }
  for (const PointsFeature& feature :
       read_sheet(print_of_discs(kSheet, discs), 220.0, 0.2, ordinary_photo(), random))
    EXPECT_FALSE(feature.code);
}

/// A sticker of a code's ink on a dot, its measures in radii of the dot.
Sticker on_dot(const PatternCode& code, int label, DotColour ink, double radius, double off,
               bool round = true) {
  const PatternDot dot = pattern_dots(shape_of(code))[static_cast<std::size_t>(label)];
  return {dot.centre_l + off * dot.radius_m * Eigen::Vector2d(0.8, 0.6), radius * dot.radius_m,
          round, strong_inks()[static_cast<std::size_t>(ink)]};
}

struct StickerCase {
  PatternCode code;
  std::vector<Sticker> stickers;
  double sheet_px;
  double blur;
  double defocus;
};

/// Stickers that leave a sickle of a dot: on centre-points, and on dots whose twins are covered.
std::vector<StickerCase> sickles() {
  const PatternCode black{1, 42, 5};
  const PatternCode green{7, 42, 5};
  const PatternDot twin = pattern_dots(shape_of(black))[4];
  const Sticker over_twin{twin.centre_l, 1.6 * twin.radius_m, false, {0.8F, 0.8F, 0.8F}};
  const DotColour other = twin.colour == DotColour::blue ? DotColour::green : DotColour::blue;
  return {{black, {on_dot(black, 0, DotColour::red, 0.55, 0.05)}, 190.0, 0.6, 0.0},
          {black, {on_dot(black, 0, DotColour::red, 0.87, 0.06)}, 333.0, 0.5, 9.4},
          {black, {on_dot(black, 0, DotColour::blue, 0.94, 0.06)}, 222.0, 1.1, 0.0},
          {green, {on_dot(green, 0, DotColour::black, 0.83, 0.04, false)}, 127.0, 1.4, 0.0},
          {green, {on_dot(green, 0, DotColour::black, 0.94, 0.13)}, 142.0, 2.6, 0.0},
          {black, {on_dot(black, 12, other, 0.83, 0.03), over_twin}, 184.0, 1.5, 0.0},
          {black, {on_dot(black, 12, other, 0.90, 0.07), over_twin}, 336.0, 0.6, 0.0}};
}

TEST(PatternPhotos, AStickerThatLeavesASickleOfADotMakesNoWrongCode) {
  constexpr int kPhotos = 4;
  RandomStream random(88, "sickles");
  for (const StickerCase& one : sickles())
    for (int k = 0; k < kPhotos; ++k) {
      PhotoParams photo = ordinary_photo();
      photo.bayer = k % 2 == 0;
      photo.blur_px = one.blur;
      photo.defocus_px = one.defocus;
      for (const PointsFeature& feature :
           read_sheet(print_of_pattern(shape_of(one.code), strong_inks()), one.sheet_px, 0.4, photo,
                      random, one.stickers))
        EXPECT_TRUE(!feature.code || std::get<PatternCode>(*feature.code) == one.code)
            << "sheet " << one.sheet_px << " px, photo " << k;
    }
}

TEST(PatternPhotos, CentresAreWhereGreenHasThemUnderAChromaticShift) {
  constexpr int kPhotos = 8;
  RandomStream random(86, "chromatic shift");
  PhotoParams photo;
  photo.white = 0.7;
  photo.noise = 3.0;
  photo.red_shift = {0.3, 0.0};
  photo.blue_shift = {-0.1, 0.28};
  PatternTracker tracker;
  double nees = 0.0;
  int count = 0;
  for (int k = 0; k < kPhotos; ++k) {
    const SheetView seen =
        view(250.0, 0.3, random, 380,
             {190.0 + random.uniform(-3.0, 3.0), 190.0 + random.uniform(-3.0, 3.0)});
    cv::Mat3f light = plain_wall(380, 380, photo.fine, {0.3F, 0.3F, 0.3F});
    const PatternShape shape = shape_of(kPrinted);
    lay_sheet(light, photo.fine, seen, print_of_pattern(shape, strong_inks()), {}, random);
    const auto found = tracker.find_all(imaging::ImageFrame(photograph(light, photo, random)));
    ASSERT_EQ(found.size(), 1U);
    const auto dots = pattern_dots(shape);
    for (const LabelledPoint& point : found[0].points) {
      const PatternDot& dot = dots[static_cast<std::size_t>(point.label)];
      const Eigen::Vector2d error = point.uv - seen.circle_centre(dot.centre_l, dot.radius_m);
      nees += error.dot(point.covariance.inverse() * error);
      count += 2;
    }
  }
  ASSERT_GE(count, 2 * 16 * kPhotos);
  // Squares of unit normals, of which a photo's share its shift: five standard errors.
  EXPECT_LT(nees / count, 1.25 + 5.0 * std::sqrt(2.0 / count));
}

}  // namespace
}  // namespace vigia::tracking::testing

// Photographs of colour patterns under everything that ordinary cameras and rooms add, mixed: how
// many are read, how many wrongly, and what the stated confidence is worth.
//   code_views mixed N SEED [csv]     views of a pattern with all conditions drawn at random
//   code_views empty N SEED           pictures with dot grids, rings, text and clutter, no pattern
//   code_views tags N SEED            corners of tags by condition: errors against what is stated
//   code_views covered N SEED         tags of which 1–20 % are covered at a corner
//   code_views dots N SEED            centres of a pattern's dots by condition
//   code_views families N SEED        false tags of each family in pictures without any

#include "tag_detector.hpp"
#include "tracking/photograph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include <Eigen/LU>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "vigia/core/angle.hpp"
#include "vigia/tracking/pattern_tracker.hpp"
#include "vigia/tracking/tag_tracker.hpp"

namespace {

using namespace vigia;
using namespace vigia::tracking;
using namespace vigia::tracking::testing;

constexpr double kSheet = 0.3;  // m

struct Conditions {
  double sheet_px = 0.0;
  double slant_deg = 0.0;
  PhotoParams photo;
  bool pale = false;
  bool over = false;  ///< glare or saturation
  int stickers = 0;
  bool covered = false;

  bool ordinary() const {
    return sheet_px >= 90.0 && slant_deg <= 50.0 && photo.blur_px <= 1.5 &&
           photo.defocus_px <= 2.0 && photo.motion_px <= 2.0 && !over && stickers == 0 && !covered;
  }
};

bool chance(RandomStream& random, double share) {
  return random.uniform(0.0, 1.0) < share;
}

cv::Vec3f tinted(RandomStream& random, double spread) {
  return {static_cast<float>(1.0 + random.uniform(-spread, spread)),
          static_cast<float>(1.0 + random.uniform(-spread, spread)),
          static_cast<float>(1.0 + random.uniform(-spread, spread))};
}

cv::Vec2d shift(RandomStream& random) {
  return {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)};
}

Conditions random_conditions(RandomStream& random) {
  Conditions c;
  c.sheet_px = 60.0 * std::pow(400.0 / 60.0, random.uniform(0.0, 1.0));
  c.slant_deg = random.uniform(0.0, 65.0);
  PhotoParams& p = c.photo;
  p.blur_px = chance(random, 0.5) ? random.uniform(0.3, 1.5) : random.uniform(0.3, 4.0);
  if (chance(random, 0.2)) p.defocus_px = random.uniform(0.0, 15.0);
  if (chance(random, 0.2)) p.motion_px = random.uniform(0.0, 15.0);
  p.motion_angle = random.uniform(0.0, kPi);
  p.fine = c.sheet_px > 200.0 || p.blur_px > 1.5 ? 2 : 3;
  p.response = chance(random, 0.8) ? PhotoParams::Response::srgb : PhotoParams::Response::linear;
  p.bayer = chance(random, 0.5);
  p.jpeg = chance(random, 0.6) ? 50 + static_cast<int>(random.index(46)) : 0;
  p.light = tinted(random, 0.12);
  p.other_light = chance(random, 0.4) ? tinted(random, 0.4) : p.light;
  p.light_slope = {random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3)};
  p.vignetting = random.uniform(0.0, 0.4);
  p.white = random.uniform(0.35, 0.8);
  p.haze = chance(random, 0.3) ? random.uniform(0.0, 0.08) : 0.0;
  p.red_shift = shift(random);
  p.blue_shift = shift(random);
  p.raw_noise = random.uniform(0.002, 0.02);
  p.noise = random.uniform(0.0, 3.0);
  if (chance(random, 0.08)) {
    p.white = random.uniform(1.0, 1.6);
    c.over = true;
  }
  c.over = c.over || p.white * 0.85 *
                             std::max({p.light[0], p.light[1], p.light[2], p.other_light[0],
                                       p.other_light[1], p.other_light[2]}) *
                             1.1 >
                         1.0;
  c.pale = chance(random, 0.3);
  c.stickers = chance(random, 0.2) ? 1 + static_cast<int>(random.index(3)) : 0;
  c.covered = chance(random, 0.15);
  return c;
}

struct Scene {
  cv::Mat3f light;
  SheetView view;
};

int size_for(double sheet_px) {
  return (static_cast<int>(sheet_px * 1.45) + 48) / 2 * 2;
}

SheetView sheet_view(const Conditions& c, RandomStream& random) {
  const int size = size_for(c.sheet_px);
  const Eigen::Vector2d centre(0.5 * size + random.uniform(-8.0, 8.0),
                               0.5 * size + random.uniform(-8.0, 8.0));
  return view_of_sheet(kSheet, c.sheet_px, from_deg(c.slant_deg), random.uniform(-kPi, kPi),
                       random.uniform(-kPi, kPi), random.uniform(600.0, 4000.0), centre, size,
                       size);
}

std::vector<Sticker> random_stickers(int count, const PatternShape& shape, RandomStream& random) {
  std::vector<Sticker> stickers;
  const auto dots = pattern_dots(shape);
  const Inks inks = strong_inks();
  for (int i = 0; i < count; ++i) {
    const PatternDot& dot = dots[random.index(dots.size())];
    Sticker sticker;
    const double off = chance(random, 0.3) ? 0.1 : 1.0;
    sticker.centre_l =
        dot.centre_l +
        off * dot.radius_m * Eigen::Vector2d(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    sticker.radius_m = shape.dot_radius_m * random.uniform(0.6, 1.8);
    sticker.round = chance(random, 0.8);
    sticker.ink = inks[random.index(4)];
    if (chance(random, 0.3)) sticker.ink = cv::Vec3f(0.8F, 0.8F, 0.8F);
    stickers.push_back(sticker);
  }
  return stickers;
}

/// Something between camera and sheet.
void cover_part(cv::Mat3f& light, double fine, double sheet_px, RandomStream& random) {
  const auto at = [&] {
    return cv::Point2f(static_cast<float>(random.uniform(0.1, 0.9) * light.cols),
                       static_cast<float>(random.uniform(0.1, 0.9) * light.rows));
  };
  const auto length = static_cast<float>(fine * sheet_px * random.uniform(0.05, 0.5));
  const cv::RotatedRect box(at(), {length, length * static_cast<float>(random.uniform(0.1, 1.0))},
                            static_cast<float>(random.uniform(0.0, 180.0)));
  const cv::Scalar colour(random.uniform(0.02, 0.8), random.uniform(0.02, 0.8),
                          random.uniform(0.02, 0.8));
  if (random.index(2) == 0) {
    cv::ellipse(light, box, colour, cv::FILLED);
  } else {
    std::array<cv::Point2f, 4> corners;
    box.points(corners.data());
    cv::fillConvexPoly(light, std::vector<cv::Point>(corners.begin(), corners.end()), colour);
  }
}

void add_glares(PhotoParams& photo, int size, Conditions& c, RandomStream& random) {
  if (!chance(random, 0.1)) return;
  c.over = true;
  photo.glares.push_back({random.uniform(0.2, 0.8) * size, random.uniform(0.2, 0.8) * size,
                          random.uniform(0.03, 0.3) * size, random.uniform(0.2, 2.0)});
}

struct Tally {
  int views = 0;
  int right = 0;
  int wrong = 0;
  int ghosts = 0;  ///< found besides

  void print(const std::string& name) const {
    if (views == 0) return;
    std::printf("%-34s %7d views  read %6.2f %%  wrong %d  ghosts %d\n", name.c_str(), views,
                100.0 * right / views, wrong, ghosts);
  }
};

/// Of readings within a band of stated confidence, the right ones.
struct Reliability {
  std::map<int, std::pair<int, int>> bands;

  static int band_of(double confidence) {
    const double doubt = std::max(1e-9, 1.0 - confidence);
    return std::clamp(static_cast<int>(std::floor(-2.0 * std::log10(doubt))), 0, 10);
  }
  void add(double confidence, bool right) {
    auto& [count, good] = bands[band_of(confidence)];
    ++count;
    good += right ? 1 : 0;
  }
  void print() const {
    for (const auto& [band, counts] : bands)
      std::printf("confidence %.5f – %.5f: %6d readings, %d wrong\n",
                  1.0 - std::pow(10.0, -0.5 * band), 1.0 - std::pow(10.0, -0.5 * (band + 1)),
                  counts.first, counts.first - counts.second);
  }
};

std::string label(const PatternCode& code) {
  return std::to_string(code.floor) + "-" + std::to_string(code.room) + "-" +
         std::to_string(code.pattern);
}

int mixed(int views, std::uint64_t seed, bool csv) {
  std::map<std::string, Tally> tallies;
  Reliability reliability;
  PatternTrackerParams params;
  params.min_confidence = std::getenv("MIN_CONFIDENCE") ? std::atof(std::getenv("MIN_CONFIDENCE"))
                                                        : params.min_confidence;
  PatternTracker tracker({}, params);
  for (int k = 0; k < views; ++k) {
    RandomStream random(seed, "view " + std::to_string(k));
    Conditions c = random_conditions(random);
    PatternShape shape;
    shape.code = {static_cast<int>(random.index(kFloors)), static_cast<int>(random.index(kRooms)),
                  static_cast<int>(random.index(kPatterns))};
    const SheetView view = sheet_view(c, random);
    const Inks inks = varied(c.pale ? pale_inks() : strong_inks(), 0.05F, random);
    cv::Mat3f light = cluttered_wall(view.width, view.height, c.photo.fine, 6, random);
    lay_sheet(light, c.photo.fine, view, print_of_pattern(shape, inks),
              random_stickers(c.stickers, shape, random), random);
    if (c.covered) cover_part(light, c.photo.fine, c.sheet_px, random);
    add_glares(c.photo, view.width, c, random);
    const imaging::ImageFrame frame(photograph(light, c.photo, random));
    Tally one;
    one.views = 1;
    double confidence = 0.0;
    FeatureStatus status = FeatureStatus::not_found;
    for (const PointsFeature& feature : tracker.find_all(frame)) {
      if (feature.points.empty() || !feature.code) {
        status = feature.status;
        confidence = std::max(confidence, feature.confidence);
        continue;
      }
      const bool right = std::get<PatternCode>(*feature.code) == shape.code;
      confidence = feature.confidence;
      status = FeatureStatus::found;
      if (right && one.right == 0)
        one.right = 1;
      else if (!right)
        ++one.wrong;
      else
        ++one.ghosts;
      reliability.add(feature.confidence, right);
      if (!right)
        std::fprintf(stderr, "WRONG view %d read %s for %s confidence %.6f\n", k,
                     label(std::get<PatternCode>(*feature.code)).c_str(), label(shape.code).c_str(),
                     feature.confidence);
    }
    if (csv)
      std::printf("%d,%.0f,%.0f,%.2f,%.1f,%.1f,%d,%d,%d,%d,%d,%d,%.2f,%d,%s,%.4f,%d,%d\n", k,
                  c.sheet_px, c.slant_deg, c.photo.blur_px, c.photo.defocus_px, c.photo.motion_px,
                  c.photo.response == PhotoParams::Response::srgb ? 1 : 0, c.photo.bayer ? 1 : 0,
                  c.photo.jpeg, c.pale ? 1 : 0, c.stickers, c.covered ? 1 : 0, c.photo.white,
                  c.over ? 1 : 0, std::string(to_string(status)).c_str(), confidence, one.right,
                  one.wrong);
    const auto add = [&](const std::string& name) {
      Tally& tally = tallies[name];
      ++tally.views;
      tally.right += one.right;
      tally.wrong += one.wrong;
      tally.ghosts += one.ghosts;
    };
    add("all");
    if (c.ordinary()) add(c.pale ? "ordinary, pale inks" : "ordinary, strong inks");
    const auto upto = [](double value, double step) {
      const double low = std::floor(value / step) * step;
      char text[40];
      std::snprintf(text, sizeof text, "%g – %g", low, low + step);
      return std::string(text);
    };
    if (c.ordinary() || (c.sheet_px < 90.0 && c.slant_deg <= 50.0 && c.photo.blur_px <= 1.5 &&
                         c.photo.defocus_px <= 2.0 && c.photo.motion_px <= 2.0 && !c.over &&
                         c.stickers == 0 && !c.covered))
      add("sheet px " + std::string(c.sheet_px < 100 ? "0" : "") + upto(c.sheet_px, 15.0) +
          " otherwise ordinary");
    add("blur before gamma px " + upto(c.photo.blur_px, 1.0));
    if (c.photo.defocus_px > 2.0) add("defocus px " + upto(c.photo.defocus_px, 5.0));
    if (c.photo.motion_px > 2.0) add("motion px " + upto(c.photo.motion_px, 5.0));
    if (c.stickers > 0) add("stickers");
    if (c.covered) add("covered");
    if (c.over) add("glare or clipped");
  }
  if (!csv) {
    for (const auto& [name, tally] : tallies) tally.print(name);
    reliability.print();
  }
  return tallies["all"].wrong == 0 ? 0 : 1;
}

/// Dots on grids and rings, with sizes and colours like a pattern's.
Print decoy(RandomStream& random) {
  std::vector<PrintedDisc> discs;
  const Inks inks = varied(strong_inks(), 0.1F, random);
  const PatternShape shape;
  const auto ink = [&] { return inks[random.index(4)]; };
  const std::size_t kind = random.index(5);
  if (kind == 0) {  // a grid
    const double pitch = random.uniform(0.035, 0.075);
    const double radius = random.uniform(0.008, 0.016);
    const double odd = chance(random, 0.5) ? 0.5 : 0.0;
    int row = 0;
    for (double y = -0.13; y < 0.13; y += pitch, ++row)
      for (double x = -0.13 + odd * pitch * (row % 2); x < 0.13; x += pitch)
        discs.push_back({x, y, chance(random, 0.1) ? radius * 5.0 / 3.0 : radius, 0.0, ink()});
  } else if (kind == 1) {  // one ring round a larger centre
    const double scale = random.uniform(0.8, 1.2);
    const double ring = chance(random, 0.5) ? shape.inner_radius_m : shape.outer_radius_m;
    const int count = chance(random, 0.6) ? 8 : 5 + static_cast<int>(random.index(8));
    for (int i = 0; i < count; ++i) {
      const double a = 2.0 * kPi * i / count;
      discs.push_back({scale * ring * std::sin(a), scale * ring * std::cos(a),
                       shape.dot_radius_m * scale, 0.0, ink()});
    }
    discs.push_back({0, 0, shape.centre_radius_m * scale, 0.0, ink()});
  } else if (kind == 2) {  // both rings, wrongly
    for (const PatternDot& dot : pattern_dots(shape)) {
      const double off = dot.label > 8 ? random.uniform(0.0, 0.6) : 0.0;
      const double c = std::cos(off), s = std::sin(off);
      discs.push_back({c * dot.centre_l.x() + s * dot.centre_l.y(),
                       c * dot.centre_l.y() - s * dot.centre_l.x(), dot.radius_m, 0.0, ink()});
    }
  } else if (kind == 3) {  // rings
    for (int i = 0; i < 14; ++i) {
      const double r = random.uniform(0.01, 0.06);
      discs.push_back({random.uniform(-0.12, 0.12), random.uniform(-0.12, 0.12), r,
                       r * random.uniform(0.3, 0.8), ink()});
    }
  } else {  // dots anywhere
    for (int i = 0; i < 40; ++i)
      discs.push_back({random.uniform(-0.14, 0.14), random.uniform(-0.14, 0.14),
                       random.uniform(0.006, 0.02), 0.0, ink()});
  }
  return print_of_discs(kSheet, discs);
}

int empty(int pictures, std::uint64_t seed) {
  PatternTracker patterns;
  TagTracker tags;
  int false_patterns = 0;
  int false_tags = 0;
  for (int k = 0; k < pictures; ++k) {
    RandomStream random(seed, "empty " + std::to_string(k));
    Conditions c = random_conditions(random);
    const SheetView view = sheet_view(c, random);
    cv::Mat3f light = cluttered_wall(view.width, view.height, c.photo.fine, 40, random);
    if (k % 3 != 0)
      lay_sheet(light, c.photo.fine, view, decoy(random),
                random_stickers(c.stickers, PatternShape{}, random), random);
    const imaging::ImageFrame frame(photograph(light, c.photo, random));
    for (const PointsFeature& feature : patterns.find_all(frame))
      if (feature.code) {
        ++false_patterns;
        std::fprintf(stderr, "false pattern in picture %d, confidence %.6f\n", k,
                     feature.confidence);
      }
    for (const PointsFeature& feature : tags.find_all(frame))
      if (feature.status == FeatureStatus::found) {
        ++false_tags;
        std::fprintf(stderr, "false tag in picture %d\n", k);
      }
  }
  std::printf("%d pictures without any: %d false patterns, %d false tags\n", pictures,
              false_patterns, false_tags);
  return false_patterns + false_tags == 0 ? 0 : 1;
}

/// Errors beside what was stated of them.
struct Pulls {
  std::vector<double> nees;  ///< per degree of freedom, one a point
  double squares = 0.0;
  double raw_squares = 0.0;
  int raw_points = 0;
  int asked = 0;
  int found = 0;

  void add(const Eigen::Vector2d& error, const Eigen::Matrix2d& covariance) {
    nees.push_back(0.5 * error.dot(covariance.inverse() * error));
    squares += error.squaredNorm();
  }
  void print(const std::string& name) {
    std::sort(nees.begin(), nees.end());
    double mean = 0.0;
    for (const double value : nees) mean += value / static_cast<double>(nees.size());
    const double high = nees.empty() ? 0.0 : nees[nees.size() * 99 / 100];
    std::printf(
        "%-30s n %5d  refused %5.1f %%  NEES mean %6.2f  99th %6.1f  worst %7.1f  rms %.4f px",
        name.c_str(), asked, 100.0 * (asked - found) / asked, mean, high,
        nees.empty() ? 0.0 : nees.back(),
        std::sqrt(squares / (2.0 * static_cast<double>(nees.size()))));
    if (raw_points > 0)
      std::printf("  libapriltag's %.4f", std::sqrt(raw_squares / (2.0 * raw_points)));
    std::printf("\n");
    std::fflush(stdout);
  }
};

std::vector<std::vector<bool>> black_fields(const TagGrid& grid) {
  const int edge = (grid.fields - grid.border) / 2;
  std::vector<std::vector<bool>> black;
  for (int row = edge; row < grid.fields - edge; ++row) {
    black.emplace_back();
    for (int column = edge; column < grid.fields - edge; ++column)
      black.back().push_back(!grid.is_white(column, row));
  }
  return black;
}

struct TagCondition {
  std::string name;
  PhotoParams photo;
  double side_px = 60.0;
  double quiet_zone = 1.0;
  double max_slant = 50.0;
};

/// Contrast 150, noise 4, blur 0.7 px.
PhotoParams nominal_photo() {
  PhotoParams photo;
  photo.fine = 4;
  photo.white = 1.0;
  photo.noise = 4.0;
  photo.light = photo.other_light = cv::Vec3f(0.745F, 0.745F, 0.745F);
  return photo;
}

std::vector<TagCondition> tag_conditions() {
  std::vector<TagCondition> all;
  const auto add = [&](const std::string& name, auto change) {
    TagCondition condition{name, nominal_photo()};
    change(condition);
    all.push_back(condition);
  };
  add("nominal", [](TagCondition&) {});
  for (const double levels : {10.0, 20.0, 40.0})
    add("slope " + std::to_string(static_cast<int>(levels)) + " levels/100 px",
        [&](TagCondition& c) {
          c.photo.light_slope = {levels / 100 / 160, 0.0};
        });
  add("slope 0.12/100 px", [](TagCondition& c) { c.photo.light_slope = {0.0008, -0.0009}; });
  add("blur 2 px", [](TagCondition& c) { c.photo.blur_px = 2.0; });
  add("blur 3 px", [](TagCondition& c) { c.photo.blur_px = 3.0; });
  add("side 20 px", [](TagCondition& c) {
    c.side_px = 20.0;
    c.max_slant = 30.0;
  });
  add("side 30 px", [](TagCondition& c) { c.side_px = 30.0; });
  add("side 150 px", [](TagCondition& c) { c.side_px = 150.0; });
  add("quiet zone half a field", [](TagCondition& c) { c.quiet_zone = 0.5; });
  add("noise 8", [](TagCondition& c) { c.photo.noise = 8.0; });
  add("sRGB after the blur",
      [](TagCondition& c) { c.photo.response = PhotoParams::Response::srgb; });
  add("sRGB, blur 2 px", [](TagCondition& c) {
    c.photo.response = PhotoParams::Response::srgb;
    c.photo.blur_px = 2.0;
  });
  add("sRGB, Bayer, JPEG 80", [](TagCondition& c) {
    c.photo.response = PhotoParams::Response::srgb;
    c.photo.bayer = true;
    c.photo.jpeg = 80;
    c.photo.noise = 2.0;
  });
  add("clipped plate", [](TagCondition& c) {
    c.photo.light = c.photo.other_light = cv::Vec3f(1.25F, 1.25F, 1.25F);
  });
  return all;
}

struct TagPhoto {
  vpImage<unsigned char> image;
  std::array<Eigen::Vector2d, 4> corners;
};

TagPhoto tag_photo(const TagCondition& c, const std::vector<std::vector<bool>>& black,
                   double cover_share, RandomStream& random) {
  constexpr double kSide = 0.2;
  const int size = (static_cast<int>(c.side_px * 1.7) + 40) / 2 * 2;
  const double width_m = kSide;
  const SheetView view = view_of_sheet(
      width_m, c.side_px, from_deg(random.uniform(0.0, c.max_slant)), random.uniform(-kPi, kPi),
      random.uniform(-kPi, kPi), random.uniform(600.0, 2000.0),
      {0.5 * size + random.uniform(-3.0, 3.0), 0.5 * size + random.uniform(-3.0, 3.0)}, size, size);
  cv::Mat3f light = plain_wall(size, size, c.photo.fine, cv::Vec3f(0.25F, 0.25F, 0.25F));
  std::vector<Sticker> stickers;
  TagPhoto photo;
  const double h = 0.5 * kSide;
  const std::array<Eigen::Vector2d, 4> at{Eigen::Vector2d(-h, -h), Eigen::Vector2d(h, -h),
                                          Eigen::Vector2d(h, h), Eigen::Vector2d(-h, h)};
  for (std::size_t k = 0; k < 4; ++k) photo.corners[k] = view(at[k]);
  if (cover_share > 0.0) {
    // A patch that covers the corner's share of the tag, from within or from beyond.
    const double reach = kSide * std::sqrt(cover_share);
    const Eigen::Vector2d corner = at[random.index(4)];
    const float grey = static_cast<float>(random.uniform(0.05, 0.8));
    const double half = reach * random.uniform(0.5, 1.2);
    stickers.push_back({corner - (reach - half) * corner / h, half, random.index(2) == 0,
                        cv::Vec3f(grey, grey, grey)});
  }
  lay_sheet(light, c.photo.fine, view, print_of_tag(black, kSide, c.quiet_zone), stickers, random);
  photo.image = grey_photograph(light, c.photo, random);
  return photo;
}

void measure_tags(const TagCondition& condition, int count, std::uint64_t seed, bool covered) {
  TagDetector detector("36h11", 1.0, 1);
  TagTracker tracker;
  Pulls pulls;
  int far_off = 0;
  for (int k = 0; k < count; ++k) {
    RandomStream random(seed, condition.name + std::to_string(k));
    const int tag = static_cast<int>(random.index(587));
    const double share = covered ? random.uniform(0.01, 0.2) : 0.0;
    TagPhoto photo = tag_photo(condition, black_fields(detector.grid(tag)), share, random);
    ++pulls.asked;
    for (const TagDetection& raw : detector.detect(photo.image))
      for (std::size_t i = 0; i < 4 && raw.tag == tag; ++i) {
        pulls.raw_squares += (raw.corners[i] - photo.corners[i]).squaredNorm();
        ++pulls.raw_points;
      }
    for (const PointsFeature& feature : tracker.find_all(imaging::ImageFrame(photo.image))) {
      if (feature.status != FeatureStatus::found) continue;
      ++pulls.found;
      bool off = false;
      for (std::size_t i = 0; i < 4; ++i) {
        const Eigen::Vector2d error = feature.points[i].uv - photo.corners[i];
        pulls.add(error, feature.points[i].covariance);
        off = off || 2.0 * pulls.nees.back() > 25.0;
      }
      if (off) {
        ++far_off;
        if (covered)
          std::fprintf(stderr, "view %d: a corner is off by more than 5 σ, %.1f %% covered\n", k,
                       100.0 * share);
      }
    }
  }
  pulls.print(condition.name);
  if (covered) std::printf("tags with a corner off by more than 5 stated σ: %d\n", far_off);
}

int tags(int count, std::uint64_t seed) {
  for (const TagCondition& condition : tag_conditions())
    measure_tags(condition, count, seed, false);
  return 0;
}

int covered(int count, std::uint64_t seed) {
  TagCondition condition{"covered 1–20 %", nominal_photo()};
  condition.photo.fine = 3;
  measure_tags(condition, count, seed, true);
  return 0;
}

struct DotCondition {
  std::string name;
  PhotoParams photo;
};

std::vector<DotCondition> dot_conditions() {
  std::vector<DotCondition> all;
  const auto add = [&](const std::string& name, auto change) {
    DotCondition condition{name, nominal_photo()};
    condition.photo.fine = 3;
    change(condition.photo);
    all.push_back(condition);
  };
  add("nominal", [](PhotoParams&) {});
  add("chromatic shift 0.3 px", [](PhotoParams& p) {
    p.red_shift = {0.3, 0.0};
    p.blue_shift = {-0.1, 0.28};
  });
  add("chromatic shift 0.1 px", [](PhotoParams& p) {
    p.red_shift = {0.0, -0.1};
    p.blue_shift = {0.1, 0.0};
  });
  for (const double levels : {10.0, 20.0, 40.0})
    add("slope " + std::to_string(static_cast<int>(levels)) + " levels/100 px",
        [&](PhotoParams& p) {
          p.light_slope = {levels / 100 / 160, 0.0};
        });
  add("slope 0.12/100 px", [](PhotoParams& p) { p.light_slope = {0.0008, -0.0009}; });
  add("blur 2 px", [](PhotoParams& p) { p.blur_px = 2.0; });
  add("sRGB after the blur", [](PhotoParams& p) { p.response = PhotoParams::Response::srgb; });
  add("sRGB, Bayer, JPEG 80", [](PhotoParams& p) {
    p.response = PhotoParams::Response::srgb;
    p.bayer = true;
    p.jpeg = 80;
    p.noise = 2.0;
  });
  return all;
}

int dots(int count, std::uint64_t seed) {
  constexpr int kSize = 360;
  for (const DotCondition& condition : dot_conditions()) {
    PatternTracker tracker;
    Pulls pulls;
    for (int k = 0; k < count; ++k) {
      RandomStream random(seed, condition.name + std::to_string(k));
      PatternShape shape;
      shape.code = {static_cast<int>(random.index(kFloors)), static_cast<int>(random.index(kRooms)),
                    static_cast<int>(random.index(kPatterns))};
      const SheetView view = view_of_sheet(
          kSheet, 250.0, from_deg(random.uniform(0.0, 50.0)), random.uniform(-kPi, kPi),
          random.uniform(-kPi, kPi), 2000.0,
          {0.5 * kSize + random.uniform(-8.0, 8.0), 0.5 * kSize + random.uniform(-8.0, 8.0)}, kSize,
          kSize);
      cv::Mat3f light = plain_wall(kSize, kSize, condition.photo.fine, {0.3F, 0.3F, 0.3F});
      lay_sheet(light, condition.photo.fine, view, print_of_pattern(shape, strong_inks()), {},
                random);
      const imaging::ImageFrame frame(photograph(light, condition.photo, random));
      pulls.asked += kPatternDots;
      for (const PointsFeature& feature : tracker.find_all(frame)) {
        if (!feature.code || !(std::get<PatternCode>(*feature.code) == shape.code)) continue;
        const auto printed = pattern_dots(shape);
        for (const LabelledPoint& point : feature.points) {
          const PatternDot& dot = printed[static_cast<std::size_t>(point.label)];
          ++pulls.found;
          pulls.add(point.uv - view.circle_centre(dot.centre_l, dot.radius_m), point.covariance);
        }
      }
    }
    pulls.print(condition.name);
  }
  return 0;
}

int families(int pictures, std::uint64_t seed) {
  for (const std::string& family : tag_families()) {
    TagTrackerParams params;
    params.family = family;
    TagTracker tracker({}, params);
    TagDetector detector(family, 1.0, 2);
    int read = 0;
    int found = 0;
    for (int k = 0; k < pictures; ++k) {
      RandomStream random(seed, "families " + std::to_string(k));
      const Conditions c = random_conditions(random);
      cv::Mat3f light = cluttered_wall(320, 240, 2, 150, random);
      PhotoParams photo = c.photo;
      photo.fine = 2;
      vpImage<unsigned char> image = grey_photograph(light, photo, random);
      read += static_cast<int>(detector.detect(image).size());
      for (const PointsFeature& feature : tracker.find_all(imaging::ImageFrame(image)))
        found += feature.status == FeatureStatus::found ? 1 : 0;
    }
    std::printf("%-14s %d pictures without any: libapriltag reads %d, found %d\n", family.c_str(),
                pictures, read, found);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  const std::string mode = argc > 1 ? argv[1] : "";
  const int count = argc > 2 ? std::atoi(argv[2]) : 1000;
  const auto seed = static_cast<std::uint64_t>(argc > 3 ? std::atoll(argv[3]) : 1);
  if (mode == "mixed") return mixed(count, seed, argc > 4);
  if (mode == "empty") return empty(count, seed);
  if (mode == "tags") return tags(count, seed);
  if (mode == "covered") return covered(count, seed);
  if (mode == "dots") return dots(count, seed);
  if (mode == "families") return families(count, seed);
  std::fprintf(stderr, "usage: code_views mixed|empty|tags|covered|dots|families N SEED [csv]\n");
  return 2;
}

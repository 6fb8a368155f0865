#include "tag_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "vigia/core/error.hpp"
#include "vigia/tracking/tag_tracker.hpp"

extern "C" {
#include <apriltag.h>
#include <tag16h5.h>
#include <tag25h9.h>
#include <tag36h11.h>
#include <tagStandard41h12.h>
}

namespace vigia::tracking {
namespace {

struct TagFamily {
  const char* name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
  TagDemands demands;
};

constexpr std::array<TagFamily, 4> kFamilies{{
    {"36h11", &tag36h11_create, &tag36h11_destroy, {2, 0.0}},
    {"25h9", &tag25h9_create, &tag25h9_destroy, {1, 30.0}},
    {"16h5", &tag16h5_create, &tag16h5_destroy, {0, 50.0}},
    {"Standard41h12", &tagStandard41h12_create, &tagStandard41h12_destroy, {2, 0.0}},
}};

const TagFamily& family_named(const std::string& name) {
  const auto* found = std::find_if(kFamilies.begin(), kFamilies.end(),
                                   [&](const TagFamily& family) { return name == family.name; });
  if (found != kFamilies.end()) return *found;
  std::string known;
  for (const TagFamily& family : kFamilies)
    known += (known.empty() ? "'" : ", '") + std::string(family.name) + "'";
  throw InputError("there is no tag family '" + name + "'; known are " + known);
}

/// Half the width of what is surely printed: half of a white rim may be cut off the sheet.
double sure_half_width(const apriltag_family_t& family) {
  constexpr double kRimCut = 0.5;
  return 0.5 * family.total_width - (family.reversed_border ? 0.0 : kRimCut);
}

TagGrid grid_of(apriltag_family_t& family, int tag) {
  const std::unique_ptr<image_u8_t, decltype(&image_u8_destroy)> image(
      apriltag_to_image(&family, tag), &image_u8_destroy);
  TagGrid grid;
  grid.fields = family.total_width;
  grid.border = family.width_at_border;
  grid.sure = sure_half_width(family);
  for (int row = 0; row < grid.fields; ++row)
    for (int column = 0; column < grid.fields; ++column)
      grid.white.push_back(image->buf[row * image->stride + column] != 0 ? 1 : 0);
  return grid;
}

}  // namespace

struct TagDetector::Library {
  explicit Library(const TagFamily& chosen)
      : demands(chosen.demands), family(chosen.create(), chosen.destroy) {}

  TagDemands demands;
  std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family;
  std::unique_ptr<apriltag_detector_t, decltype(&apriltag_detector_destroy)> detector{
      apriltag_detector_create(), &apriltag_detector_destroy};
  std::map<int, TagGrid> grids;
};

TagDetector::TagDetector(const std::string& family, double quad_decimate, int max_hamming)
    : library_(std::make_unique<Library>(family_named(family))) {
  apriltag_detector_t& detector = *library_->detector;
  // Its table of codes grows with the power of the bits that may be wrong.
  apriltag_detector_add_family_bits(&detector, library_->family.get(),
                                    std::min(max_hamming, library_->demands.max_hamming));
  detector.nthreads = 1;
  detector.quad_decimate = static_cast<float>(quad_decimate);
  // The default of 5 takes noise for edges, which costs ten times the time.
  detector.qtp.min_white_black_diff = 30;
}

TagDetector::~TagDetector() = default;

std::vector<TagDetection> TagDetector::detect(vpImage<unsigned char>& image) {
  image_u8_t view{static_cast<int32_t>(image.getWidth()), static_cast<int32_t>(image.getHeight()),
                  static_cast<int32_t>(image.getWidth()), image.bitmap};
  const std::unique_ptr<zarray_t, decltype(&apriltag_detections_destroy)> found(
      apriltag_detector_detect(library_->detector.get(), &view), &apriltag_detections_destroy);
  // The library puts the first pixel's centre at (0.5, 0.5).
  const Eigen::Vector2d half(0.5, 0.5);
  std::vector<TagDetection> detections;
  for (int i = 0; i < zarray_size(found.get()); ++i) {
    apriltag_detection_t* raw = nullptr;
    zarray_get(found.get(), i, &raw);
    TagDetection detection;
    detection.tag = raw->id;
    detection.hamming = raw->hamming;
    detection.decision_margin = static_cast<double>(raw->decision_margin);
    for (std::size_t k = 0; k < 4; ++k)
      detection.corners[k] = Eigen::Vector2d(raw->p[k][0], raw->p[k][1]) - half;
    detections.push_back(detection);
  }
  return detections;
}

const TagGrid& TagDetector::grid(int tag) {
  const auto known = library_->grids.find(tag);
  if (known != library_->grids.end()) return known->second;
  return library_->grids.emplace(tag, grid_of(*library_->family, tag)).first->second;
}

const TagDemands& TagDetector::demands() const {
  return library_->demands;
}

double TagDetector::confidence_of(int wrong_bits) const {
  const apriltag_family_t& family = *library_->family;
  const auto bits = static_cast<double>(family.nbits);
  double words = 0.0;
  double choices = 1.0;
  for (int k = 0; k <= wrong_bits; ++k) {
    words += choices;
    choices *= (bits - k) / (k + 1.0);
  }
  return std::max(0.0, 1.0 - family.ncodes * 4.0 * words / std::pow(2.0, bits));
}

std::vector<std::string> tag_families() {
  std::vector<std::string> names;
  names.reserve(std::size(kFamilies));
  for (const TagFamily& family : kFamilies) names.emplace_back(family.name);
  return names;
}

}  // namespace vigia::tracking

#include "tag_detector.hpp"

extern "C" {
#include <apriltag.h>
#include <tag36h11.h>
}

namespace vigia::tracking {

struct TagDetector::Library {
  std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family{tag36h11_create(),
                                                                         &tag36h11_destroy};
  std::unique_ptr<apriltag_detector_t, decltype(&apriltag_detector_destroy)> detector{
      apriltag_detector_create(), &apriltag_detector_destroy};
};

TagDetector::TagDetector(double quad_decimate, int max_hamming)
    : library_(std::make_unique<Library>()) {
  apriltag_detector_t& detector = *library_->detector;
  // Its table of codes grows with the power of the bits that may be wrong.
  apriltag_detector_add_family_bits(&detector, library_->family.get(), max_hamming);
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
    detection.centre = Eigen::Vector2d(raw->c[0], raw->c[1]) - half;
    for (std::size_t k = 0; k < 4; ++k)
      detection.corners[k] = Eigen::Vector2d(raw->p[k][0], raw->p[k][1]) - half;
    detections.push_back(detection);
  }
  return detections;
}

}  // namespace vigia::tracking

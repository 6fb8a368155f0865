#include "vigia/perception/eye.hpp"

#include "ceiling_eye.hpp"
#include "field_eye.hpp"
#include "landmark_eye.hpp"
#include "stereo_eye.hpp"

namespace vigia::perception {
namespace {

template <typename T>
std::unique_ptr<Eye> make(const EyeParts& parts) {
  return std::make_unique<T>(parts);
}

}  // namespace

const std::vector<EyeEntry>& eyes() {
  static const std::vector<EyeEntry> entries{
      {{"landmark", "observes the map's discs, colour patterns and tags, directed or all of them",
        "a perspective camera; patterns need colour"},
       make<LandmarkEye>},
      {{"field", "scans a field of play along rays for lines, goals and posts",
        "an omnidirectional camera in colour, fixed to the base; a field in the world"},
       make<FieldEye>},
      {{"ceiling", "finds the patches of a ceiling",
        "a perspective camera, fixed to the base, that looks up; a ceiling in the world"},
       make<CeilingEye>},
      {{"stereo", "finds the corners of goals in both images of a pair",
        "two level perspective cameras in colour, fixed to the base, alike and side by side; a "
        "field with goals in the world"},
       make<StereoEye>}};
  return entries;
}

}  // namespace vigia::perception

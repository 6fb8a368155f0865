#include "vigia/perception/eye.hpp"

#include "landmark_eye.hpp"

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
       make<LandmarkEye>}};
  return entries;
}

}  // namespace vigia::perception

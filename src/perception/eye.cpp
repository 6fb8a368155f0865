#include "vigia/perception/eye.hpp"

#include "landmark_eye.hpp"

namespace vigia::perception {
namespace {

struct Entry {
  const char* name;
  std::unique_ptr<Eye> (*make)(const EyeParts&);
};

const std::vector<Entry>& table() {
  static const std::vector<Entry> entries{
      {"landmark", [](const EyeParts& parts) -> std::unique_ptr<Eye> {
         return std::make_unique<LandmarkEye>(parts);
       }}};
  return entries;
}

}  // namespace

std::unique_ptr<Eye> make_eye(const std::string& name, const EyeParts& parts) {
  for (const Entry& entry : table())
    if (name == entry.name) return entry.make(parts);
  return nullptr;
}

std::vector<std::string> eye_names() {
  std::vector<std::string> names;
  for (const Entry& entry : table()) names.emplace_back(entry.name);
  return names;
}

}  // namespace vigia::perception

#include "vigia/core/camera_file.hpp"

#include "config_parser.hpp"
#include "xml_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace vigia {
namespace {

constexpr double kLargestPicture = 1e5;  // px
constexpr double kLargestFocal = 1e6;    // px
constexpr double kLargestKdu = 10.0;

/// Reads a whole text as one finite number in [low, high].
double number_of(const std::string& text, const SourceLocation& where, const std::string& key,
                 Range range) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  stream >> value;
  std::string rest;
  if (stream.fail() || (stream >> rest) || !std::isfinite(value) || value < range.low ||
      value > range.high) {
    std::ostringstream wanted;
    wanted << key << ": found " << quoted_for_message(text) << ", must be a number in ["
           << range.low << ", " << range.high << "]";
    throw InputError(where, wanted.str());
  }
  return value;
}

// --- ViSP's XML ---------------------------------------------------------------------------------

double xml_number(const XmlElement& parent, const std::string& key, Range range) {
  const XmlElement* element = parent.find(key);
  if (element == nullptr)
    throw InputError(parent.where, "<" + parent.name + "> has no <" + key + ">");
  return number_of(element->text, element->where, key, range);
}

// The model with distortion, or else the one without.
const XmlElement& model_of(const XmlElement& camera) {
  const XmlElement* plain = nullptr;
  for (const XmlElement& model : camera.children) {
    if (model.name != "model") continue;
    const XmlElement* type = model.find("type");
    if (type == nullptr) throw InputError(model.where, "<model> has no <type>");
    if (type->text == "perspectiveProjWithDistortion") return model;
    if (type->text == "perspectiveProjWithoutDistortion") plain = &model;
  }
  if (plain == nullptr)
    throw InputError(camera.where,
                     "<camera> has no <model> of the type "
                     "perspectiveProjWithDistortion or "
                     "perspectiveProjWithoutDistortion");
  return *plain;
}

Intrinsics camera_of_xml(const std::string& text, const std::string& name) {
  const XmlElement root = parse_xml(text, name);
  if (root.name == "opencv_storage")
    throw InputError(root.where,
                     "found OpenCV's XML, where ViSP's XML or OpenCV's YAML would be "
                     "right");
  const XmlElement* camera = nullptr;
  for (const XmlElement& child : root.children) {
    if (child.name != "camera") continue;
    if (camera != nullptr)
      throw InputError(child.where, "a second <camera>: keep the one that took the pictures");
    camera = &child;
  }
  if (camera == nullptr)
    throw InputError(root.where, "<" + root.name + "> has no <camera>, as ViSP's XML has it");
  Intrinsics out;
  out.width = static_cast<int>(xml_number(*camera, "image_width", {1.0, kLargestPicture}));
  out.height = static_cast<int>(xml_number(*camera, "image_height", {1.0, kLargestPicture}));
  const XmlElement& model = model_of(*camera);
  out.px = xml_number(model, "px", {1.0, kLargestFocal});
  out.py = xml_number(model, "py", {1.0, kLargestFocal});
  out.u0 = xml_number(model, "u0", {-kLargestPicture, kLargestPicture});
  out.v0 = xml_number(model, "v0", {-kLargestPicture, kLargestPicture});
  const bool distorted = model.find("type")->text == "perspectiveProjWithDistortion";
  out.kdu = distorted ? xml_number(model, "kdu", {-kLargestKdu, kLargestKdu}) : 0.0;
  return out;
}

// --- OpenCV's YAML ------------------------------------------------------------------------------

SourceLocation location_of(const YAML::Node& node, const std::string& name) {
  const YAML::Mark mark = node.Mark();
  return mark.is_null() ? SourceLocation{name}
                        : SourceLocation{name, mark.line + 1, mark.column + 1};
}

YAML::Node yaml_entry(const YAML::Node& map, const std::string& key, const std::string& name) {
  const YAML::Node found = map[key];
  if (!found) throw InputError(location_of(map, name), "the key '" + key + "' is missing");
  return found;
}

double yaml_number(const YAML::Node& node, const std::string& key, Range range,
                   const std::string& name) {
  if (!node.IsScalar()) throw InputError(location_of(node, name), key + ": must be a number");
  return number_of(node.Scalar(), location_of(node, name), key, range);
}

std::vector<double> yaml_matrix(const YAML::Node& map, const std::string& key,
                                const std::string& name) {
  const YAML::Node matrix = yaml_entry(map, key, name);
  if (!matrix.IsMap())
    throw InputError(location_of(matrix, name), key + ": must be a matrix with rows, cols, data");
  const YAML::Node data = yaml_entry(matrix, "data", name);
  if (!data.IsSequence() || data.size() > 64)
    throw InputError(location_of(data, name), key + ": data must be a list of numbers");
  std::vector<double> values;
  for (const YAML::Node& entry : data) values.push_back(yaml_number(entry, key, {-1e9, 1e9}, name));
  return values;
}

/// OpenCV's lens: k1 k2 p1 p2 k3 k4 k5 k6.
using Distortion = std::array<double, 8>;

Eigen::Vector2d opencv_distort(const Distortion& k, const Eigen::Vector2d& xy) {
  const double x = xy.x();
  const double y = xy.y();
  const double r2 = xy.squaredNorm();
  const double radial =
      (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
          y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}

/// Undistorted normalised points and where OpenCV's lens puts them, over the picture.
struct LensSample {
  Eigen::Vector2d undistorted;
  Eigen::Vector2d distorted;
};

std::vector<LensSample> sample_lens(const Intrinsics& camera, const Distortion& k) {
  constexpr int kSteps = 24;
  // The undistorted picture may be larger than the picture.
  constexpr double kWider = 1.4;
  std::vector<LensSample> samples;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const double u = camera.u0 + kWider * (camera.width * (i - kSteps / 2.0) / kSteps);
      const double v = camera.v0 + kWider * (camera.height * (j - kSteps / 2.0) / kSteps);
      const Eigen::Vector2d xy((u - camera.u0) / camera.px, (v - camera.v0) / camera.py);
      const Eigen::Vector2d d = opencv_distort(k, xy);
      const Eigen::Vector2d seen(camera.u0 + camera.px * d.x(), camera.v0 + camera.py * d.y());
      if (d.allFinite() && in_image(camera, seen)) samples.push_back({xy, d});
    }
  return samples;
}

/// The kdu of undistorted = (1 + kdu r²)·distorted that fits best.
double fitted_kdu(const std::vector<LensSample>& samples) {
  double product = 0.0;
  double square = 0.0;
  for (const LensSample& sample : samples) {
    const Eigen::Vector2d moved = sample.distorted.squaredNorm() * sample.distorted;
    product += moved.dot(sample.undistorted - sample.distorted);
    square += moved.squaredNorm();
  }
  return square > 0.0 ? product / square : 0.0;
}

double worst_misfit_px(const Intrinsics& camera, const std::vector<LensSample>& samples) {
  double worst = 0.0;
  for (const LensSample& sample : samples) {
    const double factor = 1.0 + camera.kdu * sample.distorted.squaredNorm();
    worst = std::max(worst, (factor * sample.distorted - sample.undistorted).norm() * camera.px);
  }
  return worst;
}

void take_distortion(const YAML::Node& root, const std::string& name, Intrinsics& camera) {
  const std::string key = "distortion_coefficients";
  if (!root[key]) return;
  const std::vector<double> values = yaml_matrix(root, key, name);
  const SourceLocation where = location_of(root[key], name);
  if (values.size() != 4 && values.size() != 5 && values.size() != 8)
    throw InputError(where, key + ": found " + std::to_string(values.size()) +
                                " numbers, must be 4, 5 or 8 (k1 k2 p1 p2 k3 k4 k5 k6)");
  Distortion k{};
  std::copy(values.begin(), values.end(), k.begin());
  const std::vector<LensSample> samples = sample_lens(camera, k);
  camera.kdu = fitted_kdu(samples);
  const double misfit = worst_misfit_px(camera, samples);
  constexpr double kMostMisfit = 1.0;  // px
  if (!(std::abs(camera.kdu) <= kLargestKdu) || !(misfit <= kMostMisfit)) {
    std::ostringstream what;
    what << key << ": vigia's one coefficient of distortion leaves this lens " << misfit
         << " px off; undistort the pictures and calibrate anew";
    throw InputError(where, what.str());
  }
}

// OpenCV's first line is no YAML directive as the standard has it.
std::string without_directive(const std::string& text) {
  if (text.compare(0, 5, "%YAML") != 0) return text;
  const std::size_t end = text.find('\n');
  return end == std::string::npos ? std::string() : '#' + text.substr(1);
}

Intrinsics camera_of_yaml(const std::string& text, const std::string& name) {
  YAML::Node root;
  try {
    root = YAML::Load(without_directive(text));
  } catch (const YAML::Exception& error) {
    throw InputError({name, error.mark.line + 1, error.mark.column + 1}, error.msg);
  }
  if (!root.IsMap())
    throw InputError({name}, "no camera: ViSP's XML or OpenCV's YAML would be right");
  Intrinsics out;
  const auto size = [&](const std::string& key) {
    return static_cast<int>(
        yaml_number(yaml_entry(root, key, name), key, {1.0, kLargestPicture}, name));
  };
  out.width = size("image_width");
  out.height = size("image_height");
  const std::vector<double> k = yaml_matrix(root, "camera_matrix", name);
  const SourceLocation where = location_of(root["camera_matrix"], name);
  if (k.size() != 9)
    throw InputError(where,
                     "camera_matrix: found " + std::to_string(k.size()) + " numbers, must be 9");
  if (!(k[0] >= 1.0 && k[4] >= 1.0) || k[1] != 0.0 || k[3] != 0.0)
    throw InputError(where,
                     "camera_matrix: must be [fx, 0, cx, 0, fy, cy, 0, 0, 1] with focal "
                     "lengths of 1 px at least");
  out.px = k[0];
  out.py = k[4];
  out.u0 = k[2];
  out.v0 = k[5];
  take_distortion(root, name, out);
  return out;
}

}  // namespace

Intrinsics parse_camera(const std::string& text, const std::string& name) {
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start == std::string::npos)
    throw InputError({name},
                     "this file is empty, where ViSP's XML or OpenCV's YAML would be right");
  return text[start] == '<' ? camera_of_xml(text, name) : camera_of_yaml(text, name);
}

Intrinsics read_camera(const std::filesystem::path& file) {
  return parse_camera(read_config_text(file, {}), file.string());
}

}  // namespace vigia

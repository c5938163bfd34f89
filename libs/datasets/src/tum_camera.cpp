// SPDX-License-Identifier: BSD-3-Clause
// Intrinsics merged from preset, camera file and single options.
#include "tum_camera.h"

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "roomgraph/core/errors.h"
#include "roomgraph/core/json_integer.h"
#include "roomgraph/core/suggest.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/datasets/camera_presets.h"

namespace roomgraph {
namespace {

using nlohmann::json;

json readJson(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw InputError(file.string() + ": no such camera file; the presets are " + presetNames());
  auto content = parseJson<json>(readTextFile(file), file.string());
  if (!content.is_object()) throw InputError(file.string() + ": is not a JSON object");
  return content;
}

// What is known, from the least to the most special source.
class Values {
 public:
  void take(const CameraPreset& preset) {
    const auto& camera = preset.camera;
    values_ = {{"fx", camera.fx},
               {"fy", camera.fy},
               {"cx", camera.cx},
               {"cy", camera.cy},
               {"depth_scale", preset.depth_scale}};
  }
  void take(const json& file) {
    for (const char* key : kKeys)
      if (file.contains(key)) values_[key] = file.at(key).get<double>();
  }
  void take(const std::string& key, const std::optional<double>& option) {
    if (option) values_[key] = *option;
  }
  double at(const std::string& key) const { return values_.at(key); }
  std::vector<std::string> missing() const {
    std::vector<std::string> names;
    for (const char* key : kKeys)
      if (!values_.contains(key)) names.emplace_back(key);
    return names;
  }

 private:
  static constexpr std::array<const char*, 5> kKeys{"fx", "fy", "cx", "cy", "depth_scale"};
  std::map<std::string, double> values_;
};

void requireAll(const Values& values, const std::filesystem::path& folder) {
  const auto missing = values.missing();
  if (missing.empty()) return;
  const std::string guess =
      presetForFolder(std::filesystem::absolute(folder).lexically_normal().filename().string());
  throw ConfigError("the camera is not known: no " + join(missing) +
                    (guess.empty() ? "" : " (the folder's name speaks for --camera " + guess + ")") +
                    "; name a published camera (--camera " + presetNames() + "), write " +
                    (folder / "camera.json").string() +
                    ", or give the numbers (--fx --fy --cx --cy --depth-scale)");
}

TumCamera readFile(const json& file) {
  TumCamera out;
  out.camera.width = integerOf<int>(file, "width", 0);
  out.camera.height = integerOf<int>(file, "height", 0);
  out.invalid_depth = integerOf<int>(file, "invalid_depth", 0);
  const auto distortion = file.value("distortion", std::vector<double>());
  if (distortion.size() > out.camera.distortion.size())
    throw InputError("camera file: distortion has more than 5 values (k1 k2 p1 p2 k3)");
  std::copy(distortion.begin(), distortion.end(), out.camera.distortion.begin());
  return out;
}

// Size, distortion and what else has no option of its own; the rest goes to `values`.
TumCamera readSource(const std::filesystem::path& folder, const TumImportOptions& options, Values& values) {
  if (!options.preset.empty()) {
    const auto preset = findCameraPreset(options.preset);
    if (!preset) throw ConfigError("no camera preset '" + options.preset + "'; there is: " + presetNames());
    values.take(*preset);
    return {preset->camera, 0, preset->invalid_depth, false};
  }
  json file = json::object();
  if (options.camera_file)
    file = readJson(*options.camera_file);
  else if (std::filesystem::exists(folder / "camera.json"))
    file = readJson(folder / "camera.json");
  try {
    values.take(file);
    return readFile(file);
  } catch (const json::exception& error) {
    throw InputError("camera file: " + firstLine(error));
  }
}

}  // namespace

TumCamera readTumCamera(const std::filesystem::path& folder, const TumImportOptions& options) {
  Values values;
  TumCamera out = readSource(folder, options, values);
  values.take("fx", options.fx);
  values.take("fy", options.fy);
  values.take("cx", options.cx);
  values.take("cy", options.cy);
  values.take("depth_scale", options.depth_scale);
  requireAll(values, folder);
  out.camera.fx = values.at("fx");
  out.camera.fy = values.at("fy");
  out.camera.cx = values.at("cx");
  out.camera.cy = values.at("cy");
  out.depth_scale = values.at("depth_scale");
  if (!(out.camera.fx > 0) || out.camera.fy == 0) throw ConfigError("fx must be positive and fy not zero");
  if (!(out.depth_scale > 0)) throw ConfigError("depth_scale must be positive");
  out.mirrored = out.camera.fy < 0;
  out.camera.fy = std::abs(out.camera.fy);
  // The mirrored image axis swaps the sign of what multiplies y once: p1.
  if (out.mirrored) out.camera.distortion[2] = -out.camera.distortion[2];
  return out;
}

}  // namespace roomgraph

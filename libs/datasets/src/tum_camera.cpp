// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "tum_camera.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using nlohmann::json;

json readJson(const std::filesystem::path& file) {
  auto content = parseJson<json>(readTextFile(file), file.string());
  if (!content.is_object()) throw InputError(file.string() + ": is not a JSON object");
  return content;
}

double required(const std::optional<double>& option, const json& file, const char* key, const char* hint) {
  if (option) return *option;
  if (!file.contains(key))
    throw ConfigError(std::string("no ") + key + ": give it in camera.json or as an option (" + hint + ")");
  return file.at(key).get<double>();
}

void readOptional(const json& file, PinholeCamera& camera) {
  camera.width = file.value("width", 0);
  camera.height = file.value("height", 0);
  const auto distortion = file.value("distortion", std::vector<double>());
  if (distortion.size() > camera.distortion.size())
    throw InputError("camera file: distortion has more than 5 values (k1 k2 p1 p2 k3)");
  std::copy(distortion.begin(), distortion.end(), camera.distortion.begin());
}

}  // namespace

TumCamera readTumCamera(const std::filesystem::path& folder, const TumImportOptions& options) {
  json file = json::object();
  if (options.camera_file)
    file = readJson(*options.camera_file);
  else if (std::filesystem::exists(folder / "camera.json"))
    file = readJson(folder / "camera.json");
  TumCamera out;
  try {
    readOptional(file, out.camera);
    out.camera.fx = required(options.fx, file, "fx", "--fx");
    out.camera.fy = required(options.fy, file, "fy", "--fy");
    out.camera.cx = required(options.cx, file, "cx", "--cx");
    out.camera.cy = required(options.cy, file, "cy", "--cy");
    out.depth_scale =
        required(options.depth_scale, file, "depth_scale", "--depth-scale; TUM and ICL-NUIM: 5000");
  } catch (const json::exception& error) {
    throw InputError("camera file: " + firstLine(error));
  }
  if (!(out.camera.fx > 0) || out.camera.fy == 0) throw ConfigError("fx must be positive and fy not zero");
  if (!(out.depth_scale > 0)) throw ConfigError("depth_scale must be positive");
  out.mirrored = out.camera.fy < 0;
  out.camera.fy = std::abs(out.camera.fy);
  // The mirrored image axis swaps the sign of what multiplies y once: p1.
  if (out.mirrored) out.camera.distortion[2] = -out.camera.distortion[2];
  return out;
}

}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Table of camera presets (TUM, ICL-NUIM, Kinect, 7-Scenes) with its sources, and lookup by name.
#include "roomgraph/datasets/camera_presets.h"

namespace roomgraph {

// Sources:
// freiburg1 … 3: TUM RGB-D benchmark, page "File formats": colour cameras and depth factor. The images of
//   freiburg3 are undistorted already. The correction of the depths (1.035, 1.031, 1.000) is in the published
//   images already.
// icl: ICL-NUIM, page of the data set (camera matrix; fy is negative) and of its TUM-compatible PNGs (scale).
// kinect: OpenNI's default for an uncalibrated Kinect, as on the benchmark's page ("ROS default"), with
//   millimetres as in ROS REP 118. Folders of the benchmark need its own scale: --depth-scale 5000.
// 7scenes: readme of Microsoft's 7-Scenes: depth camera, millimetres, 65535 where nothing was measured.
const std::vector<CameraPreset>& cameraPresets() {
  static const std::vector<CameraPreset> presets = {
      {"freiburg1",
       {640,
        480,
        517.306408,
        516.469215,
        318.643040,
        255.313989,
        {0.262383, -0.953104, -0.005358, 0.002628, 1.163314}},
       5000,
       0,
       "freiburg1"},
      {"freiburg2",
       {640,
        480,
        520.908620,
        521.007327,
        325.141442,
        249.701764,
        {0.231222, -0.784899, -0.003257, -0.000105, 0.917205}},
       5000,
       0,
       "freiburg2"},
      {"freiburg3", {640, 480, 535.4, 539.2, 320.1, 247.6, {}}, 5000, 0, "freiburg3"},
      {"icl", {640, 480, 481.20, -480.00, 319.50, 239.50, {}}, 5000, 0, "frei_png"},
      {"kinect", {640, 480, 525.0, 525.0, 319.5, 239.5, {}}, 1000, 0, ""},
      {"7scenes", {640, 480, 585.0, 585.0, 320.0, 240.0, {}}, 1000, 65535, "7scenes"},
  };
  return presets;
}

std::optional<CameraPreset> findCameraPreset(const std::string& name) {
  for (const auto& preset : cameraPresets())
    if (preset.name == name) return preset;
  return std::nullopt;
}

std::string presetForFolder(const std::string& folder_name) {
  for (const auto& preset : cameraPresets())
    if (!preset.folder_hint.empty() && folder_name.find(preset.folder_hint) != std::string::npos)
      return preset.name;
  return "";
}

std::string presetNames() {
  std::string text;
  for (const auto& preset : cameraPresets()) text += (text.empty() ? "" : "|") + preset.name;
  return text;
}

}  // namespace roomgraph

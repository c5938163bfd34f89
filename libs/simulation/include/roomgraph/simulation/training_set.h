// SPDX-License-Identifier: BSD-3-Clause
// Labelled single views of random flats, for training a detector.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace roomgraph {

/// Mesh files by what they stand for: the name of a piece of furniture, "door", "person" or "sitting person".
using MeshChoice = std::map<std::string, std::vector<std::filesystem::path>>;

struct TrainingSetOptions {
  std::uint64_t first_flat = 10000, last_flat = 10099;
  int views = 40;                                ///< of each flat
  cv::Size size{320, 240};                       ///< px, of the network's input
  MeshChoice meshes;                             ///< take the place of half of the built shapes; may be empty
  std::function<void(double, double)> progress;  ///< flats done and in all; may be empty
  std::function<bool()> interrupted;             ///< true: stop after this flat; may be empty
};

struct TrainingSetResult {
  int flats = 0, views = 0, boxes = 0;
  bool interrupted = false;
};

/// Reads {"KIND": ["FILE", ...], ...}, files relative to `folder`. Throws InputError (not JSON, not such an
/// object) and ConfigError (a kind that is none, a file that is not there).
MeshChoice readMeshChoice(const std::filesystem::path& file, const std::filesystem::path& folder);

/// Draws flats and looks at each from places along its path, in any direction and from any height that robots
/// and hands have; colours, light, depth noise, holes and registration vary beyond what recordings show.
/// Writes into `folder`, which is made: views.u8, one record of rgbdChannels() (6 x height x width bytes) per
/// view; views.jsonl, one line per view with the flat, the camera and the visible boxes in pixels of the
/// input; set.json, written last, with their number and shape. The same options give the same bytes. Throws
/// RunError when something cannot be written or rendered, ConfigError when the range is empty or holds a flat
/// that is kept for reporting (1000 to 1019).
TrainingSetResult writeTrainingSet(const TrainingSetOptions& options, const std::filesystem::path& folder);

}  // namespace roomgraph

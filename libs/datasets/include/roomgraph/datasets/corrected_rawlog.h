// SPDX-License-Identifier: BSD-3-Clause
// Copy of a rawlog with a calibration applied.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roomgraph/datasets/calibration_file.h"

namespace roomgraph {

/// Writes the observations of a rawlog with poses, stamps, depths and odometry as the calibration has them: a
/// run of the copy sees what a run of the input with the calibration sees. Images that lie in files are put
/// into the copy, which holds observations only. Colour is written as JPEG of this quality (1 to 100), or
/// without loss. Depth values move by whole units of the recording. `progress` gets the share done and may
/// throw; nothing is left of a copy that was not finished. Throws InputError (no rawlog), ConfigError (the
/// output is the input; a sensor is not in it) or RunError (cannot be written; depth along rays, which a bias
/// would not fit). Returns what was left out of the copy, in words: records that cannot be used, a file that is cut off.
std::vector<std::string> writeCorrectedRawlog(const std::filesystem::path& input, const std::filesystem::path& output,
                          const Calibration& calibration, std::optional<int> jpeg_quality = std::nullopt,
                          const std::function<void(double)>& progress = nullptr);

}  // namespace roomgraph

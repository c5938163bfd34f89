// SPDX-License-Identifier: BSD-3-Clause
// Ground truth of a TUM or ICL-NUIM folder, mirrored and re-timed where needed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace roomgraph {

/// Ground truth file of a TUM / ICL-NUIM folder: groundtruth.txt, or the only *.gt.freiburg; empty when there
/// is none.
std::filesystem::path findGroundTruth(const std::filesystem::path& folder);

/// The file's "t tx ty tz qx qy qz qw" lines; `mirrored`: poses become S T S, S = diag(1, -1, 1); frame
/// numbers become seconds at `frame_rate_hz`.
std::string groundTruthText(const std::filesystem::path& file, bool mirrored,
                            std::optional<double> frame_rate_hz);

}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Lookup and conversion of a ground-truth trajectory file.
#include "tum_ground_truth.h"

#include <cstdio>
#include <fstream>
#include <sstream>

namespace roomgraph {

namespace fs = std::filesystem;

fs::path findGroundTruth(const fs::path& folder) {
  if (fs::exists(folder / "groundtruth.txt")) return folder / "groundtruth.txt";
  fs::path found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().find(".gt.freiburg") == std::string::npos) continue;
    if (!found.empty()) return {};  // which one belongs to the images cannot be told
    found = entry.path();
  }
  return found;
}

std::string groundTruthText(const fs::path& file, bool mirrored, std::optional<double> frame_rate_hz) {
  std::ifstream in(file);
  std::ostringstream out;
  for (std::string line; std::getline(in, line);) {
    double t, x, y, z, qx, qy, qz, qw;
    std::istringstream words(line);
    const bool pose = static_cast<bool>(words >> t >> x >> y >> z >> qx >> qy >> qz >> qw);
    if (!pose || (!mirrored && !frame_rate_hz)) {
      out << line << "\n";
      continue;
    }
    if (frame_rate_hz) t /= *frame_rate_hz;
    // S R S turns by the same angle about the mirrored axis, the other way round: (qx, qy, qz) -> (-qx, qy,
    // -qz).
    const double sign = mirrored ? -1 : 1;
    char text[256];
    std::snprintf(text, sizeof text, "%.6f %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", t, x, sign * y, z,
                  sign * qx, qy, sign * qz, qw);
    out << text;
  }
  return out.str();
}

}  // namespace roomgraph

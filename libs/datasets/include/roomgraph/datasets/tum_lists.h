// SPDX-License-Identifier: BSD-3-Clause
// Image lists of a TUM folder, and pairing of colour with depth by time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace roomgraph {

/// One line "timestamp file" of rgb.txt or depth.txt.
struct TumEntry {
  double t = 0;
  std::string file;
};

struct TumPair {
  double t = 0;  ///< of the colour image, s
  std::filesystem::path color, depth;
};

/// A list of images: "timestamp file" on each line that is no comment. Throws InputError when it cannot be
/// read; `warnings` receives how many lines were not understood.
std::vector<TumEntry> readTumEntries(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// Pairs every entry of `color` with at most one of `depth`, and conversely: closest pairs first, no further
/// apart than `max_difference_s`. Returns indices (color, depth) ordered by the time of the colour image.
std::vector<std::pair<std::size_t, std::size_t>> pairByTime(const std::vector<TumEntry>& color,
                                                            const std::vector<TumEntry>& depth,
                                                            double max_difference_s);

/// The pairs of a folder, ordered by time, whether or not the files exist. Throws InputError when there is no
/// usable list. `warnings` receives what was left out.
std::vector<TumPair> readTumPairs(const std::filesystem::path& folder, double max_difference_s,
                                  std::vector<std::string>& warnings);

}  // namespace roomgraph

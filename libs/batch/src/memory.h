// SPDX-License-Identifier: BSD-3-Clause
// Memory that is there, and memory that a run is expected to need.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roomgraph/catalogue/catalogue.h"

namespace roomgraph {

/// What programs may still take, MB: MemAvailable, or less where a control group limits this process.
double availableMemory();
/// Room within the limit of a container, MB: a folder of control groups, version 2. What it holds of files counts as room.
/// Infinite without a limit.
double controlGroupRoom(const std::filesystem::path& group);

/// What runs are expected to need, from what earlier ones took.
class MemoryForecast {
 public:
  explicit MemoryForecast(std::vector<PastCost> past) : past_(std::move(past)) {}
  /// Peak memory of a run on this recording, MB, with a margin of a quarter: of the same recording; else of
  /// the one whose size is nearest, scaled up when it is smaller; else a guess from the size alone.
  double expected(const std::string& sha256, std::int64_t bytes) const;
  /// Takes a run in.
  void add(const PastCost& cost);

 private:
  std::vector<PastCost> past_;
};

}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Clock offset between two sensors from their order in the file.
#pragma once

#include <optional>
#include <vector>

#include "roomgraph/datasets/rawlog_report.h"

namespace roomgraph {

/// A record's place in the file and its stamp, s.
struct FilePlace {
  int index = 0;
  double t = 0;
};

/// Stamps of a sensor minus those of the reference sensor whose records stand before and after them in the
/// file (in the middle between the two), and the largest step in them. Both lists are in the order of the
/// file. Nothing when the records do not alternate.
std::optional<ClockOffset> clockOffset(const std::vector<FilePlace>& reference,
                                       const std::vector<FilePlace>& sensor);

}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Reader of bags in MCAP that needs no index.
#pragma once

#include <memory>

#include "bag_reader.h"

namespace roomgraph::bags {

/// Reads the files of one recording (.mcap) one after the other, each from its front to its end. Throws
/// InputError: cannot be opened, or is of another version.
std::unique_ptr<BagReader> openMcapBag(const std::vector<std::filesystem::path>& files);

}  // namespace roomgraph::bags

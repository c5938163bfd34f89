// SPDX-License-Identifier: BSD-3-Clause
// Reader of ROS 2 bags in SQLite storage.
#pragma once

#include <memory>

#include "bag_reader.h"

namespace roomgraph::bags {

/// Reads the files of one recording (.db3) one after the other. Throws InputError: cannot be opened, or is no
/// bag.
std::unique_ptr<BagReader> openRos2Bag(const std::vector<std::filesystem::path>& files);

}  // namespace roomgraph::bags

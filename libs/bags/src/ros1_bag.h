// SPDX-License-Identifier: BSD-3-Clause
// Reader of ROS 1 bags that needs no index.
#pragma once

#include <memory>

#include "bag_reader.h"

namespace roomgraph::bags {

/// Reads a bag of format 2.0 from its front to its end. Throws InputError: cannot be opened, is of an older
/// format, has no record.
std::unique_ptr<BagReader> openRos1Bag(const std::filesystem::path& file);

}  // namespace roomgraph::bags

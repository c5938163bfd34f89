// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

namespace roomgraph::lidar {

/// Registers this library's interfaces and stages with MRPT; safe to call again.
void registerClasses();

}  // namespace roomgraph::lidar

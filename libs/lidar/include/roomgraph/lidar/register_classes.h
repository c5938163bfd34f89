// SPDX-License-Identifier: BSD-3-Clause
// Registration of the lidar stages with MRPT's class factory.
#pragma once

namespace roomgraph::lidar {

/// Registers this library's interfaces and stages with MRPT; safe to call again.
void registerClasses();

}  // namespace roomgraph::lidar

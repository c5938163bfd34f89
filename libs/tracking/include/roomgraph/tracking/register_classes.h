// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

namespace roomgraph::tracking {

/// Registers this library's stages with MRPT's class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::tracking

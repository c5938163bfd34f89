// SPDX-License-Identifier: BSD-3-Clause
// Registration of the visual odometry stages with MRPT's class factory.
#pragma once

namespace roomgraph::tracking {

/// Registers this library's stages with MRPT's class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::tracking

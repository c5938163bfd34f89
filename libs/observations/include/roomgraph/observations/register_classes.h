// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

namespace roomgraph::observations {

/// Registers this library's serialisable classes with MRPT; safe to call again. The library also does so when
/// it is loaded as a plug-in (rawlog-edit -p, RawLogViewer).
void registerClasses();

}  // namespace roomgraph::observations

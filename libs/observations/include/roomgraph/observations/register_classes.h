// SPDX-License-Identifier: BSD-3-Clause
// Registration of the serialisable classes with MRPT.
#pragma once

namespace roomgraph::observations {

/// Registers this library's serialisable classes with MRPT; safe to call again. The library also does so when
/// it is loaded as a plug-in (rawlog-edit -p, RawLogViewer).
void registerClasses();

}  // namespace roomgraph::observations

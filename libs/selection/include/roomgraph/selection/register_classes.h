// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

namespace roomgraph::selection {

/// Registers the selectors with the class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::selection

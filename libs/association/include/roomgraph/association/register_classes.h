// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

namespace roomgraph::association {

/// Registers the associators with the class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::association

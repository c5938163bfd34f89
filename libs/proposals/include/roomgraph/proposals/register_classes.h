// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once

namespace roomgraph::proposals {

/// Registers the proposal generator classes with MRPT's class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::proposals

// SPDX-License-Identifier: BSD-3-Clause
// Registration of the proposal generators with MRPT's class factory.
#pragma once

namespace roomgraph::proposals {

/// Registers the proposal generator classes with MRPT's class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::proposals

// SPDX-License-Identifier: BSD-3-Clause
// Registration of the ground detectors, proposal and shape generators with MRPT's class factory.
#pragma once

namespace roomgraph::proposals {

/// Registers the ground detector, proposal and shape generator classes with MRPT's class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::proposals

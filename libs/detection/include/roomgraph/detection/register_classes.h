// SPDX-License-Identifier: BSD-3-Clause
// Registration of the detectors and network decoders with MRPT's class factory.
#pragma once

namespace roomgraph::detection {

/// Registers the classes of this library with MRPT's class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::detection

// SPDX-License-Identifier: BSD-3-Clause
// Registration of the detectors with MRPT's class factory.
#pragma once

namespace roomgraph::detection {

/// Registers the detector classes with MRPT's class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::detection

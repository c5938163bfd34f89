// SPDX-License-Identifier: BSD-3-Clause
// Registration of the selectors with MRPT's class factory.
#pragma once

namespace roomgraph::selection {

/// Registers the selectors with the class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::selection

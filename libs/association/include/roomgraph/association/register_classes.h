// SPDX-License-Identifier: BSD-3-Clause
// Registration of the associators with MRPT's class factory.
#pragma once

namespace roomgraph::association {

/// Registers the associators with the class factory; safe to call again.
void registerClasses();

}  // namespace roomgraph::association

// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#pragma once


namespace roomgraph::backend {

/// This library has no classes that are made by name; here so that every library is registered the same way.
void registerClasses();

}  // namespace roomgraph::backend

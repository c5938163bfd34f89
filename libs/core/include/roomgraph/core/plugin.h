// SPDX-License-Identifier: BSD-3-Clause
// Version of the interfaces that a plug-in was compiled with, exported for a check when it is loaded.
#pragma once

namespace roomgraph {

/// Version of the interfaces that plug-ins implement and of the structs they exchange. To be raised whenever
/// a public header changes the layout of a struct or the virtual functions of a class: a plug-in compiled
/// with the old header would read wrong memory without any error.
inline constexpr int kPluginInterfaceVersion = 4;

/// Signature and name of the function that a plug-in exports (ROOMGRAPH_PLUGIN).
using PluginInterfaceVersion = int();
inline constexpr const char* kPluginVersionSymbol = "roomgraphPluginInterfaceVersion";

}  // namespace roomgraph

/// Stands once in one source file of every plug-in: exports the version of the headers it was compiled with.
#define ROOMGRAPH_PLUGIN()                           \
  extern "C" int roomgraphPluginInterfaceVersion() { \
    return roomgraph::kPluginInterfaceVersion;       \
  }

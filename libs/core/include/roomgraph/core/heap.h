// SPDX-License-Identifier: BSD-3-Clause
// Giving freed memory back to the system.
#pragma once

namespace roomgraph {

/// Pages that are free between those still in use go back to the system; without that the C library keeps them for later. What
/// comes next may need one large piece, for which they do not serve.
void giveBackFreedMemory();

}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// What the C library keeps of freed memory.
#pragma once

namespace roomgraph {

/// Threads share one heap from now on: of the many that the C library would make for them each keeps what it once needed at most,
/// a sixth of a long run's memory.
void shareHeap();

/// Pages that are free between those still in use go back to the system; without that the C library keeps them for later. What
/// comes next may need one large piece, for which they do not serve.
void giveBackFreedMemory();

}  // namespace roomgraph

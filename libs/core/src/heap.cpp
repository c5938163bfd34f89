// SPDX-License-Identifier: BSD-3-Clause
// Wraps what glibc offers for it.
#include "roomgraph/core/heap.h"

#include <malloc.h>

namespace roomgraph {

void giveBackFreedMemory() {
  malloc_trim(0);
}

}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Wraps what glibc offers for it.
#include "roomgraph/core/heap.h"

#include <malloc.h>

namespace roomgraph {

void shareHeap() {
  mallopt(M_ARENA_MAX, 1);
}

void giveBackFreedMemory() {
  malloc_trim(0);
}

}  // namespace roomgraph

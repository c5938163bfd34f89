// SPDX-License-Identifier: BSD-3-Clause
// AllocationLimit: bound on the memory that a thread may allocate, against damaged counts in input.
#pragma once

#include <cstddef>

namespace roomgraph {

/// While it lives, this thread may allocate `bytes` in all through operator new and mrpt::aligned_malloc;
/// what goes beyond throws std::bad_alloc. Memory that is freed again counts as well. Small
/// allocations still get a quarter of a megabyte then, so that exceptions can be made and told. Limits may be
/// nested: an inner one replaces the outer one while it lives. Other threads are not concerned.
///
/// Why: MRPT's readers resize containers to whatever count a file gives before they read the elements, and
/// its allocator returns null instead of throwing. A damaged count would fill the memory or crash. No class'
/// layout needs to be known here: a record of n bytes cannot hold much more than n bytes.
///
/// Not in effect under the address and thread sanitizers (which bring their own operator new), except for
/// mrpt::aligned_malloc; nor where this library is loaded at run time into a program that does not link it.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::size_t bytes);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;

  /// True while this thread has a limit.
  static bool active();

 private:
  std::size_t outer_;
};

}  // namespace roomgraph

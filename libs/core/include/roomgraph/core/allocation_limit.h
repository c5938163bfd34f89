// SPDX-License-Identifier: BSD-3-Clause
// AllocationLimit: bound on the memory that a thread may allocate, against damaged counts in input.
#pragma once

#include <cstddef>

namespace roomgraph {

/// During its lifetime this thread may allocate `bytes` in all through operator new and mrpt::aligned_malloc; further
/// allocations throw std::bad_alloc. Freed memory counts as well. Small allocations have a reserve of a quarter of a
/// megabyte, so that exceptions can be thrown and reported. Limits may be nested: the inner one replaces the outer one
/// during its lifetime. Other threads are not limited.
///
/// Why: MRPT's readers resize containers to whatever count a file gives before they read the elements, and
/// its allocator returns null instead of throwing. A damaged count would fill the memory or crash. The layout of the
/// classes does not matter: a record of n bytes does not need much more than n bytes.
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

// SPDX-License-Identifier: BSD-3-Clause
// Address-space limit and peak memory of the test process.
#pragma once

#include <sys/resource.h>

namespace roomgraph::test {

/// Sanitizers bring an operator new of their own, which knows no AllocationLimit, and need more addresses
/// than a limit would leave them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMemoryCanBeLimited = false;
#else
constexpr bool kMemoryCanBeLimited = true;
#endif

/// Most memory that this process has had at a time, MB.
inline double peakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// From now on the process gets no more than 4 GB of addresses: what asks for more fails, as on a small
/// machine.
inline void limitAddressSpace() {
  const rlimit limit{4ul << 30, 4ul << 30};
  if (kMemoryCanBeLimited) setrlimit(RLIMIT_AS, &limit);
}

}  // namespace roomgraph::test

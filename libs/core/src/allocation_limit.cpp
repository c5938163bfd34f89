// SPDX-License-Identifier: BSD-3-Clause
// Replacements of operator new and mrpt::aligned_malloc that count against a thread-local limit.
#include "roomgraph/core/allocation_limit.h"

#include <mrpt/core/aligned_allocator.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <limits>
#include <new>

#include "roomgraph/core/unexpected.h"

namespace roomgraph {
namespace {

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

constexpr std::size_t kSmall = 1u << 14, kReserve = 1u << 18;

// Read by every allocation of the process: "initial-exec" makes that one instruction.
[[gnu::tls_model("initial-exec")]] constinit thread_local std::size_t left = kUnlimited;
[[gnu::tls_model("initial-exec")]] constinit thread_local std::size_t reserve = kReserve;
constinit std::atomic<std::size_t> shortages = 0;

// MRPT's exceptions note the call stack and compose their text in functions that must not throw: small things
// have a reserve of their own, and handlers get them in any case; so do destructors while the stack is unwound (those of MRPT's observations
// hand their memory to a pool), which would end the program.
bool allowed(std::size_t size) {
  if (left == kUnlimited) return true;
  if (size <= left) {
    left -= size;
    return true;
  }
  if (size > kSmall) return false;
  if (std::uncaught_exceptions() > 0) return true;
  if (size > reserve) return std::current_exception() != nullptr;
  reserve -= size;
  return true;
}

void* allocate(std::size_t size, std::size_t alignment) {
  if (!allowed(size)) return nullptr;
  if (size > kUnlimited - alignment) return nullptr;
  void* memory = alignment <= alignof(std::max_align_t)
                     ? std::malloc(std::max<std::size_t>(size, 1))
                     : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (!memory) ++shortages;
  return memory;
}

void* allocateOrThrow(std::size_t size, std::size_t alignment) {
  while (true) {
    if (void* memory = allocate(size, alignment)) return memory;
    const auto handler = std::get_new_handler();
    if (!handler || AllocationLimit::active()) throw std::bad_alloc();
    handler();
  }
}

}  // namespace

AllocationLimit::AllocationLimit(std::size_t bytes) : outer_(left) {
  left = std::min(bytes, kUnlimited - 1);
  if (outer_ == kUnlimited) reserve = kReserve;
}

AllocationLimit::~AllocationLimit() {
  left = outer_;
}

std::size_t memoryShortages() {
  return shortages;
}

bool AllocationLimit::active() {
  return left != kUnlimited;
}

}  // namespace roomgraph

// Takes the place of MRPT's own, which returns null when there is no memory: its containers then write to
// address 0. MRPT frees with free(), as do we.
void* mrpt::aligned_malloc(std::size_t size, std::size_t alignment) {
  return roomgraph::allocateOrThrow(size, alignment);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

using roomgraph::allocate;
using roomgraph::allocateOrThrow;

constexpr std::size_t kPlain = __STDCPP_DEFAULT_NEW_ALIGNMENT__;

// The replaceable allocation functions of [new.delete]; the default nothrow and array forms that are not
// here call these.
void* operator new(std::size_t size) {
  return allocateOrThrow(size, kPlain);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocateOrThrow(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

#endif

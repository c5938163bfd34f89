// SPDX-License-Identifier: BSD-3-Clause
// AllocationLimit against containers, every form of new, threads and exceptions.
#include "roomgraph/core/allocation_limit.h"

#include <gtest/gtest.h>
#include <mrpt/core/aligned_allocator.h>

#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "memory_limit.h"

namespace roomgraph {
namespace {

using AlignedBytes = std::vector<char, mrpt::aligned_allocator_cpp11<char>>;

/// Whether `action` is refused under a limit. (GoogleTest's macros allocate, so they stay outside.)
template <class Action>
bool isRefused(std::size_t limit_bytes, const Action& action) {
  const AllocationLimit limit(limit_bytes);
  try {
    action();
    return false;
  } catch (const std::bad_alloc&) {
    return true;
  }
}

/// Otherwise the compiler leaves out what is made and thrown away.
template <class T>
void keep(const std::unique_ptr<T>& pointer) {
  asm volatile("" : : "r"(pointer.get()) : "memory");
}

TEST(AllocationLimit, ContainersOfMrptThrowInsteadOfWritingToNull) {
  AlignedBytes bytes;
  EXPECT_FALSE(isRefused(100000, [&] { bytes.resize(50000); }));
  EXPECT_TRUE(isRefused(100000, [&] { bytes.resize(1000000); }));
  EXPECT_EQ(bytes.size(), 50000u) << "what it had is still there";
}

TEST(AllocationLimit, AlignedMallocThrowsWhereThereIsNoSuchMemory) {
  if (!test::kMemoryCanBeLimited) GTEST_SKIP() << "the sanitizer ends the program at such a size";
  EXPECT_FALSE(AllocationLimit::active());
  EXPECT_THROW(mrpt::aligned_malloc(SIZE_MAX / 4, 32), std::bad_alloc);
  void* memory = mrpt::aligned_malloc(100, 64);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % 64, 0u);
  mrpt::aligned_free(memory);
}

TEST(AllocationLimit, CountsEveryFormOfNew) {
  if (!test::kMemoryCanBeLimited) GTEST_SKIP() << "the sanitizer has its own operator new";
  struct alignas(128) Wide {
    char bytes[50000];
  };
  EXPECT_TRUE(isRefused(40000, [] { std::string(50000, 'x'); }));
  EXPECT_TRUE(isRefused(40000, [] { std::vector<double>(10000); }));
  EXPECT_TRUE(isRefused(40000, [] { keep(std::make_unique<char[]>(50000)); }));
  EXPECT_TRUE(isRefused(40000, [] { keep(std::make_unique<Wide>()); }));
  EXPECT_FALSE(isRefused(40000, [] { std::string(30000, 'x'); }));
  const char* none = "";
  EXPECT_FALSE(isRefused(40000, [&] { none = new (std::nothrow) char[50000]; }));
  EXPECT_EQ(none, nullptr);
}

TEST(AllocationLimit, FreedMemoryStaysCounted) {
  if (!test::kMemoryCanBeLimited) GTEST_SKIP() << "the sanitizer has its own operator new";
  int made = 0;
  EXPECT_TRUE(isRefused(200000, [&] {
    for (; made < 100; ++made) AlignedBytes(20000);
  }));
  EXPECT_EQ(made, 10);
}

TEST(AllocationLimit, EndsWithItsScopeAndIsOfOneThread) {
  AlignedBytes bytes;
  bool inner = false, after = true, other = true;
  {
    const AllocationLimit outer(1 << 20);
    inner = isRefused(10000, [&] { bytes.resize(50000); });
    std::thread([&] { other = AllocationLimit::active(); }).join();
    after = !AllocationLimit::active();
  }
  EXPECT_TRUE(inner);
  EXPECT_FALSE(after);
  EXPECT_FALSE(other);
  EXPECT_FALSE(AllocationLimit::active());
  EXPECT_NO_THROW(bytes.resize(2 << 20));
}

// MRPT's exceptions note the call stack and compose their text where nothing may be thrown.
TEST(AllocationLimit, SmallThingsHaveAReserveAndHandlersAlwaysGetThem) {
  if (!test::kMemoryCanBeLimited) GTEST_SKIP() << "the sanitizer has its own operator new";
  EXPECT_FALSE(isRefused(0, [] { std::string(5000, 'x'); }));
  std::size_t length = 0;
  EXPECT_TRUE(isRefused(0, [&] {
    try {
      for (int i = 0; i < 1000; ++i) std::string(5000, 'x');
    } catch (const std::bad_alloc&) {
      length = std::string(5000, 'x').size();
      std::string(1 << 20, 'x');
    }
  }));
  EXPECT_EQ(length, 5000u);
}

// A destructor that throws while the stack is unwound ends the program.
TEST(AllocationLimit, DestructorsGetSmallThingsWhileAnExceptionIsUnderWay) {
  if (!test::kMemoryCanBeLimited) GTEST_SKIP() << "the sanitizer has its own operator new";
  struct TidiesUp {
    ~TidiesUp() { left_behind += std::string(5000, 'x').size(); }
    std::size_t& left_behind;
  };
  std::size_t left_behind = 0;
  EXPECT_TRUE(isRefused(0, [&] {
    const TidiesUp last{left_behind};
    for (int i = 0; i < 1000; ++i) std::string(5000, 'x');
  }));
  EXPECT_EQ(left_behind, 5000u);
}

}  // namespace
}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
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
bool refused(std::size_t limit_bytes, const Action& action) {
  const AllocationLimit limit(limit_bytes);
  try {
    action();
    return false;
  } catch (const std::bad_alloc&) {
    return true;
  }
}

TEST(AllocationLimit, ContainersOfMrptThrowInsteadOfWritingToNull) {
  AlignedBytes bytes;
  EXPECT_FALSE(refused(1000, [&] { bytes.resize(500); }));
  EXPECT_TRUE(refused(1000, [&] { bytes.resize(10000); }));
  EXPECT_EQ(bytes.size(), 500u) << "what it had is still there";
}

TEST(AllocationLimit, AlignedMallocThrowsWhereThereIsNoSuchMemory) {
  EXPECT_FALSE(AllocationLimit::active());
  EXPECT_THROW(mrpt::aligned_malloc(SIZE_MAX / 4, 32), std::bad_alloc);
  void* memory = mrpt::aligned_malloc(100, 64);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % 64, 0u);
  mrpt::aligned_free(memory);
}

TEST(AllocationLimit, CountsEveryFormOfNew) {
  if (!testing::kMemoryCanBeLimited) GTEST_SKIP() << "the sanitizer has its own operator new";
  struct alignas(128) Wide {
    char bytes[4096];
  };
  EXPECT_TRUE(refused(4000, [] { std::string(5000, 'x'); }));
  EXPECT_TRUE(refused(4000, [] { std::vector<double>(1000); }));
  EXPECT_TRUE(refused(4000, [] { std::make_unique<char[]>(5000); }));
  EXPECT_TRUE(refused(4000, [] { std::make_unique<Wide>(); }));
  EXPECT_FALSE(refused(4000, [] { std::string(3000, 'x'); }));
  const char* none = "";
  EXPECT_FALSE(refused(4000, [&] { none = new (std::nothrow) char[5000]; }));
  EXPECT_EQ(none, nullptr);
}

TEST(AllocationLimit, FreedMemoryStaysCounted) {
  if (!testing::kMemoryCanBeLimited) GTEST_SKIP() << "the sanitizer has its own operator new";
  int made = 0;
  EXPECT_TRUE(refused(10000, [&] {
    for (; made < 100; ++made) AlignedBytes(1000);
  }));
  EXPECT_EQ(made, 10);
}

TEST(AllocationLimit, EndsWithItsScopeAndIsOfOneThread) {
  AlignedBytes bytes;
  bool inner = false, after = true, other = true;
  {
    const AllocationLimit outer(1 << 20);
    inner = refused(10000, [&] { bytes.resize(50000); });
    std::thread([&] { other = AllocationLimit::active(); }).join();
    after = !AllocationLimit::active();
  }
  EXPECT_TRUE(inner);
  EXPECT_FALSE(after);
  EXPECT_FALSE(other);
  EXPECT_FALSE(AllocationLimit::active());
  EXPECT_NO_THROW(bytes.resize(2 << 20));
}

// MRPT's exceptions compose their text in what(), which may not throw.
TEST(AllocationLimit, HandlersCanTellWhatHappened) {
  std::size_t length = 0;
  EXPECT_FALSE(refused(0, [&] {
    try {
      throw 1;
    } catch (int) {
      length = std::string(5000, 'x').size();
    }
  }));
  EXPECT_EQ(length, 5000u);
  if (!testing::kMemoryCanBeLimited) return;
  EXPECT_TRUE(refused(0, [] {
    try {
      throw 1;
    } catch (int) {
      std::string(1 << 20, 'x');
    }
  })) << "but no more than that";
}

}  // namespace
}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Lists as MRPT writes them; lengths that are damaged.
#include "roomgraph/observations/growing_reads.h"

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>

#include <numeric>

#include "memory_limit.h"

namespace roomgraph::test {
namespace {

using mrpt::serialization::archiveFrom;

TEST(GrowingReads, WhatMrptWrites) {
  for (const std::size_t size : {0U, 1U, 16383U, 16384U, 16385U, 65536U, 200000U}) {
    std::string text(size, 'x');
    for (std::size_t i = 0; i < size; i += 7) text[i] = static_cast<char>(i % 251);
    std::vector<std::uint32_t> numbers(size);
    std::iota(numbers.begin(), numbers.end(), 1000000U);
    const std::vector<std::string> texts{"", text, "end"};
    mrpt::io::CMemoryStream memory;
    auto archive = archiveFrom(memory);
    archive << text << numbers << texts;
    memory.Seek(0);
    EXPECT_EQ(readText(archive), text);
    EXPECT_EQ(readGrowing<std::vector<std::uint32_t>>(archive), numbers);
    EXPECT_EQ(readList(archive, readText), texts);
    EXPECT_EQ(memory.getPosition(), memory.getTotalBytesCount());
  }
}

TEST(GrowingReads, ALengthTakesNoMemory) {
  mrpt::io::CMemoryStream memory;
  auto archive = archiveFrom(memory);
  archive << std::uint32_t{0xfffffff0U} << std::uint32_t{7};
  const double before_mb = peakMegabytes();
  memory.Seek(0);
  EXPECT_THROW(readText(archive), std::exception);
  memory.Seek(0);
  EXPECT_THROW(readGrowing<std::vector<std::uint32_t>>(archive), std::exception);
  memory.Seek(0);
  EXPECT_THROW(readList(archive, readText), std::exception);
  EXPECT_LT(peakMegabytes() - before_mb, 16);
}

}  // namespace
}  // namespace roomgraph::test

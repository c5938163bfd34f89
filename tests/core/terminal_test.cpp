// SPDX-License-Identifier: BSD-3-Clause
// Width of pseudo-terminals, and of what is none.
#include "roomgraph/core/terminal.h"

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace roomgraph {
namespace {

std::size_t widthOf(unsigned short columns) {
  int outer = -1, inner = -1;
  winsize size{24, columns, 0, 0};
  if (openpty(&outer, &inner, nullptr, nullptr, &size) != 0) return 0;
  const std::size_t width = terminalWidth(inner);
  close(inner);
  close(outer);
  return width;
}

TEST(Terminal, HasTheWidthOfItsWindow) {
  EXPECT_EQ(widthOf(20), 20u);
  EXPECT_EQ(widthOf(1), 1u);
  EXPECT_EQ(widthOf(213), 213u);
}

TEST(Terminal, WhoDoesNotSayHasTheUsualWidth) {
  EXPECT_EQ(widthOf(0), 80u) << "serial lines do not know";
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  EXPECT_EQ(terminalWidth(ends[1]), 80u);
  close(ends[0]);
  close(ends[1]);
  EXPECT_EQ(terminalWidth(-1), 80u);
}

}  // namespace
}  // namespace roomgraph

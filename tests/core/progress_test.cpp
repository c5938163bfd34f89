// SPDX-License-Identifier: BSD-3-Clause
// Progress line: silence without a stream and few lines in a file.
#include "roomgraph/core/progress.h"

#include <gtest/gtest.h>

#include <sstream>

namespace roomgraph {
namespace {

TEST(Progress, SilentWithoutStream) {
  Progress progress(nullptr, "run", "frames", 10);
  progress.update(5, "note");
  progress.finish("done");
}

TEST(Progress, DoesNotFloodAFile) {
  std::ostringstream out;
  Progress progress(&out, "run", "frames", 1000);
  for (int i = 0; i < 1000; ++i) progress.update(i);
  EXPECT_EQ(out.str(), "");
  progress.finish("1000 frames");
  EXPECT_EQ(out.str(), "1000 frames\n");
}

}  // namespace
}  // namespace roomgraph

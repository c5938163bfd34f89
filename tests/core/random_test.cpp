// SPDX-License-Identifier: BSD-3-Clause
// Random streams: independence, repeatability and normal variance.
#include "roomgraph/core/random.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

TEST(Random, StreamsAndSeedsAreUnrelatedAndRepeatable) {
  EXPECT_EQ(Random(1, 2, 3).uniform(), Random(1, 2, 3).uniform());
  EXPECT_NE(Random(1, 2, 3).uniform(), Random(2, 2, 3).uniform());
  EXPECT_NE(Random(1, 2, 3).uniform(), Random(1, 3, 3).uniform());
  EXPECT_NE(Random(1, 2, 3).uniform(), Random(1, 2, 4).uniform());
}

TEST(Random, NormalHasUnitVariance) {
  Random random(7);
  double sum = 0, squares = 0;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kCount, 0, 4 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1, 0.02);
}

}  // namespace
}  // namespace roomgraph

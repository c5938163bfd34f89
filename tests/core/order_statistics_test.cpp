// SPDX-License-Identifier: BSD-3-Clause
// Quantile and median against sorted lists.
#include "roomgraph/core/order_statistics.h"

#include <gtest/gtest.h>

namespace roomgraph {
namespace {

TEST(OrderStatistics, EqualTheRanksOfTheSortedList) {
  std::vector<double> shuffled;
  for (int count = 1; count <= 30; ++count) {
    shuffled.clear();
    for (int i = 0; i < count; ++i) shuffled.push_back((i * 37) % 31);  // 31 is prime: all different
    std::vector<double> sorted = shuffled;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(median(shuffled), sorted[sorted.size() / 2]) << count;
    EXPECT_EQ(quantile(shuffled, 0), sorted.front());
    EXPECT_EQ(quantile(shuffled, 1), sorted.back());
    for (int rank = 0; rank < count; ++rank)
      EXPECT_EQ(quantile(shuffled, count == 1 ? 0.3 : rank / (count - 1.0)),
                sorted[static_cast<std::size_t>(rank)]);
  }
}

TEST(OrderStatistics, OfNothingIsZero) {
  EXPECT_EQ(quantile({}, 0.5), 0);
  EXPECT_EQ(median({}), 0);
}

}  // namespace
}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Outcome: value or reason, and move-only values.
#include "roomgraph/core/outcome.h"

#include <gtest/gtest.h>

#include <memory>

namespace roomgraph {
namespace {

TEST(Outcome, ValueOrReason) {
  const Outcome<int> good = 5;
  EXPECT_TRUE(good);
  EXPECT_TRUE(good.ok());
  EXPECT_EQ(*good, 5);
  EXPECT_EQ(good.reason(), "");
  const auto bad = Outcome<int>::failure("lost");
  EXPECT_FALSE(bad);
  EXPECT_EQ(bad.reason(), "lost");
}

TEST(Outcome, HoldsWhatCanOnlyBeMoved) {
  Outcome<std::unique_ptr<int>> outcome = std::make_unique<int>(7);
  EXPECT_EQ(**outcome, 7);
  const auto taken = std::move(*outcome);
  EXPECT_EQ(*taken, 7);
}

TEST(Outcome, TextIsAValueNotAReason) {
  const Outcome<std::string> outcome = std::string("words");
  EXPECT_TRUE(outcome);
  EXPECT_EQ(outcome->size(), 5u);
}

}  // namespace
}  // namespace roomgraph

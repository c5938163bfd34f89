// SPDX-License-Identifier: BSD-3-Clause
// Recent: the last keys are made once, others again; nothing is kept of what failed.
#include "recent.h"

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>

namespace roomgraph {
namespace {

using testing::ElementsAre;

TEST(Recent, TheLastOnesAskedForAreMadeOnce) {
  Recent<int, std::string> recent(2);
  std::vector<int> made;
  const auto ask = [&](int key) {
    EXPECT_EQ(recent.of(key, [&] { return made.push_back(key), std::to_string(key); }), std::to_string(key));
  };
  for (const int key : {1, 2, 1, 2}) ask(key);
  EXPECT_THAT(made, ElementsAre(1, 2));
  ask(3);  // in the place of 1, which was asked for before 2
  ask(2);
  EXPECT_THAT(made, ElementsAre(1, 2, 3));
  ask(1);  // in the place of 3
  ask(2);
  EXPECT_THAT(made, ElementsAre(1, 2, 3, 1));
}

TEST(Recent, NothingIsKeptOfWhatFailed) {
  Recent<int, int> recent(1);
  EXPECT_EQ(recent.of(1, [] { return 10; }), 10);
  EXPECT_THROW(recent.of(2, []() -> int { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_EQ(recent.of(2, [] { return 20; }), 20);
}

}  // namespace
}  // namespace roomgraph

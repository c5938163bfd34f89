// SPDX-License-Identifier: BSD-3-Clause
// Names of deciders and optimizers: known, unknown, of planar poses alone.
#include "roomgraph/graphslam/decider_names.h"

#include <gmock/gmock.h>

#include "roomgraph/core/errors.h"

namespace roomgraph {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string problemOf(const EngineParts& parts) {
  try {
    checkParts(parts, "x.ini");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(DeciderNames, EveryKindIsTakenInItsRole) {
  for (const auto& kind : deciderKinds()) {
    for (const int dimensions : {2, 3}) {
      EngineParts parts{"CEmptyNRD", {"CEmptyERD"}, "CEmptyGSO", dimensions};
      if (kind.role == DeciderRole::kNode) parts.node = kind.name;
      if (kind.role == DeciderRole::kEdge) parts.edges = {kind.name};
      if (kind.role == DeciderRole::kOptimizer) parts.optimizer = kind.name;
      if (dimensions == 2 || kind.in_3d)
        EXPECT_EQ(problemOf(parts), "") << kind.name;
      else
        EXPECT_THAT(problemOf(parts), HasSubstr(kind.name + ": is there for planar poses alone; known in 3D: "));
      EXPECT_EQ(parts.anyOfOurs(), kind.ours) << kind.name;
      EXPECT_TRUE(parts.has(kind.name));
    }
  }
}

TEST(DeciderNames, WrongNamesAreErrorsThatListTheRightOnes) {
  EXPECT_THAT(problemOf({"CKeyPoseNRD", {"CEmptyERD"}, "CEmptyGSO", 2}),
              AllOf(HasSubstr("x.ini: node_registration_decider = CKeyPoseNRD: there is none"),
                    HasSubstr("did you mean 'CKeyPosesNRD'"), HasSubstr("CFixedIntervalsNRD, ")));
  EXPECT_THAT(problemOf({"CEmptyNRD", {"CLevMarqGSO"}, "CEmptyGSO", 2}), HasSubstr("edge_registration_decider = CLevMarqGSO"));
  EXPECT_THAT(problemOf({"CEmptyNRD", {"CEmptyERD", "CEmptyERD"}, "CEmptyGSO", 2}), HasSubstr("is named twice"));
  EXPECT_THAT(problemOf({"CEmptyNRD", {"CEmptyERD"}, "CEmptyGSO", 4}), HasSubstr("dimensions = 4: must be 2 or 3"));
}

TEST(DeciderNames, EdgeDecidersAreJoinedByPlus) {
  EXPECT_THAT(splitEdgeDeciders("A"), ElementsAre("A"));
  EXPECT_THAT(splitEdgeDeciders("A+B+C"), ElementsAre("A", "B", "C"));
  for (const char* wrong : {"", "+", "A+", "+A", "A++B"}) EXPECT_THROW(splitEdgeDeciders(wrong), ConfigError) << wrong;
}

}  // namespace
}  // namespace roomgraph

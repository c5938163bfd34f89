// SPDX-License-Identifier: BSD-3-Clause
// Class registry: creation by name, listing, unknown names and missing plug-ins.
#include "roomgraph/core/class_registry.h"

#include <gmock/gmock.h>

#include "errors_of.h"
#include "example_stages.h"

namespace roomgraph {

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Greeter, Stage, roomgraph)
IMPLEMENTS_MRPT_OBJECT(PoliteGreeter, Greeter, roomgraph)
IMPLEMENTS_MRPT_OBJECT(CurtGreeter, Greeter, roomgraph)

/// An interface whose two implementations have one name in different namespaces.
class Farewell : public Stage {
  DEFINE_VIRTUAL_MRPT_OBJECT(Farewell)
};
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Farewell, Stage, roomgraph)

namespace english {
class Goodbye : public Farewell {
  DEFINE_MRPT_OBJECT(Goodbye, roomgraph::english)
};
IMPLEMENTS_MRPT_OBJECT(Goodbye, Farewell, roomgraph::english)
}  // namespace english

namespace shouted {
class Goodbye : public Farewell {
  DEFINE_MRPT_OBJECT(Goodbye, roomgraph::shouted)
};
IMPLEMENTS_MRPT_OBJECT(Goodbye, Farewell, roomgraph::shouted)
}  // namespace shouted

namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using test::messageOf;

class ClassRegistry : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int twice = 0; twice < 2; ++twice) {
      mrpt::rtti::registerClass(CLASS_ID(Greeter));
      mrpt::rtti::registerClass(CLASS_ID(PoliteGreeter));
      mrpt::rtti::registerClass(CLASS_ID(CurtGreeter));
    }
  }
};

TEST_F(ClassRegistry, MakesImplementationsByNameWithOrWithoutNamespace) {
  EXPECT_EQ(createStage<Greeter>("PoliteGreeter", "test")->greet(), "good day");
  EXPECT_EQ(createStage<Greeter>("roomgraph::CurtGreeter", "test")->greet(), "hi");
}

TEST_F(ClassRegistry, EachCallMakesAnObjectOfItsOwn) {
  EXPECT_NE(createStage<Greeter>("CurtGreeter", "test"), createStage<Greeter>("CurtGreeter", "test"));
}

TEST_F(ClassRegistry, ListsImplementationsOnceWithoutTheInterface) {
  EXPECT_THAT(implementationsOf(CLASS_ID(Greeter)), ElementsAre("CurtGreeter", "PoliteGreeter"));
}

TEST_F(ClassRegistry, UnknownNameListsTheKnownOnes) {
  const auto message =
      messageOf<ConfigError>([] { createStage<Greeter>("PoliteGreter", "[greeting] class"); });
  EXPECT_THAT(message, HasSubstr("[greeting] class: no class 'PoliteGreter' that is a Greeter"));
  EXPECT_THAT(message, HasSubstr("did you mean 'PoliteGreeter'?"));
  EXPECT_THAT(message, HasSubstr("known: CurtGreeter, PoliteGreeter"));
}

TEST_F(ClassRegistry, TheInterfaceItselfAndStrangersAreNoImplementations) {
  EXPECT_THROW(createStage<Greeter>("Greeter", "test"), ConfigError);
  EXPECT_THROW(createStage<Greeter>("Stage", "test"), ConfigError);
  EXPECT_THROW(createStage<Greeter>("", "test"), ConfigError);
}

TEST_F(ClassRegistry, OneNameInTwoNamespacesIsAnErrorThatNamesBoth) {
  mrpt::rtti::registerClass(CLASS_ID(Farewell));
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(Goodbye, roomgraph::english));
  EXPECT_THAT(implementationsOf(CLASS_ID(Farewell)), ElementsAre("Goodbye"));
  mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(Goodbye, roomgraph::shouted));
  const auto both = AllOf(HasSubstr("two classes have the name 'Goodbye'"),
                          HasSubstr("roomgraph::english::Goodbye"), HasSubstr("roomgraph::shouted::Goodbye"));
  EXPECT_THAT(messageOf<ConfigError>([] { createStage<Farewell>("Goodbye", "test"); }), both);
  EXPECT_THAT(messageOf<ConfigError>([] { implementationsOf(CLASS_ID(Farewell)); }), both);
  EXPECT_NO_THROW(createStage<Greeter>("CurtGreeter", "test")) << "other interfaces are not concerned";
}

TEST_F(ClassRegistry, MissingPluginIsAConfigError) {
  const auto message = messageOf<ConfigError>([] { loadPlugin("no_such_plugin.so"); });
  EXPECT_THAT(message, HasSubstr("no_such_plugin.so"));
  EXPECT_EQ(ConfigError("").exit_code, 2);
  EXPECT_EQ(InputError("").exit_code, 3);
  EXPECT_EQ(RunError("").exit_code, 1);
}

}  // namespace
}  // namespace roomgraph

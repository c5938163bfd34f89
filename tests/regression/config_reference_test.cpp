// SPDX-License-Identifier: BSD-3-Clause
// docs/config.md against the declared parameters, and the shipped configuration.
#include "program.h"
#include "roomgraph/core/config.h"
#include "roomgraph/pipeline/setup.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

const std::filesystem::path kSource = ROOMGRAPH_SOURCE_DIR;

TEST(ConfigReference, IsWhatTheProgramDeclares) {
  TemporaryFolder folder;
  const CallResult outcome = call(folder.path(), {"config-reference"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out == contentOf(kSource / "docs/config.md"))
      << "docs/config.md is out of date; run: build/release/bin/roomgraph config-reference > docs/config.md";
}

TEST(ConfigReference, NamesEveryKeyThatTheProgramKnows) {
  const std::string page = contentOf(kSource / "docs/config.md");
  const ConfigSchema schema = configSchema();
  for (const auto& section : schema.sections())
    for (const auto& key : section.keys) {
      EXPECT_NE(page.find(key.key), std::string::npos) << section.name << "." << key.key;
      EXPECT_FALSE(key.doc.empty()) << section.name << "." << key.key << " is not explained";
    }
}

TEST(ShippedConfig, IsAccepted) {
  const Config config = Config::fromFile(kSource / "config.ini");
  EXPECT_NO_THROW(configSchema().check(config));
  const auto setup = makeSetup(config, kSource / "objects.ini");
  EXPECT_TRUE(setup->stages.rgbd_odometry && setup->stages.scan_matcher && setup->stages.detector && setup->stages.associator);
  for (const char* name : {"swivel_chair", "sofa", "door", "person"})
    EXPECT_TRUE(setup->database.find(name)) << name;
  EXPECT_FALSE(setup->database.find("person")->landmark);
}

TEST(ShippedConfig, EffectiveConfigMakesTheSameStages) {
  const auto setup = makeSetup(Config::fromFile(kSource / "config.ini"), kSource / "objects.ini");
  Config effective = Config::fromText(setup->effective_config, "effective");
  effective.override("pipeline.objects_file=" + (kSource / "objects.ini").string());
  const auto again = makeSetup(effective, "none");
  EXPECT_EQ(again->effective_config, setup->effective_config);
}

}  // namespace
}  // namespace roomgraph::test

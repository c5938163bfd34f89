// SPDX-License-Identifier: BSD-3-Clause
// Relative files in a configuration lie beside it, whichever key names them.
#include <gmock/gmock.h>

#include <algorithm>

#include "errors_of.h"
#include "roomgraph/core/config.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/pipeline/setup.h"
#include "temporary_folder.h"
#include "tiny_network.h"

namespace roomgraph::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A configuration with everything it names in folders beside it, and none of it in the working directory.
class ConfigFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder.file("plugins"));
    fs::create_directories(folder.file("data"));
    fs::create_symlink(EXAMPLE_DECODER, folder.file("plugins/decoder.so"));
    folder.write("data/my_objects.ini", "[stool]\nlabels = mug\nshape = cylinder\n");
    folder.write("data/names.txt", "mug\nplate\nspoon\n");
    folder.write("data/boxes.jsonl",
                 R"({"timestamp": 1, "boxes": [{"class": "mug", "score": 0.9, "bbox": [1, 2, 30, 40]}]})");
    const fs::path weights = writeTinyNetwork(folder, 3);
    fs::rename(weights, folder.file("data/tiny.weights"));
    fs::rename(folder.file("tiny.cfg"), folder.file("data/tiny.cfg"));
  }
  std::unique_ptr<roomgraph::Setup> setupOf(const std::string& text) const {
    return makeSetup(Config::fromFile(folder.write("my.ini", text)), "/nowhere/objects.ini");
  }
  TemporaryFolder folder;
};

TEST_F(ConfigFiles, AreBesideTheConfiguration) {
  const std::string common = "[pipeline]\nplugins = plugins/decoder.so\nobjects_file = data/my_objects.ini\n"
                             "[detection]\n";
  const auto networks =
      setupOf(common + "models = data/tiny.weights:darknet\nlabels_file = data/names.txt\n");
  EXPECT_EQ(networks->stages.detector->identity().model, "tiny");
  EXPECT_TRUE(networks->database.find("stool"));
  EXPECT_THAT(networks->options.general.plugins, ElementsAre(folder.file("plugins/decoder.so").string()));
  const auto recorded = setupOf(common + "class = RecordedDetector\nfile = data/boxes.jsonl\n");
  EXPECT_EQ(recorded->stages.detector->identity().model, "boxes.jsonl");
  // What the run writes down names the same files from wherever it is read.
  EXPECT_THAT(networks->effective_config, HasSubstr("models = " + folder.file("data/tiny.weights").string()));
  EXPECT_THAT(networks->effective_config, HasSubstr("labels_file = " + folder.file("data/names.txt").string()));
}

TEST_F(ConfigFiles, ThatAreNotThereAreNamedWithTheirFolder) {
  const auto at = [&](const std::string& name) { return HasSubstr(folder.file(name).string()); };
  EXPECT_THAT(messageOf<ConfigError>([&] { setupOf("[pipeline]\nplugins = none.so\n"); }), at("none.so"));
  EXPECT_THAT(messageOf<ConfigError>([&] { setupOf("[pipeline]\nobjects_file = none.ini\n"); }), at("none.ini"));
  const std::string objects = "[pipeline]\nobjects_file = data/my_objects.ini\n[detection]\n";
  EXPECT_THAT(messageOf<InputError>([&] { setupOf(objects + "models = none.onnx\n"); }), at("none.onnx"));
  EXPECT_THAT(messageOf<InputError>([&] { setupOf(objects + "file = none.jsonl\n"); }), at("none.jsonl"));
  EXPECT_THAT(messageOf<InputError>([&] {
                setupOf(objects + "models = data/tiny.weights\nlabels_file = none.txt\n");
              }),
              at("none.txt"));
}

// A new key that names files is to be declared as such, and tested above.
TEST_F(ConfigFiles, TheseAreAllKeysThatNameFiles) {
  std::vector<std::string> keys;
  const ConfigSchema schema = configSchema();
  for (const auto& section : schema.sections())
    for (const auto& key : section.keys)
      if (key.allowed == "a file" || key.allowed == "files separated by commas")
        keys.push_back(section.name + "." + key.key);
  std::sort(keys.begin(), keys.end());
  EXPECT_THAT(keys, ElementsAre("detection.file", "detection.labels_file", "detection.models",
                                "pipeline.calibration_file", "pipeline.objects_file", "pipeline.plugins"));
}

}  // namespace
}  // namespace roomgraph::test

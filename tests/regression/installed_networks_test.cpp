// SPDX-License-Identifier: BSD-3-Clause
// Runs without a named network: recorded boxes, else what the model folder holds, else nothing.
#include <nlohmann/json.hpp>

#include "data_folder.h"
#include "made_up_network.h"
#include "program.h"
#include "roomgraph/models/model_folder.h"
#include "tiny_network.h"
#include "tiny_recording.h"

namespace roomgraph::test {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

class InstalledNetworks : public ::testing::Test {
 protected:
  InstalledNetworks() {
    writeTinyNetwork(folder, 80);
    const std::string weights = folder.read("tiny.weights"), cfg = folder.read("tiny.cfg");
    catalogue = folder.write(
        "networks.json",
        catalogueText({{"better", "objects", "c", {{"better.weights", weights}, {"better.cfg", cfg}}},
                       {"plain", "objects", "c", {{"plain.weights", weights}, {"plain.cfg", cfg}}},
                       {"doors", "doors", "c", {{"doors.weights", weights}, {"doors.cfg", cfg}}}}));
    writeRawlog(without_boxes, TinyRecording(6).records({}));
  }
  void install(const std::string& name) {
    fs::create_directories(models / name);
    for (const char* ending : {".weights", ".cfg"})
      fs::copy_file(folder.file(std::string("tiny") + ending), models / name / (name + ending));
  }
  CallResult run(const fs::path& input, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run",     input.string(),  "-o",          out.string(),
                                       "--quiet", "--no-snapshot", "--catalogue", catalogue.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CallResult result =
        call(folder.path(), arguments, folder.path(), {"XDG_DATA_HOME=" + data.string()});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  }
  json detector() const { return json::parse(contentOf(out / "summary.json")).at("detector"); }

  TemporaryFolder folder;
  fs::path data = folder.file("data"), models = data / "roomgraph/models", out = folder.file("out"),
           catalogue, without_boxes = folder.file("lab.rawlog");
  const fs::path with_boxes = fs::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs" / "tiny_room.rawlog";
};

TEST_F(InstalledNetworks, RunWhenNothingElseGivesBoxes) {
  const CallResult shipped = run(without_boxes);
  EXPECT_EQ(shipped.err, "");
  EXPECT_THAT(shipped.out, HasSubstr(": room_detector\n"));
  EXPECT_EQ(detector().at("model"), "room_detector") << "the one that comes with the program";
  install("plain");
  const CallResult plain = run(without_boxes);
  EXPECT_EQ(plain.err, "");
  EXPECT_THAT(plain.out, HasSubstr("networks of " + models.string() + ": plain\n"));
  EXPECT_EQ(detector().at("model"), "plain");
  EXPECT_EQ(detector().at("installed_networks"), json({"plain"}));
  EXPECT_EQ(linesOf(contentOf(out / "detections.jsonl")).size(), 3u) << "it ran on every image";
  install("better");
  install("doors");
  EXPECT_THAT(run(without_boxes).out, HasSubstr(": better, doors\n"));
  EXPECT_EQ(detector().at("model"), "better+doors");
  fs::resize_file(models / "better" / "better.weights", 100);
  run(without_boxes);
  EXPECT_EQ(detector().at("model"), "plain+doors") << "half a file is none";
}

TEST_F(InstalledNetworks, TheRunIsRepeatedFromItsConfiguration) {
  install("plain");
  run(without_boxes);
  const std::string boxes = contentOf(out / "detections.jsonl");
  const fs::path config = folder.write("again.ini", contentOf(out / "config.ini"));
  folder.write("objects.ini", contentOf(out / "objects.ini"));
  EXPECT_THAT(contentOf(config),
              HasSubstr("models = " + (models / "plain" / "plain.weights").string() + "\n"));
  install("better");
  EXPECT_THAT(run(without_boxes, {"--config", config.string()}).out, Not(HasSubstr("networks of")));
  EXPECT_EQ(detector().at("model"), "plain") << "the network that is named, although there is a better one";
  EXPECT_EQ(detector().at("installed_networks"), json::array());
  EXPECT_EQ(contentOf(out / "detections.jsonl"), boxes);
}

TEST_F(InstalledNetworks, RecordedBoxesComeFirst) {
  run(with_boxes);
  const std::string landmarks = contentOf(out / "landmarks.json"),
                    boxes = contentOf(out / "detections.jsonl");
  const json before = detector();
  install("better");
  EXPECT_THAT(run(with_boxes).out, Not(HasSubstr("networks of")));
  EXPECT_TRUE(contentOf(out / "landmarks.json") == landmarks && contentOf(out / "detections.jsonl") == boxes);
  EXPECT_EQ(detector(), before);
}

TEST_F(InstalledNetworks, WhoNamesSomethingGetsThat) {
  install("better");
  const fs::path named = folder.file("tiny.weights");
  run(without_boxes, {"--set", "detection.models=" + named.string()});
  EXPECT_EQ(detector().at("model"), "tiny");
  const fs::path boxes = folder.write(
      "boxes.jsonl",
      R"({"timestamp": 1000, "boxes": [{"class": "chair", "score": 0.9, "bbox": [1, 2, 30, 40]}]})");
  run(without_boxes, {"--set", "detection.file=" + boxes.string()});
  EXPECT_EQ(detector().at("model"), "boxes.jsonl");
  run(without_boxes, {"--set", "detection.class=RecordedDetector"});
  EXPECT_EQ(detector().at("model"), "");
  run(without_boxes, {"--set", "detection.enabled=false"});
  EXPECT_FALSE(json::parse(contentOf(out / "summary.json")).contains("detector"));
}

TEST_F(InstalledNetworks, OfAnotherFolder) {
  install("plain");
  const fs::path elsewhere = folder.file("a, b");
  fs::rename(models, elsewhere);
  EXPECT_THAT(run(without_boxes, {"--models", elsewhere.string()}).out,
              HasSubstr("networks of " + elsewhere.string() + ": plain\n"));
  EXPECT_EQ(detector().at("model"), "plain") << "a comma in the name of a folder";
  expectOneLine(
      call(folder.path(), {"run", without_boxes.string(), "-o", out.string(), "--models", "/nowhere"}), 2,
      HasSubstr("--models /nowhere: no such folder"));
}

TEST_F(InstalledNetworks, RecordedOnceTheyAreNotNeededAgain) {
  install("plain");
  const fs::path copy = folder.file("copy.rawlog");
  run(without_boxes, {"--record-detections", copy.string()});
  fs::remove_all(models);
  EXPECT_EQ(run(copy).err, "");
  EXPECT_EQ(detector().at("model"), "plain") << "what made the recording";
}

// The shipped catalogue and the real files.
TEST_F(InstalledNetworks, RealOnesFromFetchToRun) {
  const fs::path source = dataFolder() / "models";
  if (!fs::is_directory(source)) GTEST_SKIP() << "no networks in " << source;
  const std::vector<std::string> home{"XDG_DATA_HOME=" + data.string()};
  const CallResult fetched =
      call(folder.path(),
           {"models", "fetch", "yolo-fastest-1.1-xl", "deeplabv3-mnv2-ade20k", "--from", source.string()},
           folder.path(), home);
  ASSERT_EQ(fetched.exit_code, 0) << fetched.err;
  const CallResult result =
      call(folder.path(), {"run", without_boxes.string(), "-o", out.string(), "--quiet", "--no-snapshot"},
           folder.path(), home);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(detector().at("model"), "yolo-fastest-1.1-xl+deeplabv3_mnv2_ade20k_256x256");
  EXPECT_EQ(linesOf(contentOf(out / "detections.jsonl")).size(), 3u);
}

}  // namespace
}  // namespace roomgraph::test

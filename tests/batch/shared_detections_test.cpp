// SPDX-License-Identifier: BSD-3-Clause
// Detections computed once and shared by variants give what each would have computed itself.
#include "small_batch.h"

namespace roomgraph::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A Darknet network of one convolution that sees chairs where the picture is bright, and says so all over a
/// coarse grid.
std::filesystem::path writeChairNetwork(const TemporaryFolder& folder) {
  constexpr int kClasses = 80, kFilters = kClasses + 5, kChair = 56;
  folder.write("chairs.cfg",
               "[net]\nwidth=64\nheight=64\nchannels=3\n\n[convolutional]\nfilters=85\nsize=1\nstride="
               "32\npad=0\nactivation=linear\n\n"
               "[yolo]\nmask=0\nanchors=24,40\nnum=1\nclasses=80\n");
  std::string bytes;
  const auto append = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const std::int32_t version : {0, 2, 0}) append(version);
  append(std::int64_t{0});
  for (int filter = 0; filter < kFilters; ++filter)
    append(filter < 4 ? 0.0f : filter == 4 ? -1.0f : filter == 5 + kChair ? 3.0f : -20.0f);
  for (int filter = 0; filter < kFilters; ++filter)
    for (int channel = 0; channel < 3; ++channel) append(filter == 4 ? 2.5f : 0.0f);
  return folder.write("chairs.weights", bytes);
}

class SharedDetections : public SmallBatch {};

TEST_F(SharedDetections, AreThoseOfTheNetwork) {
  makeRecording("a", 24);
  const auto network = writeChairNetwork(folder);
  const std::string set = "detection.models=" + network.string();
  const std::string variants = "  - {name: default, set: " + set + "}\n  - {name: no_lidar, set: [" + set +
                               ", lidar.enabled=false]}\n" + "  - {name: weak, set: [" + set +
                               ", detection.score_threshold=0.5]}\n";
  const auto ended = batch({jobs(variants), "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  int shared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.file("out/detections")))
    shared += entry.path().extension() == ".rawlog";
  EXPECT_EQ(shared, 2) << "another threshold is another detector";
  const auto of_batch = results();
  EXPECT_THAT(
      contentOf(runFolder("no_lidar") / "x") + contentOf(runFolder("a--no_lidar") / "detections.jsonl"),
      HasSubstr("\"boxes\":[{"))
      << "there is something to share";
  int replayed = 0;
  for (const char* name : {"default", "no_lidar"}) {
    const auto words = result(std::string("a--") + name).command;
    replayed += std::find(words.begin(), words.end(), "detection.class=auto") != words.end();
    std::vector<std::string> alone{"run",     folder.file("data/a.rawlog").string(),
                                   "-o",      runFolder("alone").string(),
                                   "--quiet", "--no-snapshot",
                                   "--set",   set};
    if (name == std::string("no_lidar")) alone.insert(alone.end(), {"--set", "lidar.enabled=false"});
    ASSERT_EQ(call(folder.path(), alone).exit_code, 0);
    for (const char* file : {"trajectory.tum", "landmarks.json", "map.pgm", "graph.g2o", "associations.jsonl",
                             "detections.jsonl"})
      EXPECT_TRUE(contentOf(runFolder("alone") / file) ==
                  contentOf(runFolder(std::string("a--") + name) / file))
          << name << " " << file;
  }
  EXPECT_EQ(replayed, 1) << "one computes, the other replays";
}

TEST_F(SharedDetections, ANetworkThatChangedComputesThemAgain) {
  makeRecording("a");
  const auto network = writeChairNetwork(folder);
  const std::string variants = "  - {name: default, set: detection.models=" + network.string() + "}\n";
  ASSERT_EQ(batch({jobs(variants), "-o", "out", "--keep", "summary"}).exit_code, 0);
  std::string bytes = contentOf(network);
  bytes[20 + 4 * 4 + 3] ^= 1;  // of the bias of what makes an object
  std::ofstream(network, std::ios::binary) << bytes;
  const auto again = batch({jobs(variants), "-o", "out", "--keep", "summary"});
  EXPECT_THAT(again.out, HasSubstr("1 runs done"));
  EXPECT_THAT(again.err, HasSubstr("objects, networks or places of sensors have changed"));
}

}  // namespace
}  // namespace roomgraph::test

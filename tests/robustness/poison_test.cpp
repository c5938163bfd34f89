// SPDX-License-Identifier: BSD-3-Clause
// Records with one number replaced by NaN or 1e12 at every byte, read and in whole runs.
#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "memory_limit.h"
#include "roomgraph/pipeline/record_sorter.h"
#include "roomgraph/pipeline/semantic_slam.h"
#include "temporary_folder.h"
#include "three_frames.h"
#include "tiny_recording.h"

// One number that is none, or is absurd, in one record: the record may be lost, nothing else.

namespace roomgraph::test {
namespace {

const double kPoisons[] = {std::numeric_limits<double>::quiet_NaN(), 1e12};

std::string poisoned(const std::vector<test::Object>& records, std::size_t victim, std::size_t at,
                     double value) {
  std::string bytes;
  for (std::size_t i = 0; i < records.size(); ++i) {
    std::string record = test::bytesOf(records[i]);
    if (i == victim) std::memcpy(record.data() + at, &value, sizeof value);
    bytes += record;
  }
  return bytes;
}

// `lost`: how many of the records that are read may be gone.
void expectEveryByteSurvives(const ThreeFrames& recording, std::size_t victim, std::size_t lost = 2) {
  if (!kMemoryCanBeLimited) GTEST_SKIP() << "sizes are damaged, too; not under this sanitizer";
  limitAddressSpace();
  const TemporaryFolder folder;
  const auto countOf = [](const std::filesystem::path& file) {
    RawlogReader reader(file);
    std::size_t used = 0;
    while (reader.next()) ++used;
    return used;
  };
  const std::size_t all = countOf(folder.write("clean.rawlog", recording.bytes()));
  const double before = peakMegabytes();
  const std::size_t size = test::bytesOf(recording.records[victim]).size();
  for (const double value : kPoisons)
    for (std::size_t at = 0; at + sizeof value <= size; ++at) {
      const auto file = folder.write("x.rawlog", poisoned(recording.records, victim, at, value));
      RawlogReader reader(file);
      std::size_t used = 0;
      for (; const auto record = reader.next(); ++used)
        ASSERT_TRUE(isFinite(*record)) << value << " at byte " << at;
      // A header that is no more may take the record behind it along.
      ASSERT_GE(used + lost, all) << value << " at byte " << at;
    }
  EXPECT_LT(peakMegabytes() - before, 1024);
}

constexpr std::size_t kOdometry = 4, kScan = 5, kDetections = 6, kImages = 7;

TEST(Poison, EveryByteOfAnOdometryReading) {
  expectEveryByteSurvives(threeFrames(16, 12), kOdometry);
}
TEST(Poison, EveryByteOfAScan) {
  expectEveryByteSurvives(threeFrames(16, 12), kScan);
}
TEST(Poison, EveryByteOfDetections) {
  expectEveryByteSurvives(threeFrames(16, 12), kDetections);
}
TEST(Poison, EveryByteOfImagesAndTheirIntrinsics) {
  expectEveryByteSurvives(threeFrames(16, 12), kImages);
}

// The older format: each of its records holds several.
TEST(Poison, EveryByteOfAnAction) {
  expectEveryByteSurvives(threePairs(16, 12), 2, 5);
}
TEST(Poison, EveryByteOfASensoryFrame) {
  expectEveryByteSurvives(threePairs(16, 12), 3, 5);
}

/// What a whole run makes of a file.
SlamResult run(const std::filesystem::path& file) {
  auto setup = makeSetup(Config::fromText("[detection]\nclass = RecordedDetector\n", "test"),
                           ROOMGRAPH_SOURCE_DIR "/objects.ini");
  RawlogReader reader(file);
  RecordSorter sorter(setup->options.general.lookahead_s);
  SemanticSlam slam(std::move(setup));
  while (auto record = reader.next()) {
    sorter.push(std::move(*record));
    while (const auto next = sorter.pop(false)) slam.process(*next);
  }
  while (const auto next = sorter.pop(true)) slam.process(*next);
  return slam.finish();
}

bool isFinite(const SlamResult& result) {
  const auto finite = [](const StampedPose& p) { return std::isfinite(p.t) && p.pose.matrix().allFinite(); };
  bool landmarks = true;
  for (const auto& landmark : result.map.landmarks)
    landmarks = landmarks && landmark.position.allFinite() && landmark.covariance.allFinite();
  return landmarks && std::all_of(result.world_from_robot.begin(), result.world_from_robot.end(), finite) &&
         std::all_of(result.world_from_camera.begin(), result.world_from_camera.end(), finite);
}

/// The bytes of a record in front of its images, scans, … and behind them: what poses and sizes are in.
std::vector<std::size_t> sampled(std::size_t size, std::size_t step) {
  constexpr std::size_t kHead = 240, kTail = 460;
  std::vector<std::size_t> out;
  for (std::size_t at = 0; at + sizeof(double) <= size; at += step)
    if (at < kHead || at + kTail > size) out.push_back(at);
  return out;
}

void expectRunsSurvive(std::size_t victim, std::size_t step) {
  if (!kMemoryCanBeLimited) GTEST_SKIP() << "sizes are damaged, too; not under this sanitizer";
  limitAddressSpace();
  const TemporaryFolder folder;
  const auto records = TinyRecording(6).records({});
  const auto clean = run(folder.write("clean.rawlog", poisoned(records, records.size(), 0, 0)));
  ASSERT_EQ(clean.world_from_robot.size(), 6u);
  for (const double value : kPoisons)
    for (const std::size_t at : sampled(test::bytesOf(records[victim]).size(), step)) {
      const auto result = run(folder.write("x.rawlog", poisoned(records, victim, at, value)));
      ASSERT_TRUE(isFinite(result)) << value << " at byte " << at;
      ASSERT_GE(result.world_from_robot.size() + 2, clean.world_from_robot.size()) << value << " at " << at;
    }
}

TEST(Poison, WholeRunsWithAnOdometryReading) {
  expectRunsSurvive(5, 3);
}
TEST(Poison, WholeRunsWithAScan) {
  expectRunsSurvive(6, 7);
}
TEST(Poison, WholeRunsWithImages) {
  expectRunsSurvive(7, 7);
}

}  // namespace
}  // namespace roomgraph::test

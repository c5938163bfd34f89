// SPDX-License-Identifier: BSD-3-Clause
// map.rgmap through the years and through accidents: version 0, checksum, a writer that is killed.
#include <gmock/gmock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <random>

#include "errors_of.h"
#include "option_values.h"
#include "roomgraph/core/checksum.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/mapping/map_files.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

template <class... Values>
std::string archived(const Values&... values) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  (archive << ... << values);
  return {static_cast<const char*>(memory.getRawBufferData()),
          static_cast<std::size_t>(memory.getTotalBytesCount())};
}

/// A map as an earlier version wrote it: without the fields at the end that it did not have. No checksum;
/// plain bytes are read as gzipped ones.
std::string bytesOfVersion(char version, const CSemanticMap& map, const std::vector<std::string>& missing) {
  std::string bytes = archived(map);
  const char end_of_object = bytes.back();
  bytes.pop_back();
  for (const std::string& field : missing) bytes.resize(bytes.size() - field.size());
  bytes[1 + std::string(map.GetRuntimeClass()->className).size()] = version;
  return bytes + end_of_object;
}

// As they stand in a map without spans, provenance, views and weights.
std::string provenanceFields() {
  const std::string empty;
  return archived(std::uint32_t{0}, empty, empty, empty, std::vector<std::string>());
}
std::string viewFields() {
  return archived(std::uint32_t{0}, std::uint32_t{0});
}
std::string optionFields(const CSemanticMap& map) {
  return archived(map.genericMapParams, valuesOf(map.insertion), valuesOf(map.likelihood));
}

TEST(MapVersions, Version0Loads) {
  const TemporaryFolder folder;
  const CSemanticMap map = test::sampleMap();
  const CSemanticMap old = loadMap(folder.write(
      "old.rgmap", bytesOfVersion(0, map, {provenanceFields(), viewFields(), optionFields(map)})));
  EXPECT_EQ(old.origin, map.origin);
  EXPECT_EQ(old.occupancy->getRawMap(), map.occupancy->getRawMap());
  ASSERT_EQ(old.landmarks.size(), 3u);
  EXPECT_EQ(old.landmarks[2].covariance, map.landmarks[2].covariance);
  ASSERT_EQ(old.world_from_robot.size(), 40u);
  EXPECT_EQ(old.world_from_robot[39].pose.matrix(), map.world_from_robot[39].pose.matrix());
  EXPECT_TRUE(old.provenance.program.empty() && old.provenance.history.empty() && old.seen.empty());
  saveMap(old, folder.file("new.rgmap"));
  EXPECT_EQ(archived(loadMap(folder.file("new.rgmap"))), archived(map)) << "kept by the present version";
}

// Version 1 had neither views nor weights.
TEST(MapVersions, Version1Loads) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  map.provenance.history = {"run of a"};
  std::string bytes = bytesOfVersion(1, map, {viewFields(), optionFields(map)});
  bytes += "roomgraph map sha256 " + sha256Of(bytes);
  const CSemanticMap old = loadMap(folder.write("old.rgmap", bytes));
  EXPECT_EQ(old.landmarks.size(), 3u);
  EXPECT_THAT(old.provenance.history, ::testing::ElementsAre("run of a"));
  EXPECT_TRUE(old.views.empty() && old.weights.empty());
}

// Version 2 had no options.
TEST(MapVersions, Version2Loads) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  map.weights[map.landmarks[0].id] = 7.25;
  map.likelihood.box_sigma = 0.5;
  map.genericMapParams.enableObservationInsertion = false;
  std::string bytes = bytesOfVersion(2, map, {optionFields(map)});
  bytes += "roomgraph map sha256 " + sha256Of(bytes);
  const CSemanticMap old = loadMap(folder.write("old.rgmap", bytes));
  EXPECT_EQ(old.weights, map.weights);
  EXPECT_EQ(old.likelihood.box_sigma, MapLikelihoodOptions().box_sigma);
  EXPECT_TRUE(old.genericMapParams.enableObservationInsertion);
}

// A file that an earlier program wrote: the map that the repository ships.
TEST(MapVersions, ShippedMapLoads) {
  const TemporaryFolder folder;
  const std::filesystem::path shipped = ROOMGRAPH_SOURCE_DIR "/rawlogs/tiny_room.rgmap";
  const auto pipe = "gzip -dc " + shipped.string() + " > " + folder.file("plain").string();
  ASSERT_EQ(std::system(pipe.c_str()), 0);
  const std::string name = "roomgraph::CSemanticMap";
  EXPECT_EQ(folder.read("plain").substr(1, name.size() + 1), name + std::string(1, 1)) << "of version 1";
  const CSemanticMap tiny = loadMap(shipped);
  EXPECT_EQ(tiny.landmarks.size(), 3u);
  EXPECT_EQ(tiny.occupancy->getSizeX(), 128u);
  EXPECT_EQ(tiny.world_from_robot.size(), 81u);
}

TEST(MapVersions, OptionsComeBack) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  map.likelihood.camera_fx = 1 / 3.0;
  map.likelihood.use_grid = false;
  map.insertion.gate_sigma = 2.5;
  map.genericMapParams.enableObservationLikelihood = false;
  saveMap(map, folder.file("map.rgmap"));
  const CSemanticMap again = loadMap(folder.file("map.rgmap"));
  EXPECT_EQ(valuesOf(again.likelihood), valuesOf(map.likelihood));
  EXPECT_EQ(again.likelihood.camera_fx, 1 / 3.0) << "bit by bit";
  EXPECT_EQ(valuesOf(again.insertion), valuesOf(map.insertion));
  EXPECT_FALSE(again.genericMapParams.enableObservationLikelihood);
  EXPECT_EQ(archived(again), archived(map));
}

TEST(MapVersions, ViewsAndWeightsComeBack) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  KeyView view{1001, poseFromYpr(1, 2, 0.8, 0.3, 0.1, 0), {}};
  view.corners.resize(2);
  view.corners[1].descriptor[31] = 255;
  view.corners[1].place_mm = {-1234, 32000, 5};
  map.views = {view};
  map.weights[map.landmarks[0].id] = 7.25;
  saveMap(map, folder.file("map.rgmap"));
  const CSemanticMap again = loadMap(folder.file("map.rgmap"));
  ASSERT_EQ(again.views.size(), 1u);
  EXPECT_EQ(again.views[0].t, 1001);
  EXPECT_EQ(again.views[0].world_from_camera.matrix(), view.world_from_camera.matrix());
  ASSERT_EQ(again.views[0].corners.size(), 2u);
  EXPECT_EQ(again.views[0].corners[1].descriptor, view.corners[1].descriptor);
  EXPECT_EQ(again.views[0].corners[1].place_mm, view.corners[1].place_mm);
  EXPECT_EQ(again.weights, map.weights);
  map.weights[map.landmarks[0].id] = -1;
  saveMap(map, folder.file("map.rgmap"));
  EXPECT_THAT(test::messageOf<InputError>([&] { loadMap(folder.file("map.rgmap")); }), HasSubstr("weight"));
}

TEST(MapVersions, ProvenanceAndSpansComeBack) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  map.provenance = {"roomgraph 9 (abc)", "[run]\nx = 1\n", "[chair]\n", {"run of a", "cut"}};
  map.seen[map.landmarks[1].id] = {1000.5, 1003.25};
  saveMap(map, folder.file("map.rgmap"));
  const CSemanticMap again = loadMap(folder.file("map.rgmap"));
  EXPECT_EQ(again.provenance.program, "roomgraph 9 (abc)");
  EXPECT_EQ(again.provenance.config, "[run]\nx = 1\n");
  EXPECT_EQ(again.provenance.objects, "[chair]\n");
  EXPECT_THAT(again.provenance.history, ::testing::ElementsAre("run of a", "cut"));
  ASSERT_EQ(again.seen.size(), 1u);
  EXPECT_EQ(again.seen.at(map.landmarks[1].id).first, 1000.5);
  EXPECT_EQ(again.seen.at(map.landmarks[1].id).last, 1003.25);
  map.seen[map.landmarks[1].id] = {1000.5, 1000.25};
  saveMap(map, folder.file("map.rgmap"));
  EXPECT_THAT(test::messageOf<InputError>([&] { loadMap(folder.file("map.rgmap")); }),
              HasSubstr("landmark 2: last seen before"));
}

// The sums of gzip are out of the way when the bytes are plain.
TEST(MapVersions, EveryChangedByteIsNoticed) {
  const TemporaryFolder folder;
  const CSemanticMap map = test::sampleMap();
  const std::string content = archived(map);
  saveMap(map, folder.file("map.rgmap"));
  const std::string sum = "roomgraph map sha256 ";
  std::string plain = content + sum;
  const auto pipe = "gzip -dc " + folder.file("map.rgmap").string() + " > " + folder.file("plain").string();
  ASSERT_EQ(std::system(pipe.c_str()), 0);
  plain = folder.read("plain");
  ASSERT_EQ(plain.substr(0, content.size() + sum.size()), content + sum);
  EXPECT_EQ(loadMap(folder.file("plain")).landmarks.size(), 3u);
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    std::string changed = plain;
    const std::size_t at = random() % content.size();
    changed[at] = static_cast<char>(changed[at] ^ static_cast<char>(1u << random() % 8));
    const auto file = folder.write("changed", changed);
    EXPECT_THAT(test::messageOf<InputError>([&] { loadMap(file); }), HasSubstr("checksum")) << at;
  }
  const auto cut = folder.write("cut", content);
  EXPECT_THAT(test::messageOf<InputError>([&] { loadMap(cut); }),
              HasSubstr("its end, which holds the checksum"));
}

// Writes two maps in turn until it is killed.
[[noreturn]] void writeForEver(const CSemanticMap& a, const CSemanticMap& b,
                               const std::filesystem::path& file) {
  while (true) {
    saveMap(a, file);
    saveMap(b, file);
  }
}

TEST(MapVersions, KilledWriterLeavesAWholeMap) {
  const TemporaryFolder folder;
  const auto file = folder.file("map.rgmap");
  const CSemanticMap a = test::sampleMap();
  CSemanticMap b = a;
  b.landmarks.pop_back();
  saveMap(a, file);
  std::mt19937 random(7);
  int of_a = 0, of_b = 0;
  for (int i = 0; i < 200; ++i) {
    const pid_t writer = fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) writeForEver(a, b, file);
    const int longest_us = of_b > 0 ? 9000 : 9000 * (i + 1);  // on a busy machine a map may take longer
    usleep(static_cast<useconds_t>(random() % static_cast<unsigned>(longest_us)));
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
    const std::size_t objects = loadMap(file).landmarks.size();
    of_a += objects == 3;
    of_b += objects == 2;
  }
  EXPECT_EQ(of_a + of_b, 200);
  EXPECT_GT(of_a, 0);
  EXPECT_GT(of_b, 0);
}

}  // namespace
}  // namespace roomgraph

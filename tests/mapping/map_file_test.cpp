// SPDX-License-Identifier: BSD-3-Clause
// map.rgmap: round trip, damaged files, newer versions, impossible sizes.
#include <gmock/gmock.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>

#include <bit>
#include <cstring>
#include <functional>
#include <limits>

#include "memory_limit.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/mapping/map_files.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::HasSubstr;
using test::TemporaryFolder;

std::string mapLoadError(const std::filesystem::path& file) {
  try {
    loadMap(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "loaded";
}

void writeObject(const std::filesystem::path& file, const mrpt::serialization::CSerializable& object) {
  mrpt::io::CFileGZOutputStream out(file.string());
  mrpt::serialization::archiveFrom(out) << object;
}

void expectSame(const Landmark& a, const Landmark& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.class_name, b.class_name);
  EXPECT_EQ(a.model, b.model);
  EXPECT_EQ(a.shape.kind, b.shape.kind);
  EXPECT_EQ(a.shape.width, b.shape.width);
  EXPECT_EQ(a.shape.depth, b.shape.depth);
  EXPECT_EQ(a.shape.height, b.shape.height);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.yaw, b.yaw);
  EXPECT_EQ(a.has_yaw, b.has_yaw);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.existence, b.existence);
  EXPECT_EQ(a.class_posterior, b.class_posterior);
  EXPECT_EQ(a.observations, b.observations);
}

TEST(MapFile, GivesBackEveryField) {
  const TemporaryFolder folder;
  const CSemanticMap map = test::sampleMap();
  saveMap(map, folder.file("map.rgmap"));
  EXPECT_EQ(folder.count(), 1u) << "a temporary file was left";
  const CSemanticMap again = loadMap(folder.file("map.rgmap"));
  EXPECT_EQ(again.origin, map.origin);
  EXPECT_EQ(again.planar, map.planar);
  ASSERT_TRUE(again.occupancy);
  EXPECT_EQ(again.occupancy->getRawMap(), map.occupancy->getRawMap());
  EXPECT_EQ(again.occupancy->getXMin(), map.occupancy->getXMin());
  EXPECT_EQ(again.occupancy->getYMin(), map.occupancy->getYMin());
  EXPECT_EQ(again.occupancy->getResolution(), map.occupancy->getResolution());
  ASSERT_EQ(again.landmarks.size(), map.landmarks.size());
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) expectSame(again.landmarks[i], map.landmarks[i]);
  ASSERT_EQ(again.world_from_robot.size(), map.world_from_robot.size());
  for (std::size_t i = 0; i < map.world_from_robot.size(); ++i) {
    EXPECT_EQ(again.world_from_robot[i].t, map.world_from_robot[i].t);
    EXPECT_EQ(again.world_from_robot[i].pose.matrix(), map.world_from_robot[i].pose.matrix());
  }
}

TEST(MapFile, MapWithoutOccupancyAndBytesAreReproducible) {
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  map.occupancy.reset();
  map.planar = false;
  saveMap(map, folder.file("a.rgmap"));
  saveMap(map, folder.file("b.rgmap"));
  EXPECT_EQ(folder.read("a.rgmap"), folder.read("b.rgmap"));
  EXPECT_FALSE(loadMap(folder.file("a.rgmap")).occupancy);
  EXPECT_FALSE(loadMap(folder.file("a.rgmap")).planar);
}

TEST(MapFile, SaysWhatIsWrongWithAFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(mapLoadError(folder.file("none.rgmap")), HasSubstr("none.rgmap: no such file"));
  EXPECT_THAT(mapLoadError(folder.path()), HasSubstr("not a file"));
  EXPECT_THAT(mapLoadError(folder.write("empty.rgmap", "")), HasSubstr("empty"));
  EXPECT_THAT(mapLoadError(folder.write("text.rgmap", "[section]\nkey = value, and so on\n")),
              HasSubstr("not a roomgraph map"));
  writeObject(folder.file("pose.rgmap"), mrpt::poses::CPose3D());
  EXPECT_THAT(mapLoadError(folder.file("pose.rgmap")), HasSubstr("CPose3D"));
}

TEST(MapFile, TruncatedFileIsAnError) {
  const TemporaryFolder folder;
  saveMap(test::sampleMap(), folder.file("map.rgmap"));
  const std::string whole = folder.read("map.rgmap");
  for (const std::size_t size : {std::size_t{5}, whole.size() / 4, whole.size() / 2, whole.size() * 3 / 4})
    EXPECT_THAT(mapLoadError(folder.write("cut.rgmap", whole.substr(0, size))), HasSubstr("cut.rgmap")) << size;
}

TEST(MapFile, NewerVersionIsNamed) {
  const TemporaryFolder folder;
  // Layout of MRPT's archive: one byte 0x80 | length of the class name, the name, one byte version, the
  // fields.
  CSemanticMap map;
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << map;
  std::string bytes(static_cast<const char*>(memory.getRawBufferData()), memory.getTotalBytesCount());
  const std::string name = map.GetRuntimeClass()->className;
  ASSERT_EQ(bytes.substr(1, name.size()), name);
  bytes[1 + name.size()] = static_cast<char>(99);
  EXPECT_THAT(mapLoadError(folder.write("new.rgmap", bytes)), HasSubstr("newer version"));
}

TEST(MapFile, ValuesThatCannotBeAreNamed) {
  const TemporaryFolder folder;
  const auto errorFor = [&](const std::function<void(CSemanticMap&)>& damage) {
    CSemanticMap map = test::sampleMap();
    damage(map);
    saveMap(map, folder.file("bad.rgmap"));
    return mapLoadError(folder.file("bad.rgmap"));
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(errorFor([](auto& map) { map.landmarks[1].position.x() = kNan; }),
              HasSubstr("bad.rgmap: damaged: landmark 2: position"));
  EXPECT_THAT(errorFor([](auto& map) { map.landmarks[0].yaw = kNan; }), HasSubstr("landmark 1: yaw"));
  EXPECT_THAT(errorFor([](auto& map) { map.landmarks[0].shape.width = -1; }), HasSubstr("landmark 1: size"));
  EXPECT_THAT(errorFor([](auto& map) { map.landmarks[0].covariance(1, 2) = kNan; }), HasSubstr("covariance"));
  EXPECT_THAT(errorFor([](auto& map) { map.landmarks[0].existence = 2; }), HasSubstr("existence"));
  EXPECT_THAT(errorFor([](auto& map) { map.landmarks[0].class_posterior["other"] = kNan; }),
              HasSubstr("probability of a class"));
  EXPECT_THAT(errorFor([](auto& map) { map.world_from_robot[3].pose.linear() *= 2; }), HasSubstr("a pose"));
  EXPECT_THAT(errorFor([](auto& map) { map.world_from_robot[3].t = 0; }), HasSubstr("order of time"));
  EXPECT_THAT(errorFor([](auto& map) { map.world_from_robot[3].t = map.world_from_robot[2].t; }),
              HasSubstr("order of time"));
}

// A count, or a side of the grid, larger than the file: no memory is taken for it.
TEST(MapFile, ImpossibleSizesAreErrors) {
  if (!test::kMemoryCanBeLimited) GTEST_SKIP() << "the sanitizer ends the program at such a size";
  const TemporaryFolder folder;
  CSemanticMap map = test::sampleMap();
  mrpt::io::CMemoryStream memory;
  mrpt::serialization::archiveFrom(memory) << map;
  const std::string bytes(static_cast<const char*>(memory.getRawBufferData()), memory.getTotalBytesCount());
  const auto with = [&](std::size_t at, std::uint32_t value) {
    std::string broken = bytes;
    std::memcpy(broken.data() + at, &value, sizeof value);
    return folder.write("bad.rgmap", broken);
  };
  const float borders[] = {-1, 5, -2, 2};
  const std::uint32_t poses = 40;
  const auto borders_at = bytes.find(std::string(reinterpret_cast<const char*>(borders), sizeof borders));
  const auto poses_at = bytes.rfind(std::string(reinterpret_cast<const char*>(&poses), sizeof poses));
  ASSERT_NE(borders_at, std::string::npos);
  ASSERT_NE(poses_at, std::string::npos);
  for (const std::uint32_t count : {0xffffffffu, 0x80000000u, 0x01000000u})
    EXPECT_THAT(mapLoadError(with(poses_at, count)), HasSubstr("a size in it is larger than the file")) << count;
  // A border of the grid 10^7 m away.
  EXPECT_THAT(mapLoadError(with(borders_at + sizeof(float), std::bit_cast<std::uint32_t>(1e7f))),
              HasSubstr("bad.rgmap"));
}

// 580 m to either side at 5 cm, as a run over a large hall writes it.
TEST(MapFile, ALargeGridIsReadAgain) {
  const TemporaryFolder folder;
  CSemanticMap map;
  map.occupancy = mrpt::maps::COccupancyGridMap2D::Create(-290.f, 290.f, -290.f, 290.f, 0.05f);
  map.occupancy->setCell(7, 9, 0.f);
  saveMap(map, folder.file("large.rgmap"));
  map.occupancy.reset();
  const CSemanticMap read = loadMap(folder.file("large.rgmap"));
  EXPECT_EQ(read.occupancy->getSizeX(), 11600u);
  EXPECT_LT(read.occupancy->getCell(7, 9), 0.01f);
}

TEST(MapFile, UnwritablePlaceIsARunError) {
  const TemporaryFolder folder;
  EXPECT_THROW(saveMap(test::sampleMap(), folder.file("missing/map.rgmap")), RunError);
  std::filesystem::create_directories(folder.file("taken.rgmap/inside"));
  EXPECT_THROW(saveMap(test::sampleMap(), folder.file("taken.rgmap")), RunError);
  EXPECT_EQ(folder.count(), 1u) << "a temporary file was left";
}

}  // namespace
}  // namespace roomgraph

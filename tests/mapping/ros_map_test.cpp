// SPDX-License-Identifier: BSD-3-Clause
// ROS map files: pixel layout, round trip and malformed YAML.
#include <gmock/gmock.h>

#include "roomgraph/core/errors.h"
#include "roomgraph/mapping/map_files.h"
#include "temporary_folder.h"

namespace roomgraph {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using test::TemporaryFolder;

/// 4 x 3 cells of 0.5 m from (-1, 2): all unknown but the lower left one (occupied) and the one right of it
/// (free).
mrpt::maps::COccupancyGridMap2D smallGrid() {
  mrpt::maps::COccupancyGridMap2D grid(-1.f, 1.f, 2.f, 3.5f, 0.5f);
  grid.fill(0.5f);
  grid.setCell(0, 0, 0.f);
  grid.setCell(1, 0, 1.f);
  grid.setCell(3, 2, 1.f);
  return grid;
}

TEST(RosMap, ImageHasLargestYFirst) {
  const TemporaryFolder folder;
  saveOccupancyRos(smallGrid(), folder.file("map"));
  const std::string header = "P5\n4 3\n255\n";
  const std::string image = folder.read("map.pgm");
  ASSERT_EQ(image.size(), header.size() + 12);
  EXPECT_EQ(image.substr(0, header.size()), header);
  const unsigned char expected[12] = {205, 205, 205, 254, 205, 205, 205, 205, 0, 254, 205, 205};
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_EQ(static_cast<unsigned char>(image[header.size() + i]), expected[i]) << "pixel " << i;
  const std::string yaml = folder.read("map.yaml");
  for (const char* line : {"image: map.pgm\n", "resolution: 0.5\n", "origin: [-1, 2, 0.0]\n", "negate: 0\n",
                           "occupied_thresh: 0.65\n", "free_thresh: 0.196\n"})
    EXPECT_THAT(yaml, HasSubstr(line));
}

TEST(RosMap, RoundTrip) {
  const TemporaryFolder folder;
  const auto grid = smallGrid();
  saveOccupancyRos(grid, folder.file("map"));
  const auto [again, origin] = loadOccupancyRos(folder.file("map.yaml"));
  ASSERT_EQ(again.getSizeX(), 4u);
  ASSERT_EQ(again.getSizeY(), 3u);
  EXPECT_EQ(origin, Eigen::Vector2d(-1, 2));
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) EXPECT_NEAR(again.getCell(x, y), grid.getCell(x, y), 0.02) << x << " " << y;
}

// MRPT's grids lie on multiples of their cells, those of others anywhere.
TEST(RosMap, OriginsBetweenTheCellsAndAllColumnsAreKept) {
  const TemporaryFolder folder;
  folder.write("o.pgm", std::string("P5\n3 1\n255\n") + '\xff' + '\x00' + '\xff');
  for (const auto& [text, x] : {std::pair{"-1.024", -1.024}, {"63.575", 63.575}, {"0.025", 0.025}, {"-0.05", -0.05}}) {
    const auto map = loadOccupancyRos(folder.write("o.yaml", "image: o.pgm\nresolution: 0.05\norigin: [" + std::string(text) +
                                                                 ", -2.011, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"));
    EXPECT_NEAR(map.origin.x(), x, 1e-12);
    EXPECT_NEAR(map.origin.y(), -2.011, 1e-12);
    EXPECT_EQ(map.grid.getXMin(), 0);
    EXPECT_EQ(map.grid.getYMin(), 0);
    ASSERT_EQ(map.grid.getSizeX(), 3u) << text;
    ASSERT_EQ(map.grid.getSizeY(), 1u) << text;
    EXPECT_LT(map.grid.getCell(1, 0), 0.1F);
  }
}

// In an image with `negate`, white is occupied.
TEST(RosMap, NegatedImagesMeanTheOpposite) {
  const TemporaryFolder folder;
  folder.write("n.pgm", std::string("P5\n2 1\n255\n") + '\xff' + '\x00');
  for (const bool negate : {false, true}) {
    const auto yaml = folder.write("n.yaml", "image: n.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: " +
                                                 std::to_string(negate) +
                                                 "\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
    const auto grid = loadOccupancyRos(yaml).grid;
    EXPECT_EQ(grid.getCell(0, 0) > 0.9F, !negate);
    EXPECT_EQ(grid.getCell(1, 0) > 0.9F, negate);
  }
}

TEST(RosMap, ErrorsNameTheCause) {
  const TemporaryFolder folder;
  EXPECT_THROW(saveOccupancyRos(smallGrid(), folder.file("missing/map")), RunError);
  EXPECT_THROW(loadOccupancyRos(folder.file("none.yaml")), InputError);
  EXPECT_THROW(loadOccupancyRos(folder.write("a.yaml", "image: x.pgm\n")), InputError);
  const auto no_image = folder.write("b.yaml",
                                     "image: x.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
                                     "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  try {
    loadOccupancyRos(no_image);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("x.pgm cannot be read"));
  }
}

TEST(RosMap, BrokenYamlIsOneLineThatSaysWhy) {
  const TemporaryFolder folder;
  ::testing::internal::CaptureStderr();
  for (const std::string text : {"", "image: [", "image: x.pgm\n", "resolution: 1e999\n", "- a\n- b\n"}) try {
      loadOccupancyRos(folder.write("a.yaml", text));
      ADD_FAILURE() << "no error: " << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.yaml: not a map_server yaml: ")) << text;
      EXPECT_THAT(error.what(), Not(AnyOf(HasSubstr("\n"), HasSubstr("===")))) << text;
    }
  for (const std::string value : {"0", "nan", "1e9", "-0.05"})
    EXPECT_THROW(loadOccupancyRos(folder.write("b.yaml", "image: x.pgm\nresolution: " + value +
                                                             "\norigin: [0, 0, 0]\noccupied_thresh: 0.65\n"
                                                             "free_thresh: 0.196\n")),
                 InputError)
        << value;
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "no library speaks for itself";
}

}  // namespace
}  // namespace roomgraph

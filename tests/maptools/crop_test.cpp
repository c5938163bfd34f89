// SPDX-License-Identifier: BSD-3-Clause
// Parts of a map: rectangle on the lattice, concave polygon, nothing.
#include <gmock/gmock.h>

#include "region.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/maptools/map_crop.h"
#include "sample_map.h"

namespace roomgraph {
namespace {

TEST(MapCrop, RectangleKeepsWhatIsInside) {
  CSemanticMap map = test::sampleMap();
  map.seen[map.landmarks[0].id] = {1000, 1001};
  map.seen[map.landmarks[1].id] = {1000, 1002};
  for (const auto& landmark : map.landmarks) map.weights[landmark.id] = 7;
  map.views.resize(2);
  map.views[0].world_from_camera.translation() = Eigen::Vector3d(1, 1, 1.2);
  map.views[1].world_from_camera.translation() = Eigen::Vector3d(1, 3, 1.2);
  map.occupancy->setCell(40, 60, 0.25f);
  const CSemanticMap part = cropped(map, {{-0.51, 0.26}, {2.02, 0.26}, {2.02, 1.74}, {-0.51, 1.74}});
  ASSERT_EQ(part.landmarks.size(), 1u);
  EXPECT_EQ(part.landmarks[0].id.value, 1);
  EXPECT_EQ(part.seen.size(), 1u);
  EXPECT_EQ(part.weights.size(), 1u);
  ASSERT_EQ(part.views.size(), 1u) << "an image from outside would put the robot there";
  EXPECT_NEAR(part.views[0].world_from_camera.translation().y(), 1, 1e-12);
  ASSERT_TRUE(part.occupancy);
  // Cells of 0.05 m from -1 and -2; those with their centre inside stay.
  EXPECT_NEAR(part.occupancy->getXMin(), -0.5, 1e-5);
  EXPECT_NEAR(part.occupancy->getXMax(), 2, 1e-5);
  EXPECT_NEAR(part.occupancy->getYMin(), 0.25, 1e-5);
  EXPECT_NEAR(part.occupancy->getYMax(), 1.75, 1e-5);
  EXPECT_EQ(part.occupancy->getCell(40 - 10, 60 - 45), map.occupancy->getCell(40, 60)) << "the same place";
  EXPECT_TRUE(part.world_from_robot.empty());
  EXPECT_THAT(part.provenance.history.back(), ::testing::HasSubstr("x -0.51 to 2.02"));
}

TEST(MapCrop, OutsideAConcavePolygonIsUnknown) {
  const CSemanticMap map = test::sampleMap();
  const Polygon2 corner{{-0.9, -1.9}, {3, -1.9}, {3, 0}, {1, 0}, {1, 1.5}, {-0.9, 1.5}};
  const CSemanticMap part = cropped(map, corner);
  for (int y = 0; y < static_cast<int>(part.occupancy->getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(part.occupancy->getSizeX()); ++x) {
      const auto at = cellCentre(*part.occupancy, x, y);
      const bool inside = at.y() < 0 ? at.x() < 3 : at.x() < 1;
      EXPECT_NEAR(part.occupancy->getCell(x, y), inside ? 0.99 : 0.5, 0.02) << at.transpose();
    }
  for (const auto& stamped : part.world_from_robot) EXPECT_LT(stamped.pose.translation().x(), 3);
  EXPECT_FALSE(part.world_from_robot.empty());
}

TEST(MapCrop, TheEvidenceInCellsStays) {
  CSemanticMap map = test::sampleMap();
  auto& grid = *map.occupancy;
  for (unsigned x = 0; x < grid.getSizeX(); ++x) grid.getRow(3)[x] = static_cast<mrpt::maps::OccGridCellTraits::cellType>(x - 40);
  const CSemanticMap whole = cropped(map, {{-99, -99}, {99, -99}, {99, 99}, {-99, 99}});
  ASSERT_EQ(whole.occupancy->getSizeX(), grid.getSizeX());
  ASSERT_EQ(whole.occupancy->getSizeY(), grid.getSizeY());
  for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y)
    EXPECT_TRUE(std::equal(grid.getRow(y), grid.getRow(y) + grid.getSizeX(), whole.occupancy->getRow(y))) << y;
}

TEST(MapCrop, NothingAndNoArea) {
  const CSemanticMap map = test::sampleMap();
  const CSemanticMap far = cropped(map, {{100, 100}, {101, 100}, {101, 101}});
  EXPECT_FALSE(far.occupancy);
  EXPECT_TRUE(far.landmarks.empty() && far.world_from_robot.empty());
  EXPECT_THROW(cropped(map, {{0, 0}, {1, 0}}), ConfigError);
  EXPECT_THROW(cropped(map, {{0, 0}, {1, 1}, {2, 2}}), ConfigError);
}

}  // namespace
}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// A map of 1000 m2 with an hour's path: time to load, to draw, to export.
#include <chrono>

#include "memory_limit.h"
#include "program.h"
#include "roomgraph/mapping/map_files.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph::test {
namespace {

/// 40 m x 25 m in rooms of 5 m, 300 objects, 30 poses a second for an hour.
CSemanticMap largeMap() {
  CSemanticMap map;
  map.origin = "hall.rawlog";
  map.occupancy = mrpt::maps::COccupancyGridMap2D::Create(0.f, 40.f, 0.f, 25.f, 0.05f);
  map.occupancy->fill(0.97f);
  for (int y = 0; y < static_cast<int>(map.occupancy->getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(map.occupancy->getSizeX()); ++x)
      if ((x % 100 < 2 && y % 100 > 30) || (y % 100 < 2 && x % 100 > 30) || (x * 7 + y * 13) % 97 == 0)
        map.occupancy->setCell(x, y, 0.02f);
  for (int i = 0; i < 300; ++i)
    map.landmarks.push_back(sampleLandmark(i, i % 3 ? "swivel_chair" : "sofa",
                                           i % 3 ? ShapeKind::kCylinder : ShapeKind::kCuboid,
                                           1 + 1.9 * (i % 20), 1 + 1.6 * (i / 20)));
  for (int i = 0; i < 108000; ++i)
    map.world_from_robot.push_back(
        {1000 + i / 30.0,
         poseFromYpr(20 + 19 * std::sin(i * 1e-3), 12 + 11 * std::cos(i * 1.7e-3), 0, i * 1e-3, 0, 0)});
  return map;
}

template <class Action>
double secondsOf(const Action& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Limits are several times what was measured: other programs run beside tests.
TEST(LargeMap, LoadsAndIsDrawnQuickly) {
  if (!kMemoryCanBeLimited) GTEST_SKIP() << "slower under a sanitizer";
  const TemporaryFolder folder;
  const auto file = folder.file("large.rgmap").string();
  saveMap(largeMap(), file);
  std::size_t poses = 0;
  const double loading_s = secondsOf([&] { poses = loadMap(file).world_from_robot.size(); });
  EXPECT_EQ(poses, 108000u);
  CallResult picture, exported;
  const double drawing_s = secondsOf([&] {
    picture = call(folder.path(), {"snapshot", file, "-o", folder.file("x.png").string()});
  });
  const double exporting_s = secondsOf([&] {
    exported = call(folder.path(), {"map", "export", file, "-o", folder.file("all").string()});
  });
  if (picture.err.find("no off-screen renderer") == std::string::npos) {
    EXPECT_EQ(picture.exit_code, 0) << picture.err;
  }
  EXPECT_EQ(exported.exit_code, 0) << exported.err;
  std::printf("load %.2f s, snapshot %.2f s, export of everything %.2f s, file %.1f MB\n", loading_s,
              drawing_s, exporting_s, static_cast<double>(std::filesystem::file_size(file)) / 1e6);
  EXPECT_LT(loading_s, 4);
  EXPECT_LT(drawing_s, 15);
}

}  // namespace
}  // namespace roomgraph::test

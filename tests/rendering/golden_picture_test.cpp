// SPDX-License-Identifier: BSD-3-Clause
// Pictures of the shipped map against references that were looked at, and against pictures with a layer gone.
#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "figure_picture.h"
#include "picture.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/rendering/palette.h"

namespace roomgraph {
namespace {

// Drivers smooth edges differently: blocks are compared, not pixels.
constexpr int kBlock_px = 8;
constexpr double kLevels = 6;            ///< difference of a block's mean colour, of 255
constexpr double kShareAllowed = 0.002;  ///< of all blocks

const std::filesystem::path kShipped =
    std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "rawlogs/tiny_room.rgmap";
const std::filesystem::path kGolden = std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "tests/rendering/golden";

ObjectDatabase shippedObjects() {
  return ObjectDatabase::fromFile(std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / "objects.ini");
}

/// Share of the blocks that differ.
double differentShare(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size()) return 1;
  cv::Mat mean_a, mean_b, apart;
  const cv::Size blocks(a.cols / kBlock_px, a.rows / kBlock_px);
  cv::resize(a, mean_a, blocks, 0, 0, cv::INTER_AREA);
  cv::resize(b, mean_b, blocks, 0, 0, cv::INTER_AREA);
  cv::absdiff(mean_a, mean_b, apart);
  int different = 0;
  for (int v = 0; v < apart.rows; ++v)
    for (int u = 0; u < apart.cols; ++u) {
      const auto& block = apart.at<cv::Vec3b>(v, u);
      different += std::max({block[0], block[1], block[2]}) > kLevels;
    }
  return static_cast<double>(different) / blocks.area();
}

struct Kind {
  const char* name;
  cv::Mat (*draw)(const MapPicture&);
};

cv::Mat rendered(const MapPicture& picture, SnapshotView view) {
  return renderPicture(picture, shippedObjects(), {view, 640, 480, "tiny room"});
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all{
      {"top", [](const MapPicture& picture) { return rendered(picture, SnapshotView::kTop); }},
      {"orbit", [](const MapPicture& picture) { return rendered(picture, SnapshotView::kOrbit); }},
      {"paper", [](const MapPicture& picture) {
         return figurePixels(picture, palette::withSafeColors(shippedObjects()),
                             {FigureStyle::kPaper, 640, 480, "tiny room"});
       }}};
  return all;
}

cv::Mat reference(const Kind& kind) {
  const auto file = kGolden / (std::string(kind.name) + ".png");
  // For whoever changes how pictures look: makes the references, which are then to be looked at.
  if (std::getenv("ROOMGRAPH_NEW_GOLDEN")) cv::imwrite(file.string(), kind.draw(loadMap(kShipped)));
  return cv::imread(file.string());
}

TEST(GoldenPicture, TheShippedMapLooksAsItDid) {
  const CSemanticMap map = loadMap(kShipped);
  for (const auto& kind : kinds())
    EXPECT_LE(differentShare(kind.draw(map), reference(kind)), kShareAllowed) << kind.name;
}

TEST(GoldenPicture, TheSameMapGivesTheSamePixels) {
  const CSemanticMap map = loadMap(kShipped);
  for (const auto& kind : kinds())
    EXPECT_EQ(cv::norm(kind.draw(map), kind.draw(map), cv::NORM_INF), 0) << kind.name;
}

TEST(GoldenPicture, AMissingLayerIsNoticed) {
  const CSemanticMap map = loadMap(kShipped);
  const auto without = [&](auto&& remove) {
    CSemanticMap part = map;
    part.occupancy = std::make_shared<mrpt::maps::COccupancyGridMap2D>(*map.occupancy);
    remove(part);
    return part;
  };
  const auto clear_cells = [](CSemanticMap& part, bool free) {
    for (int y = 0; y < static_cast<int>(part.occupancy->getSizeY()); ++y)
      for (int x = 0; x < static_cast<int>(part.occupancy->getSizeX()); ++x)
        if ((part.occupancy->getCell(x, y) > 0.5f) == free) part.occupancy->setCell(x, y, 0.5f);
  };
  const std::map<std::string, CSemanticMap> broken{
      {"path", without([](CSemanticMap& part) { part.world_from_robot.clear(); })},
      {"one object", without([](CSemanticMap& part) { part.landmarks.pop_back(); })},
      {"objects", without([](CSemanticMap& part) { part.landmarks.clear(); })},
      {"walls", without([&](CSemanticMap& part) { clear_cells(part, false); })},
      {"free space", without([&](CSemanticMap& part) { clear_cells(part, true); })}};
  for (const auto& kind : kinds()) {
    const cv::Mat golden = reference(kind);
    for (const auto& [layer, part] : broken) {
      const double share = differentShare(kind.draw({part, map}), golden);
      EXPECT_GT(share, 1.5 * kShareAllowed) << kind.name << " without " << layer;
    }
  }
}

}  // namespace
}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Seeds: maps, networks, checkpoints.
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include "corpus.h"
#include "detection_bytes.h"
#include "roomgraph/core/result_store.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/observations/map_file.h"
#include "sample_map.h"
#include "temporary_folder.h"
#include "tiny_network.h"
#include "tiny_onnx.h"
#include "view_bytes.h"

namespace roomgraph::fuzz {
namespace {

/// A map of few bytes: all that maps have, with a grid of 20 x 10 cells.
CSemanticMap smallMap() {
  CSemanticMap map = test::sampleMap();
  map.occupancy = mrpt::maps::COccupancyGridMap2D::Create(-1.f, 1.f, 0.f, 1.f, 0.1f);
  map.occupancy->fill(0.99f);
  map.occupancy->setCell(3, 4, 0.01f);
  map.world_from_robot.resize(5);
  return map;
}

}  // namespace

void addMaps(Corpus& corpus) {
  const test::TemporaryFolder folder;
  const CSemanticMap map = smallMap();
  saveMap(map, folder.file("map.rgmap"));
  corpus.add("map", "small", folder.read("map.rgmap"));
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << map;
  corpus.add("map_content", "small",
             {static_cast<const char*>(stream.getRawBufferData()),
              static_cast<std::size_t>(stream.getTotalBytesCount())});
  saveOccupancyRos(*map.occupancy, folder.file("map"));
  corpus.add("occupancy_map", "small", {folder.read("map.yaml"), folder.read("map.pgm")});
}

void addNetworks(Corpus& corpus) {
  const test::TemporaryFolder folder;
  test::writeTinyNetwork(folder, 2);
  corpus.add("darknet", "tiny", {folder.read("tiny.cfg"), "chair\nsofa\n", folder.read("tiny.weights")});
  corpus.add("labels", "two", "chair\nsofa\n");
  corpus.add("score_calibration", "two", R"({"classes": {"door": {"slope": 1.9, "shift": -0.2}, "sofa": {"slope": 0.7, "shift": 1}}})");
  corpus.add("onnx", "tiny", {"chair\nsofa\ndoor\n", test::tinyOnnx()});
}

void addCheckpoints(Corpus& corpus) {
  const test::TemporaryFolder folder;
  Detection boxed;
  boxed.box = {1, 2, 30, 40};
  boxed.class_name = boxed.label = "chair";
  boxed.score = 0.7;
  boxed.mask = cv::Mat(12, 16, CV_8UC1, cv::Scalar(0));
  boxed.mask(cv::Rect(2, 3, 5, 6)) = 255;
  const std::string boxes = bytesOf(Outcome<std::vector<Detection>>({boxed, boxed}));
  corpus.add("journalled_boxes", "two", boxes);
  corpus.add("journalled_boxes", "none", bytesOf(Outcome<std::vector<Detection>>::failure("too dark")));
  tracking::LocatedView view;
  view.features.places = {{cv::Point2f(1, 2)}, {cv::Point2f(3, 4)}};
  view.features.depth = {1.5f, 2.5f};
  view.points = view.in_view = {3, 5};
  corpus.add("journalled_view", "two", tracking::bytesOf(view));
  {
    JournalledResults results(folder.file("results.journal"), "key", 1);
    for (int i = 0; i < 3; ++i) results.keep("boxes", 1000, boxes);
  }
  corpus.add("journal", "boxes", folder.read("results.journal"));
}

}  // namespace roomgraph::fuzz

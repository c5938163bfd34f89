// SPDX-License-Identifier: BSD-3-Clause
// Files that runs and simulations write: true boxes, objects, trajectories, graphs, results of batches,
// reports.
#include <cmath>
#include <sstream>

#include "../report_files.h"
#include "../target.h"
#include "roomgraph/backend/g2o_file.h"
#include "roomgraph/catalogue/catalogue.h"
#include "roomgraph/catalogue/run_result.h"
#include "roomgraph/core/errors.h"
#include "roomgraph/evaluation/frame_files.h"
#include "roomgraph/evaluation/object_files.h"
#include "roomgraph/evaluation/relations.h"
#include "roomgraph/evaluation/trajectory_file.h"
#include "roomgraph/report/graph_closures.h"
#include "roomgraph/report/report.h"

namespace roomgraph::fuzz {
namespace {

ROOMGRAPH_FUZZ_TARGET(true_boxes) {
  const auto file = scratchFile("boxes.jsonl", bytes);
  readTrueFrames(file);
  readSeenObjects(file);
}

ROOMGRAPH_FUZZ_TARGET(detections) {
  readDetections(scratchFile("detections.jsonl", bytes));
}

ROOMGRAPH_FUZZ_TARGET(associations) {
  readAssociations(scratchFile("associations.jsonl", bytes));
}

ROOMGRAPH_FUZZ_TARGET(landmarks) {
  for (const auto& object : readObjects(scratchFile("landmarks.json", bytes)))
    require(object.position.allFinite(), "positions of objects are finite");
}

ROOMGRAPH_FUZZ_TARGET(trajectory) {
  const auto read = readTrajectory(scratchFile("trajectory.tum", bytes));
  require(!read.trajectory.poses().empty(), "a trajectory that was read has poses");
  for (const auto& pose : read.trajectory.poses())
    require(std::isfinite(pose.t) && pose.pose.matrix().allFinite(), "poses are finite");
}

ROOMGRAPH_FUZZ_TARGET(relations) {
  readRelations(scratchFile("x.relations", bytes));
}

ROOMGRAPH_FUZZ_TARGET(pose_graph) {
  constexpr std::size_t kMostNodes = 50;  // of what is optimised, too
  std::istringstream text{std::string(bytes)};
  readClosures(text, 0);
  auto content = loadG2o(scratchFile("graph.g2o", bytes));
  if (auto* planar = std::get_if<PlanarGraph>(&content.graph)) {
    if (planar->poses.size() > kMostNodes) return;
    initializePoses(*planar);
    optimize(*planar, {.max_iterations = 2});
  } else {
    std::get<FactorGraph>(content.graph).optimize(2);
  }
}

ROOMGRAPH_FUZZ_TARGET(run_result) {
  const RunResult result = runResultOfText(std::string(bytes), "result.json");
  runResultOfText(textOfRunResult(result), "the same result");
}

ROOMGRAPH_FUZZ_TARGET(run_figures) {
  const auto file = scratchFile("summary.json", bytes);
  numbersOf(file, "x");
  stageTotalsOf(file);
}

ROOMGRAPH_FUZZ_TARGET(batch_catalogue) {
  const auto catalogue = Catalogue::forReading(scratchFile("catalogue.sqlite", bytes));
  catalogue.runs();
  for (const auto& name : catalogue.figureNames()) catalogue.figure(name);
  catalogue.pastCosts();
}

ROOMGRAPH_FUZZ_TARGET(report) {
  std::filesystem::create_directory(scratchFolder() / "run");
  std::vector<std::string> names;
  for (const char* name : kFilesOfReport) names.push_back(std::string("run/") + name);
  writeParts(bytes, names);
  makeReport({.runs = {{scratchFolder() / "run", "run"}}});
}

}  // namespace
}  // namespace roomgraph::fuzz

// SPDX-License-Identifier: BSD-3-Clause
// Seeds: settings of users, and files that runs write.
#include <opencv2/imgcodecs.hpp>

#include "../report_files.h"
#include "corpus.h"
#include "made_up_results.h"
#include "made_up_run.h"
#include "roomgraph/catalogue/catalogue.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/mapping/map_files.h"
#include "sample_map.h"
#include "temporary_folder.h"

namespace roomgraph::fuzz {
namespace {

std::string shipped(const std::string& name) {
  return readTextFile(std::filesystem::path(ROOMGRAPH_SOURCE_DIR) / name);
}

const std::string kSummary =
    R"({"version": "0.1", "interrupted": "no", "frames": 3, "seconds": 1.5, "timings": {"association": {"calls": 3, "total_ms": 4.5, "max_ms": 2}},
 "skipped": {"CObservationIMU: not used": 2}, "per_class": {"sofa": {"correct": 1, "f1": 0.5}}, "list": [1, 2]})";
const std::string kDetections =
    R"({"timestamp": 1000.1, "boxes": [{"class": "chair", "score": 0.75, "bbox": [10.5, 20, 110, 220.25], "track": 3, "rival": {"label": "printer", "score": 0.5}}], "unsought": ["door"]})"
    "\n"
    R"({"timestamp": 1000.2, "boxes": [{"class": "sofa", "score": 0.5, "bbox": [1, 2, 3, 4], "mask": "mask.png"}]})"
    "\n";

std::string poses() {
  std::string out = "# t x y z q\n";
  for (int i = 0; i < 4; ++i) out += "1000." + std::to_string(i) + " 0.1 0.2 0.3 0 0 0.0998334 0.9950042\n";
  return out;
}

std::string graph3d() {
  std::string out = "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nFIX 0\n# LANDMARK 3 1 cuboid 0.5 0.5 1\n";
  const std::string information = " 100 0 0 0 0 0 100 0 0 0 0 100 0 0 0 400 0 0 400 0 400\n";
  for (int i = 1; i <= 3; ++i) {
    const auto id = std::to_string(i), from = std::to_string(i - 1);
    out += "VERTEX_SE3:QUAT " + id + " " + id + " 0 0 0 0 0 1\n";
    out += "EDGE_SE3:QUAT " + from + " " + id + " 1.1 0.1 0 0 0 0.0998334 0.9950042" + information;
  }
  return out;
}

std::string graph2d() {
  std::string out = "VERTEX_SE2 0 0 0 0\n";
  for (int i = 1; i <= 3; ++i) {
    const auto id = std::to_string(i), from = std::to_string(i - 1);
    out += "VERTEX_SE2 " + id + " " + id + ".2 0.1 0.3\n";
    out += "EDGE_SE2 " + from + " " + id + " 1.1 0.1 0.2 100 1 2 100 3 400\n";
  }
  return out;
}

std::string landmarks() {
  const test::TemporaryFolder folder;
  saveLandmarksJson(test::sampleMap().landmarks, folder.file("landmarks.json"));
  return folder.read("landmarks.json");
}

}  // namespace

void addSettings(Corpus& corpus) {
  corpus.add("config", "shipped", shipped("config.ini"));
  corpus.add("config_text", "mapping", "[mapping]\nresolution_m = 0.1\n[b]\nname = \"a # b\" ; comment\n");
  corpus.add(
      "config", "some",
      "[detection]\nclass = RecordedDetector\n[lidar]\nenabled = false\n[pipeline]\nlookahead_s = 0.5\n"
      "[tracking]\nenabled = true ; comment\n");
  corpus.add("objects", "shipped", shipped("objects.ini"));
  for (const char* name : {"tiny_room", "tiny_handheld"})
    corpus.add("world", name, shipped(std::string("rawlogs/") + name + ".json"));
  corpus.add(
      "calibration", "all",
      "[sensor KINECT]\npose = 0.1,0.2,0.7,1,2,3\ntime_offset_s = 0.02\n[wheels]\nscale = 1.02\n"
      "turn_scale = 0.98\ndrift_rad_m = 0.001\ntime_offset_s = 0\n[depth]\nscale = 1.01\nbias_m = 0.005\n");
  corpus.add(
      "jobs", "all",
      "inputs:\n  - lab/*.rawlog\n  - {files: [a.rawlog, /b.rawlog], truth: {objects: t.json}, group: real}\n"
      "  - simulate: {flats: [7, 20-21], rooms: 2, handheld: true}\n"
      "variants:\n  - name: default\n  - {name: fast, set: [lidar.enabled=false], pose: \"K=0,0,1,0,0,0\"}\n"
      "limits: {jobs: 3, threads: 2, memory: 8 GB, time: 30 min, retries: 1}\nsplit: 10 min\n"
      "slurm: {partition: long, time: 4 h, options: [--nice], setup: module load x, poll: 5 s}\n"
      "keep: map\nevaluation: {trajectory: --interpolate, map: none}\n");
  corpus.add("network_catalogue", "shipped", shipped("networks.json"));
}

void addResults(Corpus& corpus) {
  std::vector<unsigned char> mask;
  cv::imencode(".png", cv::Mat(12, 16, CV_8UC1, cv::Scalar(255)), mask);
  corpus.add("recorded_boxes", "json", {kDetections, std::string(mask.begin(), mask.end())});
  corpus.add("recorded_boxes", "text", "1000.1 56 10 20 100 200 0.75\n1000.2 57 1 2 3 4 0.5\n");
  corpus.add("detections", "one", kDetections.substr(0, kDetections.find('\n') + 1));
  corpus.add(
      "true_boxes", "one",
      R"({"frame": 1, "t": 1000.1, "objects": [{"id": 2, "class": "sofa", "kind": "sofa", "bbox": [1, 2, 3, 4.5], "visible": 0.9, "z_med": 2.5}]})"
      "\n");
  corpus.add("landmarks", "three", landmarks());
  corpus.add("trajectory", "tum", poses());
  corpus.add("trajectory", "planar", "1000.1, 0.1, 0.2, 0.3\n1000.2, 0.2, 0.2, 0.3\n");
  corpus.add("relations", "two", "1000.1 1001 0.1 0.2 0.3 0 0 0.1\n1000.2 1001 0.1 0.2 0.3 0 0 0.1\n");
  corpus.add("pose_graph", "space", graph3d());
  corpus.add("pose_graph", "plane", graph2d());
  const RunResult result = test::madeUpResult("room", 1, "default");
  corpus.add("run_result", "complete", textOfRunResult(result));
  corpus.add("run_figures", "summary", kSummary);
  const test::TemporaryFolder folder;
  Catalogue::forWriting(folder.file("catalogue.sqlite")).import(result, "stamp");
  corpus.add("batch_catalogue", "one", folder.read("catalogue.sqlite"));
  const test::TemporaryFolder run;
  test::writeRun(run, {.seconds = 0.5});
  corpus.add("associations", "run", run.read("associations.jsonl"));
  std::vector<std::string> parts;
  for (const char* name : kFilesOfReport) parts.push_back(run.read(name));
  corpus.add("report", "run", parts);
}

}  // namespace roomgraph::fuzz

// SPDX-License-Identifier: BSD-3-Clause
// Part of roomgraph, object-level semantic SLAM.
#include "roomgraph/pipeline/run_output.h"

#include <sys/resource.h>

#include <iomanip>
#include <nlohmann/json.hpp>

#include "roomgraph/core/errors.h"
#include "roomgraph/mapping/map_files.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

ordered_json boxJson(const Box2& box) {
  return {box.u_min, box.v_min, box.u_max, box.v_max};
}

void writeStamped(std::ostream& out, double t, const Pose3& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d p = pose.translation();
  out << std::fixed << std::setprecision(6) << t << std::setprecision(7);
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) out << ' ' << value;
  out << '\n';
}

ordered_json detectionsJson(const StepReport& report) {
  ordered_json line{{"timestamp", report.t}, {"boxes", ordered_json::array()}};
  for (const auto& detection : report.detections) {
    line["boxes"].push_back(
        {{"class", detection.class_name}, {"score", detection.score}, {"bbox", boxJson(detection.box)}});
    if (detection.carried) line["boxes"].back()["carried"] = true;
  }
  return line;
}

ordered_json associationsJson(double t, const std::vector<ObjectDecision>& decisions) {
  ordered_json line{{"timestamp", t}, {"measurements", ordered_json::array()}};
  for (const auto& decision : decisions) {
    const auto& measurement = decision.seen.measurement;
    const Eigen::Vector3d place = decision.seen.world_from_object.translation();
    ordered_json posterior = ordered_json::array();
    for (const auto& [id, probability] : decision.association.posterior)
      posterior.push_back(
          {{"landmark", id.valid() ? ordered_json(id.value) : ordered_json("new")}, {"p", probability}});
    line["measurements"].push_back({{"class", measurement.proposal.class_name},
                                    {"bbox", boxJson(measurement.detection.box)},
                                    {"landmark", decision.landmark.value},
                                    {"new", !decision.association.landmark.valid()},
                                    {"posterior", posterior},
                                    {"track", measurement.track.value},
                                    {"beta", measurement.beta},
                                    {"confidence", measurement.confidence},
                                    {"world", {place.x(), place.y(), place.z()}},
                                    {"source", measurement.proposal.source},
                                    {"score", measurement.proposal.score},
                                    {"energy",
                                     {{"unary", measurement.energy.unary},
                                      {"pairwise", measurement.energy.pairwise},
                                      {"high_order", measurement.energy.high_order}}}});
  }
  return line;
}

double peakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

ordered_json summaryJson(const SemanticSlam& slam, const SlamResult& result, const ReadStatistics& read,
                         const std::map<std::string, std::string>& facts) {
  ordered_json summary;
  for (const auto& [key, value] : facts) summary[key] = value;
  const auto& counts = result.counts;
  summary["counts"] = {{"frames", counts.frames},
                       {"frames_lost", counts.frames_lost},
                       {"scans", counts.scans},
                       {"scans_unmatched", counts.scans_unmatched},
                       {"odometry", counts.odometry},
                       {"recorded_detections", counts.detections},
                       {"key_poses", counts.key_poses},
                       {"loop_closures", counts.loop_closures},
                       {"landmarks", result.map.landmarks.size()}};
  summary["reasons"] = counts.reasons;
  summary["records_used"] = read.used;
  summary["records_skipped"] = read.skipped;
  summary["input_warning"] = read.warning;
  summary["sensor_warnings"] = read.sensor_warnings;
  for (const auto& [stage, spent] : slam.times().totals())
    summary["timings"][stage] = {{"calls", spent.calls},
                                 {"mean_ms", spent.total_ms / spent.calls},
                                 {"max_ms", spent.max_ms},
                                 {"total_ms", spent.total_ms}};
  summary["peak_memory_mb"] = peakMemoryMb();
  return summary;
}

void writeTimings(std::ostream& out, const StageTimes& times) {
  out << "timestamp,stage,ms,cpu_ms\n" << std::fixed;
  for (const auto& call : times.calls())
    out << std::setprecision(6) << call.t << ',' << call.stage << std::setprecision(3) << ',' << call.ms
        << ',' << call.cpu_ms << '\n';
}

}  // namespace

void writeTum(std::ostream& out, const std::vector<StampedPose>& poses) {
  for (const auto& stamped : poses) writeStamped(out, stamped.t, stamped.pose);
}

RunOutput::RunOutput(const std::filesystem::path& folder) : folder_(folder) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw RunError("output folder " + folder_.string() + ": cannot be made: " + error.message());
  live_ = open("live.tum");
  detections_ = open("detections.jsonl");
  associations_ = open("associations_live.jsonl");
}

std::ofstream RunOutput::open(const std::string& name) const {
  std::ofstream out(folder_ / name);
  if (!out) throw RunError("output folder " + folder_.string() + ": " + name + " cannot be written");
  return out;
}

void RunOutput::onStep(const StepReport& report) {
  if (report.kind == StepReport::Kind::kOther) return;
  writeStamped(live_, report.t, report.world_from_robot);
  if (report.detector_ran || report.boxes_carried) detections_ << detectionsJson(report) << '\n';
  if (!report.decisions.empty()) associations_ << associationsJson(report.t, report.decisions) << '\n';
}

void RunOutput::writeResult(const SemanticSlam& slam, const SlamResult& result, const ReadStatistics& read,
                            const std::map<std::string, std::string>& facts) {
  live_.flush();
  detections_.flush();
  associations_.flush();
  auto robot = open("trajectory.tum");
  writeTum(robot, result.world_from_robot);
  auto camera = open("trajectory_camera.tum");
  writeTum(camera, result.world_from_camera);
  auto associations = open("associations.jsonl");
  for (const auto& frame : slam.objects().frames())
    associations << associationsJson(frame.t, frame.decisions) << '\n';
  saveLandmarksJson(result.map.landmarks, folder_ / "landmarks.json");
  if (result.map.occupancy) saveOccupancyRos(*result.map.occupancy, folder_ / "map");
  saveMap(result.map, folder_ / "map.rgmap");
  slam.graph().saveG2o(folder_ / "graph.g2o");
  open("config.ini") << slam.stages().effective_config;
  auto timings = open("timings.csv");
  writeTimings(timings, slam.times());
  open("summary.json") << summaryJson(slam, result, read, facts).dump(2) << '\n';
  if (!live_ || !detections_ || !associations_ || !associations || !robot || !camera || !timings)
    throw RunError("output folder " + folder_.string() + ": writing failed (disk full?)");
}

}  // namespace roomgraph

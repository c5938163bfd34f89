// SPDX-License-Identifier: BSD-3-Clause
// JSON lines per frame, trajectories, timings and summary of a run.
#include "roomgraph/pipeline/run_output.h"

#include <sys/resource.h>

#include <iomanip>
#include <nlohmann/json.hpp>

#include "frame_lines.h"
#include "graph_file.h"
#include "roomgraph/geometry/degree.h"
#include "roomgraph/mapping/map_files.h"
#include "roomgraph/pipeline/settings_json.h"

namespace roomgraph {
namespace {

using nlohmann::ordered_json;

void writeStamped(std::ostream& out, double t, const Pose3& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d p = pose.translation();
  out << std::fixed << std::setprecision(6) << t << std::setprecision(7);
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) out << ' ' << value;
  out << '\n';
}

double peakMemoryMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

ordered_json replayJson(const ReplayState& replayed) {
  return {{"from_s", replayed.records ? replayed.first_t - replayed.start_t : 0},
          {"to_s", replayed.records ? replayed.last_t - replayed.start_t : 0},
          {"records", replayed.records},
          {"share_of_span", replayed.interrupted ? replayed.share : 1}};
}

ordered_json timingsJson(const StageTimes& times) {
  ordered_json out = ordered_json::object();
  for (const auto& [stage, spent] : times.totals())
    out[stage] = {{"calls", spent.calls},
                  {"mean_ms", spent.total_ms / spent.calls},
                  {"max_ms", spent.max_ms},
                  {"total_ms", spent.total_ms}};
  return out;
}

ordered_json countsJson(const SlamResult& result) {
  const auto& counts = result.counts;
  return {{"frames", counts.frames},
          {"frames_lost", counts.frames_lost},
          {"frames_with_movers", counts.frames_with_movers},
          {"scans", counts.scans},
          {"scans_unmatched", counts.scans_unmatched},
          {"returns_on_people", counts.returns_on_people},
          {"returns_in_free_space", counts.returns_in_free_space},
          {"odometry", counts.odometry},
          {"recorded_detections", counts.detections},
          {"key_poses", counts.key_poses},
          {"loop_closures", counts.loop_closures},
          {"links", counts.links},
          {"landmarks", result.map.landmarks.size()}};
}

ordered_json detectorJson(const Detector& detector, const RunOrigin& origin) {
  const DetectorIdentity identity = detector.identity();
  return {{"model", identity.model}, {"model_hash", identity.hash}, {"installed_networks", origin.networks}};
}

ordered_json earlierMapJson(const EarlierMap& earlier) {
  ordered_json out{{"relocalised", earlier.recognised ? "yes" : "no"}, {"missing", earlier.missing}};
  if (!earlier.recognised) return out;
  out["after_s"] = earlier.after_s;
  out["by"] = earlier.by;
  out["objects"] = {{"seen_again", earlier.common},
                    {"not_seen", earlier.unseen},
                    {"vanished", earlier.vanished},
                    {"new", earlier.appeared}};
  return out;
}

// What of the recording was replaced, and how many records it concerned: as the reader did it, for the file may be
// gone or another one by now.
ordered_json calibrationJson(const std::string& file, const ReadStatistics& read) {
  ordered_json poses = ordered_json::object();
  for (const auto& [label, pose] : read.placed) poses[label] = formatPose(pose);
  return {{"file", file}, {"poses", poses}, {"records_corrected", read.corrected}};
}

// Named as in a calibration file: what movements of the wheels are multiplied by, and turned per metre.
ordered_json wheelsJson(const FrontEnds& sensors) {
  const WheelCorrection correction = sensors.wheelCorrection();
  const Eigen::Vector3d sigma = sensors.wheelCalibration().standardDeviations();
  return {{"movements_compared", sensors.wheelCalibration().compared()},
          {"scale", correction.scale},
          {"turn_scale", correction.turn_scale},
          {"drift_rad_m", correction.drift_rad_m},
          {"sigma", {{"scale", sigma[0]}, {"turn_scale", sigma[1]}, {"drift_rad_m", sigma[2]}}}};
}

// What was added to the stamps of sensors, and what would still have to be; where time went on as all clocks were set back.
ordered_json clocksJson(const std::vector<ClockSetting>& set, const SensorClocks& clocks, const std::vector<ClockSetBack>& set_back) {
  ordered_json settings = ordered_json::array(), left = nullptr, back = ordered_json::array();
  for (const ClockSetBack& step : set_back) back.push_back({{"t", step.t}, {"seconds", step.seconds}});
  for (const ClockSetting& clock : set)
    settings.push_back(jsonOf(clock));
  if (const auto offsets = clocks.offsets())
    for (std::size_t i = 0; i < offsets->size(); ++i)
      if (clocks.isThere(kMotionSensors[i])) left[toString(kMotionSensors[i])] = {{"offset_s", (*offsets)[i].seconds}, {"sigma_s", (*offsets)[i].sigma}};
  return {{"set", settings}, {"left", left}, {"set_back", back}};
}

// By what poses of sensors were turned, and by what the ways that two sensors saw are turned still (none while too little was driven).
ordered_json mountsJson(const std::vector<MountSetting>& set, const MovementAgreement& agreement) {
  ordered_json settings = ordered_json::array(), left = ordered_json::array();
  for (const MountSetting& mount : set) settings.push_back(jsonOf(mount));
  for (std::size_t i = 0; i < kMotionSensors.size(); ++i) {
    const MotionSensor sensor = kMotionSensors[i], other = kMotionSensors[(i + 1) % kMotionSensors.size()];
    if (const auto turned = agreement.turned(sensor, other))
      left.push_back({{"sensor", toString(sensor)}, {"against", toString(other)}, {"yaw_deg", turned->rad / kDegree}, {"sigma_deg", turned->sigma_rad / kDegree}});
  }
  return {{"set", settings}, {"left", left}};
}

// Nothing when the recording was not examined.
ordered_json findingsJson(const std::optional<std::vector<Finding>>& findings) {
  if (!findings) return nullptr;
  ordered_json out = ordered_json::array();
  for (const auto& finding : *findings)
    out.push_back({{"severity", toString(finding.severity)},
                   {"place", finding.place},
                   {"what", finding.what},
                   {"hint", finding.hint}});
  return out;
}

ordered_json summaryJson(const SemanticSlam& slam, const SlamResult& result, const ReadStatistics& read,
                         const ReplayState& replayed, const RunOrigin& origin) {
  ordered_json summary{{"input", origin.input},
                       {"version", origin.version},
                       {"revision", origin.revision},
                       {"command", origin.command},
                       {"interrupted", replayed.interrupted ? "yes" : "no"},
                       {"resumed", origin.resumed ? "yes" : "no"},
                       {"replay", replayJson(replayed)},
                       {"counts", countsJson(result)}};
  if (const auto& detector = slam.setup().stages.detector)
    summary["detector"] = detectorJson(*detector, origin);
  if (result.earlier) summary["earlier_map"] = earlierMapJson(*result.earlier);
  summary["reasons"] = result.counts.reasons;
  if (const auto& file = slam.setup().options.general.calibration_file; !file.empty())
    summary["calibration"] = calibrationJson(file, read);
  if (slam.frontEnds().wheelCalibration().compared() > 0) summary["wheels"] = wheelsJson(slam.frontEnds());
  summary["clocks"] = clocksJson(origin.clocks, slam.frontEnds().clocks(), read.clocks_set_back);
  summary["sensor_poses"] = mountsJson(origin.mounts, slam.frontEnds().agreement());
  summary["records_used"] = read.used;
  summary["records_skipped"] = read.skipped;
  summary["input_warning"] = read.warning;
  summary["sensor_warnings"] = read.sensor_warnings;
  summary["findings"] = findingsJson(origin.findings);
  summary["timings"] = timingsJson(slam.times());
  if (origin.wall_s > 0) summary["wall_s"] = std::round(1e3 * origin.wall_s) / 1e3;
  summary["peak_memory_mb"] = peakMemoryMb();
  return summary;
}

// Nothing that differs from one run to its repetition: the same input gives the same bytes.
CSemanticMap withProvenance(const SlamResult& result, const Setup& setup, const RunOrigin& origin) {
  CSemanticMap map = result.map;
  for (const auto& landmark : map.landmarks)
    if (const auto span = result.seen.find(landmark.id); span != result.seen.end()) map.seen.insert(*span);
  map.provenance = {"roomgraph " + origin.version + " (" + origin.revision + ")", setup.effective_config,
                    setup.objects, result.map.provenance.history};
  const bool continued = result.earlier && result.earlier->recognised;
  map.provenance.history.push_back((continued ? "continued by a run of " : "run of ") + map.origin);
  return map;
}

LandmarksOrigin originOf(const SlamResult& result, const RunOrigin& origin) {
  LandmarksOrigin out{result.map.origin, origin.version + " (" + origin.revision + ")", result.seen, {}};
  for (const auto& [landmark, evidence] : result.candidates) {
    const auto values = evidence.values();
    for (std::size_t i = 0; i < values.size(); ++i)
      out.evidence[landmark.id][std::string(ExistenceEvidence::kNames[i])] = values[i];
  }
  return out;
}

void writeTimings(std::ostream& out, const StageTimes& times) {
  out << "timestamp,stage,ms,cpu_ms,memory_mb\n" << std::fixed;
  for (const auto& call : times.calls())
    out << std::setprecision(6) << call.t << ',' << call.stage << std::setprecision(3) << ',' << call.ms
        << ',' << call.cpu_ms << std::setprecision(1) << ',' << call.memory_mb << '\n';
}

}  // namespace

void writeTum(std::ostream& out, const std::vector<StampedPose>& poses) {
  for (const auto& stamped : poses) writeStamped(out, stamped.t, stamped.pose);
}

RunOutput::RunOutput(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& inputs)
    : files_(folder,
             {"live.tum",
              "detections.jsonl",
              "associations_live.jsonl",
              "trajectory.tum",
              "trajectory_camera.tum",
              "associations.jsonl",
              "landmarks.json",
              "candidates.json",
              "map.pgm",
              "map.yaml",
              "map.rgmap",
              "graph.g2o",
              "config.ini",
              "objects.ini",
              "timings.csv",
              "views.jsonl",
              "lost.jsonl",
              "snapshot.png",
              "report.html",
              "summary.json"},
             inputs),
      live_(files_.pending("live.tum")),
      detections_(files_.pending("detections.jsonl")),
      associations_(files_.pending("associations_live.jsonl")) {}

void RunOutput::onStep(const StepReport& report) {
  lost_.onStep(report);
  if (report.kind == StepReport::Kind::kOther) return;
  views_.onStep(report);
  writeStamped(live_, report.t, report.world_from_robot);
  if (report.detections.current()) detections_ << detectionsLine(report) << '\n';
  if (!report.decisions.empty())
    associations_ << associationsLine(report.t, report.decisions) << '\n';
  for (OutputFile* file : {&live_, &detections_, &associations_}) file->check();
}

void RunOutput::write(const std::string& name, const std::string& text) const {
  writeFileAtomically(files_.pending(name), text);
}

// What grows with the recording is not made in memory first.
void RunOutput::stream(const std::string& name, const std::function<void(std::ostream&)>& text) const {
  OutputFile file(files_.pending(name));
  text(file);
  file.finish();
}

void RunOutput::writeResult(const SemanticSlam& slam, const SlamResult& result, const ReadStatistics& read,
                            const ReplayState& replayed, const RunOrigin& origin) {
  for (OutputFile* file : {&live_, &detections_, &associations_}) file->finish();
  stream("trajectory.tum", [&](std::ostream& out) { writeTum(out, result.world_from_robot); });
  stream("trajectory_camera.tum", [&](std::ostream& out) { writeTum(out, result.world_from_camera); });
  stream("associations.jsonl", [&](std::ostream& out) {
    writeAssociations(out, slam.objects().frames());
  });
  const LandmarksOrigin where = originOf(result, origin);
  std::vector<Landmark> candidates;
  for (const auto& candidate : result.candidates) candidates.push_back(candidate.landmark);
  saveLandmarksJson(result.map.landmarks, files_.pending("landmarks.json"), where);
  saveLandmarksJson(candidates, files_.pending("candidates.json"), where);
  if (result.map.occupancy)
    saveOccupancyRos(*result.map.occupancy, files_.pending("map.pgm").replace_extension());
  saveMap(withProvenance(result, slam.setup(), origin), files_.pending("map.rgmap"));
  saveGraph(slam, result.map.planar, files_.pending("graph.g2o"));
  write("config.ini", slam.setup().effective_config);
  write("objects.ini", slam.setup().objects);
  stream("timings.csv", [&](std::ostream& out) { writeTimings(out, slam.times()); });
  write("views.jsonl", views_.text(slam.objects().frames()));
  write("lost.jsonl", lost_.text());
  write("summary.json", textOf(summaryJson(slam, result, read, replayed, origin), 2) + "\n");
}

}  // namespace roomgraph

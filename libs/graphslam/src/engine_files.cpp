// SPDX-License-Identifier: BSD-3-Clause
// Names and texts of the result files.
#include "roomgraph/graphslam/engine_files.h"

#include <nlohmann/json.hpp>

#include "roomgraph/core/output_file.h"
#include "roomgraph/pipeline/run_output.h"

namespace roomgraph {

std::vector<std::string> engineFileNames(const EngineIni& ini) {
  return {"CGraphSlamEngine.log", "timings.log",    "node_registrar.log",          "edge_registrar.log",
          "optimizer.log",        "SLAM_evaluation_metric.log", ini.graph_file, ini.scene_file,
          ini.map_file + ".png",  ini.map_file + "_limits.txt", "landmarks.json", "trajectory.tum", "summary.json"};
}

void writeTrajectory(const std::filesystem::path& file, const std::vector<StampedPose>& world_from_robot) {
  OutputFile out(file);
  writeTum(out, world_from_robot);
  out.finish();
}

void writeObjects(const std::filesystem::path& file, const std::map<LandmarkId, PlacedObject>& objects) {
  nlohmann::ordered_json json{{"landmarks", nlohmann::ordered_json::array()}};
  for (const auto& [id, object] : objects)
    json["landmarks"].push_back({{"id", id.value},
                                 {"class", object.class_name},
                                 {"x", object.position.x()},
                                 {"y", object.position.y()},
                                 {"z", object.position.z()},
                                 {"yaw", object.yaw},
                                 {"has_yaw", object.has_yaw},
                                 {"size_wdh", {object.size_m.x(), object.size_m.y(), object.size_m.z()}},
                                 {"nodes", object.nodes}});
  OutputFile out(file);
  out << json.dump(1) << "\n";
  out.finish();
}

void writeEngineSummary(const std::filesystem::path& file, const EngineRequest& request, const EngineOutcome& outcome) {
  const nlohmann::ordered_json json{{"recording", request.rawlog.string()},
                                    {"ini", request.ini.string()},
                                    {"dimensions", outcome.parts.dimensions},
                                    {"node_registration_decider", outcome.parts.node},
                                    {"edge_registration_deciders", outcome.parts.edges},
                                    {"optimizer", outcome.parts.optimizer},
                                    {"records", outcome.records},
                                    {"share", outcome.share},
                                    {"interrupted", outcome.interrupted},
                                    {"nodes", outcome.nodes},
                                    {"edges", outcome.edges},
                                    {"loop_closures", outcome.closures},
                                    {"warnings", outcome.warnings}};
  OutputFile out(file);
  out << json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
  out.finish();
}

}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// Writer of landmarks.json: header, and one line per landmark.
#include <cmath>
#include <nlohmann/json.hpp>

#include "roomgraph/core/output_file.h"
#include "roomgraph/mapping/map_files.h"

namespace roomgraph {
namespace {

using Json = nlohmann::ordered_json;

Json footprintPolygon(const Landmark& landmark) {
  Json polygon = Json::array();
  const Pose2 world_from_object{landmark.position.x(), landmark.position.y(), landmark.yaw};
  for (const auto& p : footprintAt(world_from_object, landmark.shape)) polygon.push_back({p.x(), p.y()});
  return polygon;
}

Json toJson(const Landmark& landmark) {
  Json covariance = Json::array();
  for (int i = 0; i < 4; ++i) {
    Json row = Json::array();
    for (int j = 0; j < 4; ++j) row.push_back(landmark.covariance(i, j));
    covariance.push_back(row);
  }
  return {{"id", landmark.id.value},
          {"class", landmark.class_name},
          {"model", landmark.model},
          {"x", landmark.position.x()},
          {"y", landmark.position.y()},
          {"z", landmark.position.z()},
          {"yaw", landmark.yaw},
          {"has_yaw", landmark.has_yaw},
          {"shape", toString(landmark.shape.kind)},
          {"size_wdh", {landmark.shape.width, landmark.shape.depth, landmark.shape.height}},
          {"footprint", footprintPolygon(landmark)},
          {"covariance", covariance},
          {"existence", landmark.existence},
          {"class_posterior", Json(landmark.class_posterior)},
          {"observations", landmark.observations}};
}

}  // namespace

void saveLandmarksJson(const std::vector<Landmark>& landmarks, const std::filesystem::path& file,
                       const LandmarksOrigin& origin) {
  Json header{{"frame", "world"},
              {"units", {{"length", "m"}, {"angle", "rad"}, {"time", "s"}}},
              {"recording", origin.recording},
              {"program", "roomgraph"},
              {"version", origin.version}};
  std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  // One landmark per line: short, and readable in a diff.
  text.back() = ',';
  text += "\n\"landmarks\": [";
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    Json json = toJson(landmarks[i]);
    if (const auto seen = origin.seen.find(landmarks[i].id); seen != origin.seen.end()) {
      json["first_seen"] = seen->second.first;
      json["last_seen"] = seen->second.last;
    }
    if (landmarks[i].stands_since) json["stands_since"] = *landmarks[i].stands_since;
    if (const auto why = origin.evidence.find(landmarks[i].id); why != origin.evidence.end())
      json["evidence"] = why->second;
    text += (i ? ",\n  " : "\n  ") + json.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  writeFileAtomically(file, text + "\n]}\n");
}

}  // namespace roomgraph

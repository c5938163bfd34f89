// SPDX-License-Identifier: BSD-3-Clause
// Fields of landmarks.json and candidates.json, and their union.
#include "object_list.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "roomgraph/core/json_integer.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using nlohmann::json;

ReportedObject objectOf(const json& entry) {
  ReportedObject object;
  entry.at("id").get_to(object.id);
  entry.at("class").get_to(object.class_name);
  object.model = entry.value("model", "");
  object.shape = entry.value("shape", "");
  entry.at("x").get_to(object.x);
  entry.at("y").get_to(object.y);
  entry.at("z").get_to(object.z);
  entry.at("yaw").get_to(object.yaw);
  object.has_yaw = entry.value("has_yaw", true);
  entry.at("size_wdh").get_to(object.size);
  entry.at("footprint").get_to(object.footprint);
  const json& covariance = entry.at("covariance");
  object.covariance_xy = {covariance.at(0).at(0), covariance.at(0).at(1), covariance.at(1).at(1)};
  object.z_sigma_m = std::sqrt(covariance.at(2).at(2).get<double>());
  object.yaw_sigma_rad = std::sqrt(covariance.at(3).at(3).get<double>());
  entry.at("existence").get_to(object.existence);
  entry.at("class_posterior").get_to(object.class_posterior);
  object.observations = integerOf<int>(entry, "observations", 0);
  if (entry.contains("evidence")) entry.at("evidence").get_to(object.evidence);
  return object;
}

}  // namespace

ObjectFile readObjectFile(const std::filesystem::path& file) {
  const json content = parseJson<json>(readTextFile(file), file.string());
  ObjectFile out;
  std::size_t number = 0;
  try {
    out.recording = content.value("recording", "");
    out.version = content.value("version", "");
    for (const json& entry : content.at("landmarks")) {
      ++number;
      out.objects.push_back(objectOf(entry));
    }
  } catch (const json::exception& error) {
    const std::string where = number > 0 ? "object " + std::to_string(number) + ": " : "";
    throw InputError(file.string() + ": " + where + firstLine(error));
  }
  return out;
}

std::vector<ReportedObject> merged(std::vector<ReportedObject> mapped,
                                   std::vector<ReportedObject> candidates) {
  std::map<int, ReportedObject*> of_map;
  for (auto& object : mapped) of_map[object.id] = &object;
  std::vector<ReportedObject> others;
  for (auto& candidate : candidates) {
    const auto known = of_map.find(candidate.id);
    if (known == of_map.end()) {
      candidate.in_map = false;
      others.push_back(candidate);
    } else if (known->second->evidence.empty()) {
      known->second->evidence = candidate.evidence;
    }
  }
  mapped.insert(mapped.end(), others.begin(), others.end());
  return mapped;
}

}  // namespace roomgraph

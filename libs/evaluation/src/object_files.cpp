// SPDX-License-Identifier: BSD-3-Clause
// Parsers of objects.json and landmarks.json; visibility rule over boxes.jsonl.
#include "roomgraph/evaluation/object_files.h"

#include <map>

#include "json_lines.h"
#include "roomgraph/core/json_integer.h"
#include "roomgraph/core/text_file.h"

namespace roomgraph {
namespace {

using nlohmann::json;

EvaluatedObject toObject(const json& record) {
  EvaluatedObject out;
  out.id = integerOf<int>(record.at("id"));
  out.class_name = record.at("class").get<std::string>();
  out.kind = record.value("kind", out.class_name);
  out.position = {record.at("x").get<double>(), record.at("y").get<double>(), record.at("z").get<double>()};
  const auto yaw = record.find("yaw");
  out.has_yaw = yaw != record.end() && !yaw->is_null() && record.value("has_yaw", true);
  if (out.has_yaw) out.yaw = yaw->get<double>();
  const auto size = record.at("size_wdh").get<std::vector<double>>();
  if (size.size() != 3) throw std::invalid_argument("size_wdh must have 3 numbers");
  out.width = size[0];
  out.depth = size[1];
  out.height = size[2];
  out.existence = record.value("existence", 1.0);
  if (const auto covariance = record.find("covariance"); covariance != record.end() && !covariance->is_null())
    out.place_covariance = Eigen::Matrix2d{{covariance->at(0).at(0), covariance->at(0).at(1)},
                                           {covariance->at(1).at(0), covariance->at(1).at(1)}};
  return out;
}

bool isGoodView(const json& object, const VisibilityRule& rule) {
  const json& depth = object.at("z_med");
  return object.at("visible").get<double>() > rule.min_visible &&
         boxFrom(object.at("bbox")).height() > rule.min_height_px && depth.is_number() &&
         depth.get<double>() < rule.max_depth_m;
}

}  // namespace

std::vector<EvaluatedObject> readObjects(const std::filesystem::path& file) {
  const auto content = parseJson<json>(readTextFile(file), file.string());
  std::vector<EvaluatedObject> objects;
  std::string place = file.string();
  try {
    const char* key = content.contains("landmarks") ? "landmarks" : "objects";
    const json& records = content.at(key);
    for (std::size_t i = 0; i < records.size(); ++i) {
      place = file.string() + ": " + key + "[" + std::to_string(i) + "]";
      objects.push_back(toObject(records.at(i)));
    }
  } catch (const std::exception& error) {
    throw InputError(place + ": " + firstLine(error));
  }
  return objects;
}

std::set<int> readSeenObjects(const std::filesystem::path& boxes_jsonl, const VisibilityRule& rule) {
  std::map<int, int> good_frames;
  const int lines = forEachJsonLine(boxes_jsonl, [&](const json& frame) {
    for (const auto& object : frame.at("objects"))
      if (isGoodView(object, rule)) ++good_frames[integerOf<int>(object.at("id"))];
  });
  if (lines == 0) throw InputError(boxes_jsonl.string() + ": is empty");
  std::set<int> seen;
  for (const auto& [id, frames] : good_frames)
    if (frames >= rule.min_frames) seen.insert(id);
  return seen;
}

}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// landmarks.json: writer, and reader with checks of every field.
#include <cmath>
#include <nlohmann/json.hpp>

#include "roomgraph/core/output_file.h"
#include "roomgraph/core/text_file.h"
#include "roomgraph/mapping/map_files.h"

namespace roomgraph {
namespace {

using Json = nlohmann::ordered_json;

Json footprintInWorld(const Landmark& landmark) {
  Json polygon = Json::array();
  const Pose2 world_from_object{landmark.position.x(), landmark.position.y(), landmark.yaw};
  for (const auto& corner : footprint(landmark.shape)) {
    const Eigen::Vector2d p = world_from_object * corner;
    polygon.push_back({p.x(), p.y()});
  }
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
          {"footprint", footprintInWorld(landmark)},
          {"covariance", covariance},
          {"existence", landmark.existence},
          {"class_posterior", Json(landmark.class_posterior)},
          {"observations", landmark.observations}};
}

/// One entry with its place, for messages; typed access that says what is wrong.
class Entry {
 public:
  Entry(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
    if (!json.is_object()) fail("is not an object");
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(place_ + ": " + what); }
  bool has(const char* key) const { return json_.contains(key) && !json_[key].is_null(); }
  const Json& at(const char* key) const {
    if (!json_.contains(key)) fail(std::string("field '") + key + "' is missing");
    return json_[key];
  }
  double number(const Json& value, const char* key) const {
    if (!value.is_number()) fail(std::string("field '") + key + "' is not a number: " + value.dump());
    return value.get<double>();
  }
  double number(const char* key) const { return number(at(key), key); }
  double number(const char* key, double fallback) const { return has(key) ? number(key) : fallback; }
  std::int64_t integer(const char* key) const {
    if (!at(key).is_number_integer())
      fail(std::string("field '") + key + "' is not an integer: " + at(key).dump());
    return at(key).get<std::int64_t>();
  }
  std::string text(const char* key) const {
    if (!at(key).is_string()) fail(std::string("field '") + key + "' is not a text: " + at(key).dump());
    return at(key).get<std::string>();
  }
  const Json& array(const Json& value, const char* key, std::size_t size) const {
    if (!value.is_array() || value.size() != size)
      fail(std::string("field '") + key + "' is not a list of " + std::to_string(size));
    return value;
  }

 private:
  const Json& json_;
  std::string place_;
};

ObjectShape readShape(const Entry& entry) {
  ObjectShape shape;
  if (entry.has("shape")) {
    try {
      shape.kind = shapeKindFromString(entry.text("shape"));
    } catch (const std::invalid_argument& error) {
      entry.fail(std::string("field 'shape': ") + error.what());
    }
  }
  const Json& size = entry.array(entry.at("size_wdh"), "size_wdh", 3);
  shape.width = entry.number(size[0], "size_wdh");
  shape.depth = entry.number(size[1], "size_wdh");
  shape.height = entry.number(size[2], "size_wdh");
  if (shape.width < 0 || shape.depth < 0 || shape.height < 0) entry.fail("field 'size_wdh' is negative");
  return shape;
}

Eigen::Matrix4d readCovariance(const Entry& entry) {
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  if (!entry.has("covariance")) return covariance;
  const Json& rows = entry.array(entry.at("covariance"), "covariance", 4);
  for (int i = 0; i < 4; ++i) {
    const Json& row = entry.array(rows[static_cast<std::size_t>(i)], "covariance", 4);
    for (int j = 0; j < 4; ++j)
      covariance(i, j) = entry.number(row[static_cast<std::size_t>(j)], "covariance");
  }
  return covariance;
}

Landmark readLandmark(const Entry& entry) {
  Landmark landmark;
  landmark.id.value = entry.integer("id");
  landmark.class_name = entry.text("class");
  if (entry.has("kind"))
    landmark.model = entry.text("kind");
  else if (entry.has("model"))
    landmark.model = entry.text("model");
  landmark.shape = readShape(entry);
  landmark.position = {entry.number("x"), entry.number("y"), entry.number("z")};
  landmark.yaw = entry.number("yaw", 0);
  landmark.has_yaw = entry.has("yaw");
  if (entry.has("has_yaw")) {
    if (!entry.at("has_yaw").is_boolean()) entry.fail("field 'has_yaw' is not true or false");
    landmark.has_yaw = entry.at("has_yaw").get<bool>();
  }
  landmark.covariance = readCovariance(entry);
  landmark.existence = entry.number("existence", 1);
  if (entry.has("class_posterior")) {
    if (!entry.at("class_posterior").is_object()) entry.fail("field 'class_posterior' is not an object");
    for (const auto& [name, value] : entry.at("class_posterior").items())
      landmark.class_posterior[name] = entry.number(value, "class_posterior");
  } else {
    landmark.class_posterior[landmark.class_name] = 1;
  }
  landmark.observations = entry.has("observations") ? static_cast<int>(entry.integer("observations")) : 0;
  return landmark;
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
    text += (i ? ",\n  " : "\n  ") + json.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  writeFileAtomically(file, text + "\n]}\n");
}

std::vector<Landmark> loadLandmarksJson(const std::filesystem::path& file) {
  const auto json = parseJson<Json>(readTextFile(file), file.string());
  if (!json.is_object() || json.contains("landmarks") == json.contains("objects"))
    throw InputError(file.string() + ": no list under 'landmarks' or 'objects'");
  const std::string key = json.contains("landmarks") ? "landmarks" : "objects";
  const Json& list = json[key];
  if (!list.is_array()) throw InputError(file.string() + ": '" + key + "' is not a list");
  std::vector<Landmark> landmarks;
  for (std::size_t i = 0; i < list.size(); ++i)
    landmarks.push_back(
        readLandmark(Entry(list[i], file.string() + ": " + key + "[" + std::to_string(i) + "]")));
  return landmarks;
}

}  // namespace roomgraph

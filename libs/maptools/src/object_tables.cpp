// SPDX-License-Identifier: BSD-3-Clause
// Objects as GeoJSON and as CSV.
#include <nlohmann/json.hpp>

#include "exporters.h"
#include "text_numbers.h"

namespace roomgraph {
namespace {

using GeoJson = nlohmann::ordered_json;

// RFC 4180.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

double sigma(const Landmark& landmark, int axis) {
  return std::sqrt(std::max(0.0, landmark.covariance(axis, axis)));
}

GeoJson featureOf(const Landmark& landmark, const SeenSpans& spans) {
  GeoJson ring = GeoJson::array();
  auto corners = footprintOf(landmark);
  corners.push_back(corners.front());
  for (const auto& p : corners) ring.push_back({p.x(), p.y()});
  GeoJson properties{{"id", landmark.id.value},
                     {"class", landmark.class_name},
                     {"model", landmark.model},
                     {"shape", toString(landmark.shape.kind)},
                     {"x", landmark.position.x()},
                     {"y", landmark.position.y()},
                     {"z", landmark.position.z()},
                     {"yaw", landmark.has_yaw ? GeoJson(landmark.yaw) : GeoJson(nullptr)},
                     {"size_wdh", {landmark.shape.width, landmark.shape.depth, landmark.shape.height}},
                     {"existence", landmark.existence},
                     {"sigma_x", sigma(landmark, 0)},
                     {"sigma_y", sigma(landmark, 1)},
                     {"class_posterior", GeoJson(landmark.class_posterior)},
                     {"observations", landmark.observations}};
  if (const auto seen = spans.find(landmark.id); seen != spans.end()) {
    properties["first_seen"] = seen->second.first;
    properties["last_seen"] = seen->second.last;
  }
  return {{"type", "Feature"},
          {"id", landmark.id.value},
          {"geometry", {{"type", "Polygon"}, {"coordinates", GeoJson::array({ring})}}},
          {"properties", properties}};
}

}  // namespace

std::string geojsonText(const CSemanticMap& map) {
  // Plane coordinates: RFC 7946 knows degrees only, so the frame is said.
  GeoJson json{{"type", "FeatureCollection"},
               {"coordinate_frame", "world of the map: x, y in m"},
               {"recording", map.origin},
               {"features", GeoJson::array()}};
  for (const auto& landmark : map.landmarks) json["features"].push_back(featureOf(landmark, map.seen));
  return json.dump(1, ' ', false, GeoJson::error_handler_t::replace) + "\n";
}

std::string csvText(const CSemanticMap& map) {
  std::string text =
      "id,class,model,shape,x_m,y_m,z_m,yaw_rad,width_m,depth_m,height_m,existence,observations,sigma_x_m,"
      "sigma_y_m,sigma_yaw_rad,first_seen_s,last_seen_s\r\n";
  for (const auto& o : map.landmarks) {
    const auto seen = map.seen.find(o.id);
    const bool known = seen != map.seen.end();
    text += std::to_string(o.id.value) + "," + quoted(o.class_name) + "," + quoted(o.model) + "," +
            toString(o.shape.kind) + "," + decimals(o.position.x(), 4) + "," + decimals(o.position.y(), 4) +
            "," + decimals(o.position.z(), 4) + "," + (o.has_yaw ? decimals(o.yaw, 4) : "") + "," +
            decimals(o.shape.width, 4) + "," + decimals(o.shape.depth, 4) + "," +
            decimals(o.shape.height, 4) + "," + decimals(o.existence, 4) + "," +
            std::to_string(o.observations) + "," + decimals(sigma(o, 0), 4) + "," + decimals(sigma(o, 1), 4) +
            "," + (o.has_yaw ? decimals(sigma(o, 3), 4) : "") + "," +
            (known ? decimals(seen->second.first) : "") + "," + (known ? decimals(seen->second.last) : "") +
            "\r\n";
  }
  return text;
}

}  // namespace roomgraph

// SPDX-License-Identifier: BSD-3-Clause
// JSON encoding of detections in CObservationComment and its validation.
#include "roomgraph/observations/detection_comment.h"

#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "roomgraph/core/json_integer.h"

namespace roomgraph {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CObservationComment;
using Json = nlohmann::ordered_json;

constexpr const char* kMarker = "roomgraph_detections";  // its value is the version of what follows
constexpr int kVersion = 1;

Json toJson(const CObservationDetections::Item& item) {
  Json out{{"label", item.label},
           {"score", item.score},
           {"bbox", {item.u_min, item.v_min, item.u_max, item.v_max}}};
  if (item.track >= 0) out["track"] = item.track;
  if (!item.mask.runs.empty())
    out["mask"] = {{"width", item.mask.width}, {"height", item.mask.height}, {"runs", item.mask.runs}};
  return out;
}

// x, y, z, yaw, pitch, roll; MRPT's identity has a pitch of -0, which nobody wants to read.
Json numbersOf(const mrpt::poses::CPose3D& pose) {
  return {pose.x(), pose.y(), pose.z(), pose.yaw() + 0.0, pose.pitch() + 0.0, pose.roll() + 0.0};
}

// nlohmann converts -1 and 1e12 as C does, without a word.
std::uint32_t countFrom(const Json& json) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument(json.dump() + " is no count");
  return json.get<std::uint32_t>();
}

CObservationDetections::Item itemFrom(const Json& json) {
  CObservationDetections::Item item;
  item.label = json.at("label").get<std::string>();
  item.score = json.at("score").get<double>();
  const auto sides = json.at("bbox").get<std::array<double, 4>>();
  item.u_min = sides[0];
  item.v_min = sides[1];
  item.u_max = sides[2];
  item.v_max = sides[3];
  item.track = integerOf<std::int64_t>(json, "track", -1);
  if (const auto mask = json.find("mask"); mask != json.end()) {
    item.mask.width = countFrom(mask->at("width"));
    item.mask.height = countFrom(mask->at("height"));
    for (const Json& run : mask->at("runs")) item.mask.runs.push_back(countFrom(run));
  }
  return item;
}

void fill(CObservationDetections& out, const Json& json) {
  if (const int version = integerOf<int>(json.at(kMarker)); version != kVersion)
    throw std::invalid_argument("version " + std::to_string(version) + " is not known");
  // MRPT 2.5 does not write the label of a comment; where a later one does, a tool may have changed it.
  if (out.sensorLabel.empty()) out.sensorLabel = json.at("sensor_label").get<std::string>();
  out.image_label = json.at("image_label").get<std::string>();
  out.image_width = countFrom(json.at("image_size").at(0));
  out.image_height = countFrom(json.at("image_size").at(1));
  out.model = json.at("model").get<std::string>();
  out.model_hash = json.at("model_hash").get<std::string>();
  out.score_threshold = json.at("score_threshold").get<float>();
  out.nms_threshold = json.at("nms_threshold").get<float>();
  const auto pose = json.at("sensor_pose").get<std::array<double, 6>>();
  out.setSensorPose({pose[0], pose[1], pose[2], pose[3], pose[4], pose[5]});
  for (const Json& item : json.at("items")) out.items.push_back(itemFrom(item));
  if (json.contains("unsought")) out.unsought = json.at("unsought").get<std::vector<std::string>>();
}

}  // namespace

CObservationComment toComment(const CObservationDetections& detections) {
  mrpt::poses::CPose3D pose;
  detections.getSensorPose(pose);
  Json json{{kMarker, kVersion},
            {"sensor_label", detections.sensorLabel},
            {"image_label", detections.image_label},
            {"image_size", {detections.image_width, detections.image_height}},
            {"model", detections.model},
            {"model_hash", detections.model_hash},
            {"score_threshold", detections.score_threshold},
            {"nms_threshold", detections.nms_threshold},
            {"sensor_pose", numbersOf(pose)},
            {"items", Json::array()}};
  for (const auto& item : detections.items) json["items"].push_back(toJson(item));
  if (!detections.unsought.empty()) json["unsought"] = detections.unsought;
  CObservationComment out;
  out.timestamp = detections.timestamp;
  out.sensorLabel = detections.sensorLabel;
  out.text = json.dump(-1, ' ', false, Json::error_handler_t::replace);  // a file's name may be no UTF-8
  return out;
}

bool holdsDetections(const CObservationComment& comment) {
  const auto first = comment.text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && comment.text[first] == '{' &&
         comment.text.find(std::string("\"") + kMarker + "\"") != std::string::npos;
}

Outcome<CObservationDetections::Ptr> fromComment(const CObservationComment& comment) {
  auto out = std::make_shared<CObservationDetections>();
  out->timestamp = comment.timestamp;
  out->sensorLabel = comment.sensorLabel;
  try {
    fill(*out, Json::parse(comment.text));
  } catch (const std::exception&) {
    // What the parser says names places in the text: every damaged record would have a reason of its own.
    return Outcome<CObservationDetections::Ptr>::failure(
        "broken record: CObservationComment: its text is no valid record of detections");
  }
  return out;
}

Outcome<CObservation::Ptr> unpacked(const CObservation::Ptr& observation) {
  const auto comment = std::dynamic_pointer_cast<CObservationComment>(observation);
  if (!comment || !holdsDetections(*comment)) return observation;
  const auto detections = fromComment(*comment);
  if (!detections) return Outcome<CObservation::Ptr>::failure(detections.reason());
  return CObservation::Ptr(*detections);
}

}  // namespace roomgraph
